#pragma once
// The errors activity: a thread with a context of its own. Yusuf, Mostafa, Elarif 2014, section 3.

#include <memory>

#include "api/error.h"
#include "gl/device.h"
#include "multi_context/background.h"
#include "multi_context/errors_pass.h"

namespace lodbench::multi_context {

/// Computes the block errors of the latest camera that was asked for. The only object that both
/// contexts use is the texture of heights, which is complete before the thread starts and never
/// written again; what the errors activity finds crosses over in main memory, under the lock of
/// `Background`.
class ErrorsActivity {
public:
    /// On the host's thread. Returns when the thread's context, programs and textures stand. Throws
    /// UnsupportedError where the driver refuses a second context, and what making them throws.
    ErrorsActivity(gl::Device& host, const gl::Texture& heights, const TerrainInfo& terrain,
                   const ErrorsSettings& settings)
        : context_(host.make_shared_context()), background_([&, this]() -> Background_::Work {
              // Not this constructor's locals from here on: it returns when this does.
              auto gpu = std::make_shared<Gpu>(*context_, host, heights, terrain, settings);
              return [this, gpu](const Camera& camera, BlockErrors& errors) {
                  gpu->pass.run(camera, errors, [this] { background_.wait_for_tick(); });
                  gpu->require_no_errors();
              };
          }) {}

    using Background_ = Background<Camera, BlockErrors>;
    [[nodiscard]] Background_& background() { return background_; }
    [[nodiscard]] const Background_& background() const { return background_; }

private:
    /// All that belongs to the thread's context; made and destroyed on the thread.
    struct Gpu {
        struct Current {
            explicit Current(gl::SharedContext& context_) : context(context_) {
                context.make_current();
            }
            ~Current() { context.release_current(); }
            Current(const Current&) = delete;
            Current& operator=(const Current&) = delete;
            gl::SharedContext& context;
        };
        Gpu(gl::SharedContext& context, gl::Device& host, const gl::Texture& heights,
            const TerrainInfo& terrain, const ErrorsSettings& settings)
            : current(context), device(host), pass(device, heights, terrain, settings) {
            require_no_errors();
        }
        void require_no_errors() {
            const auto errors = device.take_errors();
            if (!errors.empty()) {
                throw EnvironmentError("the errors activity raised a GL error: " + errors.front());
            }
        }
        Current current;
        gl::Device device;
        ErrorsPass pass;
    };

    std::unique_ptr<gl::SharedContext> context_;
    Background_ background_;  // last: its thread uses the others
};

}  // namespace lodbench::multi_context
