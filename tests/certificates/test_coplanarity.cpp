#include "certificates/coplanarity.hpp"
#include "tests/certificates/check_certificate.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace kds;
using namespace kds::tests;
using certificates::Coplanarity;
using certificates::PointMotion;
using Eigen::Vector3d;

/// The determinant of the four points with ones below, which is the same volume in another way.
template <int PathDegree>
oracle::Polynomial expected(const Coplanarity<PathDegree>& f) {
  const std::array p{exact(f.a), exact(f.b), exact(f.c), exact(f.d)};
  const auto minor = [&](std::size_t i, std::size_t j, std::size_t k) {
    return p[i][0] * (p[j][1] * p[k][2] - p[j][2] * p[k][1]) - p[i][1] * (p[j][0] * p[k][2] - p[j][2] * p[k][0]) +
           p[i][2] * (p[j][0] * p[k][1] - p[j][1] * p[k][0]);
  };
  return (minor(1, 2, 3) - minor(0, 2, 3) + minor(0, 1, 3) - minor(0, 1, 2)) * exact(f.side);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("coplanarity is the volume of a tetrahedron", "[coplanarity]", ((int PathDegree), PathDegree), 1,
                       2) {
  const std::uint64_t seed = 130;
  CAPTURE(PathDegree, seed);
  Random random(seed);
  int wrong = 0;
  for (int round = 0; round < (PathDegree == 1 ? 60 : 25); ++round) {
    const bool coarse = random.one_in(2);
    const double start = random_start(random, coarse);
    const auto path = [&] {
      return random_path<PathDegree>(random, coarse, random.one_in(2) ? start : random_start(random, coarse));
    };
    const auto a = path(), b = path(), c = path(), d = path();
    const Coplanarity<PathDegree> f{a, b, c, d, random.one_in(2) ? 1.0 : -1.0};
    wrong += mistakes(f, expected(f), random);
  }
  CHECK(wrong == 0);
}

TEST_CASE("a vertex comes to the plane of a face, and lines to each other", "[coplanarity]") {
  const auto at = [](double x, double y, double z, double speed = 0) {
    return PointMotion<1>{{Vector3d(x, y, z), Vector3d(0, 0, speed)}, 0};
  };
  const auto o = at(0, 0, 0), x = at(1, 0, 0), y = at(0, 1, 0);
  const auto above = at(5, 7, 3, -1.5);
  // Counter-clockwise seen from above: positive while d is above. It comes to the plane, not to the face.
  CHECK(failure_time(Coplanarity<1>{o, x, y, above}, 0) == 2);
  CHECK(failure_time(Coplanarity<1>{o, x, y, above, -1}, 0) == 0);
  const auto left = at(0, -1, 1, -2), right = at(0, 1, 1, -2);
  // The edge from left to right falls through that from o to x.
  CHECK(failure_time(Coplanarity<1>{o, x, left, right}, 0) == 0);
  CHECK(failure_time(Coplanarity<1>{o, x, left, right, -1}, 0) == 0.5);
  CHECK(recovery_time(Coplanarity<1>{o, x, left, right}, 0) == 0.5);
}
