// Hulls of points: their corners, edges and faces, by definition in exact arithmetic, whatever the points.
#include "collision/shapes/polytope.hpp"

#include "collision/response/mass_properties.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "kds/arithmetic/exact.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace test_polytope {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using kds::tests::Random;

int side(const std::vector<Vector3d>& p, std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
  const auto way = [&](std::size_t to, int k) { return Exact(p[to][k]) - Exact(p[a][k]); };
  const auto minor = [&](int j, int k) { return way(b, j) * way(c, k) - way(b, k) * way(c, j); };
  return (minor(1, 2) * way(d, 0) + minor(2, 0) * way(d, 1) + minor(0, 1) * way(d, 2)).sign();
}

/// Each face has all points below or in its plane, turns left at each of its corners, and holds all that are in the
/// plane between its corners; each edge has its two faces; Euler's formula; and each point is in or under all faces.
void check(const std::vector<Vector3d>& points) {
  const HullStructure hull = structure_of_hull(points);
  CHECK(hull.corners.size() + hull.faces.size() == hull.edges.size() + 2);
  std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
  for (const auto& face : hull.faces) {
    REQUIRE(face.size() >= 3);
    CHECK(face[0] == *std::min_element(face.begin(), face.end()));
    const auto [a, b, c] = spanning_corners(face);
    for (std::size_t i = 0; i < points.size(); ++i) CHECK(side(points, a, b, c, i) <= 0);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const auto p = face[k], q = face[(k + 1) % face.size()], r = face[(k + 2) % face.size()];
      CHECK(directed.insert({p, q}).second);
      for (std::size_t i = 0; i < points.size(); ++i) CHECK(side(points, p, q, r, i) <= 0);
    }
  }
  CHECK(directed.size() == 2 * hull.edges.size());
  for (std::uint32_t e = 0; e < hull.edges.size(); ++e) {
    const auto& [ends, faces] = hull.edges[e];
    CHECK(ends[0] < ends[1]);
    CHECK(directed.count({ends[0], ends[1]}) == 1);
    CHECK(directed.count({ends[1], ends[0]}) == 1);
    const auto next = [&](std::uint32_t face, std::uint32_t from) {
      const auto& f = hull.faces[face];
      return f[static_cast<std::size_t>(std::find(f.begin(), f.end(), from) - f.begin() + 1) % f.size()];
    };
    CHECK(next(faces[0], ends[0]) == ends[1]);
    CHECK(next(faces[1], ends[1]) == ends[0]);
  }
  for (const std::uint32_t i : hull.corners) {  // extreme: not the middle of others, so the first of its place
    CHECK(std::find(points.begin(), points.end(), points[i]) - points.begin() == i);
  }
}

std::vector<Vector3d> lattice(int n) {
  std::vector<Vector3d> points;
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z) points.emplace_back(x, y, z);
    }
  }
  return points;
}

}  // namespace

TEST_CASE("hulls of random points", "[polytope]") {
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    INFO("seed 1, set " << i);
    std::vector<Vector3d> points;
    const auto kind = i % 4;
    const int count = random.integer(5, 14);
    for (int k = 0; k < count; ++k) {
      Vector3d p;
      for (int d = 0; d < 3; ++d) p[d] = kind == 0 ? random.integer(-1, 1) : random.between(-1, 1);
      if (kind == 2) p[2] = p[0] + p[1];  // in a plane but for roundings
      if (kind == 3) p = p.normalized();
      points.push_back(p);
    }
    points.push_back(points[1]);
    try {
      check(points);
    } catch (const InvalidHull& error) {
      CHECK(kind % 2 == 0);  // some lie in a plane
    }
  }
}

TEST_CASE("hulls of points in rows, in planes and twice there", "[polytope]") {
  std::vector<Vector3d> points = lattice(3);
  points.insert(points.end(), points.begin(), points.end());
  Random random(2);
  for (int round = 0; round < 4; ++round) {
    INFO("round " << round);
    const Polytope cube(points);
    CHECK(cube.structure().corners.size() == 8);
    CHECK(cube.structure().faces.size() == 6);
    CHECK(cube.surface()->triangles().size() == 12);
    check(points);
    for (std::size_t k = points.size(); k-- > 1;) std::swap(points[k], points[random.below(k + 1)]);
  }
}

TEST_CASE("what has no hull is refused by name", "[polytope]") {
  const auto refused = [](std::vector<Vector3d> points) -> std::string {
    try {
      Polytope polytope(std::move(points));
      return "nothing";
    } catch (const InvalidHull& error) {
      return error.what();
    }
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(refused({}) == "has 0 points; a solid takes at least 4");
  CHECK(refused({{0, 0, 0}, {1, 0, 0}, {0, 1, nan}, {0, 0, 1}}) == "point 2: must be finite");
  CHECK(refused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e40}}) == "point 3: is beyond 2^100");
  CHECK(refused({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}) == "has no volume: all points are one");
  CHECK(refused({{1, 2, 3}, {2, 4, 6}, {3, 6, 9}, {-1, -2, -3}}) == "has no volume: all points lie in a line");
  CHECK(refused({{1, 2, 3}, {2, 4, 6}, {3, 7, 9}, {-1, -2, -3}}) == "has no volume: all points lie in a plane");
  CHECK(refused({{0, 0, 0}, {1, 0, 0}, {0.5, 0x1p-60, 0}, {0, 0, -1}}) ==
        "points 0, 1 and 2 make a part of the surface, and lie in a line but for roundings");
  CHECK_THROWS_WITH(place(ConvexHull{}, Eigen::Quaterniond::Identity()), "hull: is missing");
}

TEST_CASE("a hull is a box if its corners are exactly those of one", "[polytope]") {
  const Vector3d low(-0.1, 0.7, 0), high(0.3, 0.7 + 1e-9, 5);
  std::vector<Vector3d> corners;
  for (int k = 0; k < 8; ++k) {
    corners.emplace_back((k & 1 ? high : low)[0], (k & 2 ? high : low)[1], (k & 4 ? high : low)[2]);
  }
  const auto box_of = [](const std::vector<Vector3d>& points) { return Polytope(points).box(); };
  const auto is_it = [&](const auto& box) { return box && box->low == low && box->high == high; };
  CHECK(is_it(box_of(corners)));
  std::reverse(corners.begin(), corners.end());
  CHECK(is_it(box_of(corners)));
  std::vector<Vector3d> more = corners;  // those that are no corners do not matter
  more.push_back(0.5 * low + 0.5 * high);
  more.emplace_back(low[0], low[1], 2);
  CHECK(is_it(box_of(more)));

  for (std::size_t i = 0; i < 8; ++i) {
    for (int d = 0; d < 3; ++d) {
      INFO("corner " << i << ", coordinate " << d);
      std::vector<Vector3d> skewed = corners;
      double& x = skewed[i][d];
      x = std::nextafter(x, skewed[i][d] == low[d] ? 10 : -10);
      CHECK_FALSE(box_of(skewed));
    }
  }
  corners.pop_back();
  CHECK_FALSE(box_of(corners));
  corners.emplace_back(low[0], low[1], 6);
  CHECK_FALSE(box_of(corners));
  CHECK_FALSE(box_of({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}));
}

TEST_CASE("a hull has the mass properties of its solid", "[polytope][mass]") {
  const Vector3d half(1, 2, 3);
  std::vector<Vector3d> corners;
  for (int k = 0; k < 8; ++k) {
    corners.emplace_back(k & 1 ? half[0] : -half[0], k & 2 ? half[1] : -half[1], k & 4 ? half[2] : -half[2]);
  }
  const MassProperties of_hull = mass_properties(convex_hull(corners), 3), of_box = mass_properties(Box{half}, 3);
  CHECK((of_hull.inertia - of_box.inertia).cwiseAbs().maxCoeff() < 1e-14 * of_box.inertia(0, 0));
  CHECK(of_hull.centre.norm() < 1e-15);
  // The corner of a cube: its centre is a quarter of the way in.
  const MassProperties tip = mass_properties(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), 1);
  CHECK((tip.centre - Vector3d::Constant(0.25)).norm() < 1e-15);
  CHECK(tip.inertia(0, 0) == Approx(2 * 3.0 / 80));  // of each coordinate the variance is 3 / 80
  CHECK(tip.inertia(0, 1) == Approx(1.0 / 80));
}

}  // namespace test_polytope
