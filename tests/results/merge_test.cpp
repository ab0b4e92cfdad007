// Folders joined: the union or a refusal that names file and field, never a silent loss.

#include "results/merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <random>

#include "api/error.h"
#include "results/cell_groups.h"
#include "results/deterministic.h"
#include "results/folder.h"
#include "support/campaign_folders.h"
#include "support/run_lodbench.h"

namespace lodbench::results {
namespace {

using test::FakeCampaign;
using test::ScratchFolder;
using test::text_of;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
namespace fs = std::filesystem;
using Cells = std::vector<FakeCampaign::Cell>;

std::string no_summary(const MergedRun&) {
    return "summary\n";
}

MergedRun merge(const std::vector<fs::path>& folders, const fs::path& out) {
    return merge_folders(folders, out, no_summary);
}

/// Every file below, by its place: what is there and what it holds.
std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            files[fs::relative(entry.path(), folder).string()] = text_of(entry.path());
        }
    }
    return files;
}

/// The words of the refusal; "" where there is none.
std::string refusal(const std::vector<fs::path>& folders, const fs::path& out) {
    try {
        (void)merge(folders, out);
    } catch (const InputError& error) {
        EXPECT_FALSE(fs::exists(out)) << "refused, and written all the same";
        for (const auto& entry : fs::directory_iterator(out.parent_path())) {
            EXPECT_EQ(entry.path().string().find(".merging-"), std::string::npos)
                << "left behind: " << entry.path();
        }
        return error.what();
    }
    return {};
}

/// Two shards that merge, to spoil one of them.
class TwoShards : public testing::Test {
protected:
    TwoShards() {
        const Cells all = campaign.cells();
        const auto half = all.begin() + std::ptrdiff_t(all.size() / 2);
        campaign.write(a, {all.begin(), half}, {all.begin(), half}, 1, 2);
        campaign.write(b, {half, all.end()}, {half, all.end()}, 2, 2);
    }
    void spoil_run(const std::function<void(Json::Value&)>& change) const {
        Json::Value run = parse_json(text_of(b / "run.json"), "b");
        change(run);
        FakeCampaign::put(b / "run.json", to_text(run));
    }
    /// Of b's first line, sealed again.
    void spoil_cell(const std::function<void(CellRecord&)>& change) const {
        const std::string text = text_of(b / "cells.jsonl");
        const std::size_t end = text.find('\n');
        CellRecord cell = read_cell(parse_sealed(text.substr(0, end), "b"), "b");
        change(cell);
        FakeCampaign::put(b / "cells.jsonl", seal(to_json(cell)) + text.substr(end));
    }
    [[nodiscard]] std::string refused() const { return refusal({a, b}, out); }

    FakeCampaign campaign;
    ScratchFolder scratch;
    const fs::path a = scratch.path() / "a", b = scratch.path() / "b", out = scratch.path() / "out";
};

TEST(Merge, of_any_partition_in_any_order_gives_every_cell_once_and_changes_no_input) {
    std::mt19937 random(24);
    std::string expected;
    for (int trial = 0; trial < 40; ++trial) {
        const ScratchFolder scratch;
        const FakeCampaign campaign;
        const Cells all = campaign.cells();
        const int count = int(random() % 6) + 1;
        std::vector<Cells> parts;
        parts.resize(std::size_t(count));
        for (const auto& cell : all) parts[random() % parts.size()].push_back(cell);
        std::vector<fs::path> folders;
        for (int i = 0; i < count; ++i) {
            Cells part = parts[std::size_t(i)];
            std::shuffle(part.begin(), part.end(), random);  // as a resumed run may have them
            folders.push_back(scratch.path() / fmt::format("in/{}", i));
            campaign.write(folders.back(), parts[std::size_t(i)], part, i + 1, count);
        }
        if (random() % 2 == 0) {  // a folder that is there twice
            const fs::path copy = scratch.path() / "in/copy";
            fs::copy(folders.front(), copy, fs::copy_options::recursive);
            folders.push_back(copy);
        }
        std::shuffle(folders.begin(), folders.end(), random);
        const auto before = contents(scratch.path() / "in");
        const fs::path out = scratch.path() / "out";
        const MergedRun merged = merge(folders, out);
        EXPECT_THAT(merged.warnings, IsEmpty());
        EXPECT_EQ(merged.missing, 0U);
        EXPECT_EQ(contents(scratch.path() / "in"), before);

        const std::string lines = text_of(out / "cells.jsonl");
        if (trial == 0) expected = lines;
        EXPECT_EQ(lines, expected) << "in the order of flight, byte for byte";
        const ResultFolder folder = read_result_folder(out);
        EXPECT_THAT(folder.warnings, IsEmpty());
        ASSERT_EQ(folder.cells.size(), all.size());
        EXPECT_EQ(folder.frames.size(), all.size());
        for (const auto& cell : all) {
            EXPECT_EQ(text_of(out / "frames" / (cell.record.cell + ".csv")), cell.csv);
            EXPECT_TRUE(fs::exists(out / "shots" / (cell.record.cell + "__f00000.png")));
            EXPECT_TRUE(fs::exists(out / "logs" / (cell.record.cell + ".log")));
        }
        EXPECT_EQ(folder.run.shards.size(), std::size_t(count));
        EXPECT_EQ(folder.run.cpu, "processor") << "alike in all";
    }
}

TEST(Merge, of_merged_folders_is_the_merge_of_their_parts) {
    const ScratchFolder scratch;
    const FakeCampaign campaign;
    const Cells all = campaign.cells();
    std::vector<fs::path> parts;
    for (int i = 0; i < 3; ++i) {
        Cells part;
        for (std::size_t c = std::size_t(i); c < all.size(); c += 3) part.push_back(all[c]);
        parts.push_back(scratch.path() / fmt::format("{}", i));
        campaign.write(parts.back(), part, part, i + 1, 3);
    }
    (void)merge(parts, scratch.path() / "at-once");
    const MergedRun two = merge({parts[2], parts[0]}, scratch.path() / "two");
    EXPECT_EQ(two.missing, all.size() / 3);
    EXPECT_THAT(two.warnings,
                Contains(HasSubstr("8 of the campaign's 24 cells are in none of the merged "
                                   "folders: shards 2/3 are not among them")));
    (void)merge({parts[1], scratch.path() / "two", parts[0]}, scratch.path() / "again");
    auto at_once = contents(scratch.path() / "at-once");
    auto again = contents(scratch.path() / "again");
    EXPECT_EQ(at_once["cells.jsonl"], again["cells.jsonl"]);
    at_once.erase("run.json");
    again.erase("run.json");  // has the warning of the folder in between
    EXPECT_EQ(at_once, again);
}

TEST(Merge, of_shards_that_flew_nothing_yet_says_what_is_missing) {
    const ScratchFolder scratch;
    const FakeCampaign campaign;
    const Cells all = campaign.cells();
    campaign.write(scratch.path() / "a", all, {}, 1, 2);
    campaign.write(scratch.path() / "b", {}, {}, 2, 2);  // without a block
    const MergedRun nothing =
        merge({scratch.path() / "a", scratch.path() / "b"}, scratch.path() / "out");
    EXPECT_THAT(nothing.cells, IsEmpty());
    EXPECT_EQ(nothing.missing, all.size());
    const Cells half(all.begin(), all.begin() + 10);
    campaign.write(scratch.path() / "c", all, half, 1, 2);
    const MergedRun some =
        merge({scratch.path() / "b", scratch.path() / "c"}, scratch.path() / "some");
    EXPECT_THAT(some.cells, SizeIs(10));
    EXPECT_EQ(some.missing, all.size() - 10);
    EXPECT_THAT(read_result_folder(scratch.path() / "some").warnings,
                Contains(HasSubstr("14 of the 24 cells that were planned are not flown")));
}

TEST_F(TwoShards, with_a_torn_last_line_merge_without_it_and_say_so) {
    const std::string text = text_of(b / "cells.jsonl");
    fs::resize_file(b / "cells.jsonl", text.size() - 1);
    const MergedRun merged = merge({a, b}, out);
    EXPECT_EQ(merged.cells.size(), 23U);
    EXPECT_EQ(merged.missing, 1U);
    EXPECT_THAT(merged.warnings,
                Contains(AllOf(HasSubstr("b/cells.jsonl:12"), HasSubstr("incomplete"))));
}

TEST_F(TwoShards, of_unlike_protocol_are_refused_by_field_and_both_values) {
    const std::vector<std::pair<std::function<void(Json::Value&)>, std::vector<const char*>>>
        cases = {
            {[](auto& run) { run["tool_version"] = "1.1"; }, {"'tool_version'", "1.0", "1.1"}},
            {[](auto& run) { run["commit"] = "abc"; }, {"'commit'", "'0123456'", "'abc'"}},
            {[](auto& run) { run["seed"] = 8; }, {"'seed' is 7 and 8"}},
            {[](auto& run) { run["overrides"]["flight.frames"] = "2"; },
             {"'overrides' is {} and {\"flight.frames\":\"2\"}"}},
            {[](auto& run) { run["campaign"] = "2"; }, {"'campaign", "0000000000000001", "'2'"}},
            {[](auto& run) { run["scenarios"][1]["frames"] = 9; },
             {"'scenarios.s1.frames' is 3 and 9"}},
            {[](auto& run) { run["scenarios"][0]["text"] = "name = \"s0\"\n[run]\nseed = 8\n"; },
             {"'scenarios.s0.text' is 'seed = 7' and 'seed = 8'"}},
        };
    const std::string good = text_of(b / "run.json");
    for (const auto& [change, words] : cases) {
        spoil_run(change);
        const std::string text = refused();
        for (const char* word : words) EXPECT_THAT(text, HasSubstr(word));
        EXPECT_THAT(text, AllOf(HasSubstr("a/run.json"), HasSubstr("b/run.json")));
        FakeCampaign::put(b / "run.json", good);
    }
    EXPECT_EQ(refused(), "") << "and what was spoiled alone was refused";
}

TEST_F(TwoShards, that_were_disturbed_alike_share_a_line_for_each_device_with_the_range) {
    const auto write_noise = [](const fs::path& folder, const char* load) {
        Json::Value run = parse_json(text_of(folder / "run.json"), "run.json");
        run["noise"].append(fmt::format("the load average was {} on 8 cores", load));
        FakeCampaign::put(folder / "run.json", to_text(run));
    };
    write_noise(a, "9.50");
    write_noise(b, "17.25");
    const std::vector<std::string> noise = merge({a, b}, out).run.noise;
    ASSERT_EQ(noise.size(), 1U);
    EXPECT_EQ(noise[0], "the load average was 9.50 to 17.25 on 8 cores");
    FakeCampaign other = campaign;
    other.device = "renderer B, OpenGL 4.6; processor, 8 cores";
    const fs::path c = scratch.path() / "c";
    other.write(c, other.cells(5), other.cells(5), 1, 1);
    write_noise(c, "12.00");
    const std::vector<std::string> both = merge({a, b, c}, scratch.path() / "both").run.noise;
    ASSERT_EQ(both.size(), 2U);
    EXPECT_EQ(both[0],
              "on renderer A; processor, 8 cores: the load average was 9.50 to 17.25 on 8 cores");
    EXPECT_EQ(both[1], "on renderer B; processor, 8 cores: the load average was 12.00 on 8 cores");
    EXPECT_EQ(merge({out, c}, scratch.path() / "again").run.noise, both) << "merged in two steps";
}

TEST_F(TwoShards, over_another_terrain_or_with_another_plugin_are_refused) {
    spoil_cell([](CellRecord& cell) { cell.terrain_checksum = "00000000000000ff"; });
    EXPECT_THAT(refused(), AllOf(HasSubstr("a/cells.jsonl:1 and"), HasSubstr("b/cells.jsonl:1"),
                                 HasSubstr("'terrain_checksum of s0' is 0000000000000000 and "
                                           "00000000000000ff")));
    spoil_cell([](CellRecord& cell) {
        cell.terrain_checksum = "0000000000000000";
        cell.plugin_checksum = "00000000000000ff";
    });
    EXPECT_THAT(refused(), HasSubstr("'plugin_checksum of m0' is 0000000000000000 and 00"));
}

TEST_F(TwoShards, that_are_damaged_are_refused_by_file) {
    const auto good = contents(b);
    const std::string frames = "frames/m0__s0__r2.csv";
    const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
        {"run.json", "{", "b/run.json: this is not JSON"},
        {"run.json", "{\"schema_version\": 99}", "schema_version is 99, expected 1"},
        {"cells.jsonl", "{}\n", "b/cells.jsonl:1: 'cell' is missing"},
        {"cells.jsonl", good.at("cells.jsonl") + good.at("cells.jsonl"), "is there twice"},
        {frames, "frame,wall_ms\n0,1\n", "r2.csv: its checksum is"},
        {"scenarios/s0.toml", "name = \"other\"\n", "s0.toml: this is not the text of"},
        {"flights/s0.json", "[", "s0.json: this is not JSON"},
        {"match.json", "{}", "match.json: a search is not flown in parts"},
    };
    for (const auto& [file, text, words] : cases) {
        FakeCampaign::put(b / file, text);
        EXPECT_THAT(refused(), HasSubstr(words)) << file;
        fs::remove(b / file);
        if (good.contains(file)) FakeCampaign::put(b / file, good.at(file));
    }
    std::string lines = good.at("cells.jsonl");
    lines[lines.find("\"fps\":") + 6] ^= 1;  // a digit of the first line
    FakeCampaign::put(b / "cells.jsonl", lines);
    EXPECT_THAT(refused(), HasSubstr("b/cells.jsonl:1: the checksum is"));
    FakeCampaign::put(b / "cells.jsonl", good.at("cells.jsonl"));
    fs::remove(b / frames);
    EXPECT_THAT(refused(), HasSubstr("r2.csv: there is no such file"));
    FakeCampaign::put(b / frames, good.at(frames));
    spoil_run([](Json::Value& run) { run["cells"].removeIndex(0, nullptr); });
    EXPECT_THAT(refused(), HasSubstr("is not among the 'cells' of"));
    spoil_run([](Json::Value& run) { run["shard"]["number"] = "x"; });
    EXPECT_THAT(refused(), HasSubstr("'shard.number' is not a whole number"));
    fs::remove_all(b);
    EXPECT_THAT(refused(), HasSubstr("b/run.json: there is no such file"));
}

TEST_F(TwoShards, that_hold_one_cell_with_unlike_content_are_refused_by_member) {
    const Cells all = campaign.cells();
    Cells again = campaign.cells(1);  // another flight: other times
    const fs::path c = scratch.path() / "c";
    campaign.write(c, {again[0]}, {again[0]}, 3, 3);
    EXPECT_THAT(refusal({a, b, c}, out),
                AllOf(HasSubstr("a/cells.jsonl:1"), HasSubstr("c/cells.jsonl:1"),
                      HasSubstr("cell 'm0__s0__r0' was flown twice on one device"),
                      HasSubstr("'fps' is 100")));
    fs::remove_all(c);
    campaign.write(c, {all[0]}, {all[0]}, 3, 3);
    EXPECT_THAT(merge({a, b, c}, out).cells, SizeIs(24)) << "equal content counts once";
}

TEST_F(TwoShards, of_two_devices_are_kept_apart_and_their_counts_compared) {
    FakeCampaign other = campaign;
    other.device = "renderer B, OpenGL 4.6; processor, 8 cores";
    Cells cells = other.cells(5);
    for (auto& cell : cells) {
        if (cell.record.method == "m1") ++cell.record.triangles->max.value();
    }
    const fs::path c = scratch.path() / "c";
    other.write(c, cells, cells, 1, 1);
    const MergedRun merged = merge({c, b, a}, out);
    EXPECT_THAT(merged.cells, SizeIs(48)) << "every cell on both";
    EXPECT_THAT(read_result_folder(out).cells, SizeIs(48));
    for (const CellRecord& cell : merged.cells) {
        EXPECT_THAT(cell.cell, HasSubstr("__on-"));
        EXPECT_TRUE(fs::exists(out / "shots" / (cell.cell + "__f00000.png")));
    }
    const auto groups = group_cells(merged.cells);
    EXPECT_THAT(groups, SizeIs(12));
    for (const CellGroup& group : groups) {
        EXPECT_THAT(group.cells, SizeIs(4));
        for (const CellRecord* cell : group.cells) EXPECT_EQ(cell->device, group.device);
        EXPECT_EQ(group.comparison(), group.scenario + " on " + group.device);
    }
    const auto differences = device_differences(merged.cells);
    ASSERT_THAT(differences, SizeIs(1));
    EXPECT_THAT(differences[0], AllOf(HasSubstr("triangles of 2 settings"), HasSubstr("renderer A"),
                                      HasSubstr("renderer B"), HasSubstr("m1, s0: ")));
    // Merged once more with one of its parts, nothing is doubled.
    EXPECT_THAT(merge({out, a}, scratch.path() / "again").cells, SizeIs(48));
    EXPECT_EQ(text_of(scratch.path() / "again/cells.jsonl"), text_of(out / "cells.jsonl"));
}

TEST_F(TwoShards, are_not_merged_over_something_or_into_one_of_them) {
    FakeCampaign::put(scratch.path() / "file", "mine");
    EXPECT_THROW((void)merge({a, b}, scratch.path() / "file"), InputError);
    EXPECT_EQ(text_of(scratch.path() / "file"), "mine");
    EXPECT_THROW((void)merge({a}, b), InputError);
    EXPECT_THROW((void)merge({a, b}, a / "inside"), InputError);
    EXPECT_THROW((void)merge({a, scratch.path() / "b/"}, b / "frames" / ".." / "x"), InputError);
    fs::create_directory(out);
    EXPECT_THAT(merge({a, b}, out).cells, SizeIs(24)) << "an empty folder is as good as none";
}

CellRecord on_device(const char* device, double error) {
    CellRecord cell;
    cell.method = "m";
    cell.scenario = "s";
    cell.status = CellStatus::ok;
    cell.device = device;
    cell.pixel_error_px.emplace().max = error;
    return cell;
}

TEST(DeviceDifferences, begin_beyond_the_rounding_that_is_stated) {
    EXPECT_THAT(device_differences({on_device("a", 2), on_device("b", 2.001)}), IsEmpty());
    EXPECT_THAT(device_differences({on_device("a", 2), on_device("b", 2.003)}), SizeIs(1));
    EXPECT_THAT(device_differences({on_device("a", 2), on_device("a", 3)}), IsEmpty())
        << "repetitions on one device are compared elsewhere";
    CellRecord later = on_device("b", 0);
    later.pixel_error_px.reset();  // a repetition without the truth
    EXPECT_THAT(device_differences({on_device("a", 2), later}), IsEmpty());
}

TEST(DeterministicFields, are_members_of_a_cell) {
    const Json::Value cell = to_json(CellRecord());
    for (const DeterministicField& field : deterministic_fields()) {
        EXPECT_TRUE(cell.isMember(field.name)) << field.name;
    }
}

}  // namespace
}  // namespace lodbench::results
