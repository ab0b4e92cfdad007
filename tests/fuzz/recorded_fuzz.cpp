// A libFuzzer target (clang, -DLODBENCH_FUZZ=ON): recorded_fuzz [--seeds FOLDER | libFuzzer's own
// arguments]. Any bytes as a recorded flight: refused as InputError in one plain line that begins
// with the file, or at least one place of finite numbers within 1e9, each a camera.

#include <cmath>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>

#include "api/error.h"
#include "fuzz/refusal.h"
#include "fuzz/seeds.h"
#include "scenario/flight_path.h"
#include "scenario/recorded_path.h"

namespace lodbench::test {
namespace {

void use_as_recorded(std::string_view text) {
    try {
        const auto places = scenario::parse_recorded(text, "f.csv");
        if (places.empty()) finding("accepted, but no frame");
        for (const scenario::RecordedPlace& place : places) {
            for (int i = 0; i < 3; ++i) {
                if (!(std::abs(place.position[i]) <= 1e9 && std::abs(place.angles[i]) <= 1e9)) {
                    finding("accepted, but not a finite place");
                }
            }
            const glm::dquat orientation =
                scenario::orientation_of(place.angles.x, place.angles.y, place.angles.z);
            if (!(std::abs(glm::length(orientation) - 1) < 1e-9)) {
                finding("accepted, but not an orientation");
            }
        }
    } catch (const InputError& error) {
        check_refusal(error.what(), "f.csv");
    }
}

std::vector<std::string> seeds() {
    const std::string header = "frame,x,y,z,heading,pitch,roll\n";
    return {
        header + "0,1,2,3,90,-30,0\n1,1.5,-2e3,3.25,90.5,-31,0.25\n",
        "\xEF\xBB\xBF" + header + "0,1,2,3,90,-30,0\r\n",
        "frame;x;y;z;heading;pitch;roll\r\n0;1,5;-2e3;3,25;90;-30;0\r\n1;2;0;4;91;-31;0\r\n\r\n",
        "frame\tx\ty\tz\theading\tpitch\troll\r0\t1\t2\t3\t4\t5\t6\r",
        "\"frame\",\"x\",\"y\",\"z\",\"heading\",\"pitch\",\"roll\"\n0, +1 ,\"2\",nan,inf,5,6\n",
        "0,1,2,3,90,-30,0\n",
        std::string("\xFF\xFE"
                    "f\0r\0",
                    6)};
}

}  // namespace
}  // namespace lodbench::test

LODBENCH_FUZZ_TARGET(lodbench::test::use_as_recorded, lodbench::test::seeds)
