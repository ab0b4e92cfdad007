#pragma once
// Rasters that a test writes: what is read of them, or why they are refused.

#include <gtest/gtest.h>

#include <algorithm>

#include "api/error.h"
#include "support/raster_files.h"
#include "terrain/load_terrain.h"

namespace lodbench::terrain {

class RasterInput : public testing::Test {
protected:
    TerrainSource source(const std::string& name, std::string_view bytes) {
        TerrainSource made;
        made.file = folder_.write(name, bytes);
        return made;
    }
    /// One line that begins with the file: what follows the folder's name.
    std::string refusal(const TerrainSource& given) {
        try {
            (void)load_terrain(given);
        } catch (const InputError& error) {
            const std::string text = error.what();
            EXPECT_EQ(text.find('\n'), std::string::npos) << text;
            EXPECT_EQ(text.find(folder_.path().string() + "/"), 0U) << text;
            return text.substr(std::min(text.size(), folder_.path().string().size() + 1));
        }
        return "accepted";
    }
    std::string refusal(const std::string& name, std::string_view bytes) {
        return refusal(source(name, bytes));
    }
    test::TemporaryFolder folder_;
};

}  // namespace lodbench::terrain
