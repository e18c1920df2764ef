// Spheres and boxes on curves against exact rational arithmetic: no contact missed, none invented, every time the right
// double.
#include "tests/collision/clocked_stretches.hpp"
#include "tests/collision_splines/random_curves.hpp"
#include "tests/support/exact_bodies.hpp"
#include "tests/support/exact_oracle.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>

namespace kds::collision::test_oracle {
namespace {

using namespace tests;

/// Of 12 bits behind the point, which spares the oracle numbers of thousands of digits; `coarse`: of one.
template <int Degree>
BodyDescription<Degree> short_body(Random& random, bool is_box, bool coarse) {
  const auto number = [&](double low, double high) {
    const double unit = coarse ? 0.5 : 0x1p-12;
    return std::round(random.between(low, high) / unit) * unit;
  };
  const auto vector = [&](double size) {
    const double x = number(-size, size), y = number(-size, size), z = number(-size, size);
    return Vector3d(x, y, z);
  };
  certificates::PointMotion<Degree> path;
  double most = 4;
  for (auto& c : path.coefficients) {
    c = random.one_in(3) ? Vector3d(Vector3d::Zero()) : vector(most);
    most *= 0.75;
  }
  path.start = coarse || random.one_in(2) ? 0 : number(-1, 0);
  const auto size = [&] { return std::max(0.5, number(0.5, 2)); };
  if (!is_box) return body<Degree>(Sphere{size()}, path);
  const double x = size(), y = size(), z = size();
  auto description = body<Degree>(Box{{x, y, z}}, path);
  if (random.one_in(2)) description.orientation = Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5);
  return description;
}

template <int Degree>
int compare_pairs(int kinds, bool coarse, std::uint64_t seeds) {
  int contacts = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    INFO("degree " << Degree << ", kinds " << kinds << (coarse ? ", coarse" : ", fine") << " numbers, seed " << seed);
    Random random(seed * 3 + static_cast<std::uint64_t>(kinds));
    const auto a = short_body<Degree>(random, kinds > 0, coarse);
    const auto b = short_body<Degree>(random, kinds > 1, coarse);
    const double limit = 3;
    const PlacedShape shape_a = place(a.shape, a.orientation);
    const PlacedShape shape_b = place(b.shape, b.orientation);
    const TranslatingShape<Degree> moving_a{shape_a, a.motion[0]};
    const TranslatingShape<Degree> moving_b{shape_b, b.motion[0]};
    const auto expected = on_the_clock(oracle::contacts(oracle::exact_body(a), oracle::exact_body(b), 0, limit), limit);
    REQUIRE(ask(moving_a, moving_b, 0, limit) == expected);
    // The estimate is a lower bound of it, or says that it is exact.
    PairMemory memory;
    const double first = expected.empty() ? never : expected[0].begin;
    const auto estimate = estimated_first_contact(moving_b, moving_a, 0, limit, ContactMode::transparent, memory);
    REQUIRE(estimate.time <= first);
    if (estimate.exact) REQUIRE(estimate.time == first);
    contacts += static_cast<int>(expected.size());
  }
  return contacts;
}

TEMPLATE_TEST_CASE_SIG("Curves: pairs of spheres and boxes against exact arithmetic", "[splines][oracle]",
                       ((int Degree), Degree), 3, 4, 5) {
  for (int kinds = 0; kinds < 3; ++kinds) {  // spheres, a box and a sphere, boxes
    CHECK(compare_pairs<Degree>(kinds, false, 30) > 2);
    CHECK(compare_pairs<Degree>(kinds, true, 60) > 15);
  }
}

/// A world of spheres and boxes: all pairs, all times, jumps included.
TEMPLATE_TEST_CASE_SIG("Curves: contacts and separations of small scenes are those of exact arithmetic",
                       "[splines][oracle]", ((int Degree), Degree), 3, 5) {
  std::size_t events = 0;
  for (const Numbers numbers : {Numbers::fine, Numbers::coarse}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      INFO("degree " << Degree << (numbers == Numbers::fine ? ", fine" : ", coarse") << " numbers, seed " << seed);
      Random random(seed);
      SceneOptions four{.shapes = Shapes::boxes, .numbers = numbers, .bodies = 4, .side = 4, .scripts = true};
      auto scene = curved_scene<Degree>(random, four);
      four.shapes = Shapes::spheres;
      const auto more = curved_scene<Degree>(random, four);
      scene.bodies.insert(scene.bodies.end(), more.bodies.begin(), more.bodies.end());
      std::vector<Event> expected;
      for (BodyId a = 0; a < scene.bodies.size(); ++a) {
        for (BodyId b = a + 1; b < scene.bodies.size(); ++b) {
          const auto stretches = oracle::contacts(oracle::exact_body(scene.bodies[a]),
                                                  oracle::exact_body(scene.bodies[b]), 0, scene.end_time);
          for (const Stretch& s : on_the_clock(stretches, scene.end_time)) {
            expected.push_back({s.at_start ? Kind::overlap : Kind::contact, a, b, {.time = s.begin}});
            if (s.end != never) expected.push_back({Kind::separation, a, b, {.time = s.end}});
          }
        }
      }
      expected = sorted(expected);
      auto found = sorted(run(scene, {}));
      for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
        found[i].contact = {.time = found[i].time()};
        REQUIRE(found[i] == expected[i]);
      }
      REQUIRE(found.size() == expected.size());
      events += expected.size();
    }
  }
  CHECK(events > 50);
}

}  // namespace
}  // namespace kds::collision::test_oracle
