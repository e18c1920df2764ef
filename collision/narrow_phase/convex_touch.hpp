// When a triangle touches another triangle or a box, one of them moving.
#pragma once

#include "collision/narrow_phase/curve_spans.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/placed_surface.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/separating_axes.hpp"
#include "collision/narrow_phase/time_spans.hpp"
#include "collision/narrow_phase/touch_condition.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>

namespace kds::collision {

/// How two shapes touch at a time.
struct TouchDirection {
  Eigen::Vector3d normal;  ///< unit, from a to b
  double separation;       ///< along the normal; < 0: penetration
  bool approaching;
};

/// When a triangle and another convex shape touch: while all the conditions "their gap along this direction is below
/// the contact gap" hold, each of them a polynomial of the time. All answers are closed forms of the shapes and the
/// motion alone.
template <int Degree, class B>
class ConvexTouch {
 public:
  /// `sharp`: whether both may have sharp corners, see every_kdop_direction; a box has none.
  ConvexTouch(const PlacedTriangle& a, const B& b, const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap,
              bool sharp)
      : a_(a), b_(b), motion_(motion), gap_(gap) {
    if constexpr (Degree >= 3) {
      add_curves(sharp);
      return;
    }
    const auto add_side = [&](const Condition& condition, bool decides) {
      if constexpr (Degree == 1) {
        add(condition, decides);
      } else if constexpr (Degree == 2) {
        const auto& p = condition.separation;
        near_[size_++] = negative_spans(p[0] - gap.c[0], p[1] - gap.c[1], p[2] - gap.c[2]);
      }
    };
    every_condition([&](const Condition& condition) { add_side(condition, true); });
    if (with_kdops && sharp) {
      every_kdop_direction(a_, b_, [&](const Eigen::Vector3d& axis, const Interval& of_a, const Interval& of_b) {
        if (Degree == 1 && !(enter_ <= leave_)) return false;  // they never touch
        both_sides(axis, of_a, of_b, [&](const Condition& condition) { add_side(condition, false); });
        return true;
      });
    }
    if constexpr (Degree == 1) near_[size_++] = TimeSpans::between(enter_, leave_);
  }

  /// The same at less cost if only times within a window are of interest. Precondition: if the two touch in the window,
  /// they do not touch before it, or only the begin of the window is asked about.
  ConvexTouch(const PlacedTriangle& a, const B& b, const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap,
              bool sharp, const TimeWindow& interest) requires(Degree == 1)
      : a_(a), b_(b), motion_(motion), gap_(gap) {
    near_[size_++] = add_within(interest, sharp) ? TimeSpans::between(enter_, leave_) : TimeSpans{};
  }

  /// The first time >= tau at which they touch, or infinity.
  double first_inside(double tau) const { return first_inside_all(near(), tau); }

  /// When the contact that holds at tau began and ends. Precondition: first_inside(tau) == tau.
  double enter(double tau) const { return enter_all(near(), tau); }
  double leave(double tau) const {
    for (;;) {
      tau = leave_all(near(), tau);
      if (tau == TimeSpans::infinity || first_inside(tau) != tau) return tau;
    }
  }

  /// Whether, at tau, they approach along the direction of least overlap.
  bool approaching(double tau) const {
    if constexpr (Degree == 1) {
      // This is the direction along which they have just come within the gap.
      if (tau == near_[0].begin[0] && entry_speed_ > tilted_speeds()[0] && meets_along(entry_normal_, gap_(tau))) {
        return true;
      }
    }
    return direction(tau).approaching;
  }

  /// The direction, from a to b, along which they overlap least just after tau, of those along which they can meet.
  ///
  /// Among directions that are equal within rounding a falling one is taken if none rises: then they approach. (A
  /// rising one will be the greatest, and they part along it.) For faces in one plane both directions of their normal
  /// are equal, and do not show on which side the bodies are: the centres decide.
  TouchDirection direction(double tau) const {
    const Conditions conditions(*this);
    const auto speeds = smallest_speeds(motion_), tilted = tilted_speeds();
    const Eigen::Vector3d offset = motion_.position(tau);
    const double gap = gap_(tau);
    const double rounding = gap / tie;
    // As many directions are left out as have to be: few are asked about. None is where they overlap along all.
    std::array<bool, capacity> left_out{};
    double most = -TimeSpans::infinity;
    bool all = std::all_of(conditions.begin(), conditions.end(),
                           [&](const Condition& each) { return each.deeper_than(gap_, gap, tau); });
    for (bool found = all; !found;) {
      most = -TimeSpans::infinity;
      std::size_t at = capacity;
      for (std::size_t i = 0; i < conditions.size(); ++i) {
        if (left_out[i] || !(conditions[i](tau) > most)) continue;
        most = conditions[i](tau);
        at = i;
      }
      found = at == capacity || meets_along(conditions[at].normal, gap);
      if (!found) left_out[at] = true;
      all = at == capacity;
    }
    if (all) {
      left_out.fill(false);
      for (const Condition& each : conditions) most = std::max(most, each(tau));
    }
    TouchDirection chosen{Eigen::Vector3d::Zero(), -TimeSpans::infinity, false};
    int chosen_trend = 0;
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      const Condition& each = conditions[i];
      const double separation = each(tau);
      if (left_out[i] || separation < most - rounding) continue;
      if (!all && !meets_along(each.normal, gap)) continue;
      if (opposite_of(conditions, each)(tau) >= most - rounding && dot(each.normal, offset) < 0) continue;
      const int trend = each.trend(tau, each.deeper_than(gap_, gap, tau) ? speeds : tilted);
      // Rising before falling before neither; then the greatest.
      const auto weight = [](int t) { return t > 0 ? 2 : (t < 0 ? 1 : 0); };
      const bool better =
          weight(trend) == weight(chosen_trend) ? separation > chosen.separation : weight(trend) > weight(chosen_trend);
      if (better) {
        chosen = {each.normal, separation, trend < 0};
        chosen_trend = trend;
      }
    }
    return chosen;
  }

  /// The first time after tau, before `end`, at which bodies that do not approach begin to, or `end`: where a
  /// separation that is the greatest of all along which they can meet has its maximum. Else the greatest goes on
  /// rising. Of paths of degree 2 also where one ceases to rise by more than its error, so that one that falls counts,
  /// and where one becomes as deep as a gap, or less deep.
  double turning(double tau, double end) const {
    if constexpr (Degree >= 3) {
      const Conditions conditions(*this);
      for (const Condition& each : conditions) {
        each_maximum(PolynomialCertificate<Degree>{{{each.separation}, 0.0}}, tau, end, [&](double top) {
          const double least = each(top) + gap_(top) / tie;
          const bool greatest = std::all_of(conditions.begin(), conditions.end(), [&](const Condition& c) {
            return c(top) <= least || !meets_along(c.normal, gap_(top));
          });
          if (greatest) end = top;
          return greatest;
        });
      }
    }
    if constexpr (Degree == 2) {
      const Conditions conditions(*this);
      const auto speeds = smallest_speeds(motion_), tilted = tilted_speeds();
      const auto look = [&](const Condition& each, double t) {
        if (!among_greatest(conditions, each, t) || !approaching(t)) return false;
        end = t;
        return true;
      };
      for (const Condition& each : conditions) {
        const auto look_here = [&](double t) { return look(each, t); };
        if (each.separation[2] < 0) {
          each_failure(each.rate({0, 0}), tau, end, look_here);
          for (const auto& error : {speeds, tilted}) {
            each_failure(each.rate({-error[0], -error[1]}), tau, end, look_here);
          }
        }
        each_change(each.above_gap(gap_), tau, end, look_here, look_here);
      }
    }
    return end;
  }

 private:
  /// Two sides of 17 axes.
  static constexpr std::size_t capacity = 34;
  /// Whether directions of k-DOPs are tested as well, which decide when the two touch, but not in which direction.
  static constexpr bool with_kdops = std::is_same_v<B, PlacedTriangle>;
  static constexpr std::size_t capacity_near = capacity + (with_kdops ? 26 : 0);
  /// Separations nearer than gap / tie are equal: 16 roundings, where two computations of one separation differ by 8.
  static constexpr double tie = 4;

  using Condition = TouchCondition<Degree>;

  /// Speeds up to these are rounding errors also where they are along the normals of triangles.
  auto tilted_speeds() const {
    auto speeds = smallest_speeds(motion_);
    double tilt = tilt_of(a_);
    if constexpr (std::is_same_v<B, PlacedTriangle>) tilt += tilt_of(b_);
    if constexpr (Degree <= 2) {
      speeds[0] += tilt * norm(motion_.coefficients[1]);
      if constexpr (Degree == 2) speeds[1] += 2 * tilt * norm(motion_.coefficients[2]);
    } else {
      for (std::size_t i = 1; i <= Degree; ++i) speeds[i] += tilt * norm(motion_.coefficients[i]);
    }
    return speeds;
  }

  /// Whether the two can meet along a normal: where a surface goes on, beyond the outermost edge or corner of the
  /// triangle, and comes out farther, something else of it is met first.
  bool meets_along(const Eigen::Vector3d& normal, double gap) const {
    if constexpr (std::is_same_v<B, PlacedTriangle>) {
      if (!is_outermost(b_, -normal, gap)) return false;
    }
    return is_outermost(a_, normal, gap);
  }

  /// Calls visit(condition) for both sides of every axis.
  template <class Visit>
  void every_condition(const Visit& visit) const {
    every_axis(a_, b_, [&](const Eigen::Vector3d& axis, const Interval& of_a, const Interval& of_b) {
      both_sides(axis, of_a, of_b, visit);
      return true;
    });
  }

  template <class Visit>
  void both_sides(const Eigen::Vector3d& axis, const Interval& of_a, const Interval& of_b, const Visit& visit) const {
    const double length = std::sqrt(dot(axis, axis));
    if (!(length > vanishing_axis)) return;
    const double inverse = 1 / length;
    const Eigen::Vector3d normal = axis * inverse;
    Condition condition{{}, normal};
    for (std::size_t i = 0; i <= Degree; ++i) condition.separation[i] = dot(normal, motion_.coefficients[i]);
    Condition opposite{{}, -normal};
    for (std::size_t i = 0; i <= Degree; ++i) opposite.separation[i] = -condition.separation[i];
    condition.separation[0] -= (of_a.high - of_b.low) * inverse;
    opposite.separation[0] -= (of_b.high - of_a.low) * inverse;
    visit(condition);
    visit(opposite);
  }

  /// Degree 3 and above: one condition that never holds ends the search.
  void add_curves(bool sharp) {
    constexpr std::size_t most = std::size_t{Degree} + 1;
    const auto add_sides = [&](const Eigen::Vector3d& axis, const Interval& of_a, const Interval& of_b) {
      bool near = true;
      both_sides(axis, of_a, of_b, [&](const Condition& condition) {
        if (!near) return;
        Polynomial<Degree> apart{condition.separation};
        for (std::size_t i = 0; i <= Degree; ++i) apart.c[i] -= gap_.c[i];
        near_[size_] = broken_spans<most>(PolynomialCertificate<Degree>{{apart, 0.0}}, never);
        near = !near_[size_++].empty();
      });
      return near;
    };
    if (every_axis(a_, b_, add_sides) && with_kdops && sharp) every_kdop_direction(a_, b_, add_sides);
  }

  /// Degree 1: the two are near from enter_ to leave_. `decides`: whether they may touch along the normal.
  void add(const Condition& condition, bool decides) {
    const double c0 = condition.separation[0] - gap_.c[0];
    const double c1 = condition.separation[1] - gap_.c[1];
    if (c1 > 0) {
      leave_ = std::min(leave_, -c0 / c1);
    } else if (c1 < 0) {
      const double begin = -c0 / c1;
      if (begin > enter_) {
        enter_ = begin;
        entry_speed_ = decides ? -condition.separation[1] : 0.0;
        entry_normal_ = condition.normal;
      }
    } else if (c0 >= 0) {
      leave_ = -TimeSpans::infinity;
    }
  }

  /// Adds the conditions that may change within the window; false if one certainly never holds there. Mostly this is
  /// decided by the condition's sign at both ends, on the axis without normalising it (no square root or quotient),
  /// with a margin of `quick_margin` gaps (as in may_touch). Each condition may shrink the window.
  bool add_within(TimeWindow window, bool sharp) {
    bool decides = true;
    const auto add_axis = [&](const Eigen::Vector3d& axis, const Interval& of_a, const Interval& of_b) {
      const double length = std::abs(axis[0]) + std::abs(axis[1]) + std::abs(axis[2]);
      if (!(length > vanishing_axis)) return true;
      const double p0 = dot(axis, motion_.coefficients[0]);
      const double p1 = dot(axis, motion_.coefficients[1]);
      const double high = of_a.high - of_b.low;
      const double low = of_a.low - of_b.high;
      const double at_begin = p0 + p1 * window.begin;
      const double at_end = p0 + p1 * window.end;
      const double spare = quick_margin * length;
      const double spare_begin = spare * gap_(window.begin);
      const double spare_end = spare * gap_(window.end);
      if (std::min(at_begin - spare_begin, at_end - spare_end) >= high) return false;
      if (std::max(at_begin + spare_begin, at_end + spare_end) <= low) return false;
      if (std::max(at_begin + spare_begin, at_end + spare_end) < high &&
          std::min(at_begin - spare_begin, at_end - spare_end) > low) {
        return true;
      }
      both_sides(axis, of_a, of_b, [&](const Condition& condition) { add(condition, decides); });
      window.begin = std::max(window.begin, enter_);
      window.end = std::min(window.end, leave_);
      return window.begin <= window.end;
    };
    if (!every_axis(a_, b_, add_axis)) return false;
    if (!with_kdops || !sharp) return true;
    decides = false;
    return every_kdop_direction(a_, b_, add_axis);
  }

  class Conditions {
   public:
    explicit Conditions(const ConvexTouch& touch) {
      touch.every_condition([this](const Condition& condition) { items_[size_++] = condition; });
    }
    std::size_t size() const { return size_; }
    const Condition& operator[](std::size_t i) const { return items_[i]; }
    const Condition* begin() const { return items_.data(); }
    const Condition* end() const { return items_.data() + size_; }

   private:
    std::array<Condition, capacity> items_;
    std::size_t size_ = 0;
  };

  /// Whether a separation may count for the direction at a time: unless another along which they can meet is greater.
  bool among_greatest(const Conditions& conditions, const Condition& each, double tau) const {
    const double gap = gap_(tau), least = each(tau) + 2 * gap / tie;
    return std::all_of(conditions.begin(), conditions.end(),
                       [&](const Condition& c) { return c(tau) <= least || !meets_along(c.normal, gap); });
  }

  /// The conditions of the two sides of an axis stand side by side.
  static const Condition& opposite_of(const Conditions& conditions, const Condition& condition) {
    return (&condition - conditions.begin()) % 2 == 0 ? *(&condition + 1) : *(&condition - 1);
  }

  std::span<const SpansOf<Degree>> near() const { return {near_.data(), size_}; }

  PlacedTriangle a_;
  B b_;
  const RelativeMotion<Degree>& motion_;
  ContactGap<Degree> gap_;
  std::array<SpansOf<Degree>, Degree == 1 ? 1 : capacity_near> near_;  ///< when each separation is below the gap
  std::size_t size_ = 0;
  // Degree 1:
  double enter_ = -TimeSpans::infinity;
  double leave_ = TimeSpans::infinity;
  double entry_speed_ = 0;  ///< along the axis on which they come within the gap last
  Eigen::Vector3d entry_normal_ = Eigen::Vector3d::Zero();
};

}  // namespace kds::collision
