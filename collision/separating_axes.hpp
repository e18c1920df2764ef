// Separating axes of a triangle with a triangle or a box, one of them moving.
#pragma once

#include "collision/relative_motion.hpp"
#include "collision/time_spans.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace kds::collision {

struct Interval {
  double low;
  double high;
};

/// A triangle in world orientation about the centre of its body.
struct PlacedTriangle {
  std::array<Eigen::Vector3d, 3> vertices;

  Interval project(const Eigen::Vector3d& axis) const {
    const double x = dot(axis, vertices[0]);
    const double y = dot(axis, vertices[1]);
    const double z = dot(axis, vertices[2]);
    return {std::min(x, std::min(y, z)), std::max(x, std::max(y, z))};
  }
  Eigen::Vector3d edge(std::size_t i) const { return vertices[i == 2 ? 0 : i + 1] - vertices[i]; }
};

/// A solid box about its centre.
struct PlacedBox {
  std::array<Eigen::Vector3d, 3> half_axes;
  Eigen::Matrix3d rotation;  ///< columns: normals of its faces

  Interval project(const Eigen::Vector3d& axis) const {
    const double reach =
        std::abs(dot(axis, half_axes[0])) + std::abs(dot(axis, half_axes[1])) + std::abs(dot(axis, half_axes[2]));
    return {-reach, reach};
  }
};

/// A ball about its centre.
struct PlacedBall {
  double radius;

  Interval project(const Eigen::Vector3d& axis) const {
    const double reach = radius * std::sqrt(dot(axis, axis));
    return {-reach, reach};
  }
};

inline Interval interval(double x, double y) { return x < y ? Interval{x, y} : Interval{y, x}; }

/// Calls test(axis, interval of a, interval of b) for the directions that can separate the two, until it says false;
/// returns what it said last. The intervals are the projections on the axis, which has any length.
///
/// Two triangles: the two normals, the nine products of edges, and the normals of the six edges in their planes, which
/// alone separate triangles of one plane, and keep those of nearly one plane from counting as touching far away from
/// each other. Any direction is a valid witness of separation, however it was rounded, so a bad one (from nearly
/// parallel edges) only fails to separate.
template <class Test>
bool every_axis(const PlacedTriangle& a, const PlacedTriangle& b, Test&& test) {
  const std::array<Eigen::Vector3d, 3> u{a.edge(0), a.edge(1), a.edge(2)};
  const std::array<Eigen::Vector3d, 3> v{b.edge(0), b.edge(1), b.edge(2)};
  // The ends of an edge project to one point, up to rounding, on an axis across it.
  const auto across = [](const PlacedTriangle& t, std::size_t i, const Eigen::Vector3d& axis) {
    return interval(dot(axis, t.vertices[i]), dot(axis, t.vertices[i == 0 ? 2 : i - 1]));
  };
  const auto flat = [](const PlacedTriangle& t, const Eigen::Vector3d& axis) {
    const double height = dot(axis, t.vertices[0]);
    return Interval{height, height};
  };
  const Eigen::Vector3d normal_a = cross(u[0], u[1]);
  if (!test(normal_a, flat(a, normal_a), b.project(normal_a))) return false;
  const Eigen::Vector3d normal_b = cross(v[0], v[1]);
  if (!test(normal_b, a.project(normal_b), flat(b, normal_b))) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Eigen::Vector3d axis = cross(u[i], v[j]);
      if (!test(axis, across(a, i, axis), across(b, j, axis))) return false;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = cross(u[i], normal_a);
    if (!test(axis, across(a, i, axis), b.project(axis))) return false;
  }
  for (std::size_t j = 0; j < 3; ++j) {
    const Eigen::Vector3d axis = cross(v[j], normal_b);
    if (!test(axis, a.project(axis), across(b, j, axis))) return false;
  }
  return true;
}

/// A triangle and a solid box: the normals of both and the products of their edges.
template <class Test>
bool every_axis(const PlacedTriangle& a, const PlacedBox& b, Test&& test) {
  const auto try_axis = [&](const Eigen::Vector3d& axis) { return test(axis, a.project(axis), b.project(axis)); };
  for (int i = 0; i < 3; ++i) {
    if (!try_axis(b.rotation.col(i))) return false;
  }
  const std::array<Eigen::Vector3d, 3> u{a.edge(0), a.edge(1), a.edge(2)};
  if (!try_axis(cross(u[0], u[1]))) return false;
  for (const auto& e : u) {
    for (int i = 0; i < 3; ++i) {
      if (!try_axis(cross(e, b.rotation.col(i)))) return false;
    }
  }
  return true;
}

/// A triangle and a ball: not all directions that can separate them (their number has no end), but the normals of the
/// triangle and its edges, and of the box around it.
template <class Test>
bool every_axis(const PlacedTriangle& a, const PlacedBall& b, Test&& test) {
  const auto try_axis = [&](const Eigen::Vector3d& axis) { return test(axis, a.project(axis), b.project(axis)); };
  const std::array<Eigen::Vector3d, 3> u{a.edge(0), a.edge(1), a.edge(2)};
  const Eigen::Vector3d normal = cross(u[0], u[1]);
  if (!try_axis(normal)) return false;
  for (int d = 0; d < 3; ++d) {
    if (!try_axis(Eigen::Vector3d::Unit(d))) return false;
  }
  for (const auto& e : u) {
    if (!try_axis(cross(e, normal))) return false;
  }
  return true;
}

/// Axes shorter than this are left out, which is always safe; with coordinates of 2^-100 to 2^100 they come from
/// parallel edges alone, and squares of projections do not underflow.
inline constexpr double vanishing_axis = 0x1p-320;

/// Cheap test: shrinks the window to times at which a and b may touch, with b moving; false if there are none.
/// Projections are widened by `margin` as in BoxPairTest, times the 1-norm of the axis, which is not below its length.
template <int Degree, class A, class B>
bool may_touch(const A& a, const B& b, const RelativeMotion<Degree>& motion,
               const std::array<double, Degree + 1>& margin, TimeWindow& window) {
  return every_axis(a, b, [&](const Eigen::Vector3d& axis, const Interval& of_a, const Interval& of_b) {
    const double length = std::abs(axis[0]) + std::abs(axis[1]) + std::abs(axis[2]);
    if (!(length > vanishing_axis)) return true;
    // They overlap while low < axis . r < high.
    const double low = of_a.low - of_b.high - length * margin[0];
    const double high = of_a.high - of_b.low + length * margin[0];
    const double p0 = dot(axis, motion.coefficients[0]);
    const double p1 = dot(axis, motion.coefficients[1]);
    const double m1 = length * margin[1];
    if constexpr (Degree == 1) {
      return clip_to_negative(p0 - high, p1 - m1, window) && clip_to_negative(low - p0, -p1 - m1, window);
    } else {
      const double p2 = dot(axis, motion.coefficients[2]);
      const double m2 = length * margin[2];
      return clip_to_negative(p0 - high, p1 - m1, p2 - m2, window) &&
             clip_to_negative(low - p0, -p1 - m1, -p2 - m2, window);
    }
  });
}

/// How two things touch at a time.
struct TouchDirection {
  Eigen::Vector3d normal;  ///< unit, from a to b
  double separation;       ///< along the normal; < 0: penetration
  bool approaching;
};

/// Speeds along an axis up to [0] + tau [1] are rounding: zero.
template <int Degree>
std::array<double, 2> smallest_speeds(const RelativeMotion<Degree>& motion) {
  constexpr double rounding = 8 * 0x1p-53;
  if constexpr (Degree == 1) {
    return {rounding * motion.coefficients[1].norm(), 0};
  } else {
    return {rounding * motion.coefficients[1].norm(), 2 * rounding * motion.coefficients[2].norm()};
  }
}

/// When a triangle and another convex shape touch: while all the conditions "their gap along this direction is below
/// the contact gap" hold, each of them a polynomial of the time. Everything it says is a closed form of the shapes and
/// the motion alone.
template <int Degree, class B>
class ConvexTouch {
 public:
  ConvexTouch(const PlacedTriangle& a, const B& b, const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap)
      : a_(a), b_(b), motion_(motion), gap_(gap) {
    double enter = -TimeSpans::infinity;
    double leave = TimeSpans::infinity;
    every_condition([&](const Condition& condition) {
      const auto& p = condition.separation;
      if constexpr (Degree == 1) {
        const double c0 = p[0] - gap.c[0];
        const double c1 = p[1] - gap.c[1];
        if (c1 > 0) {
          leave = std::min(leave, -c0 / c1);
        } else if (c1 < 0) {
          const double begin = -c0 / c1;
          if (begin > enter) {
            enter = begin;
            entry_speed_ = -p[1];
          }
        } else if (c0 >= 0) {
          leave = -TimeSpans::infinity;
        }
      } else {
        near_[size_++] = negative_spans(p[0] - gap.c[0], p[1] - gap.c[1], p[2] - gap.c[2]);
      }
    });
    if constexpr (Degree == 1) near_[size_++] = TimeSpans::between(enter, leave);
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
      // That is the direction along which they have just come within the gap.
      if (tau == near_[0].begin[0] && entry_speed_ > smallest_speeds(motion_)[0]) return true;
    }
    return direction(tau).approaching;
  }

  /// The direction, from a to b, along which they overlap least just after tau.
  ///
  /// Of directions that tie within rounding one that falls is taken if none rises: then they approach. (A rising one
  /// will be the greatest and they part along it.) Faces in one plane tie with both directions of their normal, and do
  /// not say on which side the bodies are: the centres do.
  TouchDirection direction(double tau) const {
    const Conditions conditions(*this);
    const auto speeds = smallest_speeds(motion_);
    const Eigen::Vector3d offset = motion_.position(tau);
    const double rounding = gap_(tau) / tie;
    double most = -TimeSpans::infinity;
    for (const Condition& each : conditions) most = std::max(most, each(tau));
    TouchDirection chosen{Eigen::Vector3d::Zero(), -TimeSpans::infinity, false};
    int chosen_trend = 0;
    for (const Condition& each : conditions) {
      const double separation = each(tau);
      if (separation < most - rounding) continue;
      if (opposite_of(conditions, each)(tau) >= most - rounding && dot(each.normal, offset) < 0) continue;
      const int trend = each.trend(tau, speeds);
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

  /// The first time after tau, before `end`, at which bodies that move apart turn towards each other: where a
  /// separation that is the greatest of all has its maximum, or `end`. Elsewhere the greatest separation rises on.
  double turning(double tau, double end) const {
    if constexpr (Degree == 2) {
      const Conditions conditions(*this);
      for (const Condition& each : conditions) {
        const auto& p = each.separation;
        if (!(p[2] < 0)) continue;
        const double top = -p[1] / (2 * p[2]);
        if (!(top > tau && top < end)) continue;
        const double least = each(top) + gap_(top) / tie;
        if (std::all_of(conditions.begin(), conditions.end(), [&](const Condition& c) { return c(top) <= least; })) {
          end = top;
        }
      }
    }
    return end;
  }

 private:
  /// Two sides of 17 axes.
  static constexpr std::size_t capacity = 34;
  /// Separations nearer than gap / tie are equal: 16 roundings, where two computations of one separation differ by 8.
  static constexpr double tie = 4;

  struct Condition {
    std::array<double, Degree + 1> separation;  ///< along the normal; below the gap: near
    Eigen::Vector3d normal;                     ///< unit, from a to b

    double operator()(double tau) const {
      if constexpr (Degree == 1) {
        return separation[0] + tau * separation[1];
      } else {
        return separation[0] + tau * (separation[1] + tau * separation[2]);
      }
    }

    /// 1 if it rises just after tau, -1 if it falls, 0 if it does neither but for rounding.
    int trend(double tau, const std::array<double, 2>& speeds) const {
      const auto sign = [](double x, double rounding) { return x > rounding ? 1 : (x < -rounding ? -1 : 0); };
      if constexpr (Degree == 1) {
        return sign(separation[1], speeds[0]);
      } else {
        const int now = sign(separation[1] + 2 * tau * separation[2], speeds[0] + tau * speeds[1]);
        return now != 0 ? now : sign(separation[2], 0.5 * speeds[1]);
      }
    }
  };

  /// Calls visit(condition) for both sides of every axis.
  template <class Visit>
  void every_condition(const Visit& visit) const {
    every_axis(a_, b_, [&](const Eigen::Vector3d& axis, const Interval& of_a, const Interval& of_b) {
      const double length = std::sqrt(dot(axis, axis));
      if (!(length > vanishing_axis)) return true;
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
      return true;
    });
  }

  class Conditions {
   public:
    explicit Conditions(const ConvexTouch& touch) {
      touch.every_condition([this](const Condition& condition) { items_[size_++] = condition; });
    }
    const Condition* begin() const { return items_.data(); }
    const Condition* end() const { return items_.data() + size_; }

   private:
    std::array<Condition, capacity> items_;
    std::size_t size_ = 0;
  };

  /// The conditions of the two sides of an axis stand side by side.
  static const Condition& opposite_of(const Conditions& conditions, const Condition& condition) {
    return (&condition - conditions.begin()) % 2 == 0 ? *(&condition + 1) : *(&condition - 1);
  }

  std::span<const TimeSpans> near() const { return {near_.data(), size_}; }

  PlacedTriangle a_;
  B b_;
  const RelativeMotion<Degree>& motion_;
  ContactGap<Degree> gap_;
  std::array<TimeSpans, Degree == 1 ? 1 : capacity> near_;  ///< when each separation is below the gap
  std::size_t size_ = 0;
  double entry_speed_ = 0;  ///< degree 1: along the axis on which they come within the gap last
};

}  // namespace kds::collision
