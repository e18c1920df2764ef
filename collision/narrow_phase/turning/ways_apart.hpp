// When two bodies that turn begin and cease to penetrate, by the ways in which they can be apart.
#pragma once

#include "collision/narrow_phase/narrow_phase.hpp"
#include "kds/turning/turning_certificate.hpp"
#include "kds/turning/turning_failure_time.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace kds::collision {

/// Finds contacts of a pair that has a finite number of *ways* of being apart, each of them a conjunction of turning
/// certificates, its conditions: the bodies do not penetrate if all the conditions of some way hold.
///
/// `Pair`: `ways`, their number; `every_condition(way, test)`; `needs_positive(way)`, whether a way all of whose
/// conditions are zero does not count; `gaps(t, gap)`, which fills in a width for each way and returns an error, so
/// that a way that is narrower than -error has a condition that is broken at t; `apart_until(t, horizon)`, a proven
/// time; `time_of_turning()`.
///
/// Laws: what is found depends on exact signs alone, so that it is the same whatever doubles have left out. A contact
/// is the first double just after which no way is open.
///
/// Method: a way that is open just after t stays so until the first of its conditions fails. Then another may be open,
/// just after that time; if none is, they penetrate. Before that, as far as they get, proofs in doubles.
template <class Pair>
class WaysApart {
 public:
  explicit WaysApart(const Pair& pair) : pair_(pair) {}

  /// Whether the two penetrate just after t.
  bool penetrate(double t) const { return open_way(t) == none; }

  /// The first double in [t, horizon] just after which they do, or `never`.
  double first_penetration(double t, double horizon) const {
    while (t <= horizon) {
      const double apart = pair_.apart_until(t, horizon);
      if (apart > t) {
        t = apart;
        continue;
      }
      const int way = open_way(t);
      if (way == none) return t;
      const double until = std::min(horizon, std::max(next_up(t), t + pair_.time_of_turning()));
      const double fails = closes(way, t, until);
      if (fails == never && until == horizon) return never;
      t = std::min(fails, until);
    }
    return never;
  }

  /// The first double in [t, horizon] just after which they do not, or `never`.
  double first_parting(double t, double horizon) const {
    while (t <= horizon) {
      if (!penetrate(t)) return t;
      const double until = std::min(horizon, std::max(next_up(t), t + pair_.time_of_turning()));
      const double opens = first_opening(t, until);
      if (opens != never) return opens;
      if (until == horizon) return never;
      t = until;
    }
    return never;
  }

 private:
  static constexpr int none = -1;

  /// Whether all conditions of a way hold just after t.
  bool open(int way, double t) const {
    bool positive = !Pair::needs_positive(way);
    const bool all = pair_.every_condition(way, [&](const auto& condition) {
      const int sign = sign_after(condition, t);
      positive = positive || sign > 0;
      return sign >= 0;
    });
    return all && positive;
  }

  /// One that is open just after t, or `none`; the widest first.
  int open_way(double t) const {
    std::array<double, Pair::ways> gap;
    const double error = pair_.gaps(t, gap);
    for (;;) {
      const auto widest = std::max_element(gap.begin(), gap.end());
      if (*widest < -error || *widest == -never) return none;
      const int way = static_cast<int>(widest - gap.begin());
      if (open(way, t)) return way;
      *widest = -never;
    }
  }

  /// The first double in [t, until] just after which a condition of a way is broken, or `never`.
  double closes(int way, double t, double until) const {
    double first = never;
    pair_.every_condition(way, [&](const auto& condition) {
      first = std::min(first, failure_time(condition, t, std::min(first, until)));
      return true;
    });
    return first;
  }

  /// The first double in [t, until] just after which a way is open. Precondition: none is open just after t.
  double first_opening(double t, double until) const {
    std::array<double, Pair::ways> gap;
    pair_.gaps(t, gap);
    double first = never;
    for (int round = 0; round < Pair::ways; ++round) {  // the widest first, which is mostly the one
      const auto widest = std::max_element(gap.begin(), gap.end());
      const int way = static_cast<int>(widest - gap.begin());
      *widest = -never;
      first = std::min(first, opens(way, t, std::min(first, until)));
    }
    return first;
  }

  /// The first double in [t, until] just after which all conditions of a way hold, or `never`.
  double opens(int way, double t, double until) const {
    if (Pair::needs_positive(way) && separates_nothing(way, t)) return never;
    for (bool waited = true; waited;) {
      waited = false;
      pair_.every_condition(way, [&](const auto& condition) {
        if (sign_after(condition, t) >= 0) return true;
        t = recovery_time(condition, t, until);
        waited = true;
        return t != never;
      });
      if (t == never) return never;
    }
    return t;
  }

  /// Whether all of its conditions are zero at all times. Most are not at t, which costs less to say.
  bool separates_nothing(int way, double t) const {
    return pair_.every_condition(
        way, [&](const auto& condition) { return sign_at(condition, t) == 0 && vanishes(condition); });
  }

  const Pair& pair_;
};

}  // namespace kds::collision
