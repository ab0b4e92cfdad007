// Two runs compared: every change is found and named, and no change is invented.

#include "compare/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "api/error.h"
#include "base/hash.h"
#include "compare/baseline.h"
#include "support/campaign_folders.h"
#include "support/run_lodbench.h"

namespace lodbench::compare {
namespace {

using results::CellRecord;
using test::FakeCampaign;
using test::ScratchFolder;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
namespace fs = std::filesystem;

using Cells = std::vector<FakeCampaign::Cell>;

class Compare : public testing::Test {
protected:
    /// A folder of a campaign of two methods over one scenario, changed on its way.
    results::ResultFolder flown(const std::string& name,
                                const std::function<void(Cells&)>& change = {},
                                int repetitions = 2) {
        const FakeCampaign campaign{.scenarios = 1, .methods = 2, .repetitions = repetitions};
        Cells cells = campaign.cells();
        if (change) change(cells);
        for (FakeCampaign::Cell& cell : cells) {
            cell.record.frames_checksum = results::checksum_of(cell.csv);
        }
        campaign.write(folder_.path() / name, cells, cells, 1, 1);
        return read_run_to_compare(folder_.path() / name);
    }

    /// Times of `method` that scatter by a per cent, times `factor`; `begin` is the hour in which
    /// they were flown, every second minute.
    static void set_times(Cells& cells, const std::string& method, double factor,
                          std::uint64_t seed, int hour = 1, int minute = 0) {
        base::SplitMix64 random(seed);
        for (FakeCampaign::Cell& cell : cells) {
            if (cell.record.method != method) continue;
            const double time = factor * (10 + 0.1 * double(random.below(1000)) / 1000);
            cell.record.frame_ms = measure::summarize_times(std::vector<double>{time});
            cell.record.cpu_ms = cell.record.frame_ms;
            cell.record.began = fmt::format("2025-01-01T{:02}:{:02}:00.000Z", hour,
                                            2 * cell.record.repetition + minute);
        }
    }

    /// Of method m1's frame time.
    static TimeVerdict verdict(const Comparison& comparison) {
        for (const TimeComparison& time : comparison.settings.at(1).times) {
            if (time.figure == "frame_ms.median") return time.verdict;
        }
        ADD_FAILURE() << "no time of m1";
        return TimeVerdict::cannot_tell;
    }

    ScratchFolder folder_;
};

void replace_in_csv(FakeCampaign::Cell& cell, const std::string& from, const std::string& to) {
    const std::size_t place = cell.csv.find(from);
    ASSERT_NE(place, cell.csv.npos) << cell.csv;
    cell.csv.replace(place, from.size(), to);
}

TEST_F(Compare, of_equal_runs_finds_nothing_and_holds_the_gate) {
    const Comparison comparison = compare_runs(flown("a"), flown("b"), {});
    ASSERT_THAT(comparison.settings, SizeIs(2));
    for (const SettingComparison& setting : comparison.settings) {
        EXPECT_TRUE(setting.same_figures());
        EXPECT_TRUE(setting.one_device);
        EXPECT_THAT(setting.notes, IsEmpty());
    }
    EXPECT_THAT(comparison.missing, IsEmpty());
    EXPECT_EQ(comparison.exit_status(true), 0);
}

TEST_F(Compare, names_the_frame_in_which_one_triangle_is_more) {
    const auto more = [](Cells& cells) {
        for (FakeCampaign::Cell& cell : cells) {
            if (cell.record.method != "m1" || cell.record.repetition != 0) continue;
            replace_in_csv(cell, ",1001,", ",1002,");  // frame 1 of 0 to 2
        }
    };
    const Comparison comparison = compare_runs(flown("a"), flown("b", more), {});
    EXPECT_TRUE(comparison.settings.at(0).same_figures());
    const SettingComparison& changed = comparison.settings.at(1);
    EXPECT_EQ(changed.method, "m1");
    ASSERT_THAT(changed.frame_changes, SizeIs(1)) << "though sums of the cells are as they were";
    const FrameChange& change = changed.frame_changes.front();
    EXPECT_EQ(change.column, "triangles");
    EXPECT_EQ(change.frame, 1U);
    EXPECT_EQ(change.before, "1001");
    EXPECT_EQ(change.after, "1002");
    EXPECT_EQ(change.changed, 1U);
    EXPECT_EQ(change.frames, 3U);
    EXPECT_EQ(comparison.exit_status(true), 1);
    EXPECT_EQ(comparison.exit_status(false), 0) << "without a gate it only tells";
}

TEST_F(Compare, finds_a_change_in_every_deterministic_field_and_in_no_other) {
    const auto change = [](Cells& cells) {
        for (FakeCampaign::Cell& cell : cells) {
            cell.record.crack_pixels = {7, 3};
            cell.record.peak_rss_bytes = 12345;
            cell.record.depth_hash = "00000000000000ff";
        }
    };
    const auto other = [](Cells& cells) {
        for (FakeCampaign::Cell& cell : cells) {
            cell.record.crack_pixels = {8, 3};
            cell.record.peak_rss_bytes = 54321;
            cell.record.depth_hash = "00000000000000ee";
        }
    };
    const Comparison comparison = compare_runs(flown("a", change), flown("b", other), {});
    for (const SettingComparison& setting : comparison.settings) {
        ASSERT_THAT(setting.changes, SizeIs(1));
        EXPECT_EQ(setting.changes[0].field, "crack_pixels.total");
        EXPECT_EQ(setting.changes[0].before, "7");
        EXPECT_EQ(setting.changes[0].after, "8");
    }
}

TEST_F(Compare, fails_for_what_is_no_longer_measured_and_only_notes_what_is_new) {
    const auto measured = [](Cells& cells) {
        for (FakeCampaign::Cell& cell : cells) cell.record.uncovered_samples = 4;
    };
    const results::ResultFolder with = flown("a", measured), without = flown("b");
    const Comparison lost = compare_runs(with, without, {});
    ASSERT_THAT(lost.settings[0].changes, SizeIs(1));
    EXPECT_EQ(lost.settings[0].changes[0].after, "not measured");
    EXPECT_EQ(lost.exit_status(true), 1);
    const Comparison won = compare_runs(without, with, {});
    EXPECT_THAT(won.settings[0].notes, Contains("uncovered_samples was not measured in BASE"));
    EXPECT_EQ(won.exit_status(true), 0);
}

TEST_F(Compare, of_two_devices_allows_errors_their_rounding_and_counts_none) {
    const auto device = [](double error, std::uint64_t cracks) {
        return [=](Cells& cells) {
            for (FakeCampaign::Cell& cell : cells) {
                cell.record.device = "renderer B";
                cell.record.screen_error_px.emplace().max = error;
                cell.record.crack_pixels = {cracks, 1};
            }
        };
    };
    const auto one = device(2.0, 5), near = device(2.0015, 5), far = device(2.0025, 5),
               cracked = device(2.0, 6);
    const auto on_a = [&](const auto& change) {
        return [&](Cells& cells) {
            change(cells);
            for (FakeCampaign::Cell& cell : cells) cell.record.device = "renderer A";
        };
    };
    const results::ResultFolder base = flown("base", one);
    EXPECT_EQ(compare_runs(base, flown("near", on_a(near)), {}).exit_status(true), 0);
    EXPECT_EQ(compare_runs(base, flown("far", on_a(far)), {}).exit_status(true), 1);
    EXPECT_EQ(compare_runs(base, flown("cracked", on_a(cracked)), {}).exit_status(true), 1);
    EXPECT_EQ(compare_runs(base, flown("same", near), {}).exit_status(true), 1) << "on one device";
    const Comparison two = compare_runs(base, flown("other", on_a(one)), {});
    EXPECT_THAT(two.settings[0].times, IsEmpty());
    EXPECT_THAT(two.settings[0].notes,
                Contains(HasSubstr("times are not compared: BASE was flown on 'renderer B', NEW on "
                                   "'renderer A'")));
}

TEST_F(Compare, lists_missing_and_new_settings_and_fails_for_the_missing_alone) {
    const auto renamed = [](Cells& cells) {
        for (FakeCampaign::Cell& cell : cells) {
            if (cell.record.method == "m1") cell.record.method = "m9";
        }
    };
    const Comparison comparison = compare_runs(flown("a"), flown("b", renamed), {});
    EXPECT_THAT(comparison.missing, ElementsAre("m1, s0"));
    EXPECT_THAT(comparison.added, ElementsAre("m9, s0"));
    EXPECT_EQ(comparison.exit_status(true), 1);
    const auto fewer = [](Cells& cells) {
        std::erase_if(cells, [](const auto& cell) { return cell.record.method == "m1"; });
    };
    EXPECT_EQ(compare_runs(flown("c", fewer), flown("d"), {}).exit_status(true), 0);
}

TEST_F(Compare, pairs_a_setting_across_a_parameter_that_came) {
    const auto with = [](const char* name, bool morph) {
        return [=](Cells& cells) {
            for (FakeCampaign::Cell& cell : cells) {
                cell.record.params.set("tau", 1.5);
                if (morph) cell.record.params.set(name, true);
            }
        };
    };
    const Comparison comparison =
        compare_runs(flown("a", with("morph", false)), flown("b", with("morph", true)), {});
    EXPECT_THAT(comparison.settings, SizeIs(2));
    EXPECT_THAT(comparison.missing, IsEmpty());
    EXPECT_THAT(comparison.notes, Contains(HasSubstr("NEW alone has morph")));
}

TEST_F(Compare, fails_where_a_cell_fails_that_did_not) {
    const auto crashed = [](Cells& cells) {
        cells.front().record.status = results::CellStatus::crashed;
        cells.front().record.reason = "signal 11 in draw";
    };
    const Comparison comparison = compare_runs(flown("a"), flown("b", crashed), {});
    EXPECT_THAT(comparison.settings.at(0).failures, ElementsAre(HasSubstr("signal 11 in draw")));
    EXPECT_EQ(comparison.exit_status(true), 1);
    EXPECT_EQ(compare_runs(flown("c", crashed), flown("d", crashed), {}).exit_status(true), 0)
        << "no worse than it was";
}

TEST_F(Compare, of_repetitions_that_disagree_judges_by_base_alone) {
    const auto unsteady = [](Cells& cells) {
        for (FakeCampaign::Cell& cell : cells) {
            cell.record.draw_calls->mean = 1 + cell.record.repetition;
        }
    };
    const results::ResultFolder steady = flown("a"), wavering = flown("b", unsteady);
    EXPECT_EQ(compare_runs(steady, wavering, {}).exit_status(true), 1);
    const Comparison mended = compare_runs(wavering, steady, {});
    EXPECT_EQ(mended.exit_status(true), 0);
    EXPECT_THAT(mended.settings[0].notes,
                Contains(HasSubstr("draw_calls is not the same in all repetitions of BASE")));
}

TEST_F(Compare, of_times_says_slower_faster_within_noise_or_cannot_tell) {
    const auto timed = [&](const char* name, double factor, std::uint64_t seed, int repetitions) {
        return flown(
            name,
            [=](Cells& cells) {
                for (FakeCampaign::Cell& cell : cells) cell.record.plugin_checksum = name;
                set_times(cells, "m0", 1, seed + 50);
                set_times(cells, "m1", factor, seed);
            },
            repetitions);
    };
    const results::ResultFolder base = timed("base", 1, 1, 9);
    EXPECT_EQ(verdict(compare_runs(base, timed("slow", 1.1, 2, 9), {})), TimeVerdict::slower);
    EXPECT_EQ(verdict(compare_runs(base, timed("fast", 0.9, 3, 9), {})), TimeVerdict::faster);
    EXPECT_EQ(verdict(compare_runs(base, timed("same", 1, 4, 9), {})), TimeVerdict::within_noise);
    const Comparison few = compare_runs(base, timed("few", 1.5, 5, 8), {});
    EXPECT_EQ(verdict(few), TimeVerdict::cannot_tell) << "8 repetitions, however far apart";
    EXPECT_EQ(few.settings[1].times[0].runs_needed, 9U);
}

TEST_F(Compare, calls_no_change_below_the_floor_and_takes_the_floor_from_runs_of_one_build) {
    const auto timed = [&](const char* name, double factor, std::uint64_t seed) {
        return flown(
            name,
            [=](Cells& cells) {
                for (FakeCampaign::Cell& cell : cells) cell.record.plugin_checksum = name;
                set_times(cells, "m1", factor, seed);
            },
            9);
    };
    const results::ResultFolder base = timed("base", 1, 1);
    EXPECT_EQ(verdict(compare_runs(base, timed("tiny", 1.008, 2), {})), TimeVerdict::within_noise)
        << "a change of less than 1 %";
    const results::ResultFolder slow = timed("slow", 1.04, 3);
    EXPECT_EQ(verdict(compare_runs(base, slow, {})), TimeVerdict::slower);
    Rules rules;  // one build was 6 % apart from itself: 4 % say nothing
    rules.noise = {timed("noise1", 1, 4), timed("noise2", 1.06, 5)};
    const Comparison noisy = compare_runs(base, slow, rules);
    EXPECT_NE(verdict(noisy), TimeVerdict::slower);
    EXPECT_TRUE(noisy.settings[1].times[0].measured_floor);
    EXPECT_NEAR(noisy.settings[1].times[0].floor, 0.06, 0.01);
}

TEST_F(Compare, of_an_unchanged_plugin_raises_no_alarm_over_time) {
    const auto timed = [&](const char* name, double factor, double counter) {
        return flown(
            name,
            [=](Cells& cells) {
                set_times(cells, "m1", factor, std::uint64_t(100 * factor));
                for (FakeCampaign::Cell& cell : cells) {
                    cell.record.counters = {{"visited", counter}};
                }
            },
            9);
    };
    const results::ResultFolder base = timed("base", 1, 5);
    EXPECT_EQ(verdict(compare_runs(base, timed("slow", 1.2, 5), {})), TimeVerdict::not_the_methods);
    EXPECT_EQ(verdict(compare_runs(base, timed("visits", 1.2, 6), {})), TimeVerdict::slower)
        << "its counters changed";
}

TEST_F(Compare, gates_a_slow_down_only_where_the_runs_were_flown_by_turns) {
    const auto timed = [&](const char* name, double factor, int hour, int minute) {
        return flown(
            name,
            [=](Cells& cells) {
                for (FakeCampaign::Cell& cell : cells) cell.record.plugin_checksum = name;
                set_times(cells, "m0", 1, std::uint64_t(minute) + 9, hour, minute);
                set_times(cells, "m1", factor, std::uint64_t(minute), hour, minute);
            },
            9);
    };
    const results::ResultFolder base = timed("base", 1, 1, 0);
    const Comparison by_turns = compare_runs(base, timed("by_turns", 1.2, 1, 1), {});
    EXPECT_EQ(verdict(by_turns), TimeVerdict::slower);
    EXPECT_EQ(by_turns.exit_status(true), 1);
    const Comparison later = compare_runs(base, timed("later", 1.2, 5, 1), {});
    EXPECT_EQ(verdict(later), TimeVerdict::slower);
    EXPECT_EQ(later.exit_status(true), 0) << "an hour later the machine may be another";
}

TEST_F(Compare, of_many_equal_settings_raises_an_alarm_in_less_than_a_hundredth) {
    // Nine repetitions of 10 settings, drawn alike: 30 tests in each comparison.
    const FakeCampaign campaign{.scenarios = 1, .methods = 10, .repetitions = 9, .frames = 1};
    base::SplitMix64 random(17);
    const auto drawn = [&] {
        results::ResultFolder folder;
        for (FakeCampaign::Cell& cell : campaign.cells()) {
            for (auto* times : {&cell.record.frame_ms, &cell.record.cpu_ms}) {
                *times = measure::summarize_times(
                    std::vector<double>{10 + double(random.below(1000)) / 1000});
            }
            cell.record.prepare_s = 1 + double(random.below(1000)) / 1000;
            cell.record.plugin_checksum = "";
            folder.cells.push_back(cell.record);
        }
        return folder;
    };
    int alarms = 0;
    constexpr int kComparisons = 400;
    for (int i = 0; i < kComparisons; ++i) {
        const Comparison comparison = compare_runs(drawn(), drawn(), {});
        ASSERT_EQ(comparison.time_tests, 30U);
        alarms += std::ranges::any_of(comparison.settings, [](const auto& setting) {
            return std::ranges::any_of(setting.times, [](const TimeComparison& time) {
                return time.verdict == TimeVerdict::slower || time.verdict == TimeVerdict::faster;
            });
        });
    }
    EXPECT_LE(alarms, kComparisons / 100);
}

TEST_F(Compare, without_frames_compares_cells_and_says_so) {
    const results::ResultFolder base = flown("a");
    flown("b");
    fs::remove_all(folder_.path() / "b/frames");
    const Comparison comparison = compare_runs(base, read_run_to_compare(folder_.path() / "b"), {});
    EXPECT_EQ(comparison.exit_status(true), 0);
    EXPECT_THAT(comparison.settings[0].notes, Contains(HasSubstr("NEW has no frames/")));
}

TEST_F(Compare, of_nothing_in_common_is_no_comparison) {
    const auto renamed = [](Cells& cells) {
        for (FakeCampaign::Cell& cell : cells) cell.record.scenario = "other";
    };
    EXPECT_EQ(compare_runs(flown("a"), flown("b", renamed), {}).exit_status(false), 4);
}

TEST_F(Compare, a_baseline_holds_what_it_was_made_of_and_is_the_same_to_the_byte) {
    const auto told = [](Cells& cells) {
        for (FakeCampaign::Cell& cell : cells) cell.record.crack_pixels = {7, 3};
    };
    const auto later = [&](Cells& cells) {
        told(cells);
        for (FakeCampaign::Cell& cell : cells) cell.record.peak_rss_bytes = 99;
    };
    const results::ResultFolder run = flown("a", told), again = flown("b", later);
    const fs::path first = folder_.path() / "first", second = folder_.path() / "second";
    write_baseline(run, first);
    write_baseline(again, second);
    for (const char* file : {"cells.jsonl", "run.json", "frames/m1__s0__r0.csv"}) {
        EXPECT_EQ(test::text_of(first / file), test::text_of(second / file)) << file;
    }
    EXPECT_FALSE(fs::exists(first / "frames/m1__s0__r1.csv")) << "the first repetition says it all";
    const std::string lines = test::text_of(first / "cells.jsonl");
    EXPECT_THAT(lines, HasSubstr("\"crack_pixels\":{\"max\":3,\"total\":7}"));
    for (const char* name : {"frame_ms", "peak_rss_bytes", "device", "shots_hash", "cell_s"}) {
        EXPECT_EQ(lines.find(std::string("\"") + name), lines.npos) << name;
    }
    const results::ResultFolder baseline = read_run_to_compare(first);
    EXPECT_EQ(compare_runs(baseline, again, {}).exit_status(true), 0);
    const Comparison changed =
        compare_runs(baseline,
                     flown("c",
                           [](Cells& cells) {
                               for (FakeCampaign::Cell& cell : cells) {
                                   cell.record.crack_pixels = {7, 3};
                                   if (cell.record.method == "m0")
                                       replace_in_csv(cell, ",2,", ",3,");  // frame 2
                               }
                           }),
                     {});
    EXPECT_EQ(changed.exit_status(true), 1);
    ASSERT_THAT(changed.settings.at(0).frame_changes, SizeIs(1));
    EXPECT_EQ(changed.settings.at(0).frame_changes[0].frame, 2U);
}

TEST_F(Compare, a_baseline_replaces_a_baseline_and_nothing_else) {
    const results::ResultFolder run = flown("run");
    const fs::path out = folder_.path() / "baseline";
    write_baseline(run, out);
    FakeCampaign::put(out / "frames/gone__s0__r0.csv", "frame\n");
    write_baseline(run, out);
    EXPECT_FALSE(fs::exists(out / "frames/gone__s0__r0.csv"));
    EXPECT_THROW(write_baseline(run, folder_.path() / "run"), InputError) << "that is a run";
    const fs::path other = folder_.path() / "other";
    fs::create_directory(other);
    FakeCampaign::put(other / "thesis.tex", "");
    EXPECT_THROW(write_baseline(run, other), InputError);
    EXPECT_TRUE(fs::exists(other / "thesis.tex"));
    const auto failed = [](Cells& cells) { cells[0].record.status = results::CellStatus::failed; };
    EXPECT_THROW(write_baseline(flown("failed", failed), folder_.path() / "none"), InputError);
    EXPECT_FALSE(fs::exists(folder_.path() / "none"));
}

}  // namespace
}  // namespace lodbench::compare
