// Hooks that lie: found on a sample of calls where KDS_CHECK_QUICK_ANSWERS is defined, and believed where it is not.
#include "kds/events/place_schedule.hpp"
#include "kds/roots/failure_time.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <stdexcept>

namespace test_hook_checks {
namespace {

using namespace kds;

enum class Lie { none, vanishes, extended_value, quick, after_turn, two };

/// 8 - t^3, with every hook, one of which may lie.
template <Lie lie>
struct Liar {
  static constexpr int degree = 3;
  Motion<3> value{{{8, 0, 0, -1}}, 0};

  template <class Number>
  Polynomial<3, Number> polynomial(double epoch) const {
    return about<Number>(value, epoch);
  }
  bool vanishes() const { return lie == Lie::vanishes; }
  Ball<DoubleDouble> extended_value(double t) const {
    const Ball<DoubleDouble> right = compensated_value(value.position, two_sum(t, -value.start));
    return lie == Lie::extended_value ? Ball<DoubleDouble>(right.middle + 0x1p-60, right.radius) : right;
  }
  double quick_failure_time(double now, double horizon) const { return answer(Lie::quick, now, horizon); }
  double quick_failure_time_after_turn(double now, double horizon) const {
    return answer(Lie::after_turn, now, horizon);
  }
  static TwoTimes quick_failure_times(const Liar& a, const Liar& b, double now, double horizon) {
    return {a.answer(Lie::two, now, horizon), b.answer(Lie::two, now, horizon)};
  }

  static double answer(Lie which, double now, double horizon) {
    const double right = now > 2 ? now : (horizon >= failure ? failure : never);
    return lie == which ? next_up(right) : right;
  }
  inline static const double failure = failure_time(PolynomialCertificate<3>{{{{8, 0, 0, -1}}, 0}}, 0);
};

/// Asks everything once.
template <Lie lie>
void ask() {
  const Liar<lie> liar;
  failure_time(liar, 0, 3);
  failure_time_after_turn(liar, 0, 3);
  recovery_time(liar, 3, 9);
  PlaceSchedule schedule;
  schedule.resize(2);
  schedule.certify_two(0, liar, 1, liar, 0);
  detail::extended_value(liar, 1.5);
  detail::known_to_vanish(liar);
}

}  // namespace

TEST_CASE("hooks that tell the truth pass the checks, which are not counted", "[hooks]") {
  sign_counters = {};
  CHECK_NOTHROW(ask<Lie::none>());
  const SignCounters first = sign_counters;  // the first answers are checked, where any are
  sign_counters = {};
  CHECK_NOTHROW(ask<Lie::none>());
  CHECK(sign_counters.extended == first.extended);
  CHECK(sign_counters.exact == first.exact);
  CHECK(sign_counters.searches == first.searches);
}

#ifdef KDS_CHECK_QUICK_ANSWERS

TEST_CASE("a hook that lies is found, and the certificate named", "[hooks]") {
  using Catch::Contains;
  CHECK_THROWS_WITH(ask<Lie::vanishes>(), Contains("Liar<") && Contains("vanishes is true"));
  CHECK_THROWS_WITH(ask<Lie::extended_value>(), Contains("Liar<") && Contains("extended_value is off"));
  CHECK_THROWS_WITH(ask<Lie::quick>(), Contains("Liar<") && Contains("quick_failure_time gives 0x"));
  CHECK_THROWS_WITH(ask<Lie::after_turn>(), Contains("quick_failure_time_after_turn gives 0x"));
  CHECK_THROWS_WITH(ask<Lie::two>(), Contains("quick_failure_times gives 0x"));
}

TEST_CASE("one answer of 1 024 is checked", "[hooks]") {
  const Liar<Lie::quick> liar;
  int refused = 0;
  for (std::uint32_t i = 0; i < 4 * detail::answers_per_check; ++i) {
    try {
      failure_time(liar, 0, 3);
    } catch (const std::logic_error&) {
      ++refused;
    }
  }
  CHECK(refused == 4);
}

#else

TEST_CASE("without the checks hooks are believed", "[hooks]") {
  CHECK(failure_time(Liar<Lie::quick>{}, 0, 3) == next_up(Liar<Lie::none>::failure));
  CHECK_NOTHROW(ask<Lie::two>());
}

#endif

}  // namespace test_hook_checks
