// What sensors said against a cell's times is flagged, in words that say what and which.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <json/writer.h>

#include "report/summary.h"
#include "report/table.h"
#include "results/cell_groups.h"
#include "results/health.h"
#include "results/json.h"

namespace lodbench::results {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

CellRecord cell(int repetition, const HealthFigures& health) {
    CellRecord cell;
    cell.cell = "m__demo__r" + std::to_string(repetition);
    cell.method = "m";
    cell.scenario = "demo";
    cell.repetition = repetition;
    cell.status = CellStatus::ok;
    cell.health = health;
    return cell;
}

std::vector<std::string> words_of(const std::vector<CellRecord>& cells) {
    std::vector<const CellRecord*> pointers;
    for (const CellRecord& one : cells) pointers.push_back(&one);
    return health_words(pointers);
}

HealthFigures healthy() {
    HealthFigures health;
    health.samples = 3;
    health.gpu_mhz = SensorFigures{1980, 1950, 1950, 1980, 1965};
    health.gpu_c = SensorFigures{60, 70, 60, 70, 65};
    health.gpu_w = SensorFigures{300, 300, 300, 300, 300};
    health.cpu_mhz = SensorFigures{3000, 2900, 2900, 3000, 2950};
    health.gpu_fall = 0.015;
    health.gpu_limit_c = 90;
    health.gpu_throttle.emplace();
    health.cpu_throttles = 0;
    health.cgroup_held_s = 0;
    health.others_cores = 0.1;
    health.idle_cores = 0.9;
    health.cores = 2;
    return health;
}

TEST(Health, of_a_quiet_machine_and_of_one_without_sensors_flags_nothing) {
    EXPECT_THAT(words_of({cell(0, healthy()), cell(1, healthy())}), IsEmpty());
    EXPECT_THAT(words_of({cell(0, {}), cell(1, {})}), IsEmpty());
    CellRecord without = cell(0, {});
    without.health.reset();  // of an older version
    EXPECT_THAT(words_of({without}), IsEmpty());
}

TEST(Health, each_of_its_flags_says_what_it_was) {
    const auto flags = [](const auto& change) {
        HealthFigures health = healthy();
        change(health);
        return words_of({cell(2, health)});
    };
    EXPECT_THAT(flags([](auto& h) {
                    h.gpu_throttle = {"sw_power_cap", "hw_thermal_slowdown"};
                }),
                ElementsAre("repetition 2: the GPU was held below its clock (sw_power_cap, "
                            "hw_thermal_slowdown) while it was timed"));
    EXPECT_THAT(flags([](auto& h) { h.gpu_fall = 0.31; }),
                ElementsAre("repetition 2: the GPU's clock fell by 31 % while it was timed"));
    EXPECT_THAT(flags([](auto& h) { h.gpu_fall = 0.1; }), IsEmpty()) << "a tenth and no more";
    EXPECT_THAT(flags([](auto& h) { h.gpu_c->max = 90; }),
                ElementsAre("repetition 2: the GPU reached 90 °C, and from 90 °C on it is slowed "
                            "down"));
    EXPECT_THAT(flags([](auto& h) { h.cpu_throttles = 4; }),
                ElementsAre("repetition 2: its cores were slowed down for heat 4 times while it "
                            "was timed"));
    EXPECT_THAT(flags([](auto& h) { h.cgroup_held_s = 0.25; }),
                ElementsAre("repetition 2: a CPU quota held it back for 0.25 s of its cores' time "
                            "while it was timed"));
    EXPECT_THAT(flags([](auto& h) {
                    h.others_cores = 0.8;
                    h.idle_cores = 0.05;
                }),
                ElementsAre("repetition 2: other programs took 0.8 of its 2 cores while it was "
                            "timed, and none was idle"));
    EXPECT_THAT(flags([](auto& h) { h.others_cores = 0.8; }), IsEmpty()) << "a core was left";
}

TEST(Health, repetitions_that_are_alike_share_a_line_with_the_range) {
    std::vector<CellRecord> cells;
    for (int repetition = 0; repetition < 4; ++repetition) {
        HealthFigures health = healthy();
        if (repetition != 1) health.gpu_fall = 0.2 + 0.05 * repetition;
        cells.push_back(cell(repetition, health));
    }
    EXPECT_THAT(words_of(cells),
                ElementsAre("repetitions 0, 2 and 3: the GPU's clock fell by 20 to "
                            "35 % while it was timed"));
}

TEST(Health, a_repetition_whose_clock_was_lower_all_the_time_is_flagged) {
    HealthFigures hot = healthy();
    hot.gpu_mhz = SensorFigures{1500, 1500, 1500, 1500, 1500};
    hot.cpu_mhz = SensorFigures{2000, 2000, 2000, 2000, 2000};
    EXPECT_THAT(words_of({cell(0, healthy()), cell(1, hot)}),
                ElementsAre("repetition 1: the CPU's clock was 32 % below that of its fastest "
                            "repetition",
                            "repetition 1: the GPU's clock was 24 % below that of its fastest "
                            "repetition"));
}

TEST(Health, survives_its_way_through_json_and_what_is_absent_stays_null) {
    const CellRecord full = cell(0, healthy());
    const Json::Value json = to_json(full);
    EXPECT_EQ(json["health"]["gpu_mhz"]["mean"].asDouble(), 1965);
    EXPECT_EQ(json["health"]["gpu_throttle"], Json::Value(Json::arrayValue));
    EXPECT_EQ(to_json(read_cell(json, "here")), json);
    const Json::Value bare = to_json(cell(0, {}));
    for (const std::string& name : bare["health"].getMemberNames()) {
        EXPECT_TRUE(bare["health"][name].isNull()) << name;
    }
    EXPECT_EQ(to_json(read_cell(bare, "here")), bare);
    Json::Value old = json;
    old.removeMember("health");
    EXPECT_EQ(read_cell(old, "here").health, std::nullopt);
}

TEST(Health, stands_beside_the_tables_unfolded_and_discards_nothing) {
    HealthFigures hot = healthy();
    hot.gpu_throttle = {"hw_thermal_slowdown"};
    std::vector<CellRecord> cells = {cell(0, healthy()), cell(1, hot)};
    for (CellRecord& one : cells) one.fps = 100;
    const RunRecord run;
    const std::string words =
        "m, demo, repetition 1: the GPU was held below its clock (hw\\_thermal\\_slowdown)";
    const std::string summary = report::summary_text(cells, {}, run);
    const std::size_t at = summary.find("- Noise: " + words);
    ASSERT_NE(at, summary.npos) << summary;
    EXPECT_LT(at, summary.find("<details>")) << "not folded away";
    EXPECT_THAT(summary, HasSubstr("| m | 100.0 (")) << "the flagged repetition counts";
    EXPECT_THAT(report::text_table(report::table_rows(cells, 1)),
                HasSubstr("\nNoise\n  m, demo, repetition 1: the GPU was held below its clock "
                          "(hw_thermal_slowdown) while it was timed\n"));
    cells[1].health = healthy();
    EXPECT_THAT(report::summary_text(cells, {}, run), Not(HasSubstr("Noise")));
}

}  // namespace
}  // namespace lodbench::results
