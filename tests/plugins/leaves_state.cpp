#include <GL/glcorearb.h>

#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void draw(const lodbench::View&) override { glDisable(GL_DEPTH_TEST); }
};

}  // namespace

QUIET_PLUGIN(Broken, "leaves-state");
