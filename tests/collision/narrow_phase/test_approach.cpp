// Whether bodies that overlap by a rounding approach does not depend on when it is asked.
#include "collision/narrow_phase/narrow_phase.hpp"

#include "collision/shapes/shape.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <vector>

namespace test_approach {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using kds::tests::Random;
using Path = certificates::PointMotion<2>;

}  // namespace

TEST_CASE("bodies that fall together and overlap by a rounding approach at all times or never", "[narrow_phase]") {
  const PlacedShape box = place(Box{Vector3d(0.5, 0.5, 0.5)}, Eigen::Quaterniond::Identity());
  Random random(3);
  int overlapping = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Vector3d velocity(random.between(-1, 1), random.between(-1, 1), 0), gravity(random.between(-3, 3), 0, -9.81);
    const Vector3d deeper(1 - 0x1p-50, random.between(-0.5, 0.5), 0);
    // They move alike, but for the roundings with which a motion begins anew.
    const Path path_a = Path::parabola(Vector3d::Zero(), velocity, gravity).restarted(random.between(0, 0.5));
    const Path path_b = Path::parabola(deeper, velocity, gravity).restarted(random.between(0, 0.5));
    const MovingShape<Path> a{box, path_a}, b{box, path_b};
    std::vector<bool> approaches;
    for (double t = 0.5; t < 2; t += 0.0625) {
      if (!in_contact(a, b, t)) continue;
      approaches.push_back(first_contact(a, b, t, 2, ContactMode::resolved) == t);
    }
    CAPTURE(trial);
    overlapping += approaches.size() > 5;
    for (const bool approach : approaches) REQUIRE(approach == approaches.front());
  }
  CHECK(overlapping > 100);
}

}  // namespace test_approach
