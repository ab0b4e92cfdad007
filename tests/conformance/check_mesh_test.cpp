// The independent check of an exported mesh notices what is wrong with it.

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "support/mesh_tools.h"

namespace lodbench::test {
namespace {

class CheckMesh : public MeshTest {
protected:
    void SetUp() override {
        MeshTest::SetUp();
        if (!has_numpy()) GTEST_SKIP() << "no numpy";
        const std::string path =
            scenario("synthetic = \"ridged\"\nrows = 9\ncolumns = 9\nspacing = 10",
                     "[40, 40, 1500]", "[40, 40, 1501]", -90);
        const Outcome made = lodbench("mesh template --set step=1 --before-clipping " + path +
                                      " -o " + file("good.ply"));
        ASSERT_EQ(made.status, 0) << made.output;
        bytes_ = read_bytes(file("good.ply"));
        ASSERT_EQ(check_mesh(file("good.ply") + " --watertight --covers-terrain").status, 0);
    }
    /// Says what the check says of other bytes.
    Outcome judge(const std::string& bytes) {
        write_bytes(file("bad.ply"), bytes);
        return check_mesh(file("bad.ply") + " --watertight");
    }
    static constexpr std::size_t kFaceBytes = 13;
    std::string bytes_;
};

TEST_F(CheckMesh, notices_a_missing_triangle) {
    std::string bytes = bytes_.substr(0, bytes_.size() - kFaceBytes);
    const std::size_t count = bytes.find("element face 128");
    ASSERT_NE(count, std::string::npos);
    bytes.replace(count, 16, "element face 127");
    const Outcome outcome = judge(bytes);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("inner edges are used once"), std::string::npos)
        << outcome.output;
}

TEST_F(CheckMesh, notices_a_triangle_that_is_turned_over) {
    std::string bytes = bytes_;
    const std::size_t last = bytes.size() - kFaceBytes + 1;
    for (std::size_t i = 0; i < 4; ++i) std::swap(bytes[last + i], bytes[last + 4 + i]);
    const Outcome outcome = judge(bytes);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("turned over"), std::string::npos) << outcome.output;
}

TEST_F(CheckMesh, notices_a_triangle_that_is_drawn_twice) {
    std::string bytes = bytes_ + bytes_.substr(bytes_.size() - kFaceBytes);
    bytes.replace(bytes.find("element face 128"), 16, "element face 129");
    const Outcome outcome = judge(bytes);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("used twice in one direction"), std::string::npos)
        << outcome.output;
}

TEST_F(CheckMesh, notices_a_camera_that_does_not_fit_its_matrices) {
    std::string bytes = bytes_;
    const std::size_t at = bytes.find("comment vertical_fov_rad 1");
    ASSERT_NE(at, std::string::npos);
    bytes[at + 25] = '2';
    const Outcome outcome = judge(bytes);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("by the angles"), std::string::npos) << outcome.output;
}

TEST_F(CheckMesh, notices_a_truncated_file) {
    const Outcome outcome = judge(bytes_.substr(0, bytes_.size() - 1));
    EXPECT_EQ(outcome.status, 1) << outcome.output;
}

}  // namespace
}  // namespace lodbench::test
