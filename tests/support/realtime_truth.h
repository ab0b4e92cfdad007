#pragma once
// Flights whose errors in real time are measured too.

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "support/frames_csv.h"
#include "support/run_lodbench.h"

namespace lodbench::test {

using Arguments = std::vector<std::string>;

class RealtimeTruth : public testing::Test {
protected:
    /// 12 frames 40 m apart, over a terrain from above: a frame behind is raised by 4 m of the
    /// 500 m or so that it is away.
    fs::path run(const std::string& name, const Arguments& more) {
        const fs::path file = folder_.path() / "small.toml";
        std::ofstream(file) << "name = \"small\"\n[terrain]\nsynthetic = \"ridged\"\nrows = 65\n"
                               "columns = 65\nspacing = 10\nshape.height = 100\n"
                               "[viewport]\nwidth = 64\nheight = 48\n"
                               "[flight]\nkind = \"line\"\nframes = 12\nwarmup_frames = 1\n"
                               "start = [100, 320, 500]\nend = [540, 320, 500]\nheading = 90\n"
                               "pitch = -70\n[measure]\nevery = 2\nshots = [0]\n"
                               "[run]\nrepetitions = 1\n";
        const fs::path out = folder_.path() / name;
        Arguments arguments = {"run",        file.string(),  "--out",
                               out.string(), "--plugin-dir", broken_plugin_folder("lags")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Finished finished = run_lodbench(arguments, folder_.path());
        EXPECT_EQ(finished.status, 0) << finished.output;
        return out;
    }
    static std::vector<FrameTexts> frames_of(const fs::path& out, const Json::Value& cell) {
        return read_frames_csv(out / "frames" / (cell["cell"].asString() + ".csv"));
    }
    static std::vector<std::string> texts(const std::vector<FrameTexts>& frames,
                                          std::span<const char* const> columns) {
        std::vector<std::string> all;
        for (const FrameTexts& frame : frames) {
            for (const char* column : columns) all.push_back(frame.at(column));
        }
        return all;
    }

    ScratchFolder folder_;
};

}  // namespace lodbench::test
