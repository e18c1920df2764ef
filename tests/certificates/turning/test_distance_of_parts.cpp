// Distances of corners, lines and planes of bodies that turn, against the definition in 330 bits.
#include "certificates/turning/distance_of_parts.hpp"
#include "kds/turning/turning_failure_time.hpp"
#include "tests/certificates/turning/check_turning.hpp"
#include "tests/certificates/turning/turning_scenes.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>

namespace test_distance_of_parts {
namespace {

using namespace kds;
using namespace kds::tests;
using namespace kds::certificates;
using Eigen::Vector3d;

/// Numbers of a pair of parts.
struct Parts {
  Vector3d x, y;
  EdgeEnds edge_a, edge_b;
  FaceCorners face;
  std::array<double, 2> radii;
};

Parts random_parts(Random& random, bool coarse) {
  Parts parts;
  parts.x = turning_vector(random, coarse), parts.y = turning_vector(random, coarse);
  for (EdgeEnds* const edge : {&parts.edge_a, &parts.edge_b}) {
    for (Vector3d& end : *edge) end = turning_vector(random, coarse);
  }
  if (random.one_in(4)) parts.edge_b = parts.edge_a;
  if (random.one_in(3)) parts.x = parts.edge_a[0];
  for (Vector3d& corner : parts.face) corner = turning_vector(random, coarse);
  for (double& r : parts.radii) r = coarse ? random.integer(0, 4) * 0.5 : random.between(0, 1.5);
  return parts;
}

/// `make(parts)` is a formula.
template <int Degree, class Make>
void check_signs(const char* what, std::uint64_t seed, const Make& make) {
  CAPTURE(what, Degree, seed);
  Random random(seed);
  for (const bool coarse : {false, true}) {
    LadderTally tally;
    for (int round = 0; round < 80; ++round) {
      const auto scene = turning_scene<Degree>(random, coarse);
      const Parts parts = random_parts(random, coarse);
      const auto formula = make(parts);
      const BetweenParts<Degree, std::decay_t<decltype(formula)>> f{scene.a, scene.b, parts.x, parts.y, formula};
      compare(f, scene.time, scene.span, tally);
    }
    tally.print(what, seed);
    CHECK(tally.wrong == 0);
    CHECK(tally.cases >= 120);
    CHECK(tally.rungs.extended > 60);
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("signs of distances of parts that turn are those of the definition", "[turning]",
                       ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 380 + Degree;
  check_signs<Degree>("beyond an end", seed, [](const Parts& p) { return PastEnd{p.edge_a}; });
  check_signs<Degree>("beyond a side", seed, [](const Parts& p) { return AcrossSide{p.face}; });
  check_signs<Degree>("points apart", seed, [](const Parts& p) { return PointsApart{p.radii}; });
  check_signs<Degree>("point and line apart", seed, [](const Parts& p) { return LineApart{p.edge_a, p.radii}; });
  check_signs<Degree>("edge away from a line", seed, [](const Parts& p) { return AwayFromLine{p.edge_a, p.edge_b}; });
  check_signs<Degree>("point and plane apart", seed, [](const Parts& p) { return PlaneApart{p.face, p.radii}; });
  check_signs<Degree>("lines apart", seed, [](const Parts& p) { return LinesApart{p.edge_a, p.edge_b, p.radii}; });
}

TEST_CASE("two rods that turn come as near as their radii where geometry says", "[turning]") {
  // Lines through the origin and through (0, 0, 1), in planes of z: at a distance of 1 at all times.
  RigidMotion<1> low{{{Vector3d(0, 0, 0)}}}, high{{{Vector3d(0, 0, 1)}}};
  low.angular_velocity = {0, 0, 1};
  high.angular_velocity = {0, 0, -2};
  const EdgeEnds edge{Vector3d(-1, 0, 0), Vector3d(1, 0, 0)};
  using Lines = BetweenParts<1, LinesApart>;
  const Lines touching{low, high, edge[0], edge[0], {edge, edge, {0.5, 0.5}}};
  CHECK(vanishes(touching));
  const Lines apart{low, high, edge[0], edge[0], {edge, edge, {0.5, 0.25}}};
  CHECK(sign_after(apart, 0) == 1);  // they are parallel at 0, where it is zero
  CHECK(sign_at(apart, 0) == 0);
  CHECK(failure_time(apart, 0, 100) == never);
  const Lines deep{low, high, edge[0], edge[0], {edge, edge, {0.5, next_up(0.5)}}};
  CHECK(failure_time(deep, 0, 100) == 0);
  // The upper one comes down: 1 - t = 0.75.
  high.path.coefficients[1] = {0, 0, -1};
  CHECK(failure_time(apart, 0.125, 100) == 0.25);
  // The end of the upper rod and the line of the lower one, which turn as one: at a distance of (1 - t) always.
  high.angular_velocity = low.angular_velocity;
  const BetweenParts<1, LineApart> end{low, high, edge[0], edge[0], {edge, {0.5, 0.25}}};
  CHECK(failure_time(end, 0.125, 100) == 0.25);
  // Parallel at all times: an edge along the other line leads neither away nor nearer.
  CHECK(vanishes(BetweenParts<1, AwayFromLine>{low, high, edge[0], edge[0], {edge, edge}}));
  CHECK(vanishes(Lines{low, high, edge[0], edge[0], {edge, edge, {0.5, 0.25}}}));
}

}  // namespace test_distance_of_parts
