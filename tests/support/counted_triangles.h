#pragma once
// Triangles that are counted are those that are captured. For one file of a method's tests, which
// says its plugin with INSTANTIATE_TEST_SUITE_P.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "support/method_fixture.h"

namespace lodbench::test {

struct Flyer {
    const char* plugin;
    const char* method;
    std::vector<std::pair<std::string, std::string>> settings = {};
};
inline void PrintTo(const Flyer& flyer, std::ostream* stream) {
    *stream << flyer.method;
}

class CountedTriangles : public testing::TestWithParam<Flyer> {};

TEST_P(CountedTriangles, are_those_captured_from_every_side) {
    Flight flight(hills(100, 131), GetParam().plugin, GetParam().method, GetParam().settings);
    std::uint64_t most = 0;
    for (const Camera& camera :
         {camera_at({512600, -2900, 900}, 40, -35), camera_at({512600, -2900, 250}, 200, 0, 20),
          camera_at({512600, -2900, 2500}, 0, -90), camera_at({505000, -3000, 900}, 270, 10)}) {
        flight.select(camera);
        const std::uint64_t count = flight.stage().count_primitives();
        EXPECT_EQ(count, flight.stage().capture().triangle_count());
        EXPECT_EQ(count, flight.stage().count_primitives()) << "a capture changes nothing";
        most = std::max(most, count);
    }
    EXPECT_GT(most, 1000U);
}

inline std::string plugin_of(const testing::TestParamInfo<Flyer>& flyer) {
    return flyer.param.plugin;
}

}  // namespace lodbench::test
