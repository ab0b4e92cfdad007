// A libFuzzer target (clang, -DLODBENCH_FUZZ=ON): sidecar_fuzz [--seeds FOLDER | libFuzzer's own
// arguments]. Any bytes as the text beside or in a raster: the sidecar of raw heights, a world
// file, an Arc ASCII grid, by the first byte. Each is refused as InputError in one plain line that
// begins with the file, or gives what its documentation says, and a sidecar written anew reads back
// the same.

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <optional>

#include "api/error.h"
#include "fuzz/refusal.h"
#include "fuzz/seeds.h"
#include "terrain/ascii_grid_check.h"
#include "terrain/height_field.h"
#include "terrain/sidecar.h"
#include "terrain/world_file.h"

namespace lodbench::test {
namespace {

/// A folder that stays as long as the process.
const std::filesystem::path& folder() {
    static const std::filesystem::path path = [] {
        const auto made =
            std::filesystem::temp_directory_path() / ("sidecar_fuzz_" + std::to_string(getpid()));
        std::filesystem::create_directories(made);
        std::ofstream(made / "a.raw", std::ios::binary) << std::string(32, '\1');
        return made;
    }();
    return path;
}

std::filesystem::path write(const char* name, std::string_view text) {
    std::filesystem::path file = folder() / name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

void require(bool holds, const char* what) {
    if (!holds) finding(std::string("accepted, but not ") + what);
}

void require_finite(const std::optional<double>& number, const char* what) {
    require(!number || std::isfinite(*number), what);
}

void check_sidecar(const terrain::Sidecar& sidecar) {
    for (const auto& spacing : {sidecar.spacing_x, sidecar.spacing_y}) {
        require(!spacing || (std::isfinite(*spacing) && *spacing > 0), "a positive spacing");
    }
    require(!sidecar.vertical_scale || *sidecar.vertical_scale != 0, "a scale");
    for (const auto& number :
         {sidecar.vertical_scale, sidecar.vertical_offset, sidecar.origin_x, sidecar.origin_y}) {
        require_finite(number, "finite numbers");
    }
    for (const auto& count : {sidecar.rows, sidecar.columns}) {
        require(!count || *count >= 2, "two rows and columns");
    }
    const std::string text = terrain::sidecar_text(sidecar);
    write("b.raw.toml", text);
    const std::string again = terrain::sidecar_text(terrain::read_sidecar(folder() / "b.raw"));
    if (again != text) finding("written as\n" + text + "but read back as\n" + again);
}

void use_as_sidecar(std::string_view text) {
    const std::filesystem::path file = write("a.raw.toml", text);
    const std::filesystem::path raster = folder() / "a.raw";
    try {
        check_sidecar(terrain::read_sidecar(raster));
    } catch (const InputError& error) {
        check_refusal(error.what(), file.string());
        return;
    }
    terrain::TerrainSource source;
    source.file = raster;
    try {
        const auto field = terrain::load_terrain(source);
        for (const float height : field->samples()) {
            require(std::isfinite(height), "finite heights");
        }
    } catch (const InputError&) {
        // Of the raster, the sidecar or the terrain by its name: what does not fit together.
    }
}

void use_as_world_file(std::string_view text) {
    const std::filesystem::path file = write("w.wld", text);
    terrain::RasterDescription description;
    description.rows = description.columns = 4;
    try {
        description = terrain::with_world_file(folder() / "w.png", description);
    } catch (const InputError& error) {
        return check_refusal(error.what(), file.string());
    }
    require(description.spacing.has_value() != !description.spacing_hint.empty(),
            "either a spacing or why there is none");
    if (!description.spacing) return;
    require(description.spacing->x > 0 && description.spacing->y > 0, "a positive spacing");
}

void use_as_grid(std::string_view text) {
    const std::filesystem::path file = write("g.asc", text);
    try {
        const terrain::AsciiGrid grid = terrain::check_ascii_grid(file);
        require(!grid.recognised || (grid.rows >= 2 && grid.columns >= 2), "two rows and columns");
    } catch (const InputError& error) {
        check_refusal(error.what(), file.string());
    }
}

std::vector<std::string> seeds() {
    const std::string head =
        "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 30\nNODATA_value -9999\n";
    const std::string sidecar(1, '\0');
    const std::string world(1, '\1');
    const std::string grid(1, '\2');
    return {sidecar +
                "name = \"a \\u00e9\"\nrows = 4\ncolumns = 4\ntype = \"int16\"\n"
                "endian = \"little\"\nspacing = [10, 20.5]\norigin = [1e3, -2]\n"
                "vertical_scale = 0.1\nvertical_offset = -3\nno_data = -300\nvoids_filled = 7\n",
            sidecar +
                "rows = 2\ncolumns = 4\ntype = \"float32\"\nendian = \"big\"\nspacing = 3\n"
                "no_data = nan\n",
            world + "10\n0\n0\n-10\n500005\n5199995\n", grid + head + "1 2.5 3\n4 -9999 6\n",
            grid +
                "ncols 2\r\nnrows 2\r\nxllcenter 1\r\nyllcenter 2\r\ndx 3\r\ndy 4\r\n"
                "nan +1\r\n1e5 inf\r\n"};
}

}  // namespace

void use(std::string_view input) {
    if (input.empty()) return;
    const std::string_view text = input.substr(1);
    switch (static_cast<unsigned char>(input[0]) % 3) {
        case 0: return use_as_sidecar(text);
        case 1: return use_as_world_file(text);
        default: return use_as_grid(text);
    }
}

}  // namespace lodbench::test

LODBENCH_FUZZ_TARGET(lodbench::test::use, lodbench::test::seeds)
