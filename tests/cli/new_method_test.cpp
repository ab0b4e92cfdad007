// lodbench new-method, as a user calls it.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;

struct Outcome {
    int status = -1;
    std::string output;
};

std::string read(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

class NewMethod : public ::testing::Test {
protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "lodbench-new-method-XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override { fs::remove_all(folder_); }

    [[nodiscard]] Outcome run(const std::string& arguments) const {
        const std::string command = "cd '" + folder_.string() +
                                    "' && " LODBENCH_BINARY " new-method " + arguments + " 2>&1";
        Outcome outcome;
        FILE* pipe = popen(command.c_str(), "r");
        if (pipe == nullptr) return outcome;
        std::array<char, 4096> buffer;
        while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
            outcome.output.append(buffer.data(), count);
        }
        const int status = pclose(pipe);
        outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        return outcome;
    }

    fs::path folder_;
};

TEST_F(NewMethod, writes_a_project_of_its_own_outside_a_checkout) {
    const Outcome outcome = run("two-words");
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    const fs::path project = folder_ / "two-words";
    const std::string source = read(project / "two_words.cpp");
    EXPECT_NE(source.find(".id = \"two-words\""), std::string::npos);
    EXPECT_NE(source.find("class TwoWords final"), std::string::npos);
    EXPECT_NE(source.find("\"two_words.vert\""), std::string::npos);
    EXPECT_TRUE(fs::exists(project / "two_words.vert"));
    EXPECT_EQ(read(project / "README.md").substr(0, 12), "# two-words\n");
    const std::string list = read(project / "CMakeLists.txt");
    EXPECT_NE(list.find("project(two_words"), std::string::npos);
    EXPECT_NE(
        list.find("lodbench_add_method(two_words SOURCES two_words.cpp SHADERS two_words.vert)"),
        std::string::npos);
    for (const auto& entry : fs::directory_iterator(project)) {
        const std::string text = read(entry.path());
        EXPECT_EQ(text.find("template_method"), std::string::npos) << entry.path();
        EXPECT_EQ(text.find("TemplateMethod"), std::string::npos) << entry.path();
    }
    EXPECT_NE(outcome.output.find("cmake -S two-words -B two-words/build -DCMAKE_PREFIX_PATH="),
              std::string::npos);
    EXPECT_NE(outcome.output.find("cmake --build two-words/build"), std::string::npos);
    EXPECT_NE(outcome.output.find("run --plugin-dir two-words/build --method two-words"),
              std::string::npos);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1)
        << "something unfinished is left";
}

TEST_F(NewMethod, adds_a_room_and_one_line_in_a_checkout) {
    fs::create_directory(folder_ / "methods");
    std::ofstream(folder_ / "methods" / "CMakeLists.txt") << "add_subdirectory(full_grid)";
    const Outcome outcome = run("two-words");
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    EXPECT_TRUE(fs::exists(folder_ / "methods" / "two_words" / "two_words.cpp"));
    EXPECT_EQ(read(folder_ / "methods" / "CMakeLists.txt"),
              "add_subdirectory(full_grid)\nadd_subdirectory(two_words)\n");
    EXPECT_NE(outcome.output.find("--method two-words"), std::string::npos);
}

TEST_F(NewMethod, writes_where_dir_says) {
    const Outcome outcome = run("hello --dir deep/er");
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    EXPECT_TRUE(fs::exists(folder_ / "deep" / "er" / "hello" / "hello.cpp"));
}

TEST_F(NewMethod, never_overwrites) {
    fs::create_directory(folder_ / "hello");
    std::ofstream(folder_ / "hello" / "mine.txt") << "precious";
    const Outcome outcome = run("hello");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.output.find("hello exists already and is left as it is"), std::string::npos);
    EXPECT_EQ(read(folder_ / "hello" / "mine.txt"), "precious");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "hello"), {}), 1);
}

TEST_F(NewMethod, refuses_names_that_are_no_method_ids) {
    const std::string too_long(65, 'a');
    for (const std::string& name :
         {std::string("''"), std::string("Hello"), std::string("1st"), std::string("a_b"),
          std::string("a/b"), std::string("../up"), std::string("'a b'"), std::string("template"),
          std::string("pgm"), too_long}) {
        const Outcome outcome = run(name);
        EXPECT_EQ(outcome.status, 2) << name << ": " << outcome.output;
        EXPECT_NE(outcome.output.find("new-method"), std::string::npos) << outcome.output;
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 0);
}

}  // namespace
