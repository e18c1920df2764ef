// Solids that do not turn and stand as they are given, which are tested as in worlds of bodies that keep their
// orientation: they meet at the same doubles as if they were tested as bodies that may turn.
#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "kds/arithmetic/lattice.hpp"

#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace test_standing_bodies {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::Random;

template <int Degree>
using Solid = kds::tests::TurningSolid<Degree>;
template <int Degree>
using Pair = std::pair<Solid<Degree>, Solid<Degree>>;

/// Numbers at random, or from a lattice on which solids touch, slide on each other and meet face on face.
struct Numbers {
  Random& random;
  bool on_lattice;

  double between(double low, double high) const {
    if (!on_lattice) return random.between(low, high);
    const auto steps = static_cast<std::uint64_t>(4 * (high - low));
    return low + 0.25 * static_cast<double>(random.below(steps + 1));
  }
  Vector3d vector(double size) const {
    const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
    return {x, y, z};
  }
};

/// A shape, and the same turned back by a quarter turn about z.
std::pair<Shape, Shape> random_shapes(const Numbers& numbers) {
  const auto size = [&] { return numbers.between(0.25, 1.25); };
  switch (numbers.random.below(5)) {
    case 0: {
      const Sphere ball{size()};
      return {ball, ball};
    }
    case 1: {
      const Vector3d half(size(), size(), size());
      return {Box{half}, Box{Vector3d(half[1], half[0], half[2])}};
    }
    case 2: {
      const Capsule capsule{size(), size()};
      return {capsule, capsule};
    }
    case 3: {
      std::vector<CompoundPart> parts, back;
      for (int i = 0; i < 3; ++i) {
        const Vector3d half(size() / 2, size() / 2, size() / 2), place = numbers.vector(0.75);
        parts.push_back({Box{half}, place});
        back.push_back({Box{Vector3d(half[1], half[0], half[2])}, Vector3d(place[1], -place[0], place[2])});
      }
      return {compound(parts), compound(back)};
    }
    default: {
      const double x = size(), y = size(), z = size();
      std::vector<Vector3d> points{{x, 0, 0}, {-x, 0, 0}, {0, y, 0}, {0, -y, 0}, {0, 0, z}, {0, 0, -z}}, back;
      for (const Vector3d& p : points) back.emplace_back(p[1], -p[0], p[2]);
      return {convex_hull(points), convex_hull(back)};
    }
  }
}

/// Two solids that stand, and the same two as shapes that are turned to the same places.
template <int Degree>
std::pair<Pair<Degree>, Pair<Degree>> random_pairs(Random& random) {
  const Numbers numbers{random, random.one_in(2)};
  const auto solid = [&] {
    const auto [shape, back] = random_shapes(numbers);
    auto motion =
        kds::tests::motion_of<Degree>(numbers.vector(2), numbers.vector(1), Vector3d::Zero(), -numbers.between(0, 2));
    if constexpr (Degree == 2) motion.path.coefficients[2] = numbers.vector(0.5);
    if (random.one_in(3)) motion.path.coefficients[1][2] = 0;
    auto turned = motion;
    turned.orientation = Quaterniond(1, 0, 0, 1);
    motion.orientation = Quaterniond(random.one_in(2) ? 1.0 : -3.0, 0, 0, 0);
    return std::pair(Solid<Degree>{shape, motion}, Solid<Degree>{back, turned});
  };
  auto a = solid(), b = solid();
  // Most fly towards each other, and some are at rest to each other.
  const Vector3d way = b.first.motion.path.coefficients[0] - a.first.motion.path.coefficients[0];
  const double part = random.one_in(8) ? 0 : 0.5;
  for (Solid<Degree>* of_b : {&b.first, &b.second}) {
    of_b->motion.path.coefficients[1] = a.first.motion.path.coefficients[1] - part * way;
  }
  return {{a.first, b.first}, {a.second, b.second}};
}

/// The first contact as worlds find it: by estimates that are certified when they are due.
template <int Degree>
double found_step_by_step(const Pair<Degree>& pair, double t, double horizon, ContactMode mode) {
  const auto a = pair.first.body(), b = pair.second.body();
  PairMemory memory;
  ContactEstimate next = estimated_first_contact(a, b, t, horizon, mode, memory);
  while (!next.exact && next.time <= horizon) next = certified_first_contact(a, b, next.time, horizon, mode);
  return next.time <= horizon ? next.time : never;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("solids that stand as they are given meet as those that are turned do, bit for bit", "[turning]",
                       ((int Degree), Degree), 1, 2) {
  constexpr double horizon = 6;
  int contacts = 0, begun = 0, parted = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const auto [standing, turned] = random_pairs<Degree>(random);
    const auto a = standing.first.body(), b = standing.second.body();
    const auto turned_a = turned.first.body(), turned_b = turned.second.body();
    for (const double t : {0.0, 0.75}) {
      REQUIRE(in_contact(a, b, t) == in_contact(turned_a, turned_b, t));
      for (const ContactMode mode : {ContactMode::transparent, ContactMode::resolved}) {
        // How bodies that overlap from the start are pushed apart is not unique.
        if (mode == ContactMode::resolved && in_contact(a, b, t)) continue;
        const double contact = first_contact(turned_a, turned_b, t, horizon, mode);
        REQUIRE(first_contact(a, b, t, horizon, mode) == contact);
        REQUIRE(found_step_by_step<Degree>(standing, t, horizon, mode) == contact);
        if (contact == never) continue;
        contacts += contact > t, begun += contact == t;
        REQUIRE(in_contact(a, b, contact));
        const double parts = first_separation(turned_a, turned_b, contact, horizon);
        parted += parts != never;
        REQUIRE(first_separation(a, b, contact, horizon) == parts);
      }
    }
  }
  CHECK(contacts > 300);
  CHECK(begun > 100);
  CHECK(parted > 300);
}

}  // namespace test_standing_bodies
