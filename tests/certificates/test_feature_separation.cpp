#include "certificates/feature_separation.hpp"
#include "tests/certificates/check_certificate.hpp"

#include <catch2/catch.hpp>

namespace test_feature_separation {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::FeatureSeparation;
using certificates::PointMotion;
using Eigen::Vector3d;

const std::array<Vector3d, 3> world{Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)};

template <int PathDegree>
oracle::Polynomial expected(const FeatureSeparation<PathDegree>& feature) {
  const auto a = exact(feature.a);
  const auto b = exact(feature.b);
  oracle::Polynomial f = oracle::Polynomial() - exact(feature.radius) * exact(feature.radius);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!feature.used[i]) continue;
    oracle::Polynomial x = oracle::Polynomial() - exact(feature.offset[i]);
    for (std::size_t d = 0; d < 3; ++d) x = x + (b[d] - a[d]) * exact(feature.axes[i][static_cast<int>(d)]);
    f = f + x * x;
  }
  return f;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a ball is away from a vertex or an edge by the square of its distance", "[feature_separation]",
                       ((int PathDegree), PathDegree), 1, 2) {
  const std::uint64_t seed = 120;
  CAPTURE(PathDegree, seed);
  Random random(seed);
  for (int round = 0; round < 100; ++round) {
    const bool coarse = random.one_in(2);
    const double start = random_start(random, coarse);
    const auto a = random_path<PathDegree>(random, coarse, start);
    const auto b = random_path<PathDegree>(random, coarse, random.one_in(2) ? start : random_start(random, coarse));
    FeatureSeparation<PathDegree> feature{a, b, world, {}, {true, true, true}, random.integer(1, 6) / 4.0};
    for (auto& axis : feature.axes) {
      if (!coarse) axis = random_point(random, false);
    }
    for (double& offset : feature.offset) offset = coarse ? random.integer(-2, 2) / 2.0 : random.between(-1, 1);
    if (random.one_in(2)) feature.used[random.below(3)] = false;
    CAPTURE(round, coarse);
    CHECK(mistakes(feature, expected(feature), random) == 0);
  }
}

TEST_CASE("a ball meets a corner and slips past an edge", "[feature_separation]") {
  const PointMotion<1> box{{Vector3d(0, 0, 0), Vector3d::Zero()}, 0};
  const PointMotion<1> ball{{Vector3d(5, 1, 1), Vector3d(-1, 0, 0)}, 0};
  // The corner (1, 1, 1), hit head on.
  CHECK(failure_time(FeatureSeparation<1>{box, ball, world, {1, 1, 1}, {true, true, true}, 2}, 0) == 2);
  // The edge along z through (1, 0): at the distance of the radius, so it is grazed only.
  CHECK(failure_time(FeatureSeparation<1>{box, ball, world, {1, 0, 9}, {true, true, false}, 1}, 0) == never);
  CHECK(failure_time(FeatureSeparation<1>{box, ball, world, {1, 0, 9}, {true, true, false}, next_up(1)}, 0) < 4);
  // An axis that is not used does not count, wherever its offset.
  CHECK(failure_time(FeatureSeparation<1>{box, ball, world, {1, 1, 9}, {true, true, false}, 2}, 0) == 2);
}

}  // namespace test_feature_separation
