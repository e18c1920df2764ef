// The kinetic separating axis of meshes: never later than the contact, and the contact is the same from there.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/collision/narrow_phase/random_pairs.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace test_estimated_contact {
namespace {

using namespace kds;
using namespace kds::collision;
using samples::Random;

}  // namespace

TEMPLATE_TEST_CASE_SIG("Until its estimate a pair with a mesh needs no test", "[estimated_contact]",
                       ((int Degree), Degree), 1, 2) {
  int estimates = 0, none = 0, met = 0;
  std::vector<std::uint64_t> wrong;  // seeds
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    Random random(seed);
    const double clock = random.below(4) == 0 ? 0x1p20 : 0.0;
    const PlacedShape mesh = samples::shape_of_kind(random, random.below(2));
    const PlacedShape other = samples::shape_of_kind(random, random.below(5));
    const auto path_a = samples::random_path<Degree>(random, clock, 2);
    auto path_b = samples::random_path<Degree>(random, clock, 2);
    path_b.coefficients[1] += path_a.coefficients[0] - path_b.coefficients[0];
    const bool swapped = random.below(2) == 0;
    const TranslatingShape<Degree> a{swapped ? other : mesh, path_a};
    const TranslatingShape<Degree> b{swapped ? mesh : other, path_b};
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

}  // namespace test_estimated_contact
