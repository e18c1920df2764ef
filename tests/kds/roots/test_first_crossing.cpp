// Isolation in doubles: what it says of a polynomial must hold for every polynomial within the balls, exactly.
#include "kds/roots/first_crossing.hpp"
#include "tests/kds/roots/polynomial_families.hpp"
#include "tests/support/exact_algebra.hpp"
#include "tests/support/sanitized.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace test_first_crossing {
namespace {

using namespace kds;
using namespace kds::tests;
using Status = Crossing::Status;

constexpr double infinity = std::numeric_limits<double>::infinity();

template <int Degree>
Polynomial<Degree, Ball<double>> balls(const Polynomial<Degree>& p) {
  Polynomial<Degree, Ball<double>> result;
  for (std::size_t i = 0; i <= Degree; ++i) result.c[i] = p.c[i];
  return result;
}

/// Whether the claim holds for p, by all its roots over the rationals.
template <int Degree>
bool holds(const Crossing& crossing, const Polynomial<Degree>& p, double end) {
  if (crossing.status == Status::undecided && crossing.after == 0) return true;
  const oracle::Polynomial q = oracle::Polynomial::motion({p.c.begin(), p.c.end()}, 0);
  if (q.sign_after(0) < 0) return true;  // not what the function is for
  if (crossing.status == Status::undecided) {
    return !oracle::first_negative(q, 0, oracle::rational(crossing.after * (1 - 0x1p-44)));
  }
  const auto fall = oracle::first_negative(q, 0, oracle::time_end(end));
  if (crossing.status == Status::none) return !fall;
  const auto first = oracle::first_negative(q, 0);
  if (!first) return false;
  // The ends are known to 2^-44.
  const double after = crossing.after * (1 + 0x1p-44);
  const double before = crossing.before * (1 - 0x1p-44);
  if (!(crossing.after < crossing.guess && crossing.guess < crossing.before)) return false;
  if (first->compare(oracle::rational(after)) < 0) return false;
  if (before == infinity) return oracle::roots(q, oracle::rational(after), std::nullopt).size() == 1;
  const auto inside = oracle::roots(q, oracle::rational(crossing.after * (1 - 0x1p-44)), oracle::rational(before));
  return inside.size() == 1 && first->compare(oracle::rational(crossing.before * (1 + 0x1p-44))) <= 0;
}

}  // namespace

TEST_CASE("sign patterns decide at once", "[first_crossing]") {
  CHECK(first_crossing(balls<3>({{1, 2, 3, 4}}), infinity).status == Status::none);
  CHECK(first_crossing(balls<3>({{1, 2, 3, -4}}), infinity).status == Status::isolated);
  CHECK(first_crossing(balls<3>({{1, -2, -3, -4}}), infinity).status == Status::isolated);
  CHECK(first_crossing(balls<3>({{1, -2, -3, -4}}), 0.1).status == Status::none);
  CHECK(first_crossing(balls<4>({{1, -1, 1, -1, 1}}), infinity).status == Status::none);  // (x^5 + 1) / (x + 1)
}

TEST_CASE("the first of several crossings is isolated", "[first_crossing]") {
  // (x - 1)(x - 2)(x - 3), turned.
  const Crossing crossing = first_crossing(balls<3>({{6, -11, 6, -1}}), infinity);
  REQUIRE(crossing.status == Status::isolated);
  CHECK(crossing.after < 1);
  CHECK(crossing.before > 1);
  CHECK(crossing.before <= 2);
  CHECK(first_crossing(balls<3>({{6, -11, 6, -1}}), 0.99).status == Status::none);
}

TEST_CASE("what doubles cannot tell is not told", "[first_crossing]") {
  CHECK(first_crossing(balls<4>({{1, -4, 6, -4, 1}}), infinity).status == Status::undecided);  // (x - 1)^4
  const double nan = std::nan("");
  CHECK(first_crossing(balls<3>({{1, nan, 1, -1}}), infinity).status == Status::undecided);
  CHECK(first_crossing(balls<3>({{1, -infinity, 1, 1}}), infinity).status == Status::undecided);
  auto wide = balls<3>({{1, -1, 1, 1}});
  wide.c[1].radius = infinity;
  CHECK(first_crossing(wide, infinity).status == Status::undecided);
  wide.c[1].radius = nan;
  CHECK(first_crossing(wide, infinity).status == Status::undecided);
}

#if KDS_SANITIZED
#define FOR_EACH_DEGREE ((int Degree), Degree), 2, 3, 6
#else
#define FOR_EACH_DEGREE ((int Degree), Degree), 2, 3, 4, 5, 6, 8
#endif

TEMPLATE_TEST_CASE_SIG("what isolation says holds exactly, on every family", "[first_crossing]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 3000;
  for (int number = 0; number < static_cast<int>(Family::count); ++number) {
    const auto family = static_cast<Family>(number);
    Random random(seed + static_cast<std::uint64_t>(100 * number + Degree));
    int wrong = 0;
    for (int round = 0; round < 12; ++round) {
      auto x = next_case<Degree>(family, random);
      if (sign_after(PolynomialCertificate<Degree>{x.value}, x.value.start) < 0) x.value.position = -x.value.position;
      wrong += !holds(first_crossing(balls(x.value.position), x.horizon), x.value.position, x.horizon);
    }
    CAPTURE(Degree, seed, name(family));
    CHECK(wrong == 0);
  }
}

TEMPLATE_TEST_CASE_SIG("what isolation says of balls holds for all they contain", "[first_crossing]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 3100;
  Random random(seed + Degree);
  int wrong = 0;
  int decided = 0;
  for (int round = 0; round < 60; ++round) {
    const auto x = next_case<Degree>(Family::from_roots, random);
    auto p = balls(x.value.position);
    for (auto& c : p.c) c.radius = std::abs(c.middle) * std::ldexp(1.0, random.integer(-40, -4));
    const Crossing crossing = first_crossing(p, x.horizon);
    decided += crossing.status != Status::undecided;
    for (int sample = 0; sample < 3; ++sample) {
      Polynomial<Degree> inside;
      for (std::size_t i = 0; i <= Degree; ++i) inside.c[i] = p.c[i].middle + p.c[i].radius * random.between(-1, 1);
      wrong += !holds(crossing, inside, x.horizon);
    }
  }
  CAPTURE(Degree, seed);
  CHECK(wrong == 0);
  CHECK(decided > 20);
}

TEMPLATE_TEST_CASE_SIG("what isolation says holds exactly where powers of the scale are near the ends of the doubles",
                       "[first_crossing]", ((int Degree), Degree), 10, 11, 12, 13, 16, 31) {
  const std::uint64_t seed = 3300;
  Random random(seed + Degree);
  int wrong = 0, decided = 0;
  for (int round = 0; round < 200; ++round) {
    // Only the last terms count against a small constant one, so that the scale is small, and its powers tiny.
    Polynomial<Degree> p{};
    p.c[0] = std::abs(random.scaled(-1000, 0));
    for (std::size_t i = Degree - 1 - random.below(3); i <= Degree; ++i) p.c[i] = random.scaled(700, 1000);
    const double end = std::abs(random.scaled(-150, -30));
    const Crossing crossing = first_crossing(balls(p), end);
    wrong += !holds(crossing, p, end);
    decided += crossing.status != Status::undecided;
  }
  CAPTURE(Degree, seed);
  CHECK(wrong == 0);
  CHECK(decided > 0);
}

TEMPLATE_TEST_CASE_SIG("ordinary polynomials are decided", "[first_crossing]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 3200;
  Random random(seed + Degree);
  int undecided = 0;
  for (int round = 0; round < 2000; ++round) {
    const auto x = next_case<Degree>(round % 2 == 0 ? Family::random : Family::common_scale, random);
    if (x.value.position.c[0] < 0) continue;
    undecided += first_crossing(balls(x.value.position), x.horizon).status == Status::undecided;
  }
  CAPTURE(Degree, seed);
  CHECK(undecided <= 10);
}

#undef FOR_EACH_DEGREE

}  // namespace test_first_crossing
