// Certificates of bodies that have not turned yet: the signs are those of the sums that hold at all times.
#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/normal_along_edge.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "kds/turning/turning_certificate.hpp"
#include "tests/certificates/turning/check_turning.hpp"
#include "tests/certificates/turning/turning_scenes.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cstdint>
#include <cstdio>

namespace test_value_at_start {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::EdgeEdgeSeparation;
using certificates::NormalAlongEdge;
using certificates::RigidMotion;
using certificates::VertexFaceSeparation;
using Eigen::Vector3d;

struct Tally {
  int wrong = 0, zeros = 0, plain = 0, later = 0;
};

/// The sum at its epoch, where both cosines are 1 and both sines 0.
template <class Certificate>
int sign_of_sum(const Certificate& f, double t) {
  const auto sum = f.template turning_sum<Exact, Certificate::degree>(t);
  return (sum.p[0][0].c[0] + sum.p[0][1].c[0] + sum.p[1][0].c[0] + sum.p[1][1].c[0]).sign();
}

template <class Certificate>
void compare_at_start(const Certificate& f, double t, Tally& tally) {
  const int sign = sign_of_sum(f, t);
  tally.zeros += sign == 0;
  const bool plain = f.template value_at_start<PlainNumber>(t).is_zero();
  tally.plain += plain;
  tally.wrong += plain && sign != 0;
  tally.wrong += f.template value_at_start<Exact>(t).sign() != sign;
  tally.wrong += detail::sign_at_start(f, t) != sign;
  tally.wrong += sign_at(f, t) != sign;
  const bool turns = !f.spins()[0].still() || !f.spins()[1].still();
  if (turns) tally.wrong += detail::sign_at_start(f, t + 1).has_value();
  tally.later += turns;
}

}  // namespace

TEST_CASE("what has not turned yet has the signs of the sums", "[turning]") {
  const std::uint64_t seed = 351;
  CAPTURE(seed);
  Random random(seed);
  Tally tally;
  for (int round = 0; round < 400; ++round) {
    const bool coarse = round % 2 == 0;
    TurningScene<2> scene = turning_scene<2>(random, coarse);
    const double t = scene.a.start();
    if (scene.b.spin().still()) scene.b.path.start = t - 1;
    if (!scene.b.spin().still()) scene.b.path.start = t;
    if (coarse && random.one_in(2)) scene.b.orientation = scene.a.orientation;
    const auto small = [&] { return static_cast<double>(random.integer(-1, 1)); };
    const auto point = [&]() -> Vector3d {
      if (!coarse) return turning_vector(random, false);
      const double x = small(), y = small(), z = small();
      return {x, y, z};
    };
    compare_at_start(VertexFaceSeparation<2>{scene.a, scene.b, point(), {point(), point(), point()}}, t, tally);
    compare_at_start(VertexFaceSeparation<2>{scene.b, scene.a, point(), {point(), point(), point()}}, t, tally);
    compare_at_start(EdgeEdgeSeparation<2>{scene.a, scene.b, {point(), point()}, {point(), point()}}, t, tally);
    compare_at_start(NormalAlongEdge<2>{scene.a, scene.b, {point(), point(), point()}, {point(), point()}}, t, tally);
  }
  CHECK(tally.wrong == 0);
  CHECK(tally.zeros > 100);
  CHECK(tally.plain > 100);
  std::printf("value at start, seed %llu: %d zeros, of which doubles tell %d\n", static_cast<unsigned long long>(seed),
              tally.zeros, tally.plain);
  CHECK(tally.later > 1000);
}

TEST_CASE("edges that are parallel when bodies begin to turn take no exact numbers", "[turning]") {
  // Two crates that have met face on face, and begin to turn; nothing about their places and spins is short.
  RigidMotion<1> a{{{Vector3d(0.1, 0.2, 0.3), Vector3d(0.3, 0.1, -0.7)}, 0.1}};
  RigidMotion<1> b{{{Vector3d(0.7, -0.1, 1.3), Vector3d(-0.1, 0.2, 0.9)}, 0.1}};
  a.angular_velocity = {0.3, -0.7, 0.1};
  b.angular_velocity = {-0.2, 0.9, 1.1};
  const std::array<Vector3d, 2> edge{Vector3d(-0.5, 0.5, 0.5), Vector3d(0.5, 0.5, 0.5)};
  const EdgeEdgeSeparation<1> f{a, b, edge, {Vector3d(-0.5, -0.5, -0.5), Vector3d(0.5, -0.5, -0.5)}};
  turning_sign_counters = {};
  CHECK(sign_at(f, 0.1) == 0);
  const int after = sign_after(f, 0.1);
  CHECK(after == sign_at(f, 0.1 + 0x1p-20));
  CHECK(after != 0);
  CHECK(turning_sign_counters.zeros == 2);
  CHECK(turning_sign_counters.exact == 2);
  CHECK(turning_sign_counters.enclosed == 0);
  LadderTally tally;
  compare_around(f, 0.1, tally);
  CHECK(tally.wrong == 0);
}

}  // namespace test_value_at_start
