#include <GL/glcorearb.h>

#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void draw(const lodbench::View&) override { glEnable(GL_TRIANGLES); }
};

}  // namespace

QUIET_PLUGIN(Broken, "raises-gl-error");
