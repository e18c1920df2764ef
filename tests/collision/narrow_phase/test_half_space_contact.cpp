// Half-spaces with balls, boxes, capsules, hulls and meshes: when they meet and part, against exact rational numbers.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/surface_gap.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/half_space.hpp"
#include "collision/shapes/mesh.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/exact_rational.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace test_half_space_contact {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::PointMotion;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using oracle::Rational;
using oracle::rational;
using Random = samples::Random;

constexpr double horizon = 8;

Rational product(const Vector3d& n, const std::array<Rational, 3>& x) {
  return rational(n[0]) * x[0] + rational(n[1]) * x[1] + rational(n[2]) * x[2];
}
std::array<Rational, 3> exact(const Vector3d& v) { return {rational(v[0]), rational(v[1]), rational(v[2])}; }
std::array<Rational, 3> turned(const Matrix3d& m, const Vector3d& v, double scale) {
  const auto row = [&](int i) {
    return (rational(m(i, 0)) * rational(v[0]) + rational(m(i, 1)) * rational(v[1]) +
            rational(m(i, 2)) * rational(v[2])) *
           rational(scale);
  };
  return {row(0), row(1), row(2)};
}

/// The lowest height of a shape about its centre, by all of its corners.
Rational lowest(const PlacedShape& shape, const Vector3d& n) {
  std::vector<Rational> heights;
  Rational radius;
  if (const auto* const ball = std::get_if<Sphere>(&shape.shape)) {
    heights.push_back({}), radius = rational(ball->radius);
  } else if (const auto* const capsule = std::get_if<Capsule>(&shape.shape)) {
    const Rational end = product(n, exact(shape.rotation.col(2))) * rational(capsule->half_length);
    heights = {end, -end}, radius = rational(capsule->radius);
  } else if (std::holds_alternative<Box>(shape.shape)) {
    for (int corner = 0; corner < 8; ++corner) {
      Rational height;
      for (int d = 0; d < 3; ++d) {
        const Rational along = product(n, exact(shape.half_axes[static_cast<std::size_t>(d)]));
        height += (corner >> d & 1) != 0 ? along : -along;
      }
      heights.push_back(height);
    }
  } else if (const auto* const hull = std::get_if<ConvexHull>(&shape.shape)) {
    for (const Vector3d& v : hull->polytope->points()) heights.push_back(product(n, turned(shape.rotation, v, 1)));
  } else {
    const auto& mesh = std::get<MeshShape>(shape.shape);
    for (const Mesh::Triangle& triangle : mesh.mesh->triangles()) {
      for (const std::uint32_t i : triangle) {
        heights.push_back(product(n, turned(shape.rotation, mesh.mesh->vertices()[i], mesh.scale)));
      }
    }
  }
  return *std::min_element(heights.begin(), heights.end()) - radius;
}

/// The gap, a parabola about time 0, exactly.
struct Gap {
  std::array<Rational, 3> c;

  Rational at(const Rational& t) const { return c[0] + t * (c[1] + t * c[2]); }
  /// Its sign just after a time.
  int after(double time) const {
    const Rational t = rational(time);
    if (const int sign = at(t).sign()) return sign;
    if (const int sign = (c[1] + c[2] * t * Rational(2)).sign()) return sign;
    return c[2].sign();
  }
  /// Whether it, times `sign`, is not below zero from one time to another.
  bool keeps(int sign, double from, double to) const {
    const Rational a = rational(from), b = rational(to), s(sign);
    if ((at(a) * s).sign() < 0 || (at(b) * s).sign() < 0) return false;
    if (c[2].sign() == 0) return true;
    const Rational top = -c[1] / (c[2] * Rational(2));
    return top < a || b < top || (at(top) * s).sign() >= 0;
  }
};

template <int Degree>
Gap gap_of(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b) {
  const HalfSpace plane = placed_half_space(a.shape);
  Gap gap{{lowest(b.shape, plane.normal) - rational(plane.offset), {}, {}}};
  for (const auto* const body : {&a, &b}) {
    const Rational side(body == &a ? -1 : 1), s = rational(body->motion.start);
    std::array<Rational, 3> p;
    for (std::size_t i = 0; i <= Degree; ++i) p[i] = product(plane.normal, exact(body->motion.coefficients[i])) * side;
    gap.c[0] += p[0] - s * p[1] + s * s * p[2];
    gap.c[1] += p[1] - Rational(2) * s * p[2];
    gap.c[2] += p[2];
  }
  return gap;
}

PlacedShape random_shape(Random& random, int kind) {
  static const auto ring = samples::torus(8, 4);
  static const auto cube = samples::cuboid();
  const double size = random.uniform(0.3, 1);
  const Quaterniond turn = random.below(3) == 0 ? Quaterniond::Identity() : random.orientation();
  if (kind == 0) return placed_ball(size);
  if (kind == 1) return place(Box{{size, 0.5 * size, 0.7}}, turn);
  if (kind == 2) return place(Capsule{0.5 * size, 0.7 * size}, turn);
  if (kind == 3) {
    return place(convex_hull({{0, 0, 0}, {size, 0, 0}, {0, 1, 0}, {0, 0, -size}, {0.7, 0.7, 0.25}}), turn);
  }
  return place(MeshShape{random.below(2) == 0 ? ring : cube, size}, turn);
}

PlacedShape random_half_space(Random& random) {
  Vector3d normal = Vector3d::UnitZ();
  if (random.below(2) == 0) normal = (random.vector(1) + Vector3d(0, 0, 0.01)).normalized();
  return place(HalfSpace{normal, random.below(2) == 0 ? 0.0 : random.uniform(-2, 2)},
               random.below(2) == 0 ? Quaterniond::Identity() : random.orientation());
}

template <int Degree>
PointMotion<Degree> random_motion(Random& random, bool coarse) {
  PointMotion<Degree> motion;
  const auto number = [&](double size) {
    const double x = random.uniform(-size, size);
    return coarse ? std::round(2 * x) / 2 : x;
  };
  motion.start = number(1);
  for (std::size_t i = 0; i <= Degree; ++i) {
    for (int d = 0; d < 3; ++d) motion.coefficients[i][d] = number(i == 0 ? 4 : 2);
  }
  return motion;
}

template <int Degree>
void check_times(std::uint64_t seed, std::size_t& met, std::size_t& parted) {
  INFO("degree " << Degree << ", seed " << seed);
  Random random(seed);
  const PlacedShape shape = random_shape(random, static_cast<int>(seed % 5));
  const PlacedShape half_space = random_half_space(random);
  const bool coarse = random.below(2) == 0;
  PointMotion<Degree> still{};
  still.coefficients[0] = random_motion<Degree>(random, coarse).coefficients[0];
  for (std::size_t i = 1; i <= Degree; ++i) still.coefficients[i].setZero();
  const auto its = random.below(2) == 0 ? still : random_motion<Degree>(random, coarse);
  const auto path = random_motion<Degree>(random, coarse);
  const TranslatingShape<Degree> a{half_space, its}, b{shape, path};
  const Gap gap = gap_of(a, b);
  const double t0 = 1;
  const double t = first_contact(a, b, t0, horizon, ContactMode::transparent);
  REQUIRE(first_contact(b, a, t0, horizon, ContactMode::transparent) == t);
  PairMemory memory;
  const ContactEstimate estimate = estimated_first_contact(a, b, t0, horizon, ContactMode::transparent, memory);
  REQUIRE(estimate.time <= t);
  REQUIRE((!estimate.exact || estimate.time == t));
  REQUIRE(in_contact(a, b, t0) == (gap.after(t0) < 0));
  if (t == never) {
    REQUIRE(gap.keeps(1, t0, horizon));
    return;
  }
  ++met;
  REQUIRE(gap.after(t) < 0);
  REQUIRE((t == t0 || gap.keeps(1, t0, next_down(t))));
  const Contact contact = contact_at(a, b, t);
  const HalfSpace plane = placed_half_space(half_space);
  REQUIRE((contact.normal - plane.normal).norm() < 1e-15);
  if (t > t0) {
    REQUIRE(std::abs(plane.normal.dot(contact.point - its.position(t)) - plane.offset) < 1e-9);
  }
  const double free = first_separation(a, b, t, horizon);
  if (free == never) {
    REQUIRE(gap.keeps(-1, next_up(t), horizon));
    return;
  }
  ++parted;
  REQUIRE(gap.after(free) >= 0);
  REQUIRE((next_down(free) <= next_up(t) || gap.keeps(-1, next_up(t), next_down(free))));
}

void refuses(const HalfSpace& shape, const std::string& what) {
  try {
    place(shape, Quaterniond::Identity());
    FAIL("nothing was thrown");
  } catch (const std::invalid_argument& error) {
    CHECK(std::string(error.what()).find(what) == 0);
  }
}

}  // namespace

TEST_CASE("half-space: shapes meet it and part from it at the very doubles", "[half_space]") {
  std::size_t met = 0, parted = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    check_times<1>(seed, met, parted);
    check_times<2>(seed, met, parted);
  }
  CHECK(met > 1000);
  CHECK(parted > 300);
}

TEST_CASE("half-space: known times, points and features", "[half_space]") {
  const PlacedShape ground = place(HalfSpace{Vector3d::UnitZ(), 0.5}, Quaterniond::Identity());
  const PointMotion<1> still{{Vector3d(7, 8, 0.5), Vector3d::Zero()}};  // the plane z = 1
  const PointMotion<1> falls{{Vector3d(3, 2, 9), Vector3d(0, 0, -2)}};
  const auto check = [&](const Shape& shape, double time, const Vector3d& point, const char* feature) {
    const PlacedShape placed = place(shape, Quaterniond::Identity());
    const TranslatingShape<1> a{ground, still}, b{placed, falls};
    REQUIRE(first_contact(a, b, 0, never, ContactMode::resolved) == time);
    const Contact contact = contact_at(a, b, time);
    CHECK(contact.point == point);
    CHECK(contact.normal == Vector3d::UnitZ());
    CHECK(to_string(contact.feature_a) == "-");
    CHECK(to_string(contact.feature_b) == feature);
    CHECK(contact_at(b, a, time).normal == -Vector3d::UnitZ());
    CHECK(gap_along(a, b, Vector3d::UnitZ(), 0.0) == 2 * time);
    CHECK(first_separation(a, b, time, never) == never);
  };
  check(Sphere{1}, 3.5, {3, 2, 1}, "-");
  check(Box{{1, 1, 2}}, 3, {3, 2, 1}, "f4");
  check(Capsule{0.5, 1.5}, 3, {3, 2, 1}, "v0");
  check(convex_hull({{0, 0, -4}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), 2, {3, 2, 1}, "v0");
  check(MeshShape{samples::cuboid(), 2}, 3, {3, 2, 1}, "f8");
}

TEST_CASE("half-space: it is refused unless its normal is of unit length, and its offset a number", "[half_space]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refuses({Vector3d::Zero(), 0}, "normal: must be of unit length");
  refuses({Vector3d(1, 1, 0), 0}, "normal: must be of unit length");
  refuses({Vector3d(nan, 1, 0), 0}, "normal: must be finite");
  refuses({Vector3d::UnitX(), nan}, "offset: must be finite");
  refuses({Vector3d::UnitX(), 1e70}, "offset: must be finite");
  CHECK(is_placed(place(HalfSpace{Vector3d(0.6, 0, 0.8), -3}, Quaterniond::Identity())));
}

}  // namespace test_half_space_contact
