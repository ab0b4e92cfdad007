// lodbench terrain verify: every tile of a store.

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "api/error.h"
#include "base/console.h"
#include "cli/terrain_options.h"
#include "results/json.h"
#include "run/exit_status.h"
#include "terrain/tile_store_check.h"

namespace lodbench::cli {
namespace {

struct VerifyOptions {
    std::string file;
    int most = 20;
    bool cold = false, json = false;
};

int run(const VerifyOptions& options) {
    if (!terrain::is_store(options.file)) {
        throw InputError(fmt::format(
            "{}: not a tiled store (.tiles); `lodbench terrain import` makes one", options.file));
    }
    const terrain::StoredTerrain store(options.file, options.cold);
    const auto start = std::chrono::steady_clock::now();
    const terrain::StoreReport report = terrain::check_tiles(store, std::size_t(options.most));
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const int status = report.fault_count == 0 ? run::kAllWell : run::kPromiseBroken;
    if (options.json) {
        Json::Value object;
        object["name"] = store.info().name;
        object["tiles"] = Json::UInt64(report.tiles);
        object["bytes"] = Json::UInt64(report.bytes);
        object["seconds"] = seconds;
        object["fault_count"] = Json::UInt64(report.fault_count);
        object["faults"] = results::array_of(report.faults);
        base::print("{}\n", results::to_text(object, true));
        return status;
    }
    for (const std::string& fault : report.faults) base::print("{}: {}\n", options.file, fault);
    if (report.fault_count > report.faults.size()) {
        base::print("{}: {} more\n", options.file, report.fault_count - report.faults.size());
    }
    base::print("{}: {} tiles, {} {}, {:.1f} s, {:.0f} MB/s\n", options.file, report.tiles,
                report.fault_count, report.fault_count == 1 ? "fault" : "faults", seconds,
                double(report.bytes) * 1e-6 / seconds);
    return status;
}

}  // namespace

void add_terrain_verify(CLI::App& parent, int& status) {
    const auto options = std::make_shared<VerifyOptions>();
    CLI::App& command = *parent.add_subcommand(
        "verify",
        "Read every tile of a store and compare it with checksum, summary, neighbours and finer "
        "levels; status 1 where one is damaged");
    command.add_option("FILE", options->file, "tiled store (.tiles)")->required();
    command.add_option("--most", options->most, "faults that are put in words")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command.add_flag("--cold", options->cold, "from the disk, not from what the system holds");
    command.add_flag("--json", options->json, "one JSON object on standard output");
    command.callback([options, &status] { status = run(*options); });
}

}  // namespace lodbench::cli
