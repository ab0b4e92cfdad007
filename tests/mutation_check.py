#!/usr/bin/env python3
"""Breaks the measuring code on purpose, one fault at a time, and expects its tests to notice each.

The sources are copied, and built without what the tests of the measuring code do not need (the program, plugins,
readers, benchmarks). All tests must pass on the unchanged copy. Then each mutant below is applied to the copy as
a replacement of one piece of text, the copy is rebuilt, and its tests run until one fails: that one killed the
mutant. A mutant that no test fails on has survived: a result could be wrong in that way and nobody would know.

A mutant whose text is not found exactly once, or that does not compile, is a mistake of this file, not a kill.
Exit status: 0 if all mutants were killed, 1 if one survived, 2 after a mistake or when nothing could be tried.
"""
import argparse
import dataclasses
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "support"))
import source_copy  # noqa: E402

# Quick ones first: most mutants die before the second, whose tests draw whole frames.
TESTS = ["measure_test", "measure_gl_test"]

# In the copy no test waits for the program and the plugins: those above load neither; what does is in tests/run.
TRIM = ("cmake/LodbenchTests.cmake", "    add_dependencies(${program} lodbench_under_test)\n", "")

BUILD_LIMIT = 3600  # seconds; what does not end is a mistake
TEST_LIMIT = 900  # seconds a test program; a mutant that makes one loop is killed by it


class Mistake(Exception):
    """Something is wrong with this file, the sources or the machine, so that nothing can be said."""


@dataclasses.dataclass(frozen=True)
class Mutant:
    name: str
    file: str  # below harness/measure
    old: str
    new: str

    @property
    def path(self):
        return "harness/measure/" + self.file


# In the order of the files, so that one rebuild restores a mutant's file and breaks it anew.
MUTANTS = [
    # --- A sample's or a pixel's place on screen.
    Mutant("image_rows_run_upward", "pixel_projection.h",
           "(centre_.y - y) / lambda_", "(y - centre_.y) / lambda_"),
    Mutant("camera_axes_swapped", "pixel_projection.h",
           "{glm::dot(right_, v), glm::dot(up_, v), glm::dot(forward_, v)}",
           "{glm::dot(up_, v), glm::dot(right_, v), glm::dot(forward_, v)}"),
    Mutant("world_coordinates_in_float", "pixel_projection.h",
           "return turned(world - eye_);", "return turned(glm::dvec3(glm::vec3(world) - glm::vec3(eye_)));"),
    Mutant("frustum_test_dropped", "pixel_projection.h",
           "(point.z >= near_) & (std::abs(point.x) <= tangents_.x * point.z) &\n"
           "               (std::abs(point.y) <= tangents_.y * point.z)", "point.z >= near_"),
    Mutant("near_clip_dropped", "pixel_projection.h",
           "if (a.z < near_ || b.z < near_) {", "if (false) {"),
    Mutant("near_clip_at_the_wrong_share", "pixel_projection.h",
           "((before.z - near_) / (before.z - behind.z))", "((near_ - behind.z) / (before.z - behind.z))"),

    # --- Errors at the samples.
    Mutant("displaced_downward", "sample_errors.cpp",
           "run.z[i] + up.z * displacement", "run.z[i] - up.z * displacement"),
    Mutant("uncovered_sample_is_no_error", "sample_errors.cpp",
           "std::isnan(drawn.z[i]) ? kInfinity : errors.px[i]", "std::isnan(drawn.z[i]) ? 0 : errors.px[i]"),
    Mutant("drawn_point_in_view_does_not_count", "sample_errors.cpp",
           "true_in_view[i] + drawn_in_view[i] > 0 ? px", "true_in_view[i] > 0 ? px"),
    Mutant("blocks_are_culled_by_their_nearest_corner", "box_in_view.h",
           "+ glm::dot(glm::abs(normal), half) +", "- glm::dot(glm::abs(normal), half) +"),
    Mutant("blocks_are_culled_without_what_was_drawn", "sample_errors.cpp",
           "{heights.low + displacement.low, heights.high + displacement.high}",
           "{heights.low + 0 * displacement.low, heights.high}"),
    Mutant("blocks_are_left_out_by_the_truth_alone", "sample_errors.cpp",
           "if (bounds) all = {std::min(all.low, bounds->low), std::max(all.high, bounds->high)};", ""),
    # --- What is called hidden without a look.
    Mutant("horizon_of_the_highest_edges", "hidden_ground.cpp",
           "double least = std::min(edge_[i], edge_[i + 1]);", "double least = std::max(edge_[i], edge_[i + 1]);"),
    Mutant("squares_are_not_turned", "hidden_ground.cpp", "    transpose(bits);\n", "    transpose(bits), transpose(bits);\n"),
    Mutant("seen_runs_end_with_their_word", "reference_view.cpp",
           "if (shift > 0) add(first / kWord + 1, run >> (kWord - shift));", ""),
    Mutant("nothing_is_hidden", "hidden_ground.cpp",
           "            hide_samples(line, distance);\n", ""),
    Mutant("horizon_before_the_near_plane", "hidden_ground.cpp",
           "&& distance >= q_.nearest", "&& distance > 0"),
    Mutant("highest_of_a_block_not_asked", "hidden_ground.cpp",
           "kBlockCells + 1, kBlockCells + 1}).high", "kBlockCells + 1, kBlockCells + 1}).low"),
    Mutant("hidden_samples_count_as_visible", "reference_view.cpp",
           """if (!pixels.in_view(local) ||
                    !terrain.sees(camera.position, camera.near_plane / local.z, row, column)) {""",
           "if (!pixels.in_view(local)) {"),
    Mutant("popping_counts_what_is_out_of_view", "sample_errors.cpp",
           "if (now_seen[i] + before_now_seen[i] == 0 || !was_in_view) continue;", "if (!was_in_view) continue;"),
    Mutant("covered_once_is_not_counted", "sample_errors.cpp",
           "std::isnan(before) != std::isnan(after) && in_view_now",
           "std::isnan(before) && std::isnan(after) && in_view_now"),
    Mutant("popping_counts_what_enters_the_view", "sample_errors.cpp",
           "if (now_seen[i] + before_now_seen[i] == 0 || !was_in_view) continue;",
           "if (now_seen[i] + before_now_seen[i] == 0) continue;"),
    Mutant("covered_once_counts_what_enters_the_view", "sample_errors.cpp",
           "in_view_now && was_in_view) {", "in_view_now) {"),
    Mutant("map_keeps_the_least_error", "sample_errors.cpp",
           "if (!(px <= cell)) cell = px;", "if (!(px >= cell)) cell = px;"),
    # --- Errors at the pixels.
    Mutant("pixel_corner_for_its_centre", "pixel_errors.cpp",
           "pixels_.direction(double(x) + 0.5 + shift.x, double(y) + 0.5 + shift.y)",
           "pixels_.direction(double(x) + shift.x, double(y) + shift.y)"),
    Mutant("uncovered_pixel_is_no_error", "pixel_errors.cpp",
           "if (!drawn.height) return std::numeric_limits<float>::infinity();",
           "if (!drawn.height) return 0;"),
    Mutant("skirts_count_as_surface", "pixel_errors.cpp",
           "(mark & kSkirtMark) != 0 || drawn_depth == kInfinity", "drawn_depth == kInfinity"),
    Mutant("crack_slack_sign", "pixel_errors.cpp",
           "const double to = depth < kInfinity ? depth * (1 - kDepthSlack) : kInfinity;",
           "const double to = depth < kInfinity ? depth * (1 + kDepthSlack) : kInfinity;"),
    Mutant("holes_are_cracks", "pixel_errors.cpp",
           "return came_over_covered_ground(ray(x, y), to) &&", "return"),
    Mutant("sliver_slack_dropped", "pixel_errors.cpp",
           "if (!surface_.sliver_near(", "return std::nullopt;\n            if (!surface_.sliver_near("),
    Mutant("rounding_on_steep_ground_counts", "pixel_errors.cpp",
           "if (distance.px - least.px > kRoundingPx) distance = least;", ""),
    Mutant("depth_between_two_rays_is_elsewhere", "pixel_errors.cpp",
           "(*met < depth ? low : high) = middle;", "break;"),
    Mutant("uncertain_depths_are_judged", "pixel_errors.cpp",
           "return pixels_between(point, point + glm::dvec3(0, 0, uncertain)) > kJudgedPx;", "return false;"),
    Mutant("heights_around_forget_the_slope", "reference_terrain.cpp",
           "const double change = radius * glm::length(steepest);", "const double change = 0;"),
    Mutant("slivers_everywhere", "drawn_surface.cpp",
           "return nearest <= radius && area < thickness * longest;",
           "return nearest <= radius;"),
    Mutant("ambiguous_silhouettes_count", "pixel_errors.cpp",
           "if (agrees(terrain_.cast(pixels_.eye(), ray(x, y, kShifts[i]), near_))) return drawn;", ""),
    Mutant("silhouette_of_rows_for_columns", "pixel_errors.cpp",
           "errors.silhouette_mean = sum / double(width);", "errors.silhouette_mean = sum / double(height);"),

    # --- Pools of errors.
    Mutant("percentile_rank_off_by_one", "error_pool.cpp",
           "if (seen > above_rank) return std::min(",
           "if (seen >= above_rank) return std::min("),
    Mutant("rms_over_uncovered_places_too", "error_pool.cpp",
           "std::sqrt(sums_.sum_of_squares / double(finite))",
           "std::sqrt(sums_.sum_of_squares / double(sums_.count))"),
    Mutant("errors_outlive_the_frame", "error_pool.cpp",
           "std::exchange(other.buckets_[i], 0)", "other.buckets_[i]"),
    Mutant("the_bound_itself_is_over_it", "error_pool.h",
           "if (error > bound) ++over_bound;", "if (error >= bound) ++over_bound;"),

    # --- The drawn surface.
    Mutant("edges_are_exclusive", "plan_triangle.h",
           "edges[0].side(point) >= 0 && edges[1].side(point) >= 0 && edges[2].side(point) >= 0;",
           "edges[0].side(point) > 0 && edges[1].side(point) > 0 && edges[2].side(point) > 0;"),
    Mutant("corners_weighted_by_each_others_side", "plan_triangle.h",
           "edges[1].side(point) / area * rise1 + edges[2].side(point) / area * rise2",
           "edges[2].side(point) / area * rise1 + edges[1].side(point) / area * rise2"),
    Mutant("lowest_triangle_wins", "drawn_surface.cpp",
           "highest = std::max(highest, triangle.height(point));",
           "highest = highest == -kInfinity ? triangle.height(point)\n                                     : std::min(highest, triangle.height(point));"),
    Mutant("lowest_triangle_wins_at_pixels", "drawn_surface.cpp",
           "covering = std::max(covering, triangle.height(point));",
           "covering = covering == -kInfinity ? triangle.height(point) : std::min(covering, triangle.height(point));"),
    Mutant("skirts_are_surface_and_risers_skirts", "drawn_surface.cpp",
           "append(steep_below[i] != 0 ? skirts : risers,", "append(steep_below[i] != 0 ? risers : skirts,"),
    Mutant("rounding_of_vertices_ignored", "drawn_surface.cpp",
           "    return nearby_height(point);\n", "    return highest;\n"),
    Mutant("a_ray_on_the_surface_is_below_it", "plan_ray.h",
           "origin_.z + t * direction_.z <\n", "origin_.z + t * direction_.z <=\n"),
    Mutant("only_the_rays_end_is_asked", "plan_ray.h",
           "(is_below(triangle, begin) || is_below(triangle, end))", "is_below(triangle, end)"),
    Mutant("rays_come_over_boxes_too_late", "plan_ray.cpp",
           "from = std::max(from, enter);", "from = std::max(from, leave);"),
    Mutant("lowest_triangle_wins_at_samples", "drawn_surface_grid.cpp",
           "heights[column] = heights[column] > height ? heights[column] : height;",
           "if (covered) heights[column] = heights[column] == -kInfinity ? height\n"
           "                                          : std::min(heights[column], height);"),
    Mutant("edges_are_exclusive_at_samples", "drawn_surface_grid.cpp",
           "(local.edges[0].side(point) >= 0) & (local.edges[1].side(point) >= 0) &\n"
           "                             (local.edges[2].side(point) >= 0);",
           "(local.edges[0].side(point) > 0) & (local.edges[1].side(point) > 0) &\n"
           "                             (local.edges[2].side(point) > 0);"),
    Mutant("samples_half_a_spacing_east", "drawn_surface_grid.cpp",
           "info.position(0, rect.column + column).x - origin.x",
           "info.position(0, rect.column + column).x + 0.5 * spacing.x - origin.x"),
    Mutant("samples_off_by_one_row", "drawn_surface_grid.cpp",
           "info.position(rect.row + row, 0).y - origin.y", "info.position(rect.row + row + 1, 0).y - origin.y"),
    Mutant("displacements_in_float", "drawn_surface_grid.cpp",
           "float(origin_.z + drawn[column] - double(truth[column]))",
           "float(origin_.z + drawn[column]) - truth[column]"),
    Mutant("a_box_as_high_as_its_last_corner", "triangle_tree.cpp",
           "box.max_z = std::max(box.max_z, vertex.z);", "box.max_z = vertex.z;"),

    # --- The true surface.
    Mutant("south_is_north", "reference_terrain.cpp",
           "return {cells.x, info_.rows - 1 - cells.y};", "return {cells.x, cells.y};"),
    Mutant("terrain_off_by_one_row", "reference_terrain.cpp",
           "return {cells.x, info_.rows - 1 - cells.y};", "return {cells.x, info_.rows - cells.y};"),
    Mutant("terrain_rows_are_columns", "reference_terrain.cpp",
           "return {cells.x, info_.rows - 1 - cells.y};", "return {info_.rows - 1 - cells.y, cells.x};"),
    Mutant("half_texel_shift", "reference_terrain.cpp",
           "(position - info_.origin) / info_.spacing;", "(position - info_.origin) / info_.spacing - 0.5;"),
    Mutant("touching_hides", "reference_terrain.cpp",
           "std::clamp(share, 0.0, 1.0) * (to - from) - tolerance_;",
           "std::clamp(share, 0.0, 1.0) * (to - from) + tolerance_;"),
    Mutant("envelopes_swapped", "grid_cell.h",
           "(envelope == Envelope::kUpper) == (twist() >= 0)", "(envelope == Envelope::kUpper) == (twist() < 0)"),
    Mutant("blocks_without_their_last_row", "height_pyramid.cpp",
           "std::min((block_row + 1) * kWidth, rows - 1)", "std::min((block_row + 1) * kWidth, rows - 1) - 1"),
    Mutant("cells_left_through_the_farther_side", "grid_walk.h",
           "const bool through_column = t_column <= t_row;", "const bool through_column = t_column >= t_row;"),

    # --- Pictures and captured triangles.
    Mutant("mean_squared_error_a_pixel", "image_difference.cpp",
           "return double(sum) / double(a.bytes.size());", "return 3 * double(sum) / double(a.bytes.size());"),
    Mutant("decibels_of_amplitude", "image_difference.cpp",
           "return 10 * std::log10", "return 20 * std::log10"),
    Mutant("clipped_corner_beside_the_border", "capture.cpp",
           "(from_distance / (from_distance - to_distance))", "(to_distance / (to_distance - from_distance))"),

    # --- A cell's figures.
    Mutant("popping_seen_by_the_earlier_camera", "truth.cpp",
           "{now_.camera, *now_.drawn}, frame_);",
           "{before_.camera, *now_.drawn}, frame_);"),
    Mutant("popping_across_a_gap", "truth.cpp",
           "const bool pops = before_.measured && before_.frame + 1 == frame;",
           "const bool pops = before_.measured;"),
    Mutant("height_error_without_its_root", "truth.cpp",
           "return std::sqrt(heights.sum_of_squares / double(heights.count));",
           "return heights.sum_of_squares / double(heights.count);"),
    Mutant("picture_error_of_the_best_frame", "truth.cpp",
           "extreme(squared_errors_, std::greater<>())", "extreme(squared_errors_, std::less<>())"),
    Mutant("the_best_frame_is_shown", "truth.cpp",
           "if (worst_ && !(rank(pixel) > rank(worst_pixel_))) return;",
           "if (worst_ && !(rank(pixel) < rank(worst_pixel_))) return;"),
    Mutant("crack_max_is_the_last_frames", "truth.cpp",
           "total_.crack_max = std::max(total_.crack_max, pixels.crack_pixels);",
           "total_.crack_max = pixels.crack_pixels;"),
    Mutant("worst_pixels_column_is_its_row", "truth.cpp",
           "worst = {px, int(i / std::size_t(width)), int(i % std::size_t(width))};",
           "worst = {px, int(i % std::size_t(width)), int(i / std::size_t(width))};"),
    # --- What would do.
    Mutant("greedy_stops_at_another_percentile", "greedy_triangulation.cpp",
           "return errors - errors / 1000;", "return errors - errors / 100;"),
    Mutant("greedy_forgets_what_left_the_view", "greedy_triangulation.cpp",
           "count(noted, ~std::uint64_t{0});", ""),
    Mutant("greedy_leaves_out_what_is_only_drawn_in_view", "greedy_triangulation.cpp",
           "(!pixels_.in_view(truth) && !pixels_.in_view(drawn))", "!pixels_.in_view(truth)"),
    Mutant("needed_tiles_lack_one_level_alone", "needed_tiles.cpp",
           "std::nextafter(below + terrain", "std::nextafter(0 * below + terrain"),
    Mutant("needed_tiles_by_the_box_s_middle", "needed_tiles.cpp",
           "glm::dot(forward_, centre) - glm::dot(glm::abs(forward_), half)", "glm::dot(forward_, centre)"),
    Mutant("needed_tiles_at_the_image_s_centre_alone", "needed_tiles.cpp",
           "std::hypot(up.x - x * up.z, up.y - y * up.z)", "std::hypot(up.x, up.y)"),
    Mutant("honesty_upside_down", "truth.cpp",
           "*summary.screen.max / *claimed_", "*claimed_ / *summary.screen.max"),
]


def replaced(path, old, new):
    """The file's text with one piece replaced, which must be there exactly once."""
    text = path.read_text(encoding="utf-8")
    count = text.count(old)
    if count != 1:
        raise Mistake(f"{path}: expected exactly once, found {count} times:\n{old}")
    return text.replace(old, new)


class Copy:
    """The sources in a folder of their own, and what is built of them."""

    def __init__(self, work, jobs):
        self.work = work
        self.source = source_copy.update(work, {TRIM[0]: replaced(source_copy.ROOT / TRIM[0], *TRIM[1:])})
        self.build_folder = work / "build"
        self.jobs = jobs
        self.original = None  # path and text of the file that a mutant has broken

    def run(self, command, what):
        try:
            result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                    errors="replace", timeout=BUILD_LIMIT)
        except subprocess.TimeoutExpired as error:
            raise Mistake(f"{what} did not end in {BUILD_LIMIT} s") from error
        except OSError as error:
            raise Mistake(f"{what}: {error}") from error
        if result.returncode != 0:
            raise Mistake(f"{what} failed:\n{result.stdout[-6000:]}")

    def configure(self):
        # Release, as what is measured with; libraries that only read terrain files are left out.
        self.run(["cmake", "-S", self.source, "-B", self.build_folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                  "-DLODBENCH_BENCHMARKS=OFF", "-DLODBENCH_WITH_GDAL=OFF", "-DLODBENCH_WITH_OIIO=OFF",
                  "-DLODBENCH_WITH_WEBP=OFF"], "cmake")

    def build(self, what):
        self.run(["cmake", "--build", self.build_folder, "--parallel", str(self.jobs), "--target", *TESTS], what)

    def restore(self):
        if self.original is not None:
            path, text = self.original
            path.write_text(text, encoding="utf-8")
            self.original = None

    def apply(self, mutant):
        self.restore()
        path = self.source / mutant.path
        text = replaced(path, mutant.old, mutant.new)
        self.original = path, path.read_text(encoding="utf-8")
        path.write_text(text, encoding="utf-8")
        self.build(f"building the mutant {mutant.name}")

    def first_failure(self):
        """What went wrong in the first test that failed; None where all passed."""
        for test in TESTS:
            try:
                result = subprocess.run([self.build_folder / "tests" / test, "--gtest_fail_fast"],
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                        errors="replace", timeout=TEST_LIMIT, cwd=self.build_folder)
            except subprocess.TimeoutExpired:
                return f"{test}, which did not end in {TEST_LIMIT} s"
            except OSError as error:
                raise Mistake(f"{test}: {error}") from error
            if result.returncode == 0:
                if re.search(r"^\[  SKIPPED \]|^\[  PASSED  \] 0 tests", result.stdout, re.MULTILINE):
                    raise Mistake(f"{test}: expected every test to run:\n{result.stdout[-6000:]}")
                continue
            failed = re.findall(r"^\[  FAILED  \] ([\w./]+)", result.stdout, re.MULTILINE)
            begun = re.findall(r"^\[ RUN      \] ([\w./]+)", result.stdout, re.MULTILINE)
            name = failed[0] if failed else (begun or ["before its first test"])[-1]
            return f"{test}: {name}" + ("" if failed else f" (ended with status {result.returncode})")
        return None


def check(mutants, work, jobs):
    """Tries all mutants; returns how many survived."""
    work.mkdir(parents=True, exist_ok=True)
    copy = Copy(work, jobs)
    # Before anything is built: texts that have gone are told at once.
    for mutant in mutants:
        replaced(copy.source / mutant.path, mutant.old, mutant.new)
    begin = time.monotonic()
    copy.configure()
    copy.build("building the unchanged copy")
    failure = copy.first_failure()
    if failure is not None:
        raise Mistake(f"the unchanged code fails in {failure}")
    print(f"unchanged: all tests pass ({time.monotonic() - begin:.0f} s)", flush=True)
    survivors = []
    for mutant in mutants:
        begin = time.monotonic()
        copy.apply(mutant)
        failure = copy.first_failure()
        outcome = f"killed by {failure}" if failure is not None else "SURVIVED"
        print(f"{mutant.name} ({mutant.file}): {outcome} ({time.monotonic() - begin:.0f} s)", flush=True)
        if failure is None:
            survivors.append(mutant.name)
    copy.restore()
    print(f"{len(mutants) - len(survivors)} of {len(mutants)} mutants killed")
    if survivors:
        print("survived: " + " ".join(survivors))
    return len(survivors)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true", help="name all mutants and end")
    parser.add_argument("--only", action="append", metavar="NAME", help="try this mutant alone; may be repeated")
    parser.add_argument("--work", type=pathlib.Path, metavar="DIR",
                        help="copy and build here, and keep it: the next run builds only what has changed; "
                             "without it a temporary folder is used and removed")
    parser.add_argument("--jobs", type=int, default=min(2, os.cpu_count() or 1), metavar="N",
                        help="compilers at a time (default: %(default)s)")
    options = parser.parse_args()
    if options.list:
        for mutant in MUTANTS:
            print(f"{mutant.name} ({mutant.file})")
        return 0
    unknown = set(options.only or []) - {mutant.name for mutant in MUTANTS}
    if unknown:
        parser.error("no such mutant: " + " ".join(sorted(unknown)))
    mutants = [mutant for mutant in MUTANTS if not options.only or mutant.name in options.only]
    try:
        if options.work is not None:
            return 1 if check(mutants, options.work.resolve(), options.jobs) else 0
        with tempfile.TemporaryDirectory(prefix="lodbench-mutation-") as folder:
            return 1 if check(mutants, pathlib.Path(folder), options.jobs) else 0
    except Mistake as mistake:
        print(f"mutation_check: {mistake}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
