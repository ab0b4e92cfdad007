#include "conformance/suite.h"

#include <fmt/format.h>

#include <array>
#include <chrono>

#include "api/error.h"
#include "base/isolated.h"
#include "run/shared_signs.h"
#include "run/stage.h"

namespace lodbench::conformance {

namespace {

constexpr double kUsualLimit = 120;  // seconds; a check takes some on a software rasteriser
constexpr double kLongLimit = 300;   // those that start a method a dozen times

constexpr std::array kChecks = {
    Check{"descriptor-is-sane", "texts are there, one line each; knob and bound make sense", 30,
          descriptor_is_sane},
    Check{"draw-is-idempotent", "picture, capture, picture: identical depth bits", kUsualLimit,
          draw_is_idempotent},
    Check{"select-is-repeatable", "select twice with one camera: the same triangles to the bit",
          kUsualLimit, select_is_repeatable},
    Check{"selection-is-frozen", "draw gives the same selection through every view", kUsualLimit,
          selection_is_frozen},
    Check{"picture-shows-the-capture", "the picture is that of the captured triangles", kUsualLimit,
          picture_shows_the_capture},
    Check{"timing-equals-lockstep",
          "depth after a random number of timing frames equals a fresh lockstep replay's",
          kUsualLimit, timing_equals_lockstep},
    Check{"lockstep-is-repeatable", "two lockstep replays draw the same triangles", kUsualLimit,
          lockstep_is_repeatable},
    Check{"pipeline-state-is-restored", "every call leaves the GL state as it was found",
          kUsualLimit, pipeline_state_is_restored},
    Check{"no-gl-errors", "no call raises a GL error", kUsualLimit, no_gl_errors},
    Check{"objects-are-given-back", "release gives all GL objects back, bare ones included",
          kUsualLimit, objects_are_given_back},
    Check{"release-without-frames", "prepare, upload, release without a frame leaves nothing",
          kUsualLimit, release_without_frames},
    Check{"resize-and-back", "other viewports work, and the first gives the first picture again",
          kUsualLimit, resize_and_back},
    Check{"vertices-are-finite", "no NaN or infinite vertex, wherever the camera is and looks",
          kUsualLimit, vertices_are_finite},
    Check{"any-terrain-works", "2x2, odd sizes, plane, step, ridged: drawn and finite", kLongLimit,
          any_terrain_works},
    Check{"origin-does-not-matter", "10,000 km from the origin the surface is the same",
          kUsualLimit, origin_does_not_matter},
    Check{"parameters-at-their-limits", "every parameter works at its minimum, default and maximum",
          kLongLimit, parameters_at_their_limits},
    Check{"terrain-in-view-is-covered",
          "a method that claims a bound leaves no sample in view uncovered", kUsualLimit,
          terrain_in_view_is_covered},
    Check{"finest-is-the-terrain",
          "at the knob's fine end the surface is the terrain, to the bound or 1 px (RMS 2 px "
          "without one)",
          kUsualLimit, finest_is_the_terrain},
    Check{"claimed-bound-holds",
          "no sample's screen error exceeds the claimed bound; a warning, a failure with --strict",
          kUsualLimit, claimed_bound_holds},
    Check{"finer-is-no-worse", "the measured screen error does not rise as the knob gets finer",
          kUsualLimit, finer_is_no_worse},
};

// The first letter of a child's answer.
constexpr char kPassed = 'p', kWarned = 'w', kFailed = 'f', kSkipped = 's';

Verdict verdict_of(char letter) {
    switch (letter) {
        case kPassed: return Verdict::passed;
        case kWarned: return Verdict::warned;
        case kSkipped: return Verdict::skipped;
        default: return Verdict::failed;
    }
}

/// A letter and the reason for it.
std::string judge(const Check& check, const Subject& subject) {
    try {
        check.run(subject);
        return {kPassed};
    } catch (const NotApplicable& reason) {
        return kSkipped + std::string(reason.what());
    } catch (const run::MethodSkipped& reason) {
        return kSkipped + std::string(reason.what());
    } catch (const ClaimBroken& broken) {
        return kWarned + std::string(broken.what());
    } catch (const PromiseBroken& broken) {
        return kFailed + std::string(broken.what());
    } catch (const run::MethodFailure& failure) {
        return kFailed + std::string(failure.what());
    }
}

/// The verdict after a line with what the check found out and others need; empty where it asked for
/// nothing.
std::string answer_of(const Check& check, const Subject& subject) {
    const std::string verdict = judge(check, subject);
    const std::optional<Qualities>& found = *subject.qualities;
    return (found ? write_qualities(*found) : "") + "\n" + verdict;
}

/// Takes from an answer what was found, for the checks to come, and leaves the verdict.
std::string verdict_in(const std::string& answer, const Subject& subject) {
    const std::size_t line = answer.find('\n');
    if (line > 0) *subject.qualities = read_qualities(std::string_view(answer).substr(0, line));
    return answer.substr(line + 1);
}

}  // namespace

std::span<const Check> all_checks() {
    return kChecks;
}

const char* name_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::passed: return "passed";
        case Verdict::warned: return "warned";
        case Verdict::failed: return "failed";
        case Verdict::skipped: return "skipped";
    }
    return "";
}

const Check& find_check(const std::string& name) {
    std::string names;
    for (const Check& check : kChecks) {
        if (name == check.name) return check;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", check.name);
    }
    throw InputError(fmt::format("no test is called '{}'; there are {}", name, names));
}

CheckReport run_check(const Check& check, const Subject& subject, double time_limit_s) {
    const auto start = std::chrono::steady_clock::now();
    Subject watched = subject;
    watched.signs = run::map_signs();
    const double call_limit_s = 0.5 * time_limit_s;
    run::HangWatch watch(watched.signs, call_limit_s);
    CheckReport report;
    report.check = check.name;
    const base::Answer answer = base::run_isolated(
        time_limit_s, [&] { return answer_of(check, watched); },
        [&] {
            const run::Call call = watch.hung_in();
            if (call == run::Call::none) return std::string();
            report.hung_in = run::name_of(call);
            return fmt::format("hung in {}: it did not come back within {:g} s", report.hung_in,
                               call_limit_s);
        });
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report.reason = answer.text;
    switch (answer.ending) {
        case base::Ending::answered: {
            const std::string verdict = verdict_in(answer.text, subject);
            report.verdict = verdict_of(verdict.front());
            report.reason = verdict.substr(1);
            break;
        }
        case base::Ending::refused: throw InputError(answer.text);
        case base::Ending::environment_error: report.verdict = Verdict::skipped; break;
        case base::Ending::threw:
        case base::Ending::died:
        case base::Ending::timed_out: report.verdict = Verdict::failed; break;
    }
    return report;
}

}  // namespace lodbench::conformance
