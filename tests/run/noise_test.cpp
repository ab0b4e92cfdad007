// What disturbs times is told, and only that.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/cell.h"
#include "results/cell_groups.h"
#include "run/context.h"

namespace lodbench::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

results::CellResult flown(int frames, double wall_ms, double cpu_ms, std::optional<double> gpu_ms,
                          bool software) {
    results::CellResult result;
    result.cell.status = results::CellStatus::ok;
    result.software = software;
    for (int i = 0; i < frames; ++i) {
        results::FrameRecord& frame = result.frames.emplace_back();
        frame.wall_ms = wall_ms;
        frame.cpu_ms = cpu_ms;
        frame.gpu_ms = gpu_ms;
    }
    return result;
}

TEST(Noise, of_a_cell_is_wall_time_far_above_what_was_spent) {
    EXPECT_EQ(noise_of(flown(10, 100, 66, {}, true)),
              "its frames took 1000 ms, and 660 ms of CPU "
              "time were spent on them: it waited for other "
              "programs, a quota or the disk, and its times "
              "say how long");
    EXPECT_EQ(noise_of(flown(10, 100, 67, {}, true)), "") << "1.5 times and no more";
    EXPECT_EQ(noise_of(flown(10, 100, 180, {}, true)), "") << "two threads";
    EXPECT_EQ(noise_of(flown(4, 100, 1, {}, true)), "") << "0.4 s say nothing";
}

TEST(Noise, of_a_cell_on_a_gpu_counts_its_time_and_is_untold_where_that_is_unknown) {
    EXPECT_EQ(noise_of(flown(10, 100, 10, 85, false)), "");
    EXPECT_THAT(noise_of(flown(10, 100, 10, 50, false)),
                HasSubstr("1000 ms, and 600 ms of CPU and GPU time"));
    EXPECT_EQ(noise_of(flown(10, 100, 10, {}, false)), "");
    EXPECT_EQ(noise_of(flown(5000, 0.5, 0.05, 0.05, false)), "") << "it was woken late";
    EXPECT_NE(noise_of(flown(5000, 0.5, 0.05, {}, true)), "") << "nothing is waited for";
    EXPECT_NE(noise_of(flown(1000, 1, 0.2, 0.2, false)), "");
}

TEST(Noise, of_a_setting_names_the_repetitions) {
    std::vector<results::CellRecord> cells;
    for (int repetition = 0; repetition < 2; ++repetition) {
        const results::CellName name{"id", "scenario", "method", {}, repetition, 1};
        cells.push_back(finish_cell(name, flown(10, 100, repetition == 1 ? 20 : 90, {}, true), 16));
    }
    EXPECT_EQ(cells[0].noise, "");
    const auto groups = results::group_cells(cells);
    EXPECT_THAT(noise_of(groups.at(0)),
                ElementsAre(testing::StartsWith("repetition 1: its frames")));
}

results::MachineContext machine(int cores, std::optional<double> quota,
                                std::optional<double> load) {
    results::MachineContext machine;
    machine.cores = cores;
    machine.cpu_quota_cores = quota;
    machine.load_average = load;
    return machine;
}

TEST(Noise, of_a_machine_is_a_quota_or_a_load_beyond_its_cores) {
    EXPECT_THAT(
        run::noise_of(machine(2, 0.5, std::nullopt)),
        ElementsAre(HasSubstr("the CPU quota of this process's control group is 0.5 of its 2 "
                              "cores")));
    EXPECT_THAT(run::noise_of(machine(2, std::nullopt, 2.5)),
                ElementsAre(HasSubstr("the load average was 2.50 on 2 cores when this began")));
    EXPECT_EQ(run::noise_of(machine(2, 1.0, 3.0)).size(), 2U);
    EXPECT_THAT(run::noise_of(machine(2, 2.0, 2.0)), IsEmpty());
    EXPECT_THAT(run::noise_of(machine(2, std::nullopt, std::nullopt)), IsEmpty());
}

}  // namespace
}  // namespace lodbench::test
