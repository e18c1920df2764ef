// Delaunay triangulation and convex hull against exact brute force.
#include "certificates/plane_motion.hpp"
#include "structures/convex_hull.hpp"
#include "structures/delaunay.hpp"
#include "tests/support/exact_algebra.hpp"
#include "tests/structures/run_structure.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::ConvexHullRule;
using structures::Criterion;
using structures::DelaunayRule;
using structures::PlaneTriangulationRule;
using structures::TriangleMesh;

/// Points just after a time, exactly. Shares no code with the library.
class ExactPlane {
 public:
  template <int Degree>
  ExactPlane(const MovingSet<PlaneMotion<Degree>>& set, double now) : now_(oracle::rational(now)) {
    for (const Id id : set.ids()) {
      for (int d = 0; d < 2; ++d) {
        const auto axis = set[id].axis(d);
        points_[id][static_cast<std::size_t>(d)] =
            oracle::Polynomial::motion({axis.position.c.begin(), axis.position.c.end()}, axis.start);
      }
    }
  }
  int orientation(Id a, Id b, Id c) const {
    const auto u = from(a, b), v = from(a, c);
    return (u[0] * v[1] - u[1] * v[0]).sign_after(now_);
  }
  /// +1 if d is inside the circle through a, b, c, which turn left.
  int inside(Id a, Id b, Id c, Id d) const {
    const auto u = from(d, a), v = from(d, b), w = from(d, c);
    const auto lift = [](const Point& p) { return p[0] * p[0] + p[1] * p[1]; };
    const auto cross = [](const Point& p, const Point& q) { return p[0] * q[1] - p[1] * q[0]; };
    return (lift(u) * cross(v, w) + lift(v) * cross(w, u) + lift(w) * cross(u, v)).sign_after(now_);
  }
  bool same(Id a, Id b) const {
    const auto u = from(a, b);
    return u[0].sign_after(now_) == 0 && u[1].sign_after(now_) == 0;
  }
  std::vector<Id> ids() const {
    std::vector<Id> result;
    for (const auto& [id, point] : points_) result.push_back(id);
    return result;
  }

 private:
  using Point = std::array<oracle::Polynomial, 2>;
  Point from(Id a, Id b) const {
    return {points_.at(b)[0] - points_.at(a)[0], points_.at(b)[1] - points_.at(a)[1]};
  }
  std::map<Id, Point> points_;
  oracle::Rational now_;
};

/// Every triangle turns left, every edge of the hull has all points on its left, no point is inside a circle; and there
/// are as many triangles as the vertices must have.
template <int Degree, Criterion What>
int check_triangulation(const PlaneTriangulationRule<PlaneMotion<Degree>, What>& rule,
                        const MovingSet<PlaneMotion<Degree>>& set, double now) {
  const ExactPlane plane(set, now);
  const auto ids = plane.ids();
  const TriangleMesh& mesh = rule.mesh();
  int wrong = 0;
  if (rule.flat()) {
    for (const Id a : ids) {
      for (const Id b : ids) {
        for (const Id c : ids) wrong += a < b && b < c && plane.orientation(a, b, c) != 0;
      }
    }
    return wrong;
  }
  std::size_t vertices = 0, triangles = 0;
  for (const Id id : ids) {
    vertices += mesh.contains(id);
    wrong += rule.vertex(id) != id && !plane.same(id, rule.vertex(id));
    wrong += mesh.contains(id) != (rule.vertex(id) == id);
  }
  const std::vector<Id> hull = rule.hull();
  for (std::uint32_t t = 0; t < mesh.end_triangle(); ++t) {
    if (!mesh.in_use(t) || !mesh.finite(t)) continue;
    ++triangles;
    const Id a = mesh.origin(3 * t), b = mesh.origin(3 * t + 1), c = mesh.origin(3 * t + 2);
    wrong += plane.orientation(a, b, c) <= 0;
    if (What != Criterion::delaunay) continue;
    for (const Id d : ids) wrong += d != a && d != b && d != c && plane.inside(a, b, c, d) > 0;
  }
  wrong += triangles != 2 * vertices - 2 - hull.size();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Id a = hull[i], b = hull[(i + 1) % hull.size()];
    for (const Id c : ids) wrong += plane.orientation(a, b, c) < 0;
  }
  return wrong;
}

template <int Degree>
PlaneMotion<Degree> random_point(Random& random, Kind kind, double now) {
  const auto x = random_motion<Degree>(random, kind, now);
  const auto y = random_motion<Degree>(random, kind, now);
  return {{x.position, y.position}, x.start};
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a kinetic Delaunay triangulation is Delaunay, exactly", "[delaunay]", ((int Degree), Degree), 1,
                       2) {
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 800; seed < (Degree == 1 ? 803u : 801u); ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      std::vector<KineticEvent> log;
      const RunOptions options{10, 4 + 4 * (seed % 3), 14, seed % 2 == 0 ? never : 0.4};
      CHECK(run_structure(seed, kind, options, DelaunayRule<PlaneMotion<Degree>>{}, random_point<Degree>,
                          check_triangulation<Degree, Criterion::delaunay>, log) == 0);
    }
  }
}

TEMPLATE_TEST_CASE_SIG("a kinetic convex hull is the hull, exactly", "[hull]", ((int Degree), Degree), 1, 2) {
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 810; seed < 813; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      std::vector<KineticEvent> log;
      const RunOptions options{12, 4 + 4 * (seed % 3), 14, seed % 2 == 0 ? never : 0.4};
      CHECK(run_structure(seed, kind, options, ConvexHullRule<PlaneMotion<Degree>>{}, random_point<Degree>,
                          check_triangulation<Degree, Criterion::hull>, log) == 0);
    }
  }
}
