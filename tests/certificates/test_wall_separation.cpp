#include "certificates/wall_separation.hpp"
#include "tests/certificates/check_certificate.hpp"

#include <catch2/catch.hpp>

namespace test_wall_separation {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::WallSeparation;

}  // namespace

TEMPLATE_TEST_CASE_SIG("a ball is inside its wall while its centre is farther than its radius", "[wall_separation]",
                       ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 130;
  CAPTURE(Degree, seed);
  Random random(seed);
  for (int round = 0; round < 300; ++round) {
    const bool coarse = random.one_in(2);
    const auto path = random_path<Degree>(random, coarse, random_start(random, coarse));
    const double side = random.one_in(2) ? 1 : -1;
    const double plane = coarse ? random.integer(-3, 3) : random.between(-3, 3);
    const double radius = coarse ? random.integer(0, 4) / 4.0 : random.unit();
    const WallSeparation<Degree> wall{path.axis(0), plane, radius, side};
    const auto f = (exact(plane) - exact(path.axis(0))) * exact(side) - exact(radius);
    CAPTURE(round, coarse);
    CHECK(mistakes(wall, f, random) == 0);
  }
}

TEST_CASE("a ball meets the upper and the lower wall", "[wall_separation]") {
  const Motion<1> rising{{{0, 1}}, 0};
  CHECK(failure_time(WallSeparation<1>{rising, 10, 1, 1}, 0) == 9);
  CHECK(failure_time(WallSeparation<1>{rising, -10, 1, -1}, 0) == never);
  const Motion<1> falling{{{0, -1}}, 0};
  CHECK(failure_time(WallSeparation<1>{falling, -10, 1, -1}, 0) == 9);
  CHECK(failure_time(WallSeparation<1>{falling, 10, 1, 1}, 0) == never);
  // Touching the wall at rest, or on the way back, is no failure.
  CHECK(failure_time(WallSeparation<1>{Motion<1>{{{9, 0}}, 0}, 10, 1, 1}, 0) == never);
  CHECK(failure_time(WallSeparation<1>{Motion<1>{{{9, -1}}, 0}, 10, 1, 1}, 0) == never);
  // A ball thrown up to just below the ceiling: a touch at the top.
  CHECK(failure_time(WallSeparation<2>{Motion<2>{{{0, 4, -2}}, 0}, 3, 1, 1}, 0) == never);
  CHECK(failure_time(WallSeparation<2>{Motion<2>{{{0, 4, -2}}, 0}, next_down(3), 1, 1}, 0) < 1);
}

}  // namespace test_wall_separation
