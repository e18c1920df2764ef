// Meshes that turn: when they meet, against boxes, and against the definition in long doubles.
#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"

#include "kds/arithmetic/lattice.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/narrow_phase/turning_mesh_oracle.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

namespace test_turning_mesh {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_vector;
using Oracle = kds::tests::TurningMeshOracle;

template <int Degree>
using Solid = kds::tests::TurningSolid<Degree>;

template <int Degree>
certificates::RigidMotion<Degree> random_motion(Random& random, const Vector3d& place, double rate) {
  const Vector3d velocity = random_vector(random, 2);
  auto m = motion_of<Degree>(place - velocity, velocity, random_vector(random, rate), -random.between(0, 2));
  m.path.start = random.one_in(2) ? 0 : m.path.start;
  if constexpr (Degree == 2) m.path.coefficients[2] = random_vector(random, 1);
  m.path.coefficients[0] = Vector3d::Zero();
  m.path.coefficients[0] = place - m.path.position(1);  // there at the time 1
  m.orientation =
      Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  return m;
}

template <int Degree>
double meet(const Solid<Degree>& a, const Solid<Degree>& b, double t0, double horizon,
            ContactMode mode = ContactMode::transparent) {
  return first_contact(a.body(), b.body(), t0, horizon, mode);
}

/// The depth of two surfaces before the time at which they are said to meet, at its greatest.
double deepest(const std::function<double(double)>& depth, double t0, double until, int samples) {
  std::vector<double> at;
  for (int i = 0; i <= samples; ++i) at.push_back(depth(t0 + (until - t0) * i / samples));
  double deepest = -never;
  for (int i = 1; i < samples; ++i) {
    const auto k = static_cast<std::size_t>(i);
    deepest = std::max(deepest, at[k]);
    if (at[k] < at[k - 1] || at[k] < at[k + 1]) continue;
    double low = t0 + (until - t0) * (i - 1) / samples, high = t0 + (until - t0) * (i + 1) / samples;
    for (int round = 0; round < 25; ++round) {
      const double left = low + (high - low) * 0.382, right = low + (high - low) * 0.618;
      (depth(left) > depth(right) ? high : low) = depth(left) > depth(right) ? right : left;
    }
    deepest = std::max(deepest, depth(low));
  }
  return deepest;
}

/// Seconds for each of the calls of a function.
template <class Function>
double time_of(const Function& function, int calls) {
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < calls; ++i) function();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / calls;
}

}  // namespace

TEST_CASE("a triangle that turns meets another at the time of its sine", "[turning]") {
  const auto triangle = [](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    return MeshShape{
        std::make_shared<const Mesh>(std::vector<Vector3d>{a, b, c}, std::vector<Mesh::Triangle>{{0, 1, 2}})};
  };
  // The tip is at height 0.5 - sin t.
  const Solid<1> blade{triangle({1, 0, 0}, {-1, 0.5, 0}, {-1, -0.5, 0}),
                       motion_of<1>({0, 0, 0.5}, {0, 0, 0}, {0, 1, 0})};
  const Solid<1> floor{triangle({4, 0, 0}, {-4, 5, 0}, {-4, -5, 0}), motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 0})};
  const double t = meet(blade, floor, 0, 10);
  CHECK(std::abs(t - std::numbers::pi / 6) < 1e-15);
  CHECK(meet(floor, blade, 0, 10) == t);
  const Contact contact = contact_at(floor.body(), blade.body(), t);
  CHECK((contact.normal - Vector3d::UnitZ()).norm() < 1e-15);
  CHECK(std::abs(contact.point[0] - std::cos(t)) < 1e-14);
  CHECK(contact.feature_a == Feature::face(0));
  CHECK(contact.feature_b == Feature::vertex(0));
  // In the end its other end comes down, and up again; through it stays in between.
  const double out = first_separation(blade.body(), floor.body(), t, 10);
  CHECK(std::abs(out - (std::numbers::pi - std::numbers::pi / 6)) < 1e-14);
  CHECK_FALSE(in_contact(blade.body(), floor.body(), out));
  CHECK(in_contact(blade.body(), floor.body(), next_down(out)));
}

TEST_CASE("surfaces that slide on each other, touch or lie inside are not in contact", "[turning]") {
  const Solid<1> below{MeshShape{samples::cuboid({1, 2, 3})}, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 0.7})};
  const Solid<1> above{MeshShape{samples::cuboid({2, 1, 1})}, motion_of<1>({0.125, 0, 4}, {0.25, 0, 0}, {0, 0, -11})};
  CHECK(meet(below, above, 0, 2) == never);
  const Solid<1> box_above{Box{{2, 1, 1}}, above.motion};
  CHECK(meet(below, box_above, 0, 2) == never);
  auto lower = above;
  lower.motion.path.coefficients[0][2] = next_down(4);
  CHECK(meet(below, lower, 0, 5) == 0);
  CHECK(meet(below, lower, 0, 0.1, ContactMode::resolved) == never);
  const Solid<1> small{MeshShape{samples::ball_mesh(1), 0.25}, motion_of<1>({0, 0, 0}, {0, 0, 0}, {3, 2, 1})};
  CHECK(meet(below, small, 0, 5) == never);
  CHECK(meet(below, Solid<1>{Box{{0.25, 0.5, 0.25}}, small.motion}, 0, 5) == never);
  CHECK(meet(below, Solid<1>{Sphere{0.99}, small.motion}, 0, 5) == never);
  CHECK(meet(below, Solid<1>{Sphere{1.01}, small.motion}, 0, 5) == 0);
}

TEMPLATE_TEST_CASE_SIG("meshes of boxes meet what boxes meet, when boxes do, bit for bit", "[turning]",
                       ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 520 + Degree;
  CAPTURE(Degree, seed);
  Random random(seed);
  int contacts = 0;
  for (int round = 0; round < 300; ++round) {
    const Vector3d half_a(random.between(0.1, 1), random.between(0.1, 1), random.between(0.1, 1));
    const Vector3d half_b(random.between(0.5, 2), random.between(0.02, 0.3), random.between(0.1, 1));
    const double rate = std::pow(10.0, random.between(-2, 1.5));
    const Solid<Degree> box_a{Box{half_a}, random_motion<Degree>(random, Vector3d::Zero(), rate)};
    const Solid<Degree> box_b{Box{half_b}, random_motion<Degree>(random, random_vector(random, 2), rate)};
    const Solid<Degree> ball{Sphere{half_a[0]}, box_a.motion};
    const Solid<Degree> mesh_a{MeshShape{samples::cuboid(half_a)}, box_a.motion};
    const Solid<Degree> mesh_b{MeshShape{samples::cuboid(half_b)}, box_b.motion};
    CAPTURE(round, rate);
    if (!in_contact(box_a.body(), box_b.body(), 0)) {
      const double t = meet(box_a, box_b, 0, 3);
      contacts += t < never;
      CHECK(meet(mesh_a, mesh_b, 0, 3) == t);
      CHECK(meet(mesh_a, box_b, 0, 3) == t);
      CHECK(meet(box_a, mesh_b, 0, 3) == t);
      CHECK(meet(mesh_a, mesh_b, std::min(t, 3.0) * random.unit(), 3) == t);
      if (t < never) {
        CHECK(in_contact(mesh_a.body(), mesh_b.body(), t));
        CHECK_FALSE(in_contact(mesh_a.body(), mesh_b.body(), next_down(t)));
        const Contact of_boxes = contact_at(box_a.body(), box_b.body(), t);
        const Contact of_meshes = contact_at(mesh_a.body(), mesh_b.body(), t);
        CHECK((of_boxes.normal - of_meshes.normal).norm() < 1e-6);
        CHECK((of_boxes.point - of_meshes.point).norm() < 1e-6);
        const Contact of_both = contact_at(mesh_a.body(), box_b.body(), t);
        CHECK((of_boxes.normal - of_both.normal).norm() < 1e-6);
        CHECK((of_boxes.point - of_both.point).norm() < 1e-6);
      }
    }
    if (!in_contact(ball.body(), box_b.body(), 0)) {
      const double t = meet(ball, box_b, 0, 3);
      CHECK(meet(ball, mesh_b, 0, 3) == t);
      CHECK(meet(mesh_b, ball, 0, 3) == t);
      if (t < never) {
        const Contact of_box = contact_at(ball.body(), box_b.body(), t);
        const Contact of_mesh = contact_at(ball.body(), mesh_b.body(), t);
        CHECK((of_box.normal - of_mesh.normal).norm() < 1e-6);
        CHECK((of_box.point - of_mesh.point).norm() < 1e-6);
      }
    }
  }
  CHECK(contacts > 40);
}

TEMPLATE_TEST_CASE_SIG("meshes that turn meet when the definition says so", "[turning]", ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 540 + Degree;
  CAPTURE(Degree, seed);
  Random random(seed);
  int contacts = 0;
  for (int round = 0; round < 20; ++round) {
    const auto some_mesh = [&]() -> std::shared_ptr<const Mesh> {
      if (random.one_in(3)) return samples::torus(4 + random.below(3), 3, 0.75, 0.2);
      if (random.one_in(2)) return samples::needle();
      return samples::ball_mesh(0);
    };
    const double rate = std::pow(10.0, random.between(-2, 1.3));
    const Solid<Degree> a{MeshShape{some_mesh(), random.between(0.5, 1.5)},
                          random_motion<Degree>(random, Vector3d::Zero(), rate)};
    const Solid<Degree> b{MeshShape{some_mesh()}, random_motion<Degree>(random, random_vector(random, 2), rate)};
    const Solid<Degree> ball{Sphere{random.between(0.1, 0.6)}, b.motion};
    CAPTURE(round, rate);
    const double t = meet(a, b, 0, 2);
    CHECK(meet(b, a, 0, 2) == t);
    const auto depth = [&](double s) {
      return static_cast<double>(
          Oracle::depth(Oracle::placed(a.motion, a.mesh(), s), Oracle::placed(b.motion, b.mesh(), s)));
    };
    if (t > 0) CHECK(deepest(depth, 0, std::min(t, 2.0), 60) < 1e-13);
    if (t < never) {
      CHECK(in_contact(a.body(), b.body(), t));
      if (t > 0) {
        ++contacts;
        CHECK_FALSE(in_contact(a.body(), b.body(), next_down(t)));
        CHECK(Oracle::distance(Oracle::placed(a.motion, a.mesh(), t), Oracle::placed(b.motion, b.mesh(), t)) < 1e-13);
      }
      const double parted = first_separation(a.body(), b.body(), t, 3);
      CHECK(parted > t);
      if (parted < never) {
        CHECK_FALSE(in_contact(a.body(), b.body(), parted));
        CHECK(in_contact(a.body(), b.body(), next_down(parted)));
        CHECK(depth(parted) < 1e-12);
        for (int i = 1; i < 20; ++i) CHECK(depth(t + (parted - t) * i / 20) > -1e-12);
      }
    } else {
      CHECK_FALSE(in_contact(a.body(), b.body(), 2));
    }
    const double met = meet(a, ball, 0, 2);
    const double radius = std::get<Sphere>(ball.shape).radius;
    const auto in_ball = [&](double s) {
      const auto centre = Oracle::point(ball.motion, Vector3d::Zero(), s);
      return radius - static_cast<double>(Oracle::distance(centre, Oracle::placed(a.motion, a.mesh(), s)));
    };
    if (met > 0) CHECK(deepest(in_ball, 0, std::min(met, 2.0), 100) < 1e-13);
    if (met < never && met > 0) CHECK(std::abs(in_ball(met)) < 1e-13);
    if (met < never) {
      CHECK(in_contact(ball.body(), a.body(), met));
      const double parted = first_separation(a.body(), ball.body(), met, 3);
      CHECK(parted > met);
      if (parted < never) CHECK(std::abs(in_ball(parted)) < 1e-12);
    }
  }
  CHECK(contacts > 2);
}

TEST_CASE("a search through all of the time finds what searches through its parts find", "[turning]") {
  const std::uint64_t seed = 545;
  CAPTURE(seed);
  Random random(seed);
  const auto ring = samples::torus(8, 4);
  constexpr double horizon = 3, part = 1.0 / 16;
  int contacts = 0;
  for (int round = 0; round < 2000; ++round) {
    const double rate = random.between(0.5, 4);
    const Solid<1> a{MeshShape{ring}, random_motion<1>(random, Vector3d::Zero(), rate)};
    const Solid<1> b{MeshShape{ring}, random_motion<1>(random, random_vector(random, 2), rate)};
    CAPTURE(round);
    double met = never;
    for (double t = 0; t < horizon && met == never; t += part) met = meet(a, b, t, t + part);
    CHECK(meet(a, b, 0, horizon) == met);
    contacts += met > 0 && met < never;
  }
  CHECK(contacts > 300);
}

TEST_CASE("rings that are linked, and meshes of many triangles: what a contact costs", "[turning]") {
  const auto small = samples::torus(8, 4), large = samples::torus(100, 30);
  REQUIRE(small->triangles().size() == 64);
  REQUIRE(large->triangles().size() == 6000);
  for (const auto& mesh : {small, large}) {
    for (const double rate : {0.01, 0.1, 1.0, 10.0, 100.0}) {
      Random random(99);
      std::vector<double> apart, linked;
      int met = 0;
      for (int round = 0; round < 20; ++round) {
        // From two and a half away, in a second.
        const Vector3d way = random_vector(random, 1).normalized() * 2.5;
        auto a =
            Solid<1>{MeshShape{mesh}, motion_of<1>({0, 0, 0}, {0, 0, 0}, random_vector(random, 1).normalized() * rate)};
        auto b = Solid<1>{MeshShape{mesh}, motion_of<1>(way, -way, random_vector(random, 1).normalized() * rate)};
        b.motion.orientation = Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), 1);
        apart.push_back(time_of([&] { met += meet(a, b, 0, 1) < never; }, 1));
        // Each through the hole of the other.
        b.motion = motion_of<1>({0.75, 0, 0}, {0, 0, 0}, random_vector(random, 1).normalized() * rate);
        b.motion.orientation = Quaterniond(1, 1, 0, 0);
        linked.push_back(time_of([&] { met += meet(a, b, 0, 1) < never; }, 1));
      }
      std::sort(apart.begin(), apart.end()), std::sort(linked.begin(), linked.end());
      std::printf("%4zu triangles, %6.2f rad: %8.1f us (most %8.1f), linked %8.1f us (most %8.1f); %d contacts\n",
                  mesh->triangles().size(), rate, apart[10] * 1e6, apart[19] * 1e6, linked[10] * 1e6, linked[19] * 1e6,
                  met);
    }
  }
}

TEST_CASE("meshes that have passed each other are followed if they come back, and only then", "[turning]") {
  const auto cube = [](const Vector3d& place, const Vector3d& velocity, double fall) {
    auto m = motion_of<2>(place, velocity, Vector3d::Zero(), 0);
    m.path.coefficients[2] = Vector3d(0, 0, -fall);
    return Solid<2>{MeshShape{samples::cuboid(Vector3d::Constant(0.5)), 1}, m};
  };
  // The balls around the two overlap at first, then one flies up, and falls down on the other at 1 = 1.2 + 10 t - 5
  // t^2.
  const auto below = cube({0, 0, 0}, {0, 0, 0}, 0);
  const double back = (10 + std::sqrt(104.0)) / 10;
  for (const ContactMode mode : {ContactMode::transparent, ContactMode::resolved}) {
    CHECK(std::abs(meet<2>(below, cube({0.25, 0.5, 1.2}, {0, 0, 10}, 5), 0, 1e6, mode) - back) < 1e-14);
    CHECK(meet<2>(below, cube({0.25, 0.5, 1.2}, {0, 0, 10}, 0), 0, 1e300, mode) == never);
    CHECK(meet<2>(below, cube({0.25, 0.5, 1.2}, {3, 0, 10}, 5), 0, 1e6, mode) == never);
    CHECK(std::abs(meet<2>(below, cube({0.25, 0.5, -4}, {0, 0, 1}, 0), 0, 1e300, mode) - 3) < 1e-14);
  }
}

}  // namespace test_turning_mesh
