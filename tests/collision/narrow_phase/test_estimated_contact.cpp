// The kinetic separating axis of meshes: never later than the contact, and the contact is the same from there.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace {

using namespace kds;
using namespace kds::collision;
using certificates::PointMotion;
using samples::Random;

PlacedShape random_shape(Random& random, std::uint32_t kind) {
  static const auto ring = samples::torus(8, 4);
  static const auto cube = samples::cuboid();
  const double size = random.uniform(0.3, 1);
  switch (kind) {
    case 0:
      return place(MeshShape{ring, size}, random.orientation());
    case 1:
      return place(MeshShape{cube, size}, random.orientation());
    case 2:
      return place(Box{{size, 0.5 * size, 0.7 * size}}, random.orientation());
    default:
      return placed_ball(size);
  }
}

template <int Degree>
PointMotion<Degree> random_path(Random& random, double clock) {
  PointMotion<Degree> path;
  path.start = clock - random.uniform(0, 1);
  path.coefficients[0] = random.vector(2.5);
  path.coefficients[1] = random.vector(2);
  if constexpr (Degree == 2) path.coefficients[2] = random.vector(1) * random.below(2);
  return path;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Until its estimate a pair with a mesh needs no test", "[estimated_contact]",
                       ((int Degree), Degree), 1, 2) {
  int estimates = 0, none = 0, met = 0;
  std::vector<std::uint64_t> wrong;  // seeds
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    Random random(seed);
    const double clock = random.below(4) == 0 ? 0x1p20 : 0.0;
    const PlacedShape mesh = random_shape(random, random.below(2));
    const PlacedShape other = random_shape(random, random.below(4));
    const auto path_a = random_path<Degree>(random, clock);
    auto path_b = random_path<Degree>(random, clock);
    path_b.coefficients[1] += path_a.coefficients[0] - path_b.coefficients[0];
    const bool swapped = random.below(2) == 0;
    const MovingShape<Degree> a{swapped ? other : mesh, path_a};
    const MovingShape<Degree> b{swapped ? mesh : other, path_b};
    const double horizon = random.below(4) == 0 ? never : clock + random.uniform(0, 3);
    for (const ContactMode mode : {ContactMode::transparent, ContactMode::resolved}) {
      PairMemory memory;
      const ContactEstimate estimate = estimated_first_contact(a, b, clock, horizon, mode, memory);
      const double first = first_contact(a, b, clock, horizon, mode);
      if (estimate.exact) {
        if (estimate.time != first) wrong.push_back(seed);
        none += first == never;
      } else {
        const bool right = estimate.time > clock && estimate.time <= first && estimate.time <= horizon &&
                           first_contact(a, b, estimate.time, horizon, mode) == first;
        if (!right) wrong.push_back(seed);
        ++estimates;
        met += first != never;
      }
    }
  }
  CAPTURE(Degree, none);
  CHECK(wrong == std::vector<std::uint64_t>{});
  CHECK(estimates > 200);
  CHECK(met > 100);
  CHECK(none > 200);
}
