// What scenarios/demo.toml keeps is true: at the values of its knobs the methods show the error
// that it promises, and what it says cannot, cannot.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "results/cell_groups.h"
#include "scenario/scenario.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using Arguments = std::vector<std::string>;

const fs::path kDemo = fs::path(LODBENCH_SOURCE_DIR) / "scenarios/demo.toml";

class Demo : public testing::Test {
protected:
    /// P99.9 of the pixel error of each method, in pixels, its background work finished: what it
    /// shows at its own pace depends on the machine.
    std::map<std::string, double> errors(const Arguments& more, const std::string& name = "out") {
        const std::string out = (folder_.path() / name).string();
        Arguments arguments = {"run", "--out", out};
        arguments.insert(arguments.end(), more.begin(), more.end());
        finished_ = run_lodbench(arguments, folder_.path());
        EXPECT_EQ(finished_.status, 0) << finished_.output;
        std::map<std::string, double> errors;
        for (const Json::Value& cell : cells_of(out)) {
            const Json::Value& error = results::member_of(cell, "pixel_error_px", "p999");
            EXPECT_TRUE(error.isNumeric()) << cell["cell"];
            errors[cell["method"].asString()] = error.isNumeric() ? error.asDouble() : -1;
        }
        return errors;
    }
    ScratchFolder folder_;
    Finished finished_;
    const scenario::EqualError equal_ = scenario::load_scenario(kDemo).equal.value();
};

TEST_F(Demo, each_kept_value_shows_the_error_that_it_was_kept_for_and_every_method_has_one) {
    const std::map<std::string, double> errors = this->errors({});
    EXPECT_EQ(errors.size(), equal_.knobs.size() + 1) << "and full-grid, which has no knob";
    EXPECT_LT(errors.at("full-grid"), 0.02);
    for (const scenario::EqualError::Knob& knob : equal_.knobs) {
        const double ratio = errors.at(knob.method) / equal_.error_px;
        if (knob.off.empty()) {
            EXPECT_NEAR(ratio, 1, equal_.tolerance) << knob.method;
        } else {
            EXPECT_GT(std::abs(ratio - 1), equal_.tolerance)
                << knob.method << " is not off any more";
            EXPECT_THAT(finished_.output, HasSubstr(knob.off));
        }
    }
    EXPECT_THAT(
        finished_.output,
        HasSubstr("\n\nAt equal error (99.9 % of the pixels within 1 px of the true terrain, "
                  "measured) "));
}

/// The value at the end of the knob's range, towards the error that cannot be reached.
TEST_F(Demo, what_is_said_to_be_out_of_reach_is) {
    const auto error = [this](const std::string& method, const std::string& value) {
        const std::string out = method + "-out";
        return errors({"--frames", "1", "--method", method, "--set", method + ".tau=" + value}, out)
            .at(method);
    };
    EXPECT_LT(error("static-patches", "1000"), equal_.error_px * (1 - equal_.tolerance));
    EXPECT_GT(error("tess-uniform", "0.01"), equal_.error_px * (1 + equal_.tolerance));
}

}  // namespace
}  // namespace lodbench::test
