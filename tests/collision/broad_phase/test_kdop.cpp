// k-DOPs: slabs that hold what they should, by exact arithmetic.
#include "collision/broad_phase/kdop.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape.hpp"
#include "tests/collision/broad_phase/kdop_values.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/exact_algebra.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace kds::collision::test_kdop {
namespace {

using Eigen::Vector3d;
using namespace tests;
using kds::tests::Random;
using oracle::rational;
using oracle::Rational;

/// direction . x of a path, exactly.
template <int Degree>
oracle::Polynomial along(const certificates::PointMotion<Degree>& path, const KdopDirection& direction) {
  oracle::Polynomial sum;
  for (std::size_t d = 0; d < 3; ++d) {
    sum = sum + oracle::Polynomial(rational(direction[d])) * polynomial(path.axis(static_cast<int>(d)));
  }
  return sum;
}

/// Numbers that cancel, differ in size or are few bits long.
double number(Random& random) {
  if (random.one_in(3)) return random.integer(-3, 3);
  if (random.one_in(2)) return random.between(-1, 1);
  return random.scaled(-60, 60);
}

}  // namespace

TEST_CASE("Sums are rounded down, and are exact where they can be", "[kdop]") {
  const std::uint64_t seed = 1200;
  CAPTURE(seed);
  Random random(seed);
  int wrong = 0, inexact = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = number(random);
    const double y = random.one_in(3) ? -x * (1 + random.integer(0, 2) * 0x1p-52) : number(random);
    const double z = random.one_in(3) ? number(random) * 0x1p-53 : number(random);
    const double below = detail::sum_below(x, y, z);
    const Rational exact = rational(x) + rational(y) + rational(z);
    const Rational size = oracle::abs(rational(x)) + oracle::abs(rational(y)) + oracle::abs(rational(z));
    wrong += rational(below) > exact;
    wrong += exact - rational(below) > size * rational(0x1p-49);
    wrong += rational(next_up(below)) == exact;  // then it could have been exact
    inexact += rational(below) != exact;
  }
  CHECK(wrong == 0);
  CHECK(inexact > 1000);
}

TEMPLATE_TEST_CASE_SIG("A slab holds its body from now on, and hardly more", "[kdop]", ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 1210;
  CAPTURE(Degree, seed);
  Random random(seed);
  int wrong = 0;
  for (int i = 0; i < 400; ++i) {
    const double now = random.one_in(4) ? 1e6 * random.unit() : random.unit();
    certificates::PointMotion<Degree> path;
    for (auto& c : path.coefficients) {
      for (int d = 0; d < 3; ++d) c[d] = random.between(-9, 9);
    }
    const int before = random.integer(-1, 2);
    path.start = now - before * random.unit();
    const double low = -random.unit();
    const double high = random.unit();
    const KineticBox<Degree> box = box_around(path, Vector3d(low, 2 * low, low), Vector3d(high, high, 2 * high));
    for (const KdopDirection& direction : directions(26)) {
      const oracle::Polynomial centre = along(path, direction);
      const auto check = [&](const KineticSlab<Degree>& slab, const Rational& from, const Rational& to) {
        for (const double later : {0.0, 0.3, 1.0, 100.0, 1e5}) {
          const Rational t = rational(now) + rational(later);
          const Rational below = centre(t) + from - polynomial(slab.min)(t);
          const Rational above = polynomial(slab.max)(t) - centre(t) - to;
          // The sizes of terms, after so long and from so far back as the start may be.
          const double farthest = 3 + later;
          const Rational slack = rational(0x1p-46) * rational(40 * (1 + farthest + farthest * farthest));
          wrong += below.sign() < 0 || above.sign() < 0 || below > slack || above > slack;
        }
      };
      if (path.start <= now) check(slab_around(path, low, high, direction), rational(low), rational(high));
      Rational from, to;
      for (std::size_t d = 0; d < 3; ++d) {
        const double least = d == 1 ? 2 * low : low, greatest = d == 2 ? 2 * high : high;
        from = from + rational(direction[d] > 0 ? least : direction[d] < 0 ? -greatest : 0);
        to = to + rational(direction[d] > 0 ? greatest : direction[d] < 0 ? -least : 0);
      }
      check(slab_around(box, direction, now), from, to);
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("Extents hold every vertex, and hardly more", "[kdop]") {
  const std::uint64_t seed = 1220;
  CAPTURE(seed);
  Random random(seed);
  int wrong = 0;
  for (int i = 0; i < 40; ++i) {
    const double w = random.unit(), x = random.between(-1, 1), y = random.between(-1, 1);
    const Eigen::Quaterniond turn =
        i == 0 ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(w, x, y, 0.5).normalized();
    const double width = random.unit() + 0.1;
    const PlacedShape box = place(Box{{width, 0.01, random.unit() + 1}}, turn);
    const PlacedShape ring = place(MeshShape{samples::torus(8, 4), random.unit() + 0.5}, turn);
    const PlacedShape ball = place(Sphere{random.unit() + 0.1}, turn);
    for (const KdopDirection& direction : structures::kdop_directions(26)) {
      const Eigen::Vector3d d(direction.data());
      const auto along = [&](const Eigen::Vector3d& v) {
        return rational(d[0]) * rational(v[0]) + rational(d[1]) * rational(v[1]) + rational(d[2]) * rational(v[2]);
      };
      const auto check = [&](const PlacedShape& shape, const Rational& least, const Rational& greatest) {
        const auto [low, high] = extent(shape, d);
        const Rational slack = rational(0x1p-21 * shape.bounding_radius);
        wrong += least < rational(low) || rational(high) < greatest;
        wrong += least - rational(low) > slack || rational(high) - greatest > slack;
      };
      Rational sum;
      for (const auto& half : box.half_axes) sum = sum + oracle::abs(along(half));
      check(box, -sum, sum);
      std::vector<Rational> reaches;
      const auto& mesh = *std::get<MeshShape>(ring.shape).mesh;
      for (const auto& v : mesh.placed_vertices(ring.rotation, std::get<MeshShape>(ring.shape).scale)) {
        reaches.push_back(along(v));
      }
      check(ring, *std::min_element(reaches.begin(), reaches.end()), *std::max_element(reaches.begin(), reaches.end()));
      const double radius = ball.bounding_radius;
      const auto [low, high] = extent(ball, d);
      wrong += low != -high || oracle::square(rational(high)) < along(d) * oracle::square(rational(radius));
      wrong += high > radius * d.norm() * (1 + 0x1p-40);
    }
  }
  CHECK(wrong == 0);
}

}  // namespace kds::collision::test_kdop
