// Failure times of vertices and faces, and of edges, of bodies that turn: against their signs.
#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "kds/turning/turning_failure_time.hpp"
#include "tests/certificates/turning/turning_scenes.hpp"
#include "tests/kds/turning/check_turning_failure_time.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace test_turning_failure_time {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::EdgeEdgeSeparation;
using certificates::RigidMotion;
using certificates::VertexFaceSeparation;
using Eigen::Vector3d;

struct Tally {
  int wrong = 0, failures = 0, recoveries = 0, zero = 0;
};

/// Values in double-doubles guide the search for low ones.
template <class Certificate>
void check(const Certificate& f, double now, double horizon, Tally& tally) {
  const auto value = [&](long double t) {
    const auto ball = kds::detail::turning_value<Ball<DoubleDouble>>(f, static_cast<double>(t));
    return static_cast<long double>(ball.middle.high) + static_cast<long double>(ball.middle.low);
  };
  if (vanishes(f)) {
    ++tally.zero;
    tally.wrong += failure_time(f, now, horizon) != never || recovery_time(f, now, horizon) != never;
    return;
  }
  const double t = failure_time(f, now, horizon);
  tally.failures += t != never;
  tally.wrong += refutations(f, value, 1, now, horizon, t, 100);
  if (t == never) return;
  const double again = recovery_time(f, t, horizon);
  tally.recoveries += again != never;
  tally.wrong += refutations(f, value, -1, t, horizon, again, 100);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("failure times of bodies that turn are refuted by no sign", "[turning]", ((int Degree), Degree),
                       1, 2) {
  const std::uint64_t seed = 390 + Degree;
  CAPTURE(Degree, seed);
  Random random(seed);
  for (const bool coarse : {false, true}) {
    Tally tally;
    turning_search_counters = {};
    for (int round = 0; round < 60; ++round) {
      const auto scene = turning_scene<Degree>(random, coarse);
      VertexFaceSeparation<Degree> f{scene.a, scene.b, turning_vector(random, coarse), {}};
      for (Vector3d& corner : f.corners) corner = turning_vector(random, coarse);
      check(f, scene.time, scene.time + 6 * scene.span, tally);
      const EdgeEdgeSeparation<Degree> g{
          scene.a, scene.b, {f.vertex, f.corners[0]}, {f.corners[1], turning_vector(random, coarse)}};
      check(g, scene.time, scene.time + 6 * scene.span, tally);
    }
    const TurningSearchCounters& n = turning_search_counters;
    std::printf(
        "%s, seed %llu: %d failures, %d recoveries, %d zero; expansions %llu, finer %llu and %llu, by signs %llu\n",
        coarse ? "bodies that turn, coarse" : "bodies that turn", static_cast<unsigned long long>(seed), tally.failures,
        tally.recoveries, tally.zero, static_cast<unsigned long long>(n.expansions),
        static_cast<unsigned long long>(n.extended), static_cast<unsigned long long>(n.enclosed),
        static_cast<unsigned long long>(n.searches));
    CHECK(tally.wrong == 0);
    CHECK(tally.failures > 40);
    CHECK(tally.recoveries > 20);
  }
}

TEST_CASE("a tip that touches the ground does not fail, one that is nudged down does", "[turning]") {
  const std::array<Vector3d, 3> floor_of_body{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  RigidMotion<1> rod{{{Vector3d(0, 0, 1)}}};  // its end is at height 1 - cos t, of body coordinates (0, 0, -1)
  rod.angular_velocity = {0, 1, 0};
  rod.path.start = 2;  // lowest there, at a double, and again after a turn, which is none
  const RigidMotion<1> ground{{{Vector3d(0, 0, 0)}}};
  const VertexFaceSeparation<1> f{rod, ground, Vector3d(0, 0, -1), floor_of_body};
  CHECK(sign_at(f, 2) == 0);
  CHECK(failure_time(f, 0, 100) == never);
  rod.path.coefficients[0][2] = next_up(1.0);
  CHECK(failure_time(f, 0, 100) == never);
  rod.path.coefficients[0][2] = next_down(1.0);
  const double t = failure_time(f, 0, 100);
  CHECK(std::abs(t - (2 - 0x1p-26)) < 1e-15);
  CHECK(std::abs(recovery_time(f, t, 100) - (2 + 0x1p-26)) < 1e-15);
}

}  // namespace test_turning_failure_time
