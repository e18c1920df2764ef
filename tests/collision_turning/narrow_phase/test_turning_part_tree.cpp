// Trees of parts of bodies that turn: the pairs of parts that may meet are those that a look at each part finds, bit
// for bit, though they are listed piece by piece.
#include "collision/narrow_phase/turning/turning_part_pairs.hpp"
#include "tests/collision/sample_compounds.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kds::collision::test_turning_part_tree {
namespace {

using namespace tests;

template <int Degree>
certificates::RigidMotion<Degree> random_turning(Random& random, double side) {
  certificates::RigidMotion<Degree> motion{};
  for (std::size_t i = 0; i <= Degree; ++i) {
    if (i > 0 && random.one_in(4)) continue;
    const double size = i == 0 ? side : i == 1 ? 4 : 1;
    for (int d = 0; d < 3; ++d) motion.path.coefficients[i][d] = random.between(-size, size);
  }
  for (int d = 0; d < 3; ++d) motion.angular_velocity[d] = random.one_in(3) ? 0 : random.between(-1, 1);
  const double w = random.between(-1, 1), x = random.between(-1, 1), y = random.between(-1, 1);
  motion.orientation = unit_quaternion(w, x, y, random.between(0.1, 1));
  return motion;
}

/// Returns how many pairs there were.
template <int Degree>
std::size_t compare_lists(std::uint64_t seed) {
  Random random(seed);
  const Parts kinds = random.one_in(2) ? Parts::boxes : Parts::all;
  const double side = random.between(1, 12);
  const auto identity = Eigen::Quaterniond::Identity();
  const std::size_t count = 2 + random.below(120), others = 1 + random.below(40);
  const PlacedShape a = place(random_compound(random, kinds, count, side), identity);
  const PlacedShape b = random.one_in(2) ? place(random_compound(random, kinds, others, 0.5 * side), identity)
                                         : place(Box{{0.5, 0.25, 1}}, identity);
  const bool two = std::holds_alternative<Compound>(b.shape);
  const PlacedShape plain_a = without_tree(a), plain_b = two ? without_tree(b) : b;
  const auto motion_a = random_turning<Degree>(random, 1), motion_b = random_turning<Degree>(random, side + 10);
  const double horizon = random.between(0, 20);
  INFO("degree " << Degree << ", seed " << seed << ", " << count << " parts");
  TurningPartPairs<Degree> pairs({a, motion_a}, {b, motion_b}, 0, horizon);
  const TurningPartPairs<Degree> plain({plain_a, motion_a}, {plain_b, motion_b}, 0, horizon);
  const auto same = [&](const ListOfPartPairs::Pair& x, const ListOfPartPairs::Pair& y) {
    return x.a == y.a && (x.b == y.b || !two) && x.from == y.from && x.until == y.until;
  };
  std::vector<ListOfPartPairs::Pair> in_time = pairs.in_time();
  while (pairs.list_on(never)) {
    const auto later = pairs.in_time();
    in_time.insert(in_time.end(), later.begin(), later.end());
  }
  const auto sorted = plain.in_time();
  CHECK(std::equal(in_time.begin(), in_time.end(), sorted.begin(), sorted.end(), same));
  CHECK(std::equal(pairs.all().begin(), pairs.all().end(), plain.all().begin(), plain.all().end(), same));
  return sorted.size();
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("pairs of parts that turn are those that a look at each part lists", "[compound]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t listed = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) listed += compare_lists<Degree>(seed);
  CHECK(listed > 1000);
}

}  // namespace kds::collision::test_turning_part_tree
