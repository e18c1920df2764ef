// Failure times on every family of hard polynomials: two solvers that share only the signs agree bit for bit, and with
// the exact ones; the certified enclosures hold; and the expensive rungs stay rare where they should.
#include "kds/roots/enclosed_failure_time.hpp"
#include "tests/kds/roots/check_failure_time.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace test_failure_time_families {
namespace {

using namespace kds;
using namespace kds::tests;

/// By exact signs and derivatives alone.
template <int Degree>
double slow_failure_time(const FailureCase<Degree>& x) {
  const PolynomialCertificate<Degree> f{x.value};
  return detail::DerivativeIntervals<Degree>(CertificateReference(f), x.now, x.horizon).first_negative();
}

/// Runs `holds` on cases of every family and reports the first that it refuses, if any.
template <int Degree, class Check>
void for_all_families(std::uint64_t seed, int rounds, Check&& holds) {
  for (int number = 0; number < static_cast<int>(Family::count); ++number) {
    const auto family = static_cast<Family>(number);
    Random random(seed + static_cast<std::uint64_t>(100 * number + Degree));
    std::string refused;
    int count = 0;
    for (int round = 0; round < rounds_here(rounds); ++round) {
      const auto x = next_case<Degree>(family, random);
      if (!holds(x) && count++ == 0)
        refused = "round " + std::to_string(round) + ": " + describe(x.value, x.now, x.horizon);
    }
    CAPTURE(Degree, seed, name(family), refused);
    CHECK(count == 0);
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the quick and the slow solver agree bit for bit on every family", "[failure_time][families]",
                       FOR_DEGREES_TO_10) {
  for_all_families<Degree>(2000, Degree <= 4 ? 300 : 100, [](const FailureCase<Degree>& x) {
    return failure_time(PolynomialCertificate<Degree>{x.value}, x.now, x.horizon) == slow_failure_time(x);
  });
}

TEMPLATE_TEST_CASE_SIG("failure times are exact on every family", "[failure_time][families]", FOR_DEGREES_TO_10) {
  for_all_families<Degree>(2100, 10, [](const FailureCase<Degree>& x) {
    const double expected =
        oracle::failure_time(exact(x.value.position), oracle::rational(x.value.start), x.now, x.horizon);
    return failure_time(PolynomialCertificate<Degree>{x.value}, x.now, x.horizon) == expected;
  });
}

TEMPLATE_TEST_CASE_SIG("after its failure a certificate recovers and fails again as the slow solver says",
                       "[failure_time][families]", FOR_DEGREES_TO_8) {
  for_all_families<Degree>(2200, 60, [](FailureCase<Degree> x) {
    const PolynomialCertificate<Degree> f{x.value};
    for (int turn = 0; turn < 3; ++turn) {
      x.now = failure_time(f, x.now, x.horizon);
      if (x.now == never) break;
      x.value.position = -x.value.position;
      const double recovery = recovery_time(f, x.now, x.horizon);
      if (recovery != slow_failure_time(x)) return false;
      x.value.position = -x.value.position;
      if (recovery == never) break;
      x.now = recovery;
      if (failure_time_after_turn(f, x.now, x.horizon) != slow_failure_time(x)) return false;
    }
    return true;
  });
}

TEMPLATE_TEST_CASE_SIG("enclosures hold the root, and are as narrow as they say", "[failure_time][families]",
                       FOR_DEGREES_TO_8) {
  for_all_families<Degree>(2300, 60, [](const FailureCase<Degree>& x) {
    const PolynomialCertificate<Degree> f{x.value};
    const double t = failure_time(f, x.now, x.horizon);
    for (const FailureTime& found :
         {certified_failure_time(f, x.now, x.horizon), enclosed_failure_time(f, x.now, x.horizon)}) {
      const FailureStatus expected =
          t == never ? FailureStatus::holds : (t == x.now ? FailureStatus::fails_at_once : FailureStatus::root);
      if (found.status != expected || (found.time == never) != (t == never)) return false;
      if (found.status == FailureStatus::fails_at_once && (found.time != t || found.lower != t || found.upper != t)) {
        return false;
      }
      if (found.status != FailureStatus::root) continue;
      if (!(found.lower <= found.time && found.time <= found.upper && found.upper <= x.horizon)) return false;
      if (!(found.lower <= t && t <= next_up(found.upper))) return false;
      if (sign_after(f, found.lower) < 0) return false;
      const double width = found.upper - found.lower;
      const double unit = next_up(std::abs(found.upper)) - std::abs(found.upper);
      if (!(width <= 0x1p-45 * (found.upper - x.now) + 4 * unit)) return false;
    }
    return true;
  });
}

TEMPLATE_TEST_CASE_SIG("the root lies in the enclosure, to the last bit", "[failure_time][families]",
                       FOR_DEGREES_TO_8) {
  for_all_families<Degree>(2400, 4, [](const FailureCase<Degree>& x) {
    const PolynomialCertificate<Degree> f{x.value};
    const FailureTime found = enclosed_failure_time(f, x.now, x.horizon);
    if (found.status != FailureStatus::root) return true;
    std::vector<double> c(x.value.position.c.begin(), x.value.position.c.end());
    const auto p = oracle::Polynomial::motion(c, x.value.start);
    // A crossing that no double sees may come before.
    const auto root = oracle::first_negative(p, oracle::rational(std::max(x.now, next_down(found.lower))));
    return root && root->compare(oracle::rational(found.lower)) >= 0 &&
           root->compare(oracle::rational(found.upper)) <= 0;
  });
}

TEMPLATE_TEST_CASE_SIG("ordinary polynomials ask for one value in double-double and no exact sign", "[failure_time]",
                       FOR_DEGREES_TO_8) {
  const std::uint64_t seed = 2500;
  const int rounds = 10000;
  Random random(seed);
  sign_counters = {};
  int failures = 0;
  for (int round = 0; round < rounds; ++round) {
    FailureCase<Degree> x = next_case<Degree>(Family::random, random);
    failures += failure_time(PolynomialCertificate<Degree>{x.value}, x.now, x.horizon) != never;
  }
  CAPTURE(Degree, seed, failures);
  CHECK(failures > rounds / 10);
  CHECK(sign_counters.exact <= rounds / 10000);
  CHECK(sign_counters.searches <= rounds / 1000);
  CHECK(sign_counters.extended <= static_cast<std::uint64_t>(failures) + rounds / 20);
}

// --- the rungs one by one

namespace {

/// What a failure time has asked for: values and signs in double-double, exact signs, searches.
template <class C>
SignCounters asked(const C& certificate, double now = 0) {
  sign_counters = {};
  failure_time(certificate, now);
  return sign_counters;
}

}  // namespace

TEST_CASE("a root among the doubles is placed by one value, one at a double by an exact sign", "[failure_time]") {
  const SignCounters known = asked(Value<2>{{{{1, -1, -1}}, 0}});  // a parabola of known coefficients: not even that
  CHECK(known.extended == 0);
  CHECK(known.exact == 0);
  CHECK(known.searches == 0);
  const SignCounters ordinary = asked(Value<3>{{{{1, -1, -1, 0}}, 0}});
  CHECK(ordinary.extended == 1);
  CHECK(ordinary.exact == 0);
  CHECK(ordinary.searches == 0);
  const SignCounters cubic = asked(Value<3>{{{{1, -1, -1, -1}}, 0}});
  CHECK(cubic.extended == 1);
  CHECK(cubic.exact == 0);
  CHECK(cubic.searches == 0);
  const Value<3> at_one{{{{3, -1, -1, -1}}, 0}};
  CHECK(failure_time(at_one, 0) == 1);
  CHECK(asked(at_one).exact == 1);
  CHECK(asked(at_one).searches == 0);
  // 2^-110 to either side of 1: beyond what one value in double-double tells.
  for (const double shift : {0x1p-110, -0x1p-110}) {
    const Value<4> beside_one{{{{3, -1, -1, -1, 0}}, 0}};
    Value<4> moved = beside_one;
    moved.value.position.c[4] = shift;
    CHECK(failure_time(moved, 0) == (shift > 0 ? next_up(1) : 1.0));
    CHECK(asked(moved).exact == 1);
    CHECK(asked(moved).searches == 0);
  }
}

TEST_CASE("certificates that touch zero are left to exact signs", "[failure_time]") {
  const Value<2> touch{{{{1, -2, 1}}, 0}};
  CHECK(failure_time(touch, 0) == never);
  CHECK(asked(touch).searches == 1);
  const Value<4> touches_twice{{{{4, 0, -4, 0, 1}}, 0}};  // (t^2 - 2)^2: touches where no double is
  CHECK(failure_time(touches_twice, 0) == never);
  CHECK(asked(touches_twice).searches == 1);
  const Value<3> touches_then_falls{{{{2, -5, 4, -1}}, 0}};
  CHECK(failure_time(touches_then_falls, 0) == 2);
  CHECK(asked(touches_then_falls).searches == 1);
}

TEST_CASE("signs alone decide where nothing fails", "[failure_time]") {
  for (const SignCounters& counted :
       {asked(Value<4>{{{{1, 2, 0, 3, 4}}, 0}}), asked(Value<2>{{{{1, -1, 1}}, 0}}),
        asked(Value<4>{{{{1, -1, 0, 0, 1}}, 0}}), asked(Value<6>{{{{1, 0, -1, 0, 0, 0, 1}}, 0}})}) {
    CHECK(counted.extended == 0);
    CHECK(counted.exact == 0);
    CHECK(counted.searches == 0);
  }
}

TEST_CASE("a horizon at, before and after the root, for results with enclosures", "[failure_time]") {
  const Value<2> f{{{{2, 0, -1}}, 0}};  // the root of 2
  const double t = failure_time(f, 0);
  CHECK(t == std::sqrt(2.0));  // which is above the root
  CHECK(enclosed_failure_time(f, 0, t).status == FailureStatus::root);
  CHECK(enclosed_failure_time(f, 0, next_down(t)).status == FailureStatus::holds);
  CHECK(enclosed_failure_time(f, 0, next_down(t)).time == never);
  CHECK(enclosed_failure_time(f, t).status == FailureStatus::fails_at_once);
  CHECK(enclosed_failure_time(f, 1, 0.5).status == FailureStatus::holds);
  CHECK(certified_failure_time(f, 0).lower == next_down(t));
  CHECK(certified_failure_time(f, 0).upper == t);
}

}  // namespace test_failure_time_families
