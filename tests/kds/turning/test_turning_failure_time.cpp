// Failure times of sums of sines and cosines: known ones, roots of all orders, and random ones against their signs.
#include "kds/roots/failure_time.hpp"
#include "kds/turning/turning_failure_time.hpp"
#include "tests/kds/turning/check_turning_failure_time.hpp"
#include "tests/kds/turning/written_sum.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/sanitized.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <utility>

namespace test_turning_failure_time {
namespace {

using namespace kds;
using namespace kds::tests;

constexpr double pi = 3.14159265358979323846;

/// Adds (c0 + c1 t + c2 t^2) A_i B_j.
template <int Degree, int Harmonics>
void add(WrittenSum<Degree, Harmonics>& f, std::size_t i, std::size_t j,
         const std::array<double, std::size_t{Degree} + 1>& c) {
  f.p[i][j].position.c = c;
}

/// One spin about x, at 1 rad/s from 0; the other one is still.
template <int Degree>
WrittenSum<Degree> one_spin() {
  WrittenSum<Degree> f;
  f.spin[0].velocity = {1, 0, 0};
  return f;
}

/// Two spins at 1 rad/s, the same but for their axes.
template <int Degree>
WrittenSum<Degree> equal_spins() {
  WrittenSum<Degree> f = one_spin<Degree>();
  f.spin[1].velocity = {0, -1, 0};
  return f;
}

template <class Certificate>
int refutations_of_failure(const Certificate& f, double now, double horizon, int samples = 2000) {
  return refutations(
      f, [&](long double t) { return f.value(t); }, 1, now, horizon, failure_time(f, now, horizon), samples);
}

}  // namespace

TEST_CASE("a sine fails and recovers where it crosses", "[turning_failure_time]") {
  WrittenSum<1> f = one_spin<1>();  // 0.5 - sin t
  add<1>(f, 0, 0, {0.5, 0});
  add<1>(f, 2, 0, {-1, 0});
  const double t = failure_time(f, 0, 100);
  CHECK(std::abs(t - pi / 6) < 1e-15);
  CHECK(sign_after(f, t) == -1);
  CHECK(sign_after(f, next_down(t)) == 1);
  CHECK(failure_time(f, t, 100) == t);
  CHECK(failure_time(f, 1, 100) == 1);
  CHECK(failure_time(f, 0, t) == t);
  CHECK(failure_time(f, 0, next_down(t)) == never);
  CHECK(failure_time(f, 0, 0) == never);
  CHECK(failure_time(f, 1, 0) == never);
  const double again = recovery_time(f, 1, 100);
  CHECK(std::abs(again - 5 * pi / 6) < 1e-15);
  CHECK(sign_after(f, again) == 1);
  CHECK(sign_after(f, next_down(again)) == -1);
  CHECK(change_of_sign(f, 1, 0, 100) == t);
  CHECK(change_of_sign(f, 1, 0, next_down(t)) == never);
  CHECK(change_of_sign(f, -1, t, 100) == again);
  CHECK_THROWS_AS(change_of_sign(f, 1, 0, never), std::invalid_argument);
  CHECK(recovery_time(f, 1, 2) == never);
  CHECK(recovery_time(f, 0, 2) == 0);
  CHECK(std::abs(failure_time(f, 3, 100) - 13 * pi / 6) < 1e-15);
  CHECK_THROWS_AS(failure_time(f, 0, never), std::invalid_argument);
  CHECK_THROWS_AS(recovery_time(f, 0, never), std::invalid_argument);
  CHECK(failure_time(f, 0, std::numeric_limits<double>::quiet_NaN()) == never);
}

TEST_CASE("what holds for long, or fails after many turns, is found", "[turning_failure_time]") {
  WrittenSum<1> f = one_spin<1>();  // 1.5 - t / 65536 - cos t
  add<1>(f, 0, 0, {1.5, -0x1p-16});
  add<1>(f, 1, 0, {-1, 0});
  const double t = failure_time(f, 0, 1e9);
  CHECK(std::abs(t - 32768) < 40);  // five thousand turns
  CHECK(refutations_of_failure(f, t - 100, t + 100) == 0);
  CHECK(failure_time(f, t - 100, 1e9) == t);
  add<1>(f, 0, 0, {1.5, 0});
  turning_search_counters = {};
  CHECK(failure_time(f, 0, 1e12) == never);
  CHECK(turning_search_counters.expansions == 0);  // the part that does not turn outweighs the other
  f.spin[1].velocity = {0, 0.75, 0};
  add<1>(f, 0, 0, {1.99999, 0});  // 1.99999 - cos a - cos b: both are nearly 1 again after 8 pi
  add<1>(f, 1, 0, {-1, 0});
  add<1>(f, 0, 1, {-1, 0});
  const double both = failure_time(f, 1, 100);
  CHECK(std::abs(both - 8 * pi) < 0.01);
  CHECK(refutations_of_failure(f, 1, 100) == 0);
}

TEST_CASE("touching is not failing, and a nudge makes it", "[turning_failure_time]") {
  WrittenSum<1> f = one_spin<1>();
  add<1>(f, 1, 0, {-1, 0});
  add<1>(f, 0, 0, {1, 0});  // 1 - cos t: zero at 0 exactly, elsewhere not at doubles
  for (const double now : {-1.0, -1e-9, -0x1p-1000, 0.0, 1e-9, 5.0}) {
    CAPTURE(now);
    CHECK(failure_time(f, now, 40) == never);
    CHECK(recovery_time(f, now, 40) == now);
  }
  add<1>(f, 0, 0, {next_up(1.0), 0});
  CHECK(failure_time(f, -1, 40) == never);
  add<1>(f, 0, 0, {next_down(1.0), 0});  // below zero for 2^-26 around
  CHECK(std::abs(failure_time(f, -1, 40) + 0x1p-26) < 0x1p-50);
  CHECK(std::abs(failure_time(f, 1, 40) - (2 * pi - 0x1p-26)) < 1e-14);
  CHECK(refutations_of_failure(f, 1, 40) == 0);
  // By less than a double can say: the other spin is still, and its cosine 1.
  add<1>(f, 0, 0, {1, 0});
  add<1>(f, 0, 1, {-0x1p-100, 0});  // 2^-49.5 on either side
  const double t = failure_time(f, 1, 40);
  CHECK(std::abs(t - 2 * pi) < 0x1p-49);
  CHECK(refutations_of_failure(f, 1, 40) == 0);
  CHECK(std::abs(failure_time(f, -1, 40) + std::sqrt(0x1p-99)) < 0x1p-100);
  add<1>(f, 0, 1, {-0x1p-110, 0});  // less than the spacing of doubles: not seen after a turn
  CHECK(failure_time(f, 1, 40) == never);
  CHECK(std::abs(failure_time(f, -1, 40) + std::sqrt(0x1p-109)) < 0x1p-105);
  add<1>(f, 0, 1, {-0x1p-700, 0});
  CHECK(failure_time(f, 1, 40) == never);
  CHECK(std::abs(failure_time(f, -1, 40) / 0x1.6a09e667f3bcdp-350 + 1) < 1e-15);
  add<1>(f, 0, 1, {0x1p-700, 0});
  CHECK(failure_time(f, -1, 40) == never);
}

TEST_CASE("roots of a high order are found, and those of an even one passed", "[turning_failure_time]") {
  for (const double start : {0.0, 0.3, -1e6, 1e-12}) {
    CAPTURE(start);
    const auto begin_at = [start](auto f) {
      for (Spin& spin : f.spin) spin.start = start;
      for (auto& row : f.p) {
        for (auto& p : row) p.start = start;
      }
      return f;
    };
    WrittenSum<2> quartic = one_spin<2>();  // cos t - 1 + t^2 / 2
    add<2>(quartic, 0, 0, {-1, 0, 0.5});
    add<2>(quartic, 1, 0, {1, 0, 0});
    quartic = begin_at(quartic);
    CHECK(failure_time(quartic, start - 3, start + 3) == never);
    CHECK(recovery_time(quartic, start - 3, start + 3) == start - 3);
    WrittenSum<2> cubic = one_spin<2>();  // sin t - t
    add<2>(cubic, 0, 0, {0, -1, 0});
    add<2>(cubic, 2, 0, {1, 0, 0});
    cubic = begin_at(cubic);
    CHECK(failure_time(cubic, start - 3, start + 3) == start);
    CHECK(failure_time(cubic, start, start + 3) == start);
    for (int power = 0; power <= 2; ++power) {  // +-t^power (1 - cos t)^2
      for (const double factor : {1.0, -1.0}) {
        WrittenSum<2> f = equal_spins<2>();
        std::array<double, 3> c{};
        c[static_cast<std::size_t>(power)] = factor;
        f.p[0][0].position.c = f.p[1][1].position.c = c;
        c[static_cast<std::size_t>(power)] = -factor;
        f.p[1][0].position.c = f.p[0][1].position.c = c;
        f = begin_at(f);
        CAPTURE(power, factor);
        const bool negative_before = power == 1 ? factor > 0 : factor < 0;
        const double expected = negative_before ? start - 1 : (power == 1 ? start : never);
        CHECK(failure_time(f, start - 1, start + 1) == expected);
      }
    }
    WrittenSum<2> sixth = equal_spins<2>();  // (t - sin t)^2, and less 2^-70
    add<2>(sixth, 0, 0, {0, 0, 1});
    add<2>(sixth, 2, 0, {0, -1, 0});
    add<2>(sixth, 0, 2, {0, -1, 0});
    add<2>(sixth, 2, 2, {1, 0, 0});
    sixth = begin_at(sixth);
    CHECK(failure_time(sixth, start - 3, start + 3) == never);
    sixth.p[0][0].position.c[0] = -0x1p-70;
    // |t|^3 / 6 = 2^-35
    CHECK(std::abs(failure_time(sixth, start - 3, start + 3) - start + std::cbrt(6 * 0x1p-35)) < 1e-6);
    CHECK(refutations_of_failure(sixth, start - 1e-2, start + 1e-2) == 0);
  }
}

TEST_CASE("what is zero at all times never fails", "[turning_failure_time]") {
  WrittenSum<1> f = equal_spins<1>();  // cos^2 + sin^2 - 1
  add<1>(f, 0, 0, {-1, 0});
  add<1>(f, 1, 1, {1, 0});
  add<1>(f, 2, 2, {1, 0});
  CHECK(failure_time(f, 0.7, 1e9) == never);
  CHECK(recovery_time(f, 0.7, 1e9) == never);
  f.spin[1].velocity = {0, next_up(1.0), 0};  // nearly
  CHECK(refutations_of_failure(f, -0.7, 100) == 0);
  CHECK(failure_time(WrittenSum<1>{}, 0, 1) == never);
}

TEST_CASE("what cancels but for the least of all doubles fails where that says", "[turning_failure_time]") {
  WrittenSum<1> f = equal_spins<1>();  // cos^2 + sin^2 - 1, and 2^-1074 cos t
  add<1>(f, 0, 0, {-1, 0});
  add<1>(f, 1, 1, {1, 0});
  add<1>(f, 2, 2, {1, 0});
  add<1>(f, 1, 0, {0x1p-1074, 0});
  turning_search_counters = {};
  const double t = failure_time(f, 0, 100);
  CHECK(std::abs(t - pi / 2) < 1e-15);
  CHECK(sign_after(f, t) == -1);
  CHECK(sign_after(f, next_down(t)) == 1);
  CHECK(std::abs(recovery_time(f, 2, 100) - 3 * pi / 2) < 1e-15);
  CHECK(turning_search_counters.enclosed > 0);
  add<1>(f, 0, 0, {-1, 0x1p-1074});  // t + sin t, from -1
  add<1>(f, 1, 0, {0, 0});
  add<1>(f, 2, 0, {0x1p-1074, 0});
  CHECK(recovery_time(f, -1, 100) == 0);
  CHECK(failure_time(f, 0, 3) == never);
  WrittenSum<1> still;
  add<1>(still, 0, 0, {1, 0});
  add<1>(still, 0, 1, {-1, 0});
  add<1>(still, 1, 0, {0x1p-1074, -0x1p-1074});
  CHECK(failure_time(still, 0, 20) == 1);
}

TEST_CASE("rates and times of all sizes", "[turning_failure_time]") {
  for (const double rate : {0x1p-1000, 0x1p-600, 0x1p-30, 0x1p14, 0x1p600, 0x1p1000}) {
    for (const double size : {0x1p-1000, 1.0, 0x1p1000}) {
      CAPTURE(rate, size);
      WrittenSum<1> f;  // cos - 1/2
      f.spin[0].velocity = {0, rate, 0};
      add<1>(f, 0, 0, {-0.5 * size, 0});
      add<1>(f, 1, 0, {size, 0});
      const double t = failure_time(f, 0, 20 / rate);
      CHECK(std::abs(t * rate - pi / 3) < 1e-15);
      CHECK(sign_after(f, t) == -1);
      CHECK(sign_after(f, next_down(t)) == 1);
      CHECK(std::abs(recovery_time(f, t, 20 / rate) * rate - 5 * pi / 3) < 2e-15);
    }
  }
  // A turn between two doubles: what is seen of it are its signs at doubles.
  WrittenSum<1> f = one_spin<1>();
  f.spin[0].velocity = {0, 0, 1000};
  add<1>(f, 0, 0, {0.5, 0});
  add<1>(f, 1, 0, {1, 0});
  const double now = 0x1p54;
  const double t = failure_time(f, now, now + 1000);
  CHECK(refutations_of_failure(f, now, now + 1000, 250) == 0);
  CHECK(t != never);
}

TEST_CASE("second harmonics of one spin fail where they should", "[turning_failure_time]") {
  WrittenSum<1> f;  // cos^2 a - 1/4, and one spin for both
  f.spin[0] = f.spin[1] = Spin{{1, 2, 2}, 0.5};
  add<1>(f, 1, 1, {1, 0});
  add<1>(f, 0, 0, {-0.25, 0});
  CHECK(std::abs(failure_time(f, 0.5, 100) - (0.5 + pi / 9)) < 1e-15);
  CHECK(std::abs(recovery_time(f, 1, 100) - (0.5 + 2 * pi / 9)) < 1e-15);
  CHECK(refutations_of_failure(f, 0.5, 100) == 0);
  add<1>(f, 0, 0, {0, 0});  // cos^2: a double root each half turn
  CHECK(failure_time(f, 0, 100) == never);
  add<1>(f, 0, 0, {-0x1p-80, 0});  // 2^-40 / 3 on either side
  CHECK(std::abs(failure_time(f, 0.5, 100) - (0.5 + pi / 6 - 0x1p-40 / 3)) < 1e-15);
}

TEST_CASE("second harmonics of two spins fail where they should", "[turning_failure_time]") {
  WrittenSum<1, 2> f;  // 1/2 + cos 2 a cos 2 b, at rates of 3 and 1 rad/s
  f.spin[0] = Spin{{1, 2, 2}, 0.5};
  f.spin[1] = Spin{{0, 1, 0}, 0.5};
  add<1>(f, 0, 0, {0.5, 0});
  add<1>(f, 3, 3, {1, 0});
  const double t = failure_time(f, 0.5, 100);  // cos 8 x + cos 4 x = -1: cos 4 x = 0
  CHECK(std::abs(t - (0.5 + pi / 8)) < 1e-15);
  CHECK(std::abs(recovery_time(f, t, 100) - (0.5 + pi / 6)) < 1e-15);  // cos 4 x = -1/2
  CHECK(refutations_of_failure(f, 0.5, 100) == 0);
  WrittenSum<1, 2> g;  // (cos a - cos b)^2 with b = 3 a: zero where a or 2 a is a half turn, doubly, never negative
  g.spin = f.spin;
  std::swap(g.spin[0], g.spin[1]);
  add<1>(g, 0, 0, {1, 0});
  add<1>(g, 3, 0, {0.5, 0});
  add<1>(g, 0, 3, {0.5, 0});
  add<1>(g, 1, 1, {-2, 0});
  CHECK(failure_time(g, 0, 40) == never);
  add<1>(g, 0, 0, {1 - 0x1p-53, 0});
  CHECK(failure_time(g, 0.5, 40) == 0.5);
  CHECK(refutations_of_failure(g, 1, 10) == 0);
  // cos^2 and sin^2 of twice the angle, of two spins that are equal: zero at all times.
  WrittenSum<1, 2> h;
  h.spin = {f.spin[0], Spin{{-3, 0, 0}, 0.5}};
  add<1>(h, 0, 0, {-9, 0});
  add<1>(h, 3, 3, {9, 0});
  add<1>(h, 4, 4, {1, 0});
  CHECK(vanishes(h));
  CHECK(failure_time(h, 0.7, 1e9) == never);
}

TEST_CASE("lines and parabolas without a turn are those of polynomials", "[turning_failure_time]") {
  const std::uint64_t seed = 360;
  CAPTURE(seed);
  Random random(seed);
  int wrong = 0;
  for (int round = 0; round < 1000; ++round) {
    WrittenSum<2> f;
    const bool coarse = random.one_in(2);
    for (double& c : f.p[0][0].position.c) c = coarse ? random.integer(-3, 3) : random.scaled(-2, 2);
    f.p[0][0].start = coarse ? random.integer(-3, 3) : random.between(-3, 3);
    const PolynomialCertificate<2> g{f.p[0][0]};
    const double now = coarse ? random.integer(-3, 3) : random.between(-3, 3);
    const double horizon = now + std::abs(random.scaled(-4, 40));
    const double t = failure_time(f, now, horizon);
    wrong += t != failure_time(g, now, horizon);
    wrong += recovery_time(f, now, horizon) != recovery_time(g, now, horizon);
    f.spin[0] = {{0, 1e-300, 0}, 7};  // nor one of no account
    wrong += t != failure_time(f, now, horizon);
  }
  CHECK(wrong == 0);
}

TEMPLATE_TEST_CASE_SIG("failure times of random sums are refuted by no sign", "[turning_failure_time]",
                       ((int Degree, int Harmonics), Degree, Harmonics), (1, 1), (2, 1), (1, 2), (2, 2), (4, 2)) {
  const std::uint64_t seed = 351 + Degree + 10 * Harmonics;
  CAPTURE(Degree, Harmonics, seed);
  Random random(seed);
  turning_search_counters = {};
  int wrong = 0;
  int found = 0;
  int touching = 0;
  constexpr int rounds = tests::rounds_here(Harmonics == 1 ? 400 : 60);
  for (int round = 0; round < rounds; ++round) {
    const bool coarse = random.one_in(3);
    const double rate = coarse ? 1 : (random.one_in(2) ? 1.0 : std::pow(10.0, random.between(-9, 4)));
    const double long_ago = random.one_in(4) ? -1e6 : 0;
    WrittenSum<Degree, Harmonics> f;
    for (Spin& spin : f.spin) {
      for (double& v : spin.velocity) v = rate * (coarse ? random.integer(-1, 1) : random.between(-1, 1));
      if (random.one_in(8)) spin.velocity = {};
      spin.start = long_ago + (coarse ? random.integer(-1, 1) : random.between(-1, 1)) / rate;
    }
    if (random.one_in(3)) f.spin[1] = f.spin[0];
    const double now = coarse ? random.integer(-1, 1) : random.between(-1, 1) / rate;
    for (std::size_t i = 0; i < f.size; ++i) {
      for (std::size_t j = 0; j < f.size; ++j) {
        if (random.one_in(3)) continue;
        const double scale = (is_sine(i) ? 1 / rate : 1) * (is_sine(j) ? 1 / rate : 1);
        f.p[i][j].start = now;
        for (std::size_t k = 0; k <= Degree; ++k) {
          const double x = coarse ? random.integer(-2, 2) : random.between(-1, 1);
          f.p[i][j].position.c[k] = x * scale * std::pow(rate, static_cast<double>(k)) * (k > 0 ? 0.25 : 1);
        }
      }
    }
    const double horizon = now + 20 / rate;
    const auto value = [&](long double t) { return f.value(t); };
    const int shape = random.integer(0, 2);
    if (shape > 0) {
      // Raised so that its least value is next to zero, by some units in the last place: it touches, or nearly.
      double lowest = now;
      for (int i = 1; i < 1000; ++i) {
        const double t = now + (horizon - now) * i / 1000;
        if (value(t) < value(lowest)) lowest = t;
      }
      const long double step = (horizon - now) / 1000;
      const long double least = value(time_of_least(value, lowest - step, lowest + step));
      double& c = f.p[0][0].position.c[0];
      f.p[0][0].start = now;
      c = static_cast<double>(c - least);
      c = lattice_point(lattice_index(c) + random.integer(-3, 3));
      ++touching;
    }
    const double t = failure_time(f, now, horizon);
    found += t > now && t != never;
    const int refuted = refutations(f, value, 1, now, horizon, t, 1000);
    if (refuted > 0) std::printf("round %d refuted\n", round);
    wrong += refuted;
    if (t == now) {
      const double again = recovery_time(f, now, horizon);
      found += again != never;
      wrong += refutations(f, value, -1, now, horizon, again, 1000);
    }
  }
  const TurningSearchCounters& n = turning_search_counters;
  std::printf(
      "failure times, degree %d, harmonics %d, seed %llu: %d searches, %d roots, %d nearly touching; models in doubles "
      "%llu, "
      "double-doubles %llu, exact %llu; signs %llu, by signs alone %llu\n",
      Degree, Harmonics, static_cast<unsigned long long>(seed), rounds, found, touching,
      static_cast<unsigned long long>(n.expansions), static_cast<unsigned long long>(n.extended),
      static_cast<unsigned long long>(n.enclosed), static_cast<unsigned long long>(n.signs),
      static_cast<unsigned long long>(n.searches));
  CHECK(wrong == 0);
  CHECK(found > rounds / 3);
}

}  // namespace test_turning_failure_time
