// Certificates of points in space: orientation, the direction of a normal, in-sphere, with weights and without.
#include "certificates/space_certificates.hpp"
#include "tests/certificates/check_certificate.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace test_space_certificates {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::InSphere;
using certificates::NormalDirection;
using certificates::PointMotion;
using certificates::SpaceOrientation;
using certificates::WeightedPoint;

/// The determinant of a square matrix, by its first row: another way than the certificates'.
oracle::Polynomial determinant(const std::vector<std::vector<oracle::Polynomial>>& rows) {
  if (rows.size() == 1) return rows[0][0];
  oracle::Polynomial sum;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<std::vector<oracle::Polynomial>> minor(rows.begin() + 1, rows.end());
    for (auto& row : minor) row.erase(row.begin() + static_cast<std::ptrdiff_t>(i));
    const oracle::Polynomial part = rows[0][i] * determinant(minor);
    sum = i % 2 == 0 ? sum + part : sum - part;
  }
  return sum;
}

/// x, y, z, x^2 + y^2 + z^2 - weight, 1.
template <class Path>
std::vector<oracle::Polynomial> lifted(const Path& path) {
  const auto x = exact(path.axis(0)), y = exact(path.axis(1)), z = exact(path.axis(2));
  auto height = x * x + y * y + z * z;
  if constexpr (certificates::Weighted<Path>) height = height - exact(path.weight());
  return {x, y, z, height, exact(1.0)};
}

template <class Path>
Path random_point(Random& random, bool coarse, double start) {
  const auto path = random_path<Path::degree>(random, coarse, start);
  if constexpr (certificates::Weighted<Path>) {
    Path point{path, {}};
    for (double& c : point.weight_since_start.c) c = coarse ? random.integer(0, 3) : random.between(-1, 1);
    return point;
  } else {
    return path;
  }
}

using Weighted = WeightedPoint<1, 2>;

}  // namespace

TEMPLATE_TEST_CASE("space certificates are the polynomials they say they are", "[space]", PointMotion<1>,
                   PointMotion<2>, (WeightedPoint<1, 0>), Weighted) {
  using Path = TestType;
  const std::uint64_t seed = 180;
  CAPTURE(Path::degree, seed);
  Random random(seed);
  int wrong_orientation = 0, wrong_normal = 0, wrong_sphere = 0;
  for (int round = 0; round < (Path::degree == 1 ? 16 : 4); ++round) {
    const bool coarse = random.one_in(2);
    const double start = random_start(random, coarse);
    const auto point = [&] {
      return random_point<Path>(random, coarse, random.one_in(2) ? start : random_start(random, coarse));
    };
    const auto a = point(), b = point(), c = point(), d = point(), e = random.one_in(8) ? b : point();
    const auto without_height = [](std::vector<oracle::Polynomial> row) { return row.erase(row.begin() + 3), row; };
    // Columns x, y, z, 1; its sign is that of d seen from the other side.
    const auto volume = determinant(
        {without_height(lifted(a)), without_height(lifted(b)), without_height(lifted(c)), without_height(lifted(d))});
    wrong_orientation += mistakes(SpaceOrientation<Path>{b, a, c, d}, volume, random);
    wrong_sphere += mistakes(InSphere<Path>{a, b, c, d, e},
                             determinant({lifted(a), lifted(b), lifted(c), lifted(d), lifted(e)}), random);
    for (const int axis : {0, 1, 2}) {
      const auto at = [&](const Path& p, int shift) { return exact(p.axis((axis + shift) % 3)); };
      const auto area = determinant(
          {{at(a, 1), at(a, 2), exact(1.0)}, {at(b, 1), at(b, 2), exact(1.0)}, {at(c, 1), at(c, 2), exact(1.0)}});
      wrong_normal += mistakes(NormalDirection<Path>{a, b, c, axis}, area, random);
    }
  }
  CHECK(wrong_orientation == 0);
  CHECK(wrong_normal == 0);
  CHECK(wrong_sphere == 0);
}

TEST_CASE("a point enters a sphere, four points come to one plane, a weight grows", "[space]") {
  const auto at = [](double x, double y, double z, double speed = 0) {
    return PointMotion<1>{{Eigen::Vector3d(x, y, z), Eigen::Vector3d(speed, 0, 0)}, 0};
  };
  const auto a = at(-1, 0, 0), b = at(0, 1, 0), c = at(0, -1, 0), d = at(0, 0, 1), e = at(-3, 0, 0, 0.5);
  CHECK(sign_after(SpaceOrientation<PointMotion<1>>{a, b, c, d}, 0) < 0);
  const InSphere<PointMotion<1>> outside{b, a, c, d, e};
  CHECK(failure_time(outside, 0) == 4);   // through a
  CHECK(recovery_time(outside, 5) == 8);  // out of it, where (1, 0, 0) is
  CHECK(failure_time(InSphere<PointMotion<1>>{b, a, c, d, b}, 0) == never);
  const auto passing = at(-3, 0, 0, 1);
  CHECK(failure_time(SpaceOrientation<PointMotion<1>>{b, c, d, passing}, 0) ==
        recovery_time(SpaceOrientation<PointMotion<1>>{c, b, d, passing}, 0));
  const auto weighted = [](const PointMotion<1>& path, double weight, double growth = 0) {
    return WeightedPoint<1, 1>{path, {{weight, growth}}};
  };
  const auto p = weighted(a, 1), q = weighted(b, 1), r = weighted(c, 1), s = weighted(d, 1);
  // The orthogonal sphere of the four is at the origin, of radius zero; so a point at distance 3 enters at weight 9.
  const auto far = weighted(at(0, 0, 3), 1, 2);
  CHECK(failure_time(InSphere<WeightedPoint<1, 1>>{q, p, r, s, far}, 0) == 4);
}

TEST_CASE("space certificates have the symmetries they state", "[space]") {
  const std::uint64_t seed = 190;
  CAPTURE(seed);
  Random random(seed);
  using Path = PointMotion<1>;
  int wrong = 0;
  for (int round = 0; round < 100; ++round) {
    const bool coarse = random.one_in(2);
    std::array<Path, 5> p;
    for (Path& path : p) path = random_path<1>(random, coarse, random_start(random, coarse));
    const double t = random_time(random);
    std::array<std::size_t, 5> order{0, 1, 2, 3, 4};
    const int sphere = sign_after(InSphere<Path>{p[0], p[1], p[2], p[3], p[4]}, t);
    const int side = sign_after(SpaceOrientation<Path>{p[0], p[1], p[2], p[3]}, t);
    int parity = 1;
    for (int swap = 0; swap < 6; ++swap) {
      const std::size_t i = random.below(5), j = random.below(5);
      if (i == j) continue;
      std::swap(order[i], order[j]);
      parity = -parity;
      const auto at = [&](std::size_t k) -> const Path& { return p[order[k]]; };
      wrong += sign_after(InSphere<Path>{at(0), at(1), at(2), at(3), at(4)}, t) != parity * sphere;
      if (order[4] != 4) continue;
      wrong += sign_after(SpaceOrientation<Path>{at(0), at(1), at(2), at(3)}, t) != parity * side;
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("a weighted point restarts and runs backwards", "[space]") {
  const std::uint64_t seed = 195;
  CAPTURE(seed);
  Random random(seed);
  const auto point = random_point<WeightedPoint<2, 1>>(random, true, 1);
  const auto later = restarted(point, 3);
  CHECK(later.weight()(5) == point.weight()(5));
  CHECK(later.axis(2)(5) == point.axis(2)(5));
  CHECK(reversed(point).weight()(-5) == point.weight()(5));
  CHECK(reversed(reversed(point)) == point);
  CHECK(point.finite());
  auto broken = point;
  broken.weight_since_start.c[1] = never;
  CHECK_FALSE(broken.finite());
}

}  // namespace test_space_certificates
