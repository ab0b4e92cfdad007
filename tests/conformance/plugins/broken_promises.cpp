// Methods that break one promise each, on purpose: the conformance suite must notice every one of
// them.

#include <cfenv>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <string>

#include "grid_method.h"

namespace {

using namespace lodbench;
using broken::GridMethod;

/// A capture's matrix leaves w at 1, a picture's does not.
bool is_capture(const View& view) {
    return view.clip_from_relative[2][3] == 0.0F;
}

class DrawDrifts : public GridMethod {
public:
    using GridMethod::GridMethod;
    void draw(const View&) override { draw_grid({0, 0, float(draws_++)}); }

private:
    int draws_ = 0;
};

class SelectCounts : public GridMethod {
public:
    using GridMethod::GridMethod;
    void select(const Camera&, const Clock&) override { ++selects_; }
    void draw(const View&) override { draw_grid({}, selects_ % 2); }

private:
    int selects_ = 0;
};

class CullsByView : public GridMethod {
public:
    using GridMethod::GridMethod;
    void draw(const View& view) override { draw_grid({}, is_capture(view) ? 0 : 100); }
};

class DrawsElsewhere : public GridMethod {
public:
    using GridMethod::GridMethod;
    void draw(const View& view) override { draw_grid({0, 0, is_capture(view) ? 0.0F : 20.0F}); }
};

class NeedsSettle : public GridMethod {
public:
    using GridMethod::GridMethod;
    void select(const Camera& camera, const Clock& clock) override {
        GridMethod::select(camera, clock);
        settled_ = false;
    }
    void settle() override { settled_ = true; }
    void draw(const View&) override { draw_grid({0, 0, settled_ ? 0.0F : 20.0F}); }

private:
    bool settled_ = false;
};

class DependsOnThePast : public GridMethod {
public:
    explicit DependsOnThePast(const Params& params) : GridMethod(params) {
        static int instances = 0;  // outlives the method: a plugin's code stays mapped
        instance_ = instances++;
    }
    void draw(const View&) override { draw_grid({0, 0, float(instance_)}); }

private:
    int instance_ = 0;
};

class LeavesState : public GridMethod {
public:
    using GridMethod::GridMethod;
    void draw(const View& view) override {
        GridMethod::draw(view);
        glDisable(GL_DEPTH_TEST);
    }
};

class RoundsUpwards : public GridMethod {
public:
    using GridMethod::GridMethod;
    void select(const Camera& camera, const Clock& clock) override {
        GridMethod::select(camera, clock);
        std::fesetround(FE_UPWARD);
    }
};

class RaisesErrors : public GridMethod {
public:
    using GridMethod::GridMethod;
    void draw(const View& view) override {
        GridMethod::draw(view);
        glEnable(GL_TEXTURE_2D);  // not an enum of the core profile
    }
};

class LeaksBareBuffer : public GridMethod {
public:
    using GridMethod::GridMethod;
    void upload(gl::Device& device) override {
        GridMethod::upload(device);
        glCreateBuffers(1, &leaked_);
    }

private:
    GLuint leaked_ = 0;
};

class KeepsObjects : public GridMethod {
public:
    using GridMethod::GridMethod;
    void draw(const View& view) override {
        GridMethod::draw(view);
        drawn_ = true;
    }
    void release(gl::Device& device) override {
        if (drawn_) GridMethod::release(device);
    }

private:
    bool drawn_ = false;
};

class ResizeSticks : public GridMethod {
public:
    using GridMethod::GridMethod;
    void resize(const Viewport&) override { ++resizes_; }
    void draw(const View&) override { draw_grid({0, 0, float(resizes_)}); }

private:
    int resizes_ = 0;
};

class NanStraightDown : public GridMethod {
public:
    using GridMethod::GridMethod;
    void draw(const View&) override {
        const bool down = camera_.forward().z < -0.9999;
        draw_grid({0, 0, down ? std::numeric_limits<float>::quiet_NaN() : 0.0F});
    }
};

class NeedsSquare : public GridMethod {
public:
    using GridMethod::GridMethod;
    void prepare(const Terrain& terrain, gl::Device& device) override {
        if (terrain.info().rows != terrain.info().columns)
            throw ContractError("the terrain is not square");
        GridMethod::prepare(terrain, device);
    }
};

class FloatWorld : public GridMethod {
public:
    using GridMethod::GridMethod;
    void draw(const View&) override {
        draw_grid({float(double(float(camera_.position.x)) - camera_.position.x), 0, 0});
    }
};

class RefusesItsMaximum : public GridMethod {
public:
    explicit RefusesItsMaximum(const Params& params) : GridMethod(params) {
        if (params.real("tau") >= 100) throw ContractError("tau is too large");
    }
};

class LeavesAHole : public GridMethod {
public:
    using GridMethod::GridMethod;
    void draw(const View&) override { draw_grid({}, index_count_ / 3 / 2); }
};

class UnboundTexture : public GridMethod {
public:
    explicit UnboundTexture(const Params& params) : GridMethod(params) {
        vertex_shader_ = "unbound.vert";
    }
};

/// Level of detail from 2 px up: in order at the default and at the knob's fine end.
class MorphsByView : public GridMethod {
public:
    explicit MorphsByView(const Params& params) : GridMethod(params) {
        if (params.real("tau") >= 2) step_ = 4;
    }
    void draw(const View& view) override {
        const double moved = glm::length(view.origin - camera_.position);
        draw_grid({0, 0, step_ > 1 ? float(0.05 * moved) : 0.0F});
    }
};

/// Every second sample at 1 px, every fourth at 2 px: about ten times what is claimed.
class ClaimsTooMuch : public GridMethod {
public:
    explicit ClaimsTooMuch(const Params& params) : GridMethod(params) {
        while (step_ <= params.real("tau")) step_ *= 2;
    }
};

class WorseWhenFiner : public GridMethod {
public:
    explicit WorseWhenFiner(const Params& params) : GridMethod(params) {
        if (params.real("tau") >= 2) step_ = 2;
        if (params.real("tau") < 1) lift_ = 100;
    }
    void draw(const View&) override { draw_grid({0, 0, lift_}); }

private:
    float lift_ = 0;
};

class Aborts : public GridMethod {
public:
    using GridMethod::GridMethod;
    void draw(const View&) override { std::abort(); }
};

class Loops : public GridMethod {
public:
    using GridMethod::GridMethod;
    void draw(const View&) override {
        for (volatile bool forever = true; forever;) {
        }
    }
};

constexpr ParamSpec kTau[] = {real_param("tau", 1, 0.1, 100, "screen error, pixels")};

template <typename T>
constexpr MethodDescriptor method(const char* id) {
    return {.id = id,
            .title = "Breaks one promise",
            .citation = "",
            .version = "1",
            .capabilities = 0,
            .gl_extensions = nullptr,
            .params = kTau,
            .param_count = std::size(kTau),
            .quality_knob = "tau",
            .claimed_bound = "tau",
            .create = create_method<T>,
            .destroy = destroy_method};
}

constexpr MethodDescriptor untitled() {
    MethodDescriptor descriptor = method<GridMethod>("untitled");
    descriptor.title = "";
    return descriptor;
}

constexpr MethodDescriptor kMethods[] = {
    method<GridMethod>("faultless"),
    untitled(),
    method<DrawDrifts>("draw-drifts"),
    method<SelectCounts>("select-counts"),
    method<CullsByView>("culls-by-view"),
    method<DrawsElsewhere>("draws-elsewhere"),
    method<NeedsSettle>("needs-settle"),
    method<DependsOnThePast>("depends-on-the-past"),
    method<LeavesState>("leaves-state"),
    method<RoundsUpwards>("rounds-upwards"),
    method<RaisesErrors>("raises-errors"),
    method<LeaksBareBuffer>("leaks-bare-buffer"),
    method<KeepsObjects>("keeps-objects"),
    method<ResizeSticks>("resize-sticks"),
    method<NanStraightDown>("nan-straight-down"),
    method<NeedsSquare>("needs-square"),
    method<FloatWorld>("float-world"),
    method<RefusesItsMaximum>("refuses-its-maximum"),
    method<LeavesAHole>("leaves-a-hole"),
    method<UnboundTexture>("unbound-texture"),
    method<MorphsByView>("morphs-by-view"),
    method<ClaimsTooMuch>("claims-too-much"),
    method<WorseWhenFiner>("worse-when-finer"),
    method<Aborts>("aborts"),
    method<Loops>("loops"),
};

}  // namespace

LODBENCH_PLUGIN(kMethods);
