// What certificates say of their negatives must be true, and they must know the negatives that occur.
#include "certificates/direction_order.hpp"
#include "certificates/distance_order.hpp"
#include "certificates/empty_disc.hpp"
#include "certificates/in_circle.hpp"
#include "certificates/in_order.hpp"
#include "certificates/in_region.hpp"
#include "certificates/in_sphere.hpp"
#include "certificates/order.hpp"
#include "certificates/orientation.hpp"
#include "certificates/plane_motion.hpp"
#include "certificates/space_orientation.hpp"
#include "certificates/weighted_point.hpp"
#include "certificates/within_limit.hpp"
#include "tests/certificates/check_certificate.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

namespace test_negatives {
namespace {

using namespace kds;
using namespace kds::certificates;
using kds::tests::Random;

template <Certificate C>
bool is_zero_sum(const C& a, const C& b) {
  const auto f = a.template polynomial<Exact>(0.25), g = b.template polynomial<Exact>(0.25);
  for (std::size_t i = 0; i <= C::degree; ++i) {
    if ((f.c[i] + g.c[i]).sign() != 0) return false;
  }
  return true;
}

/// Of all pairs of certificates, how many negatives are not told, or told wrongly. No other may be the negative by
/// chance.
template <Certificate C>
int mistakes(const std::vector<C>& all) {
  static_assert(TellsItsNegative<C> && kds::detail::RightHooks<C>::checked);
  int wrong = 0, negatives = 0;
  for (const C& a : all) {
    for (const C& b : all) {
      negatives += a.is_negative_of(b);
      wrong += a.is_negative_of(b) != is_zero_sum(a, b);
    }
  }
  return negatives > 0 ? wrong : 1;
}

/// make(things) for all orders of some of the things.
template <std::size_t N, class Thing, class Make>
auto of_all_orders(const std::vector<Thing>& things, const Make& make) {
  using C = decltype(make(std::array<const Thing*, N>{}));
  std::vector<C> all;
  for (std::size_t last = N - 1; last < things.size(); ++last) {  // the last of them is another one
    std::array<std::size_t, N> order;
    std::iota(order.begin(), order.end(), 0);
    order[N - 1] = last;
    do {
      std::array<const Thing*, N> chosen;
      for (std::size_t i = 0; i < N; ++i) chosen[i] = &things[order[i]];
      all.push_back(make(chosen));
    } while (std::next_permutation(order.begin(), order.end()));
  }
  return all;
}

template <int Degree>
Motion<Degree> random_motion(Random& random) {
  Motion<Degree> motion{{}, random.between(-1, 1)};
  for (double& c : motion.position.c) c = random.between(-1, 1);
  return motion;
}
template <class Thing, class Make>
std::vector<Thing> some(std::size_t n, const Make& make) {
  std::vector<Thing> things;
  for (std::size_t i = 0; i < n; ++i) things.push_back(make());
  return things;
}

}  // namespace

TEST_CASE("certificates in the plane know their negatives", "[hooks]") {
  const std::uint64_t seed = 190;
  CAPTURE(seed);
  Random random(seed);
  const auto motions = some<Motion<2>>(3, [&] { return random_motion<2>(random); });
  CHECK(mistakes(of_all_orders<2>(motions, [](auto x) { return Order<2>{*x[0], *x[1]}; })) == 0);
  CHECK(mistakes(of_all_orders<2>(motions, [](auto x) { return Ascending<Motion<2>>{*x[0], *x[1]}; })) == 0);
  std::vector<WithinLimit<Motion<2>>> limits;
  for (const double side : {1.0, -1.0}) {
    limits.insert(limits.end(), {{motions[0], 0.5, side}, {motions[0], 0.25, side}, {motions[1], 0.5, side}});
  }
  CHECK(mistakes(limits) == 0);
  using Path = PlaneMotion<1>;
  const auto paths = some<Path>(5, [&] {
    return Path{{random_motion<1>(random).position, random_motion<1>(random).position}, random.between(-1, 1)};
  });
  const std::array<double, 2> along{1, 0.5}, across{0.25, -1};
  auto directions = of_all_orders<2>(paths, [&](auto p) { return DirectionOrder<Path, 2>{*p[0], *p[1], along}; });
  directions.push_back({paths[1], paths[0], across});
  CHECK(mistakes(directions) == 0);
  CHECK(mistakes(of_all_orders<3>(paths, [](auto p) { return Orientation<Path>{*p[0], *p[1], *p[2]}; })) == 0);
  CHECK(mistakes(of_all_orders<4>(paths, [](auto p) { return InCircle<Path>{*p[0], *p[1], *p[2], *p[3]}; })) == 0);
  // Of the orders of four points in two pairs those with the lesser number first in each.
  std::vector<DistanceOrder<Path>> distances;
  for (const auto& [a, b, c, d] : {std::array{0, 1, 2, 3}, {2, 3, 0, 1}, {0, 2, 1, 3}, {1, 3, 0, 2}, {0, 1, 2, 4}}) {
    const auto at = [&](int i) -> const Path& { return paths[static_cast<std::size_t>(i)]; };
    distances.emplace_back(at(a), at(b), at(c), at(d));
  }
  CHECK(mistakes(distances) == 0);
  std::vector<OutsideDisc<Path>> discs;
  std::vector<PairRadius<Path>> pairs;
  std::vector<CircleRadius<Path>> circles;
  std::vector<OnSide<1>> sides;
  std::vector<InBall<Path>> balls;
  const Motion<1> radius{{{0.5, 0.25}}, 0}, other_radius{{{0.5, 0.5}}, 0};
  for (const double sign : {1.0, -1.0}) {
    discs.emplace_back(paths[0], paths[1], paths[2], sign);
    discs.emplace_back(paths[0], paths[2], paths[1], sign);
    pairs.emplace_back(paths[0], paths[1], 0.5, sign);
    pairs.emplace_back(paths[0], paths[1], 0.25, sign);
    pairs.emplace_back(paths[0], paths[2], 0.5, sign);
    circles.emplace_back(paths[0], paths[1], paths[2], 0.5, sign);
    circles.emplace_back(paths[0], paths[1], paths[2], 0.25, sign);
    circles.emplace_back(paths[0], paths[1], paths[3], 0.5, sign);
    sides.push_back({paths[0].axis(0), paths[1].axis(0), sign});
    sides.push_back({paths[0].axis(1), paths[1].axis(0), sign});
    balls.push_back({paths[0], paths[1], radius, sign});
    balls.push_back({paths[0], paths[1], other_radius, sign});
    balls.push_back({paths[0], paths[2], radius, sign});
  }
  CHECK(mistakes(discs) == 0);
  CHECK(mistakes(pairs) == 0);
  CHECK(mistakes(circles) == 0);
  CHECK(mistakes(sides) == 0);
  CHECK(mistakes(balls) == 0);
}

TEST_CASE("certificates in space know their negatives", "[hooks]") {
  const std::uint64_t seed = 191;
  CAPTURE(seed);
  Random random(seed);
  using Path = PointMotion<1>;
  const auto path = [&] { return kds::tests::random_path<1>(random, false, random.between(-1, 1)); };
  const auto paths = some<Path>(6, path);
  CHECK(mistakes(of_all_orders<4>(paths, [](auto p) {
          return SpaceOrientation<Path>{*p[0], *p[1], *p[2], *p[3]};
        })) == 0);
  auto normals = of_all_orders<3>(paths, [](auto p) { return NormalDirection<Path>{*p[0], *p[1], *p[2], 1}; });
  normals.push_back({paths[1], paths[0], paths[2], 2});
  CHECK(mistakes(normals) == 0);
  CHECK(mistakes(of_all_orders<5>(paths, [](auto p) {
          return InSphere<Path>{*p[0], *p[1], *p[2], *p[3], *p[4]};
        })) == 0);
  using Heavy = WeightedPoint<1>;
  const auto heavy = some<Heavy>(5, [&] { return Heavy{path(), {{random.unit()}}}; });
  CHECK(mistakes(of_all_orders<5>(heavy, [](auto p) {
          return InSphere<Heavy>{*p[0], *p[1], *p[2], *p[3], *p[4]};
        })) == 0);
}

}  // namespace test_negatives
