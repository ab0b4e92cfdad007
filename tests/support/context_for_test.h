#pragma once
// Each test makes its own context, so that no state passes from one to the next.

#include "gl/device.h"
#include "platform/context.h"

namespace lodbench::test {

struct GlTest {
    platform::Context context;
    gl::Device device;
};

}  // namespace lodbench::test
