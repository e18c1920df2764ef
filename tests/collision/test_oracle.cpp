// Spheres and boxes against exact rational arithmetic: no contact missed, none invented, every time the right double.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "tests/collision/clocked_stretches.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/exact_bodies.hpp"
#include "tests/support/exact_failure_time.hpp"
#include "tests/support/exact_models.hpp"
#include "tests/support/exact_oracle.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace kds::collision::test_oracle {
namespace {

using namespace tests;

/// Orientations that doubles hold exactly: the axes go to axes.
const std::vector<Eigen::Quaterniond>& exact_orientations() {
  static const std::vector<Eigen::Quaterniond> all{{1, 0, 0, 0},          {0, 1, 0, 0},          {0.5, 0.5, 0.5, 0.5},
                                                   {0.5, -0.5, 0.5, 0.5}, {0.5, 0.5, 0.5, -0.5}, {0, 0, 0, 1}};
  return all;
}

struct Found {
  int contacts = 0;
  int separations = 0;
  int at_start = 0;
};

template <int Degree>
void compare_pair(const BodyDescription<Degree>& a, const BodyDescription<Degree>& b, double limit, Found& found) {
  const PlacedShape shape_a = place(a.shape, a.orientation);
  const PlacedShape shape_b = place(b.shape, b.orientation);
  const TranslatingShape<Degree> moving_a{shape_a, a.motion[0]};
  const TranslatingShape<Degree> moving_b{shape_b, b.motion[0]};
  const auto expected = on_the_clock(oracle::contacts(oracle::exact_body(a), oracle::exact_body(b), 0, limit), limit);
  REQUIRE(ask(moving_a, moving_b, 0, limit) == expected);
  // The order of the two bodies does not matter.
  REQUIRE(first_contact(moving_b, moving_a, 0, limit, ContactMode::transparent) ==
          (expected.empty() ? never : expected[0].begin));
  for (const Stretch& s : expected) {
    ++found.contacts;
    found.separations += s.end != never;
    found.at_start += s.at_start;
  }
}

/// Bodies about the origin on a lattice of halves: ties, touches and double roots abound.
template <int Degree>
BodyDescription<Degree> lattice_body(Random& random, bool is_box) {
  const auto vector = [&](int size) -> Vector3d {
    return Vector3d(random.integer(-size, size), random.integer(-size, size), random.integer(-size, size)) * 0.5;
  };
  const auto path = motion<Degree>(vector(6), vector(6), random.one_in(2) ? vector(2) : Vector3d(Vector3d::Zero()));
  const auto size = [&] { return 0.5 * random.integer(1, 4); };
  if (!is_box) return body<Degree>(Sphere{size()}, path);
  auto description = body<Degree>(Box{{size(), size(), size()}}, path);
  description.orientation = exact_orientations()[random.below(exact_orientations().size())];
  return description;
}

template <int Degree>
BodyDescription<Degree> random_body(Random& random, bool is_box) {
  // 20 bits behind the point are random enough, and spare the oracle numbers of thousands of digits.
  const auto number = [&](double low, double high) { return std::round(random.between(low, high) * 0x1p20) * 0x1p-20; };
  const auto vector = [&](double size) -> Vector3d {
    return Vector3d(number(-size, size), number(-size, size), number(-size, size));
  };
  auto path = motion<Degree>(vector(3), vector(3), vector(1));
  path.start = random.one_in(2) ? 0 : number(-1, 1);
  const auto size = [&] { return number(0.2, 2); };
  if (!is_box) return body<Degree>(Sphere{size()}, path);
  auto description = body<Degree>(Box{{size(), size(), size()}}, path);
  description.orientation = exact_orientations()[random.below(exact_orientations().size())];
  return description;
}

TEMPLATE_TEST_CASE_SIG("Pairs of spheres and boxes on a lattice against exact arithmetic", "[oracle]",
                       ((int Degree), Degree), 1, 2) {
  for (int kinds = 0; kinds < 3; ++kinds) {  // spheres, a box and a sphere, boxes
    Found found;
    for (std::uint64_t seed = 1; seed <= 250; ++seed) {
      INFO("degree " << Degree << ", kinds " << kinds << ", seed " << seed);
      Random random(seed * 3 + static_cast<std::uint64_t>(kinds));
      const auto a = lattice_body<Degree>(random, kinds > 0);
      const auto b = lattice_body<Degree>(random, kinds > 1);
      compare_pair(a, b, 8, found);
    }
    CHECK(found.contacts > 60);
    CHECK(found.separations > 50);
    CHECK(found.at_start > 10);
  }
}

TEMPLATE_TEST_CASE_SIG("Random pairs of spheres and boxes against exact arithmetic", "[oracle]", ((int Degree), Degree),
                       1, 2) {
  for (int kinds = 0; kinds < 3; ++kinds) {
    Found found;
    for (std::uint64_t seed = 1; seed <= 120; ++seed) {
      INFO("degree " << Degree << ", kinds " << kinds << ", seed " << seed);
      Random random(seed * 3 + static_cast<std::uint64_t>(kinds));
      const auto a = random_body<Degree>(random, kinds > 0);
      const auto b = random_body<Degree>(random, kinds > 1);
      compare_pair(a, b, 5, found);
    }
    CHECK(found.contacts > 20);
    CHECK(found.separations > 20);
  }
}

TEST_CASE("Turned boxes: the shapes are rounded, so that times are near the exact ones", "[oracle]") {
  // Rounding the axes moves a vertex by some 4 roundings of its distance, at closing speeds that are not tiny here.
  constexpr double most = 1e-12;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    auto a = random_body<1>(random, true);
    auto b = random_body<1>(random, random.one_in(2));
    for (auto* each : {&a, &b}) {
      // The oracle normalises what it is given; four integers are exact.
      Eigen::Quaterniond q(random.integer(1, 5), random.integer(-5, 5), random.integer(-5, 5), random.integer(-5, 5));
      each->orientation = q;
    }
    const auto exact_contact = oracle::first_contact(oracle::exact_body(a), oracle::exact_body(b), 0, 5);
    const PlacedShape shape_a = place(a.shape, a.orientation.normalized());
    const PlacedShape shape_b = place(b.shape, b.orientation.normalized());
    const double t = first_contact(TranslatingShape<1>{shape_a, a.motion[0]}, TranslatingShape<1>{shape_b, b.motion[0]},
                                   0, 5, ContactMode::transparent);
    REQUIRE(exact_contact.has_value() == (t != never));
    if (t == never) continue;
    CHECK(std::abs(t - exact_contact->approximate()) <= most);
    found += t > 0;
  }
  CHECK(found > 10);
}

/// A world of spheres and boxes: all pairs, all times, jumps included.
TEMPLATE_TEST_CASE_SIG("Contacts and separations of small scenes are those of exact arithmetic", "[oracle]",
                       ((int Degree), Degree), 1, 2) {
  int contacts = 0;
  int separations = 0;
  for (const Numbers numbers : {Numbers::fine, Numbers::coarse}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      INFO("degree " << Degree << (numbers == Numbers::fine ? ", fine" : ", coarse") << " numbers, seed " << seed);
      Random random(seed);
      SceneOptions five{.shapes = Shapes::boxes, .numbers = numbers, .bodies = 5, .side = 4, .scripts = true};
      SceneMaker boxes(random, five);
      five.shapes = Shapes::spheres;
      SceneMaker spheres(random, five);
      auto scene = boxes.template scene<Degree>();
      const auto more = spheres.template scene<Degree>();
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
        CHECK(std::abs(found[i].contact.normal.norm() - 1) < 1e-15);
        found[i].contact = {.time = found[i].time()};
        REQUIRE(found[i] == expected[i]);
      }
      REQUIRE(found.size() == expected.size());
      for (const Event& e : expected) {
        contacts += e.kind == Kind::contact;
        separations += e.kind == Kind::separation;
      }
    }
  }
  CHECK(contacts > 100);
  CHECK(separations > 100);
}

/// The box that the world gives a body: the exact sums where doubles hold them.
template <int Degree>
oracle::MovingBox exact(const KineticBox<Degree>& box) {
  oracle::MovingBox result;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto& low = box.min.axis(static_cast<int>(d));
    const auto& high = box.max.axis(static_cast<int>(d));
    result.low[d] = {{low.position.c.begin(), low.position.c.end()}, low.start};
    result.high[d] = {{high.position.c.begin(), high.position.c.end()}, high.start};
  }
  return result;
}

TEMPLATE_TEST_CASE_SIG("Bounding volumes begin and cease to overlap at exact times", "[oracle]", ((int Degree), Degree),
                       1, 2) {
  int began = 0;
  for (const Numbers numbers : {Numbers::fine, Numbers::coarse}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      INFO("degree " << Degree << (numbers == Numbers::fine ? ", fine" : ", coarse") << " numbers, seed " << seed);
      Random random(seed);
      SceneMaker maker(random, {.shapes = Shapes::boxes, .numbers = numbers, .bodies = 10, .side = 5});
      const auto scene = maker.template scene<Degree>();
      std::vector<Event> expected;
      std::vector<oracle::MovingBox> boxes;
      for (const auto& description : scene.bodies) {
        const PlacedShape shape = place(description.shape, description.orientation);
        boxes.push_back(exact(box_around(description.motion[0], shape.low, shape.high)));
      }
      for (BodyId a = 0; a < boxes.size(); ++a) {
        for (BodyId b = a + 1; b < boxes.size(); ++b) {
          const auto stretches = oracle::overlaps(boxes[a], boxes[b], 0, scene.end_time);
          for (const Stretch& s : on_the_clock(stretches, scene.end_time)) {
            expected.push_back({Kind::pair_began, a, b, {.time = s.begin}});
            if (s.end != never) expected.push_back({Kind::pair_ended, a, b, {.time = s.end}});
          }
        }
      }
      began += static_cast<int>(expected.size());
      expected = sorted(expected);
      for (const auto kind : {BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap, BroadPhaseKind::all_pairs}) {
        INFO("broad phase " << static_cast<int>(kind));
        WorldOptions options;
        options.broad_phase = kind;
        options.report_pairs = true;
        REQUIRE(lasting_pairs(run(scene, options)) == expected);
      }
    }
  }
  CHECK(began > 100);
}

}  // namespace
}  // namespace kds::collision::test_oracle
