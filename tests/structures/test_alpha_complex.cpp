// The alpha complex against exact brute force.
#include "kds/testing/trial.hpp"
#include "structures/alpha_complex.hpp"
#include "structures/closest_pair.hpp"
#include "tests/structures/exact_plane.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/sampled_orbits.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace test_alpha_complex {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::AlphaComplexRule;
using structures::AlphaTriangleChange;
using structures::DelaunayRule;
using structures::EdgeChange;
using structures::TriangleMesh;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;

/// By the definition: is there an open disc of at most the radius that contains no vertex, with the ends on its border?
/// The smallest has the ends on a diameter, or three points on its border.
bool has_empty_disc(const ExactPlane& plane, const std::vector<Id>& vertices, double radius, Id a, Id b) {
  const auto none = [&](const auto& is_inside) { return std::none_of(vertices.begin(), vertices.end(), is_inside); };
  if (plane.compare_diameter(radius, a, b) < 0) return false;
  if (none([&](Id c) { return c != a && c != b && plane.outside_disc(a, b, c) < 0; })) return true;
  return std::any_of(vertices.begin(), vertices.end(), [&](Id c) {
    if (c == a || c == b) return false;
    const int turn = plane.orientation(a, b, c);
    const Id p = turn > 0 ? a : b, q = turn > 0 ? b : a;
    return turn != 0 && plane.compare_circle(radius, p, q, c) >= 0 &&
           none([&](Id d) { return d != a && d != b && d != c && plane.inside(p, q, c, d) > 0; });
  });
}

/// Of triangles it is the circle that decides, and of edges the definition; both of all that the triangulation has.
template <int Degree>
int check_complex(const AlphaComplexRule<PlaneMotion<Degree>>& rule, const MovingSet<PlaneMotion<Degree>>& set,
                  double now) {
  const auto& delaunay = rule.inner();
  if (delaunay.flat()) return !rule.edges().empty() + !rule.triangles().empty();
  const ExactPlane plane(set, now);
  std::vector<Id> vertices;
  for (const Id id : plane.ids()) {
    if (delaunay.vertex(id) == id) vertices.push_back(id);
  }
  const TriangleMesh& mesh = delaunay.mesh();
  std::vector<std::array<Id, 3>> triangles;
  for (std::uint32_t t = 0; t < mesh.end_triangle(); ++t) {
    if (!mesh.in_use(t) || !mesh.finite(t)) continue;
    std::array<Id, 3> corners{mesh.origin(3 * t), mesh.origin(3 * t + 1), mesh.origin(3 * t + 2)};
    if (plane.compare_circle(rule.radius(), corners[0], corners[1], corners[2]) < 0) continue;
    std::sort(corners.begin(), corners.end());
    triangles.push_back(corners);
  }
  std::sort(triangles.begin(), triangles.end());
  std::vector<std::array<Id, 2>> edges;
  for (std::uint32_t edge = 0; edge < delaunay.edges().end(); ++edge) {
    if (!delaunay.edges().contains(edge)) continue;
    const auto [a, b] = delaunay.edges().ends(edge);
    if (has_empty_disc(plane, vertices, rule.radius(), a, b)) edges.push_back({a, b});
  }
  std::sort(edges.begin(), edges.end());
  return (rule.triangles() != triangles) + (rule.edges() != edges);
}

/// What it knows of the edges, or of the triangles, by what it has been told alone.
template <class Path, class Told>
struct ToldRule : StandsOn<Telling<AlphaComplexRule<Path>, Told>> {
  static constexpr const char* name = "Told";
  static constexpr std::size_t corners = std::is_same_v<Told, EdgeChange> ? 2 : 3;
  std::vector<std::array<Id, corners>> known{};  ///< by number
  int wrong = 0, moved = 0;

  std::monostate certificate(Slot, const MovingSet<Path>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Path>&) { return Effect::internal; }
  Effect follow(std::span<const Told> changes, Repair<Path>&) {
    for (const Told& change : changes) {
      const auto [number, ids] = parts(change);
      std::array<Id, corners> none;
      none.fill(nobody);
      if (number >= known.size()) known.resize(number + std::size_t{1}, none);
      wrong += known[number] != (change.what == EdgeChange::What::came ? none : ids);
      known[number] = change.what == EdgeChange::What::went ? none : ids;
      moved += change.what == EdgeChange::What::moved;
    }
    return Effect::external;
  }
  std::vector<std::array<Id, corners>> all() const {
    auto result = known;
    std::erase_if(result, [](const auto& ids) { return ids[0] == nobody; });
    std::sort(result.begin(), result.end());
    return result;
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(known, wrong, moved);
  }

 private:
  static auto parts(const Told& change) {
    if constexpr (corners == 2) {
      return std::pair(change.edge, change.ends);
    } else {
      return std::pair(change.triangle, change.corners);
    }
  }
};

/// Another radius now and then.
struct OtherRadius {
  template <class Structure>
  void operator()(Structure& structure, Random& random, double now) const {
    if (random.one_in(2)) return;
    const double radius = random.integer(0, 8) / 4.0;
    structure.edit([&](auto& rule, auto& repair) { rule.set_radius(radius, repair); }, now);
  }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("the kinetic alpha complex is that of its points, exactly", "[alpha_complex]",
                       ((int Degree), Degree), 1, 2) {
  using Rule = AlphaComplexRule<PlaneMotion<Degree>>;
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = Degree == 1 ? 650 : 653; seed < (Degree == 1 ? 653u : 654u); ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 6, 2 + 3 * (seed % 3), 8, seed % 2 == 0 ? never : 0.4, 8};
      const Findings found = try_rule(options, Rule(kind == Kind::scales ? 1000 : 1), random_plane_motion<Degree>,
                                      check_complex<Degree>, OtherRadius{});
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 200);
}

TEST_CASE("an alpha complex grows with its radius, and tells what comes and goes", "[alpha_complex]") {
  MovingSet<PlaneMotion<1>> set;
  const auto at = [](double x, double y, double vx = 0) { return PlaneMotion<1>{{{{{x, vx}}, {{y, 0}}}}, 0}; };
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(set, 0);
  using Rule = AlphaComplexRule<PlaneMotion<1>>;
  Kinetic<Rule> complex(triangulation, 0, Rule(1));
  Kinetic<ToldRule<PlaneMotion<1>, EdgeChange>> edges(complex, 0);
  Kinetic<ToldRule<PlaneMotion<1>, AlphaTriangleChange>> triangles(complex, 0);
  Simulator simulator(0, triangulation, complex, edges, triangles);
  using Edges = std::vector<std::array<Id, 2>>;
  using Triangles = std::vector<std::array<Id, 3>>;
  const auto right = [&](const Edges& border, const Triangles& inside) {
    simulator.audit();
    return edges.rule().wrong + triangles.rule().wrong == 0 && complex.rule().border() == border &&
           triangles.rule().all() == inside && complex.rule().edges() == edges.rule().all() &&
           check_complex<1>(complex.rule(), set, simulator.now()) == 0;
  };
  const auto resize = [&](double radius) {
    complex.edit([&](Rule& rule, Rule::Pen& repair) { rule.set_radius(radius, repair); }, simulator.now());
  };
  set.insert(0, at(0, 0), 0);
  set.insert(1, at(6, 0), 0);
  set.insert(2, at(0, 8), 0);
  set.insert(3, at(30, 0, -1), 0);
  CHECK(right({}, {}));
  resize(3);
  CHECK(right({{0, 1}}, {}));  // its disc is just large enough
  resize(4.5);
  CHECK(right({{0, 1}, {0, 2}}, {}));
  resize(5);
  CHECK(right({{0, 1}, {0, 2}, {1, 2}}, {{0, 1, 2}}));  // right-angled: the longest side is a diameter of its circle
  simulator.advance_to(13.75);                          // 3 at (16.25, 0)
  CHECK(right({{0, 1}, {0, 2}, {1, 2}}, {{0, 1, 2}}));
  simulator.advance_to(14.25);  // nearer to 1 than 10
  CHECK(right({{0, 1}, {0, 2}, {1, 2}, {1, 3}}, {{0, 1, 2}}));
  const int before = triangles.rule().moved;
  set.update(1, at(6, 0.25), simulator.now());  // the triangles stay
  CHECK(triangles.rule().moved > before);
  CHECK(edges.rule().moved > 0);
  resize(0);
  CHECK(right({}, {}));
  CHECK_THROWS_WITH(Rule(-1), Catch::Contains("radius must be >= 0"));
  CHECK_THROWS_AS(Rule(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

TEST_CASE("an alpha complex keeps to its measures", "[alpha_complex]") {
  const std::uint64_t seed = 656, n = 40;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> set;
  for (Id id = 0; id < n; ++id) set.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(set, 0);
  Kinetic<AlphaComplexRule<PlaneMotion<1>>> complex(triangulation, 0, AlphaComplexRule<PlaneMotion<1>>(0.3));
  Kinetic<structures::ClosestPairRule<PlaneMotion<1>>> closest(triangulation, 0);  // told of edges, on the same one
  Simulator simulator(0, triangulation, complex, closest);
  simulator.advance_to(1);
  simulator.audit();
  const Measures m = complex.measures();
  CHECK(check_complex<1>(complex.rule(), set, 1) == 0);
  CHECK(m.events > 100);
  CHECK(m.external > m.events / 2);
  CHECK(m.most_held < 11 * n);  // compact
  CHECK(m.most_touched <= 20);  // responsive
  CHECK(closest.measures().followed == complex.measures().followed);
}

TEST_CASE("an alpha complex of sampled points is that of the truth but for a tick", "[alpha_complex][bounded]") {
  using certificates::BoundedPoint;
  const std::uint64_t seed = 657;
  CAPTURE(seed);
  Random random(seed);
  const Id n = 12;
  const Orbits orbits(random, n);  // known to the sampler only
  const auto sample = [&](Id id, double t) { return BoundedPoint{orbits.position(id, t), orbits.speed(id), t}; };
  MovingSet<BoundedPoint> set;
  set.sample_with(sample, 0.01);
  for (Id id = 0; id < n; ++id) set.insert(id, sample(id, 0), 0);
  const double radius = 0.3;
  Kinetic<DelaunayRule<BoundedPoint>> triangulation(set, 0);
  Kinetic<AlphaComplexRule<BoundedPoint>> complex(triangulation, 0, AlphaComplexRule<BoundedPoint>(radius));
  Simulator simulator(0, triangulation, complex);
  std::size_t all = 0, other = 0;
  std::vector<std::array<Id, 2>> first;
  bool changes = false;
  for (double t = 0.125; t <= 8; t += 0.125) {
    simulator.advance_to(t);
    simulator.audit();
    using Path = PlaneMotion<1>;
    MovingSet<Path> truth;  // at rest, as they are at t
    for (Id id = 0; id < n; ++id) {
      const auto [x, y] = orbits.position(id, t);
      truth.insert(id, Path{{{{{x, 0}}, {{y, 0}}}}, t}, t);
    }
    const Kinetic<DelaunayRule<Path>> true_triangulation(truth, t);
    const auto edges = complex.rule().edges();
    std::vector<std::array<Id, 2>> expected, missing;
    std::vector<Id> vertices = truth.ids();
    for (std::uint32_t edge = 0; edge < true_triangulation.rule().edges().end(); ++edge) {
      const auto [a, b] = true_triangulation.rule().edges().ends(edge);
      if (has_empty_disc(ExactPlane(truth, t), vertices, radius, a, b)) expected.push_back({a, b});
    }
    std::sort(expected.begin(), expected.end());
    std::set_symmetric_difference(edges.begin(), edges.end(), expected.begin(), expected.end(),
                                  std::back_inserter(missing));
    other += missing.size();
    all += expected.size();
    if (first.empty()) first = expected;
    changes = changes || expected != first;
  }
  CHECK(changes);
  CHECK(all > 500);
  CHECK(100 * other < all);
}

}  // namespace test_alpha_complex
