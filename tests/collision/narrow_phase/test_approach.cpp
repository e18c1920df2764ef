// Whether bodies that overlap by a rounding approach does not depend on when it is asked.
#include "collision/narrow_phase/narrow_phase.hpp"

#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace test_approach {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using kds::tests::Random;
using Path = certificates::PointMotion<2>;

/// Two squares of triangles that meet in an edge, in one plane or not.
std::shared_ptr<const Mesh> two_squares(double height) {
  const std::vector<Vector3d> vertices{{-1, -1, height}, {0, -1, 0}, {1, -1, height},
                                       {-1, 1, height},  {0, 1, 0},  {1, 1, height}};
  const std::vector<Mesh::Triangle> triangles{{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  return std::make_shared<const Mesh>(vertices, triangles);
}

Shape solid_of_kind(int kind, double size) {
  if (kind == 0) return Sphere{size};
  if (kind == 1) return Capsule{0.25, size};
  if (kind == 2) return Box{Vector3d(size, 0.7 * size, 0.5 * size)};
  return convex_hull({Vector3d(size, 0, 0), Vector3d(-size, 0.3 * size, 0), Vector3d(-0.2 * size, -size, 0.1 * size),
                      Vector3d(0, 0, size), Vector3d(0.4 * size, 0.8 * size, -0.5 * size)});
}

}  // namespace

TEST_CASE("bodies that fall together and overlap by a rounding approach at all times or never", "[narrow_phase]") {
  const PlacedShape box = place(Box{Vector3d(0.5, 0.5, 0.5)}, Eigen::Quaterniond::Identity());
  Random random(3);
  int overlapping = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Vector3d velocity(random.between(-1, 1), random.between(-1, 1), 0), gravity(random.between(-3, 3), 0, -9.81);
    const Vector3d deeper(1 - 0x1p-50, random.between(-0.5, 0.5), 0);
    // They move alike, but for the roundings with which a motion begins anew.
    const Path path_a = Path::parabola(Vector3d::Zero(), velocity, gravity).restarted(random.between(0, 0.5));
    const Path path_b = Path::parabola(deeper, velocity, gravity).restarted(random.between(0, 0.5));
    const MovingShape<Path> a{box, path_a}, b{box, path_b};
    std::vector<bool> approaches;
    for (double t = 0.5; t < 2; t += 0.0625) {
      if (!in_contact(a, b, t)) continue;
      approaches.push_back(first_contact(a, b, t, 2, ContactMode::resolved) == t);
    }
    CAPTURE(trial);
    overlapping += approaches.size() > 5;
    for (const bool approach : approaches) REQUIRE(approach == approaches.front());
  }
  CHECK(overlapping > 100);
}

TEST_CASE("what touches a mesh meets it next at one time, whenever it is asked", "[narrow_phase]") {
  int touching = 0, met = 0;
  std::vector<int> wrong;  // trials
  for (int trial = 0; trial < 1000; ++trial) {
    Random random(static_cast<std::uint64_t>(trial));
    const auto between = [&](double low, double high) { return random.between(low, high); };
    const auto vector = [&](double size) {
      const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
      return Vector3d(x, y, z);
    };
    const auto turn = random.one_in(3) ? Eigen::Quaterniond::Identity()
                                       : Eigen::Quaterniond(1, between(-1, 1), between(-1, 1), 0.5).normalized();
    const PlacedShape mesh = place(MeshShape{two_squares(0.25 * random.integer(-1, 1))}, turn);
    const double radius = between(0.02, 0.5);
    const PlacedShape solid = place(solid_of_kind(trial % 4, radius), turn);
    const Vector3d out = turn * Vector3d(random.one_in(2) ? 0 : between(-0.3, 0.3), 0, 1).normalized();
    const Vector3d above = turn * Vector3d(random.one_in(2) ? 0 : between(-1, 1), between(-1, 1), 0);
    const Path still;
    const auto at = [&](double height) {
      return Path::parabola(above + height * out, Vector3d::Zero(), Vector3d::Zero());
    };
    double low = 0, high = 2;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      const Path there = at(middle);
      (in_contact(TranslatingShape<2>{mesh, still}, TranslatingShape<2>{solid, there}, 0) ? low : high) = middle;
    }
    // It lies about a contact gap deep, and moves along or slowly towards or away from the surface.
    const Path start = at(low + 0x1p-47 * between(-3, 0.5));
    const Vector3d normal = contact_at(TranslatingShape<2>{mesh, still}, TranslatingShape<2>{solid, start}, 0).normal;
    const auto along = [&](const Vector3d& v) -> Vector3d { return v - normal.dot(v) * normal; };
    const Vector3d common = vector(1), weight(0, 0, -9.81);
    const Vector3d velocity =
        random.integer(0, 2) * along(vector(1)) + std::ldexp(between(-1, 1), -random.integer(20, 60)) * normal;
    const Vector3d pull = random.integer(0, 1) * along(vector(3)) - random.integer(-1, 1) * normal;
    const Path path_a = Path::parabola(Vector3d::Zero(), common, weight);
    Path path_b = Path::parabola(start.coefficients[0], common + velocity, weight + pull);
    if (random.one_in(2)) path_b = path_b.restarted(0x1p-8 * between(0, 1));
    const TranslatingShape<2> a{mesh, path_a}, b{solid, path_b};
    const double begin = std::max(path_a.start, path_b.start), horizon = 2;
    const double first = first_contact(a, b, begin, horizon, ContactMode::resolved);
    touching += in_contact(a, b, begin);
    met += first > begin && first <= horizon;
    const double end = std::min(first, horizon);
    for (int k = 0; k < 12; ++k) {
      const double t = begin + (end - begin) * (k < 6 ? between(0, 1) : std::ldexp(1, -4 * k));
      if (first_contact(a, b, t, horizon, ContactMode::resolved) == first) continue;
      wrong.push_back(trial);
      break;
    }
  }
  CHECK(wrong == std::vector<int>{});
  CHECK(touching > 330);
  CHECK(met > 80);
}

}  // namespace test_approach
