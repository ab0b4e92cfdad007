#pragma once
// The promises that every method makes, each as a named check that any plugin can be put to.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "conformance/quality.h"
#include "run/plugin_library.h"
#include "run/vital_signs.h"

namespace lodbench::conformance {

/// What is put to the test. A run is repeated by its seed.
struct Subject {
    run::MethodInfo method;  ///< its plugin included
    run::Settings settings;
    std::string device;  ///< as for platform::Context
    std::uint64_t seed = 1;
    /// Where each call of the method is told; shared with whoever watches.
    std::shared_ptr<run::VitalSigns> signs = std::make_shared<run::VitalSigns>();
    /// Found by the first check that asks for them, and used by those after it.
    std::shared_ptr<std::optional<Qualities>> qualities =
        std::make_shared<std::optional<Qualities>>();
};

/// The method does not keep its promise: what was seen, with frame or camera, and what was
/// expected.
struct PromiseBroken : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What the method claims of itself does not hold: the figures. A warning, for a claim is its
/// paper's, not the harness's.
struct ClaimBroken : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The check says nothing of this method: why.
struct NotApplicable : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Check {
    const char* name;     ///< [a-z0-9-]+
    const char* promise;  ///< one line: what holds when it passes
    double time_limit_s;
    /// Returns when the promise is kept, throws PromiseBroken, ClaimBroken, run::MethodFailure or
    /// NotApplicable otherwise.
    void (*run)(const Subject&);
};

/// Every check, in the order in which they are run.
[[nodiscard]] std::span<const Check> all_checks();

// selection_checks.cpp
void draw_is_idempotent(const Subject&);
void select_is_repeatable(const Subject&);
void selection_is_frozen(const Subject&);
void picture_shows_the_capture(const Subject&);
void timing_equals_lockstep(const Subject&);
void lockstep_is_repeatable(const Subject&);
// state_checks.cpp
void descriptor_is_sane(const Subject&);
void pipeline_state_is_restored(const Subject&);
void no_gl_errors(const Subject&);
void objects_are_given_back(const Subject&);
void release_without_frames(const Subject&);
void resize_and_back(const Subject&);
// surface_checks.cpp
void vertices_are_finite(const Subject&);
void any_terrain_works(const Subject&);
void origin_does_not_matter(const Subject&);
void parameters_at_their_limits(const Subject&);
void terrain_in_view_is_covered(const Subject&);
// error_checks.cpp
void finest_is_the_terrain(const Subject&);
void claimed_bound_holds(const Subject&);
void finer_is_no_worse(const Subject&);

}  // namespace lodbench::conformance
