// The quick answers of Order against the general method: the same double, or none.
#pragma once

#include "certificates/order.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>

namespace kds::tests {

using kds::certificates::Order;

/// Order without its quick answers.
template <int Degree>
struct CarefulOrder {
  static constexpr int degree = Degree;
  Order<Degree> order;

  template <class Number>
  Polynomial<Degree, Number> polynomial(double epoch) const {
    return order.template polynomial<Number>(epoch);
  }
  Ball<DoubleDouble> extended_value(double t) const { return order.extended_value(t); }
  bool vanishes() const { return order.vanishes(); }
};

template <int Degree>
std::string describe(const Motion<Degree>& lower, const Motion<Degree>& upper, double now, double horizon) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const auto* motion : {&lower, &upper}) {
    for (const double c : motion->position.c) text << c << ' ';
    text << "from " << motion->start << ", ";
  }
  text << "now " << now << ", horizon " << horizon;
  return text.str();
}

/// Asks both ways and keeps count.
struct Comparison {
  int asked = 0;
  int undecided = 0;
  int failures = 0;  ///< failure times found
  int wrong = 0;
  int undecided_together = 0;  ///< pairs in order from a common start with a quick answer, but not beside another pair
  std::string example;

  template <int Degree>
  void ask(const Motion<Degree>& lower, const Motion<Degree>& upper, double now, double horizon, bool turned = false) {
    if (!(now <= horizon)) return;
    const Order<Degree> order{lower, upper};
    const CarefulOrder<Degree> careful{order};
    double expected, quick, answer;
    if (turned) {
      expected = failure_time(careful, now, horizon);
      quick = order.quick_failure_time_after_turn(now, horizon);
      answer = failure_time_after_turn(order, now, horizon);
    } else {
      expected = failure_time(careful, now, horizon);
      quick = order.quick_failure_time(now, horizon);
      answer = failure_time(order, now, horizon);
    }
    ++asked;
    failures += expected < never;
    undecided += std::isnan(quick);
    if constexpr (Degree == 1) {
      if (!turned && !ask_together(lower, upper, now, horizon, expected, quick) && wrong++ == 0) {
        example = describe(lower, upper, now, horizon) + ", together";
      }
    }
    if (answer == expected && (std::isnan(quick) || quick == expected)) return;
    if (wrong++ == 0) example = describe(lower, upper, now, horizon) + (turned ? ", turned" : "");
  }

  /// From `now`; where they are known to be in order, without looking; with the horizon at the failure and around it;
  /// at the failure, when they have swapped.
  template <int Degree>
  void ask_around(const Motion<Degree>& lower, const Motion<Degree>& upper, double now, double horizon) {
    ask(lower, upper, now, horizon);
    ask(lower, upper, now, never);
    if (sign_after(CarefulOrder<Degree>{{lower, upper}}, now) > 0) {
      ask(lower, upper, now, horizon, true);
      ask(lower, upper, now, never, true);
    }
    const double t = failure_time(CarefulOrder<Degree>{{lower, upper}}, now);
    if (t == never) return;
    for (const double edge : {next_down(t), t, next_up(t)}) ask(lower, upper, now, edge);
    if (t == now) return;
    ask(upper, lower, t, never, true);
    ask(upper, lower, t, std::max(t, horizon), true);
    ask(upper, lower, t, never);
  }

  /// As first and as second of two.
  bool ask_together(const Motion<1>& lower, const Motion<1>& upper, double now, double horizon, double expected,
                    double quick) {
    const Order<1> order{lower, upper};
    const Order<1> other{before_[0], before_[1]};
    const double first = Order<1>::quick_failure_times(order, other, now, horizon).first;
    const double second = Order<1>::quick_failure_times(other, order, now, horizon).second;
    if (lower.start == upper.start) {
      before_ = {lower, upper};
      undecided_together += quick > now && (std::isnan(first) || std::isnan(second));
    }
    return (std::isnan(first) || first == expected) && (std::isnan(second) || second == expected);
  }

  void report() const {
    INFO("asked " << asked << ", failures " << failures << ", undecided " << undecided << ", wrong " << wrong << ": "
                  << example);
    CHECK(wrong == 0);
    CHECK(failures > asked / 5);
  }

 private:
  std::array<Motion<1>, 2> before_;
};

enum class Starts { common, different };

}  // namespace kds::tests
