// Each method of the plugin broken_promises breaks one promise: the check of that promise must
// fail, and a method that keeps them all must pass every check.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace {

const std::string kPlugin = LODBENCH_BUILD_DIR "/conformance-plugins/broken_promises.so";

struct Outcome {
    int status = -1;
    std::string output;
};

Outcome validate(const std::string& arguments) {
    const std::string command =
        std::string(LODBENCH_BINARY) + " validate " + kPlugin + " " + arguments + " 2>&1";
    Outcome outcome;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return outcome;
    std::array<char, 4096> part{};
    while (const std::size_t count = fread(part.data(), 1, part.size(), pipe)) {
        outcome.output.append(part.data(), count);
    }
    const int status = pclose(pipe);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

struct Fault {
    const char* method;
    const char* test;
    const char* reason;  ///< part of what is said
};
void PrintTo(const Fault& fault, std::ostream* stream) {
    *stream << fault.method << " by " << fault.test;
}

class BrokenPromise : public testing::TestWithParam<Fault> {};

TEST_P(BrokenPromise, is_noticed_by_its_check) {
    const Fault fault = GetParam();
    const Outcome outcome =
        validate(std::string("--method ") + fault.method + " --seed 7 --test " + fault.test);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find(fault.reason), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("--seed 7"), std::string::npos) << outcome.output;
}

constexpr Fault kFaults[] = {
    {"untitled", "descriptor-is-sane", "the title is empty"},
    {"draw-drifts", "draw-is-idempotent", "picture after a capture: depth differs"},
    {"select-counts", "select-is-repeatable", "selected twice: "},
    {"culls-by-view", "selection-is-frozen", "triangles in the capture, "},
    {"draws-elsewhere", "picture-shows-the-capture", "show another surface"},
    {"needs-settle", "timing-equals-lockstep", "timing replay against lockstep: depth differs"},
    {"depends-on-the-past", "lockstep-is-repeatable", "two lockstep replays: "},
    {"leaves-state", "pipeline-state-is-restored", "left GL state changed"},
    {"raises-errors", "no-gl-errors", "draw of plugin broken_promises.so raised"},
    {"leaks-bare-buffer", "objects-are-given-back", "made by bare GL and not deleted: buffers: "},
    {"keeps-objects", "release-without-frames", "not given back to gl/: 2 buffers"},
    {"resize-sticks", "resize-and-back", "back from 97x211: depth differs"},
    {"nan-straight-down", "vertices-are-finite", "camera straight down"},
    {"needs-square", "any-terrain-works", "the terrain is not square"},
    {"float-world", "origin-does-not-matter", "rounding allows"},
    {"refuses-its-maximum", "parameters-at-their-limits", "tau = 100: "},
    {"leaves-a-hole", "terrain-in-view-is-covered", "are covered by no triangle"},
    {"unbound-texture", "finest-is-the-terrain",
     "tau = 0.1 (finest): the surface is not the terrain: greatest screen error "},
    {"morphs-by-view", "picture-shows-the-capture",
     "tau = 2 (coarse), camera 0 of seed 7: through "},
    {"claims-too-much", "claimed-bound-holds --strict",
     "the claimed bound does not hold: tau = 2 (coarse): 2 px are claimed, "},
    {"worse-when-finer", "finer-is-no-worse",
     "tau = 0.1 (finest) is finer than tau = 1, but its P99.9 of the screen error is "},
    {"aborts", "draw-is-idempotent", "signal 6"},
    {"rounds-upwards", "pipeline-state-is-restored",
     "left the floating-point rounding mode changed in select"},
    // The limit of 120 s, shortened.
    {"loops", "draw-is-idempotent --time-factor 0.02", "hung in draw: it did not come back within"},
};

std::string name_of(const testing::TestParamInfo<Fault>& info) {
    std::string name = info.param.method;
    for (char& c : name) {
        if (c == '-') c = '_';
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(each, BrokenPromise, testing::ValuesIn(kFaults), name_of);

TEST(Conformance, passes_a_method_that_keeps_every_promise) {
    const Outcome outcome = validate("--method faultless --seed 7");
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    EXPECT_EQ(outcome.output.find("failed "), std::string::npos) << outcome.output;
    EXPECT_EQ(outcome.output.find("skipped "), std::string::npos) << outcome.output;
}

TEST(Conformance, warns_of_a_claim_that_does_not_hold_and_fails_only_with_strict) {
    const std::string test = "--method claims-too-much --seed 7 --test claimed-bound-holds";
    const Outcome warned = validate(test);
    EXPECT_EQ(warned.status, 0) << warned.output;
    EXPECT_NE(warned.output.find("warned   claims-too-much claimed-bound-holds"), std::string::npos)
        << warned.output;
    EXPECT_NE(warned.output.find("tau = 1: 1 px are claimed, "), std::string::npos)
        << warned.output;
    EXPECT_NE(warned.output.find("0 passed, 0 failed, 0 skipped, 1 warned"), std::string::npos)
        << warned.output;
    const Outcome strict = validate(test + " --strict");
    EXPECT_EQ(strict.status, 1) << strict.output;
    EXPECT_NE(strict.output.find("0 passed, 1 failed, 0 skipped, 0 warned"), std::string::npos)
        << strict.output;
    EXPECT_NE(strict.output.find("--seed 7 --strict"), std::string::npos) << strict.output;
}

TEST(Conformance, finds_level_of_detail_at_fault_where_the_default_shows_none) {
    // In order at the default: only the coarse end tells.
    const Outcome outcome =
        validate("--method morphs-by-view --seed 7 --test picture-shows-the-capture --set tau=0.1");
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("tau = 3.2 (coarse)"), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("show another surface"), std::string::npos) << outcome.output;
}

TEST(Conformance, a_hang_costs_one_limit_and_not_one_a_test) {
    const Outcome outcome = validate("--method loops --time-limit 4");
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    const auto said = [&](const std::string& words) {
        std::size_t count = 0;
        for (std::size_t at = 0; (at = outcome.output.find(words, at)) != std::string::npos; ++at) {
            ++count;
        }
        return count;
    };
    EXPECT_EQ(said("hung in draw: it did not come back within 2 s"), 1U) << outcome.output;
    EXPECT_EQ(said("not run: draw-is-idempotent hung in draw"), 18U) << outcome.output;
    EXPECT_NE(outcome.output.find("1 passed, 1 failed, 18 skipped"), std::string::npos)
        << outcome.output;
}

TEST(Conformance, names_the_tests_when_one_is_misspelt) {
    const Outcome outcome = validate("--method faultless --test nonsense");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.output.find("'nonsense'"), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("draw-is-idempotent"), std::string::npos) << outcome.output;
}

TEST(Conformance, refuses_a_method_that_the_plugin_does_not_hold) {
    const Outcome outcome = validate("--method nobody");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.output.find("faultless"), std::string::npos) << outcome.output;
}

}  // namespace
