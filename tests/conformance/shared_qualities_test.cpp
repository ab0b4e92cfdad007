// The conformance suite finds the ends of a method's quality knob once, and every check uses them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "conformance/suite.h"

namespace lodbench::test {
namespace {

using conformance::CheckReport;
using conformance::read_qualities;
using conformance::Subject;
using conformance::Verdict;

/// No test here may make a GL context in its own process: checks run in forks of it.
Subject subject_of(const std::string& plugin, const std::string& method) {
    const run::PluginListing listing = run::list_plugin(plugin);
    EXPECT_EQ(listing.refusal, "");
    const auto found = std::ranges::find(listing.methods, method, &run::MethodInfo::id);
    EXPECT_NE(found, listing.methods.end()) << method;
    Subject subject;
    subject.method = *found;
    return subject;
}

CheckReport checked(const Subject& subject, const std::string& check, double limit_s = 60) {
    return run_check(conformance::find_check(check), subject, limit_s);
}

TEST(SharedQualities, the_first_check_that_asks_tells_the_others) {
    const Subject subject =
        subject_of(LODBENCH_BUILD_DIR "/broken-plugins/stand_ins/stand_ins.so", "refined");
    EXPECT_EQ(checked(subject, "descriptor-is-sane").verdict, Verdict::passed);
    EXPECT_FALSE(*subject.qualities) << "nothing was asked for";
    EXPECT_EQ(checked(subject, "draw-is-idempotent").verdict, Verdict::passed);
    ASSERT_TRUE(*subject.qualities);
    conformance::Qualities& found = **subject.qualities;
    EXPECT_EQ(found.terrain_size, 257);
    EXPECT_EQ(found.given.name, "tau = 1");
    EXPECT_TRUE(found.given.settings.empty()) << "as the subject has it";
    ASSERT_TRUE(found.finest && found.coarse);
    EXPECT_EQ(found.finest->name, "tau = 0.01 (finest)");
    EXPECT_EQ(found.finest->claimed_px, 0.01);
    EXPECT_EQ(found.coarse->settings, (run::Settings{{"tau", "16"}}));

    // What no search could find shows that none is made.
    found.coarse->name = "told";
    found.coarse->claimed_px = 1e-6;
    const CheckReport claims = checked(subject, "claimed-bound-holds");
    EXPECT_EQ(claims.verdict, Verdict::warned);
    EXPECT_THAT(claims.reason, testing::HasSubstr("told: 1e-06 px are claimed"));
}

TEST(SharedQualities, come_through_as_they_were_found) {
    conformance::Qualities found{.terrain_size = 513,
                                 .given = {"tau = 0.1", {}, 0.1},
                                 .finest = conformance::Quality{"a", {{"tau", "1e-3"}}, 1.0 / 3},
                                 .coarse = conformance::Quality{"b", {{"tau", "7"}}, {}}};
    const conformance::Qualities read = read_qualities(write_qualities(found));
    EXPECT_EQ(read.terrain_size, 513);
    EXPECT_EQ(read.given.name, "tau = 0.1");
    EXPECT_EQ(read.given.claimed_px, 0.1);
    EXPECT_EQ(read.finest->settings, found.finest->settings);
    EXPECT_EQ(read.finest->claimed_px, 1.0 / 3) << "to the bit";
    EXPECT_EQ(read.coarse->claimed_px, std::nullopt);
    EXPECT_EQ(read.all().size(), 3U);
    conformance::Qualities only;
    only.given.name = "default";
    EXPECT_EQ(read_qualities(write_qualities(only)).all().size(), 1U);
}

TEST(SharedQualities, a_check_that_crashes_or_hangs_in_finding_them_leaves_none) {
    const std::string plugin = LODBENCH_BUILD_DIR "/conformance-plugins/broken_promises.so";
    const Subject aborts = subject_of(plugin, "aborts");
    for (const char* check : {"draw-is-idempotent", "select-is-repeatable"}) {
        const CheckReport report = checked(aborts, check);
        EXPECT_EQ(report.verdict, Verdict::failed);
        EXPECT_THAT(report.reason,
                    testing::HasSubstr("ended before it answered: aborted (signal 6"));
        EXPECT_FALSE(*aborts.qualities);
    }
    const CheckReport hung = checked(subject_of(plugin, "loops"), "draw-is-idempotent", 2);
    EXPECT_EQ(hung.hung_in, "draw");
    EXPECT_EQ(hung.reason, "hung in draw: it did not come back within 1 s");
}

}  // namespace
}  // namespace lodbench::test
