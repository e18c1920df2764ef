#include "certificates/plane_separation.hpp"
#include "tests/certificates/check_certificate.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <vector>

namespace test_plane_separation {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneSeparation;
using certificates::PointMotion;
using Eigen::Vector3d;
using oracle::Rational;
using oracle::rational;

Rational dot(const Vector3d& a, const Vector3d& b) {
  return rational(a[0]) * rational(b[0]) + rational(a[1]) * rational(b[1]) + rational(a[2]) * rational(b[2]);
}

template <int PathDegree>
oracle::Polynomial expected(const PlaneSeparation<PathDegree>& planes) {
  const auto a = exact(planes.a);
  const auto b = exact(planes.b);
  oracle::Polynomial f;
  for (std::size_t d = 0; d < 3; ++d) {
    f = f + (b[d] - a[d]) * exact(planes.axis[static_cast<int>(d)]) * exact(planes.side);
  }
  for (const Vector3d* half_axis : planes.extents) {
    if (half_axis) f = f - oracle::Polynomial(abs(dot(planes.axis, *half_axis)));
  }
  for (const double margin : planes.margins) f = f - exact(margin);
  return f;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("bodies are apart along an axis while the gap exceeds their extents", "[plane_separation]",
                       ((int PathDegree), PathDegree), 1, 2) {
  const std::uint64_t seed = 110;
  CAPTURE(PathDegree, seed);
  Random random(seed);
  for (int round = 0; round < 200; ++round) {
    const bool coarse = random.one_in(2);
    const double start = random_start(random, coarse);
    const auto a = random_path<PathDegree>(random, coarse, start);
    const auto b = random_path<PathDegree>(random, coarse, random.one_in(2) ? start : random_start(random, coarse));
    std::vector<Vector3d> half_axes;
    for (int i = 0; i < 6; ++i) half_axes.push_back(random_point(random, coarse) / 4);
    PlaneSeparation<PathDegree> planes{a, b, random_point(random, coarse), random.one_in(2) ? 1.0 : -1.0, {}, {}};
    for (std::size_t i = 0; i < random.below(7); ++i) planes.extents[i] = &half_axes[i];
    if (random.one_in(2)) planes.margins = {random.unit() / 8, random.unit() / 8};
    CAPTURE(round, coarse);
    CHECK(mistakes(planes, expected(planes), random) == 0);
  }
}

TEST_CASE("an axis across which half axes vanish up to rounding has the exact extent", "[plane_separation]") {
  const std::uint64_t seed = 111;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 300; ++round) {
    const auto a = random_path<1>(random, false, 0);
    const auto b = random_path<1>(random, false, 0);
    // Half axes across the axis but for roundings: their extent cancels, and its sign is any.
    const Vector3d u = random_point(random, false);
    const Vector3d v = random_point(random, false);
    const Vector3d axis = u.cross(v);
    const PlaneSeparation<1> planes{a, b, axis, 1, {&u, &v, nullptr, &u}, {}};
    CAPTURE(round);
    CHECK(mistakes(planes, expected(planes), random) == 0);
  }
}

TEST_CASE("motion along the plane but for roundings fails when it must", "[plane_separation]") {
  const std::uint64_t seed = 112;
  CAPTURE(seed);
  Random random(seed);
  int failed = 0;
  for (int round = 0; round < 400; ++round) {
    PointMotion<1> a = random_path<1>(random, false, 0);
    PointMotion<1> b = random_path<1>(random, false, 0);
    // The rate along the axis is a rounding error, or cancels to less than one.
    const double x = 1 + random.integer(0, 9) * 0x1p-52;
    const double y = 1 + random.integer(0, 9) * 0x1p-52;
    const Vector3d axis(x, -1, 0);
    a.coefficients[1] = Vector3d::Zero();
    b.coefficients[1] = Vector3d(y, x * y, 0);
    // And the gap is of a size that the rate may close.
    b.coefficients[0] = a.coefficients[0] = Vector3d::Zero();
    b.coefficients[0][0] = random.scaled(-106, -50);
    const PlaneSeparation<1> planes{a, b, axis, random.one_in(2) ? 1.0 : -1.0, {}, {}};
    CAPTURE(round);
    CHECK(mistakes(planes, expected(planes), random) == 0);
    failed += failure_time(planes, 0) != never && failure_time(planes, 0) != 0;
  }
  CHECK(failed > 20);
}

TEST_CASE("boxes face to face part and meet at their faces", "[plane_separation]") {
  const PointMotion<1> rest{{Vector3d(0, 0, 0), Vector3d::Zero()}, 0};
  const PointMotion<1> coming{{Vector3d(5, 0.3, 0), Vector3d(-1, 0, 0)}, 0};
  const Vector3d x(1, 0, 0);
  const Vector3d y(0, 1, 0);
  const Vector3d z(0, 0, 0.5);
  const PlaneSeparation<1> planes{rest, coming, x, 1, {&x, &y, &z, &x, &y, &z}, {}};
  CHECK(failure_time(planes, 0) == 3);
  CHECK(failure_time(PlaneSeparation<1>{rest, coming, x, 1, {&x, &y, &z, &x, &y, &z}, {0.5, 0.25}}, 0) == 2.25);
  // From the other side they are apart only after they have passed each other.
  const PlaneSeparation<1> other_side{rest, coming, x, -1, {&x, &y, &z, &x, &y, &z}, {}};
  CHECK(failure_time(other_side, 0) == 0);
  CHECK(recovery_time(other_side, 0) == 7);
}

}  // namespace test_plane_separation
