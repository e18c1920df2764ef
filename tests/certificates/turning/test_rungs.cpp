// Each rung of the ladder by itself: what it says holds the truth, and is as narrow as it should be.
#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/normal_along_edge.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "tests/certificates/turning/check_turning.hpp"
#include "tests/certificates/turning/turning_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>

namespace test_rungs {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::EdgeEdgeSeparation;
using certificates::NormalAlongEdge;
using certificates::RigidMotion;
using certificates::VertexFaceSeparation;
using Eigen::Vector3d;

/// The factor by which Turner multiplies the vectors of a body.
template <int Degree>
Real scale_of(const RigidMotion<Degree>& motion) {
  Real square = 0;
  for (const double x : motion.orientation.coeffs()) square += Real(x) * Real(x);
  if (motion.spin().still()) return square;
  const RealVector w = real(motion.angular_velocity);
  return square * inner(w, w);
}

/// The greatest share of its radius that a value was off, and the greatest radius relative to the size of the terms.
struct Widths {
  double share = 0, radius = 0;

  template <class T>
  void take(const Ball<T>& ball, const Real& truth, const Real& size) {
    if (!(ball.radius < 1e300)) return;
    const Real middle = Real(static_cast<double>(ball.middle)) + low(ball.middle);
    const Real error = abs(middle - truth);
    // A radius may be 0: the value is known exactly, but the truth only to some 60 digits, of a difference.
    share = std::max(share, error <= size * Real("1e-50") ? 0 : static_cast<double>(error / Real(ball.radius)));
    radius = std::max(radius, static_cast<double>(Real(ball.radius) / size));
  }

 private:
  static Real low(double) { return 0; }
  static Real low(const DoubleDouble& x) { return x.low; }
};

struct Rungs {
  Widths quick, doubles, turned, extended, slope;  // turned: vectors in double-doubles, with one bound for all

  template <class Certificate>
  void take(const Certificate& f, double t) {
    TrueSigns<Certificate> signs(f, t);
    const TrueValue truth = signs.value_at(t);
    if (truth.size == 0) return;
    quick.take(f.quick_value(t), truth.value, truth.size);
    const Real scale = scale_of(f.a) * scale_of(f.b);
    const Real value = truth.value * scale;
    const Real size = truth.size * scale;
    doubles.take(kds::detail::turning_value<Ball<double>>(f, t), value, size);
    turned.take(f.extended_value(t), value, size);
    extended.take(kds::detail::turning_value<Ball<DoubleDouble>>(f, t), value, size);
    const Real rate = 1 + length(real(f.a.angular_velocity)) + length(real(f.b.angular_velocity));
    const Real h = Real("1e-30") / rate;
    const Real growth = (signs.value_after(t, h).value - signs.value_after(t, -h).value) / (2 * h);
    slope.take(kds::detail::turning_derivative<Ball<DoubleDouble>>(TurningReference(f), t, 1), growth * scale,
               size * rate);
  }
};

}  // namespace

TEST_CASE("each rung holds the truth", "[turning]") {
  const std::uint64_t seed = 380;
  CAPTURE(seed);
  Random random(seed);
  Rungs near;  // angles up to some radians
  Rungs any;
  for (int round = 0; round < 400; ++round) {
    const bool coarse = random.one_in(4);
    const auto scene = turning_scene<2>(random, coarse);
    const double t = scene.time + random.between(-1, 1) * scene.span;
    const auto angle = [&](const RigidMotion<2>& m) { return m.angular_velocity.norm() * std::abs(t - m.start()); };
    Rungs& rungs = angle(scene.a) < 10 && angle(scene.b) < 10 ? near : any;
    VertexFaceSeparation<2> f{scene.a, scene.b, turning_vector(random, coarse), {}};
    for (Vector3d& corner : f.corners) corner = turning_vector(random, coarse);
    rungs.take(f, t);
    rungs.take(EdgeEdgeSeparation<2>{scene.a, scene.b, {f.vertex, f.corners[0]}, {f.corners[1], f.corners[2]}}, t);
    // Of the third kind the two values in double-doubles have to agree.
    const NormalAlongEdge<2> leaning{scene.a, scene.b, f.corners, {f.vertex, turning_vector(random, coarse)}};
    const Ball<DoubleDouble> turned = leaning.extended_value(t);
    const auto added = kds::detail::turning_value<Ball<DoubleDouble>>(leaning, t);
    const double apart = std::abs((turned.middle - added.middle).high);
    CHECK_FALSE(apart > (turned.radius + added.radius) * Ball<double>::slack);
  }
  for (const Rungs* rungs : {&near, &any}) {
    CAPTURE(rungs->quick.radius, rungs->doubles.radius, rungs->turned.radius, rungs->extended.radius);
    CAPTURE(rungs->slope.radius);
    CAPTURE(rungs->quick.share, rungs->doubles.share, rungs->turned.share, rungs->extended.share, rungs->slope.share);
    CHECK(rungs->quick.share < 1);
    CHECK(rungs->doubles.share < 1);
    CHECK(rungs->turned.share < 1);
    CHECK(rungs->extended.share < 1);
    CHECK(rungs->slope.share < 1);
  }
  CHECK(near.quick.radius < 0x1p-40);
  CHECK(near.turned.radius < 0x1p-86);
  CHECK(near.turned.share > 0.00001);
  CHECK(near.extended.radius < 0x1p-88);
  CHECK(near.quick.share > 0.001);
  CHECK(near.extended.share > 0.0001);
  CHECK(any.extended.radius < 0x1p-60);
}

}  // namespace test_rungs
