// Polygons that are cut into triangles: these cover what the polygon covers, and nothing twice.
#include "io/polygon.hpp"

#include "io/mesh_file.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

namespace test_polygon {
namespace {

using namespace kds::io;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

std::vector<std::uint32_t> in_order(std::size_t n) {
  std::vector<std::uint32_t> corners(n);
  std::iota(corners.begin(), corners.end(), 0);
  return corners;
}

/// Points of the plane z = 0.
std::vector<Vector3d> flat(const std::vector<Vector2d>& points) {
  std::vector<Vector3d> places;
  for (const Vector2d& p : points) places.emplace_back(p[0], p[1], 0);
  return places;
}

double cross(const Vector2d& a, const Vector2d& b) { return a[0] * b[1] - a[1] * b[0]; }

/// How often the outline goes around a point of the plane.
int turns_around(const std::vector<Vector2d>& outline, const Vector2d& point) {
  int turns = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d a = outline[i] - point, b = outline[(i + 1) % outline.size()] - point;
    if ((a[1] <= 0) == (b[1] <= 0)) continue;
    if ((cross(a, b) > 0) == (b[1] > 0)) turns += b[1] > 0 ? 1 : -1;
  }
  return turns;
}

/// The triangles of a polygon that does not cross itself.
Triangles cut(const std::vector<Vector3d>& places) {
  const auto triangles = cut_into_triangles(places, in_order(places.size()));
  REQUIRE(triangles);
  return *triangles;
}

/// Whether triangles have a corner at each place of the outline: so that they fit to polygons beside it.
bool all_corners_are_there(const std::vector<Vector2d>& outline) {
  const auto triangles = cut(flat(outline));
  return std::all_of(outline.begin(), outline.end(), [&](const Vector2d& place) {
    return std::any_of(triangles.begin(), triangles.end(), [&](const auto& t) {
      return outline[t[0]] == place || outline[t[1]] == place || outline[t[2]] == place;
    });
  });
}

/// Checks the triangles of a polygon in the plane against its outline: area, way around, and which points are covered.
void check(const std::vector<Vector2d>& outline, std::uint32_t seed = 1) {
  const auto places = flat(outline);
  double area = 0, covered = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) area += cross(outline[i], outline[(i + 1) % outline.size()]) / 2;
  const Triangles triangles = cut(places);
  for (const auto& [a, b, c] : triangles) {
    const double twice = cross(outline[b] - outline[a], outline[c] - outline[a]);
    CHECK(twice * area > 0);
    covered += twice / 2;
  }
  CHECK(covered == Approx(area).epsilon(1e-12));
  Vector2d low = outline[0], high = outline[0];
  for (const Vector2d& p : outline) low = low.cwiseMin(p), high = high.cwiseMax(p);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part;
  for (int i = 0; i < 30; ++i) {
    const Vector2d point = low + (high - low).cwiseProduct(Vector2d(part(random), part(random)));
    const auto holds = [&](const std::array<std::uint32_t, 3>& t) {
      return turns_around({outline[t[0]], outline[t[1]], outline[t[2]]}, point) != 0;
    };
    CHECK(std::count_if(triangles.begin(), triangles.end(), holds) == std::abs(turns_around(outline, point)));
  }
}

/// The same, gone around from each corner and in both directions.
void check_all_ways(std::vector<Vector2d> outline) {
  for (int direction = 0; direction < 2; ++direction) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      CAPTURE(direction, i);
      CHECK(all_corners_are_there(outline));
      check(outline);
      std::rotate(outline.begin(), outline.begin() + 1, outline.end());
    }
    std::reverse(outline.begin(), outline.end());
  }
}

TEST_CASE("polygon: concave, collinear, repeated, keyholes, and such as touch themselves") {
  check_all_ways({{0, 0}, {2, 1}, {0, 2}, {1, 1}});                                  // an arrow
  check_all_ways({{0, 0}, {4, 0}, {4, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {0, 3}});  // a U
  check_all_ways({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}});  // corners on edges
  check_all_ways({{0, 0}, {1, 0}, {2, 0}, {1, 1}, {0, 2}, {0, 1}});                  // on all of a triangle's
  check_all_ways({{0, 0}, {0, 0}, {2, 0}, {2, 2}, {2, 2}, {2, 2}, {0, 2}});          // one after the other
  check_all_ways({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}});  // a keyhole
  // Two holes in a chain, whose edges overlap.
  check_all_ways({{0, 0},
                  {9, 0},
                  {9, 4},
                  {0, 4},
                  {0, 0},
                  {1, 1},
                  {1, 3},
                  {3, 3},
                  {3, 1},
                  {1, 1},
                  {5, 1},
                  {5, 3},
                  {8, 3},
                  {8, 1},
                  {5, 1},
                  {1, 1}});
  check_all_ways(
      {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 2}, {1, 2}, {2, 3}, {3, 2}, {2, 1}, {1, 2}, {0, 2}});  // from an edge
  check_all_ways({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {2, 2}});  // an edge that leads nowhere
  check_all_ways({{0, 0}, {2, 0}, {6, 0}, {6, 2}, {2, 0}, {0, 4}});  // two triangles at a corner
  check_all_ways({{0, 0}, {2, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}});  // a corner on an edge
  check_all_ways({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}});          // without a corner there
  check_all_ways(
      {{0, 0}, {2, 0}, {2, 2}, {5, 2}, {5, 0}, {7, 0}, {7, 4}, {5, 4}, {5, 2}, {2, 2}, {0, 4}});  // a dumbbell
}

TEST_CASE("polygon: outlines of random stars, combs and grids, with holes") {
  const auto seed = GENERATE(range(1u, 31u));
  CAPTURE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part;
  std::vector<Vector2d> star;
  const int n = 5 + static_cast<int>(40 * part(random));
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * 3.14159265358979 * i / n, radius = 1 + 9 * part(random);
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  check(star, seed);
  CHECK(all_corners_are_there(star));
  // A hole, from a corner: the same star, smaller, gone around the other way.
  std::vector<Vector2d> ring = star;
  ring.push_back(star[0]);
  for (int i = 0; i <= n; ++i) ring.push_back(0.5 * star[std::size_t((n - i) % n)]);
  check(ring, seed);
  CHECK(all_corners_are_there(ring));
  // Teeth on a grid: many corners on a line.
  std::vector<Vector2d> comb;
  const int teeth = 2 + static_cast<int>(10 * part(random));
  for (int i = 0; i < 2 * teeth; ++i) comb.emplace_back(i, 0);
  for (int i = 2 * teeth; i-- > 0;) {
    const double height = 1 + std::floor(3 * part(random));
    if (i % 2 == 1 && i + 1 < 2 * teeth) comb.emplace_back(i, height);
    comb.emplace_back(i, i % 2 == 1 ? 1 : height + 1);
  }
  check(comb, seed);
  CHECK(all_corners_are_there(comb));
}

/// Whether two edges of an outline meet where they need not.
bool touches_itself(const std::vector<Vector2d>& o) {
  const std::size_t n = o.size();
  const auto side = [](const Vector2d& a, const Vector2d& b, const Vector2d& c) {
    const double twice = cross(b - a, c - a);
    return (twice > 0) - (twice < 0);
  };
  const auto on = [&](const Vector2d& a, const Vector2d& b, const Vector2d& c) {
    return side(a, b, c) == 0 && (c - a).dot(c - b) <= 0;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d &a = o[i], &b = o[(i + 1) % n];
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vector2d &c = o[j], &d = o[(j + 1) % n];
      if (j == i + 1 ? on(a, b, d) || on(c, d, a) : (j + 1) % n == i ? on(a, b, c) || on(c, d, b) : false) return true;
      if (j == i + 1 || (j + 1) % n == i) continue;
      if (on(a, b, c) || on(a, b, d) || on(c, d, a) || on(c, d, b)) return true;
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
    }
  }
  return false;
}

TEST_CASE("polygon: of corners on a small grid all that are simple are cut, and what is cut is covered once") {
  std::mt19937 random(7);
  int simple = 0, touching = 0, refused = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    CAPTURE(trial);
    std::vector<Vector2d> outline(4 + random() % 5);
    for (Vector2d& p : outline) p = Vector2d(random() % 4, random() % 4);
    const bool touches = touches_itself(outline);
    if (!cut_into_triangles(flat(outline), in_order(outline.size()))) {
      REQUIRE(touches);
      ++refused;
      continue;
    }
    touches ? ++touching : ++simple;
    double area = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) area += cross(outline[i], outline[(i + 1) % outline.size()]);
    if (area != 0) check(outline, static_cast<std::uint32_t>(trial));
  }
  CAPTURE(simple, touching, refused);
  CHECK((simple > 500 && touching > 500 && refused > 5000));
}

TEST_CASE("polygon: in space the triangles have its area and go around as it does") {
  const auto seed = GENERATE(range(1u, 11u));
  CAPTURE(seed);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
  // Turned, the polygon is flat and its corners are on lines up to roundings alone.
  const std::vector<Vector2d> outline{{0, 0}, {2, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0},
                                      {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
  std::vector<Vector3d> places;
  for (const Vector2d& p : outline) places.push_back(turn * Vector3d(p[0], p[1], 0) + Vector3d(100, 200, 300));
  Vector3d area = Vector3d::Zero();
  for (const auto& [a, b, c] : cut(places)) {
    const Vector3d of_triangle = (places[b] - places[a]).cross(places[c] - places[a]) / 2;
    CHECK((of_triangle.dot(turn * Vector3d::UnitZ()) > 0 || of_triangle.norm() < 1e-10));
    area += of_triangle;
  }
  CHECK((area - turn * Vector3d(0, 0, 12)).norm() < 1e-10);
}

TEST_CASE("polygon: one that is not flat, and the shorter diagonal of four corners") {
  const std::vector<Vector3d> saddle{{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}, {-0.5, 0.5, 0.25}};
  double area = 0;
  for (const auto& [a, b, c] : cut(saddle)) {
    area += (saddle[b] - saddle[a]).cross(saddle[c] - saddle[a])[2] / 2;
  }
  CHECK(area == Approx(1.25));
  CHECK(cut(flat({{0, 0}, {3, 0}, {2, 1}, {0, 1}})) == Triangles{{0, 1, 2}, {0, 2, 3}});
  CHECK(cut(flat({{0, 0}, {2, 0}, {3, 1}, {0, 1}})) == Triangles{{0, 1, 3}, {1, 2, 3}});
}

TEST_CASE("polygon: one that crosses itself is not cut, one without area gives one such triangle") {
  const auto refused = [](const std::vector<Vector2d>& outline) {
    CHECK_FALSE(cut_into_triangles(flat(outline), in_order(outline.size())));
  };
  refused({{0, 0}, {1, 1}, {1, 0}, {0, 1}});                          // a bow-tie, of no area
  refused({{0, 0}, {2, 2}, {2, 0}, {0, 1}});                          // and of some
  refused({{0, 3}, {2, -2}, {-3, 1}, {3, 1}, {-2, -2}});              // a pentagram
  refused({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {3, 5}, {1, 2}});  // its hole leads out
  for (const auto& outline : std::vector<std::vector<Vector2d>>{{{0, 0}, {1, 1}, {2, 2}, {3, 3}},
                                                                {{0, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 0}},
                                                                {{1, 2}, {0, 0}, {1, 2}, {1, 1}, {3, 1}, {1, 1}},
                                                                {{1, 1}, {1, 1}, {1, 1}, {1, 1}},
                                                                {{1, 2}}}) {
    const auto triangles = cut(flat(outline));
    REQUIRE(triangles.size() == 1);
    const auto at = [&](std::size_t k) { return outline[triangles[0][k]]; };
    CHECK(cross(at(1) - at(0), at(2) - at(0)) == 0);
  }
}

TEST_CASE("polygon: sides are decided exactly, however thin and however small") {
  // The third corner is above the line by one rounding; the last is on it.
  const double tiny = 0x1p-300;
  for (const double size : {1.0, tiny, 1 / tiny}) {
    CAPTURE(size);
    const std::vector<Vector2d> thin{
        {0, 0}, {3 * size, 3 * size}, {2 * size, std::nextafter(2, 3) * size}, {size, size}};
    const auto triangles = cut(flat(thin));
    CHECK(triangles == Triangles{{1, 2, 3}});
  }
}

}  // namespace
}  // namespace test_polygon
