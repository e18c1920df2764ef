// When two bodies that turn begin and cease to penetrate, by the ways in which they can be apart.
#pragma once

#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/turning/exact_signs.hpp"
#include "collision/narrow_phase/turning/pair_frame.hpp"
#include "collision/narrow_phase/turning/way_widths.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <tuple>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace kds::collision {

/// Finds contacts of a pair that has a finite number of *ways* of being apart, each of them a conjunction of turning
/// certificates, its conditions: the bodies do not penetrate if all the conditions of some way hold.
///
/// `Pair`: `ways`, their number, a constant or a member; `all(way)`, its conditions, and `every_condition(way,
/// conditions, test)`; `separates_nothing(way, vanishes)`, whether the way does not count: all of its conditions are
/// zero at all times, as vanishes(certificate) tells, and `known_to_separate_nothing(way)`, where that is told at once;
/// `frame(t)`, what is known in doubles; if the number of ways is a constant, `gaps(frame, gap)`, which fills in a
/// width for each way and returns an error, so that a way that is narrower than -error has a condition that is broken
/// then; if it is a member, `near_ways(frame, stretch)`, the ways that are not certainly closed just after all times of
/// the stretch, with their widths, and `error(frame)`; `fastest(frame, stretch)`, a bound on how fast widths change;
/// `unsure(frame, way, stretch)`, the conditions that have to be looked at, and perhaps
/// `unsure_while_open`, the same of a way whose conditions hold just after the time of the frame; perhaps
/// `is_thin(frame, way)`, whether a way is along edges that are nearly parallel; perhaps `many_conditions`, if they are
/// never all to be looked at; `apart_until(t, horizon)`, a proven time; `time_of_turning()`; perhaps `open_wait(frame,
/// way, stretch)`, for how long a way that is open just after the time of the frame stays so for certain, `waits`, the
/// same of each of its conditions by its number, and `stretch(frame, longest)`, how far these can be told; perhaps
/// `closed_wait(frame, way, stretch)`, with these and `is_thin`, for how long one of its conditions is broken for
/// certain.
///
/// Laws: what is found depends on exact signs alone, so that it is the same whatever doubles have left out. A contact
/// is the first double just after which no way is open.
///
/// Method: a way that is open just after t stays so until the first of its conditions fails. Then another may be open,
/// just after that time; if none is, they penetrate. Before that, as far as they get, proofs in doubles.
///
/// `Signs` finds signs and when they change: kds::sign_after, failure_time, recovery_time and vanishes, or what
/// remembers them.
template <class Pair, class Signs = ExactSigns>
class WaysApart {
 public:
  using Frame = std::decay_t<decltype(std::declval<const Pair&>().frame(0.0))>;

  explicit WaysApart(const Pair& pair, Signs signs = Signs()) : pair_(pair), signs_(signs) {
    if constexpr (has_constant_ways<Pair>) {
      for (Way way = 0; way < pair_.ways; ++way) {
        nothing_[static_cast<std::size_t>(way)] = pair.known_to_separate_nothing(way) ? 1 : -1;
      }
    }
  }

  /// The same, with a frame that is known.
  WaysApart(const Pair& pair, Signs signs, const Frame& frame) : WaysApart(pair, signs) { frame_.emplace(frame); }

  /// Whether the two penetrate just after t.
  bool penetrate(double t) const { return open_way(t) == none; }

  /// The first double in [t, horizon] just after which they do, or `never`. `stuck`: proofs are known to tell nothing
  /// more at t.
  double first_penetration(double t, double horizon, bool stuck = false) const {
    while (t <= horizon) {
      if (!stuck) {
        if (const double apart = apart_until(t, horizon); apart > t) {
          t = apart;
          continue;
        }
      }
      stuck = false;
      const Way way = open_way(t);
      if (way == none) return t;
      double until = std::min(horizon, std::max(next_up(t), t + pair_.time_of_turning()));
      const double fails = closes(way, t, until);
      if (fails == never && until == horizon) return never;
      t = std::min(fails, until);
    }
    return never;
  }

  /// The first double in [t, horizon] just after which they do not, or `never`. `penetrates`: they are known to do so
  /// just after t.
  double first_parting(double t, double horizon, bool penetrates = false) const {
    constexpr double worth = 0x1p-6;  // of the time of turning: shorter waits are left to exact signs
    double part = 0x1p-4;  // of it that these look at once: for what overlaps for long, twice as much each time
    while (t <= horizon) {
      if (!penetrates && !penetrate(t)) return t;
      const double turning = pair_.time_of_turning();
      const double turned = std::min(horizon, std::max(next_up(t), t + turning));
      const double deep = turned - t > part * turning ? deep_until(t, turned) : t;
      penetrates = deep - t > worth * (turned - t);
      if (penetrates) {
        if (deep >= horizon) return never;
        t = deep;
        continue;
      }
      const double until = std::min(turned, std::max(next_up(t), t + part * turning));
      const double opens = first_opening(t, until);
      if (opens != never) return opens;
      if (until == horizon) return never;
      t = until;
      part = std::min(1.0, 2 * part);
    }
    return never;
  }

  static constexpr bool follows_open_ways = requires(const Pair& pair, const Frame& frame) {
    pair.open_wait(frame, 0, pair.stretch(frame, 0.0));
  };

  /// A time until which a way that is open just after t stays so for certain; t if none is, or if doubles do not tell.
  double open_until(double t, double horizon) const requires follows_open_ways {
    const Way way = open_way(t);
    if (way == none) return t;
    const Frame& frame = this->frame(t);
    const double all = (horizon - t) * (1 + 0x1p-40), stretch = pair_.stretch(frame, all);
    const double wait = pair_.open_wait(frame, way, stretch);
    return wait >= all ? never : after_wait(t, wait, stretch);
  }

 private:
  using Way = WayOf<Pair>;
  using Widths = WayWidths<Pair>;
  using Conditions = typename Pair::Conditions;
  static constexpr Way none = -1;

  /// The last one is kept.
  const Frame& frame(double t) const {
    if (!frame_ || frame_->time != t) frame_.emplace(pair_.frame(t));
    return *frame_;
  }
  double apart_until(double t, double horizon) const {
    if constexpr (requires(const Frame& frame) { pair_.apart_until(frame, horizon); }) {
      return pair_.apart_until(frame(t), horizon);
    } else {
      return pair_.apart_until(t, horizon);
    }
  }

  /// Of a stretch: what is likely to be all that is needed of it.
  static constexpr double soon_part = 0x1p-10;

  /// Whether all conditions of a way hold just after the time of the frame.
  bool open(Way way, const Frame& frame) const {
    if (known_nothing(way) > 0) return false;
    return pair_.every_condition(way, pair_.unsure(frame, way, 0), [&](const auto& condition) {
      const int sign = signs_.sign_after(condition, frame.time);
      return sign > 0 || (sign == 0 && !separates_nothing(way));
    });
  }

  /// Of a way: whether it separates nothing; -1: not known.
  signed char& known_nothing(Way way) const {
    if constexpr (has_constant_ways<Pair>) {
      return nothing_[static_cast<std::size_t>(way)];
    } else {
      const auto [known, is_new] = nothing_.try_emplace(way, static_cast<signed char>(-1));
      if (is_new && pair_.known_to_separate_nothing(way)) known->second = 1;
      return known->second;
    }
  }
  static auto nothing_known() {
    if constexpr (has_constant_ways<Pair>) {
      return std::array<signed char, static_cast<std::size_t>(Pair::ways)>{};
    } else {
      return std::unordered_map<Way, signed char>{};
    }
  }

  /// Those that may be open just after times of the stretch.
  Widths widths(const Frame& frame, double stretch) const {
    Widths widths(pair_, frame, stretch);
    widths.leave_out([this](Way way) { return known_nothing(way) > 0; });
    return widths;
  }

  /// Calls visit(way) for those that are no narrower than least(), the widest first, until it returns true. Thin ways
  /// come last: signs of what is parallel but for roundings cost most, and where another way is open they are not
  /// asked.
  template <class Least, class Visit>
  void every_way(const Frame& frame, Widths& widths, const Least& least, const Visit& visit) const {
    std::vector<WayWidth<Way>> thin;
    for (;;) {
      const WayWidth<Way> widest = widths.take_widest();
      const Way way = widest.way;
      if (widest.width == -never || widest.width < least()) break;
      if constexpr (requires { pair_.is_thin(frame, way); }) {
        if (pair_.is_thin(frame, way)) {
          thin.push_back(widest);
          continue;
        }
      }
      if (visit(way)) return;
    }
    for (const auto& [way, width] : thin) {
      if (!(width < least()) && visit(way)) return;
    }
  }

  /// One that is open just after t, or `none`.
  Way open_way(double t) const {
    const Frame& frame = this->frame(t);
    Widths widths = this->widths(frame, 0);
    Way found = none;
    every_way(
        frame, widths, [least = -widths.error()] { return least; },
        [&](Way way) {
          if (open(way, frame)) found = way;
          return found != none;
        });
    return found;
  }

  /// The first double in [t, until] just after which a condition of a way is broken, or `never`. Mostly it is soon, and
  /// then few conditions have to be looked at. `until` may become less.
  double closes(Way way, double t, double& until) const {
    const Frame& frame = this->frame(t);
    if constexpr (requires { pair_.waits(frame, way, 0.0); }) {
      const double all = (until - t) * (1 + 0x1p-40), stretch = pair_.stretch(frame, all);
      if (stretch < all) until = std::max(next_up(t), std::min(until, next_down(t + stretch)));
      // Those first that may be broken first: then the others are mostly known not to be broken before.
      auto waits = pair_.waits(frame, way, stretch);
      double first = never;
      for (;;) {
        const auto least = std::min_element(waits.begin(), waits.end());
        if (*least >= stretch || (first != never && next_down(t + *least) >= first)) return first;
        *least = never;
        const auto bit = Conditions{1} << (least - waits.begin());
        pair_.every_condition(way, bit, [&](const auto& condition) {
          first = std::min(first, signs_.failure_time(condition, t, std::min(first, until)));
          return true;
        });
      }
    }
    const double soon = t + soon_part * (until - t);
    for (const double end : {soon, until}) {
      double first = never;
      pair_.every_condition(way, unsure_while_open(frame, way, (end - t) * (1 + 0x1p-40)), [&](const auto& condition) {
        first = std::min(first, signs_.failure_time(condition, t, std::min(first, end)));
        return true;
      });
      if (first != never) return first;
    }
    return never;
  }

  Conditions unsure_while_open(const Frame& frame, Way way, double stretch) const {
    if constexpr (requires { pair_.unsure_while_open(frame, way, stretch); }) {
      return pair_.unsure_while_open(frame, way, stretch);
    } else {
      return pair_.unsure(frame, way, stretch);
    }
  }

  /// A time up to `until` just after which all ways are surely closed, as just after all times from t on: they are so
  /// narrow at t, and do not widen faster. t if doubles do not tell.
  double deep_until(double t, double until) const {
    const Frame& frame = this->frame(t);
    const double stretch = (until - t) * (1 + 0x1p-40);
    const Widths widths = this->widths(frame, stretch);
    const double error = widths.error(), widest = widths.widest();
    if (!(widest < -error)) return t;
    const double wait = (-error - widest) / pair_.fastest(frame, stretch) * (1 - 0x1p-30);
    return wait > stretch ? until : std::max(t, next_down(t + wait));
  }

  /// The first double in [t, until] just after which a way is open. Precondition: none is open just after t.
  double first_opening(double t, double until) const {
    const Frame& frame = this->frame(t);
    Widths widths = this->widths(frame, (until - t) * (1 + 0x1p-40));
    const double error = widths.error();
    const double fastest = pair_.fastest(frame, (until - t) * (1 + 0x1p-40));
    double first = never;
    // Narrower ones are not open by then.
    const auto least = [&] { return -error - fastest * ((std::min(first, until) - t) * (1 + 0x1p-40)); };
    if constexpr (!requires { pair_.closed_wait(frame, 0, 0.0); }) {
      every_way(frame, widths, least, [&](Way way) {
        first = std::min(first, opens(way, t, std::min(first, until)));
        return false;
      });
    } else {
      // An exact look at the widest one mostly leaves few others that may open before. Of these the first come first.
      struct Other {
        bool thin;
        double closed_until;
        Way way;
      };
      std::vector<Other> others;
      bool any = false;
      every_way(frame, widths, least, [&](Way way) {
        const double end = std::min(first, until);
        if (!std::exchange(any, true)) {
          first = opens(way, t, end);
        } else if (const double closed = closed_until(frame, way, end); closed < end) {
          others.push_back({pair_.is_thin(frame, way), closed, way});
        }
        return false;
      });
      std::sort(others.begin(), others.end(), [](const Other& x, const Other& y) {
        return std::tie(x.thin, x.closed_until, x.way) < std::tie(y.thin, y.closed_until, y.way);
      });
      for (const Other& other : others) {
        const double end = std::min(first, until);
        if (other.closed_until < end) first = std::min(first, opens(other.way, other.closed_until, end));
      }
    }
    return first;
  }

  /// A time up to `end`, not before that of the frame, until which a way is closed for certain, just after all times
  /// before it.
  double closed_until(const Frame& frame, Way way, double end) const {
    const double all = (end - frame.time) * (1 + 0x1p-40);
    const double wait = pair_.closed_wait(frame, way, pair_.stretch(frame, all));
    if (wait >= all) return end;
    return wait > 0 ? std::max(frame.time, next_down(frame.time + wait)) : frame.time;
  }

  /// The first double in [t, until] just after which all conditions of a way hold, or `never`.
  double opens(Way way, double t, double until) const {
    for (bool waited = true; waited;) {
      waited = false;
      pair_.every_condition(way, conditions_at(way, t), [&](const auto& condition) {
        if (signs_.sign_after(condition, t) >= 0) return true;
        t = signs_.recovery_time(condition, t, until);
        waited = true;
        return t != never;
      });
      if (t == never) return never;
    }
    if constexpr (has_many_conditions) return separates_nothing(way) ? never : t;
    // Conditions that are zero just after t are zero at all times.
    const auto zero = [&](const auto& condition) { return signs_.sign_after(condition, t) == 0; };
    return pair_.every_condition(way, pair_.all(way), zero) ? never : t;
  }

  /// Those that are to be looked at to know whether all hold just after t.
  static constexpr bool has_many_conditions = requires { Pair::many_conditions; };
  Conditions conditions_at(Way way, double t) const {
    if constexpr (has_many_conditions) {
      return pair_.unsure(frame(t), way, 0);
    } else {
      return pair_.all(way);
    }
  }

  /// As the pair says, which is asked once: exact zeros cost most.
  bool separates_nothing(Way way) const {
    signed char& known = known_nothing(way);
    if (known < 0) {
      const auto vanishes = [&](const auto& condition) { return signs_.vanishes(condition); };
      known = pair_.separates_nothing(way, vanishes) ? 1 : 0;
    }
    return known != 0;
  }

  const Pair& pair_;
  Signs signs_;
  mutable std::optional<Frame> frame_;
  mutable decltype(nothing_known()) nothing_ = nothing_known();
};

}  // namespace kds::collision
