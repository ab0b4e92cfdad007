// Work in a child process: how it ended, in words.

#include "base/isolated.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include "api/error.h"

namespace lodbench::base {
namespace {

using testing::HasSubstr;

Answer ask(const std::function<std::string()>& work, double seconds = 20) {
    return run_isolated(seconds, work);
}

TEST(Isolated, tells_an_answer_from_each_kind_of_refusal) {
    EXPECT_EQ(ask([] { return std::string(); }).ending, Ending::answered);
    const Answer answer = ask([] { return std::string(100'000, 'x'); });
    EXPECT_EQ(answer.ending, Ending::answered);
    EXPECT_EQ(answer.text, std::string(100'000, 'x'));
    const Answer refused = ask([]() -> std::string { throw InputError("no such file"); });
    EXPECT_EQ(refused.ending, Ending::refused);
    EXPECT_EQ(refused.text, "no such file");
    const Answer environment_error = ask([]() -> std::string { throw EnvironmentError("no device"); });
    EXPECT_EQ(environment_error.ending, Ending::environment_error);
    const Answer threw = ask([]() -> std::string { throw std::runtime_error("a refusal"); });
    EXPECT_EQ(threw.ending, Ending::threw);
    EXPECT_EQ(threw.text, "a refusal");
    EXPECT_EQ(ask([]() -> std::string { throw 1; }).ending, Ending::threw);
}

TEST(Isolated, says_which_signal_or_exit_ended_the_work) {
    const Answer killed = ask([] { return std::to_string(std::raise(SIGKILL)); });
    EXPECT_EQ(killed.ending, Ending::died);
    EXPECT_THAT(killed.text, HasSubstr("killed (signal 9)"));
    const Answer aborted = ask([]() -> std::string { std::abort(); });
    EXPECT_EQ(aborted.ending, Ending::died);
    EXPECT_THAT(aborted.text, HasSubstr("(signal 6)"));
    const Answer left = ask([]() -> std::string { _exit(3); });
    EXPECT_EQ(left.ending, Ending::died);
    EXPECT_THAT(left.text, HasSubstr("exited with status 3"));
    EXPECT_EQ(ask([]() -> std::string { _exit(0); }).ending, Ending::died)
        << "left without an answer";
}

TEST(Isolated, ends_work_that_takes_more_memory_than_it_may) {
    const auto take = [](std::size_t bytes) {
        return [bytes]() -> std::string {
            const std::string taken(bytes, 'x');
            usleep(1'500'000);  // it is looked at five times a second
            return std::to_string(taken.size());
        };
    };
    const Allowance allowance{.seconds = 20, .memory_bytes = 256ULL << 20};
    const Answer greedy = run_isolated(allowance, take(std::size_t(512) << 20));
    EXPECT_EQ(greedy.ending, Ending::timed_out);
    EXPECT_TRUE(greedy.out_of_memory);
    EXPECT_EQ(greedy.text, "exceeded the memory limit of 256 MiB");
    const Answer modest = run_isolated(allowance, take(std::size_t(16) << 20));
    EXPECT_EQ(modest.ending, Ending::answered) << modest.text;
    EXPECT_FALSE(modest.out_of_memory);
}

TEST(Isolated, ends_work_that_does_not_end) {
    const Answer endless = ask(
        []() -> std::string {
            for (;;) pause();
        },
        0.2);
    EXPECT_EQ(endless.ending, Ending::timed_out);
    EXPECT_EQ(endless.text, "gave no answer within 0.2 s");
}

}  // namespace
}  // namespace lodbench::base
