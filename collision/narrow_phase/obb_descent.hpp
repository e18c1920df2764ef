// Walking down two trees of oriented boxes while one of them moves.
#pragma once

#include "collision/degrees.hpp"
#include "collision/lanes.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/time_spans.hpp"
#include "collision/shapes/obb_tree.hpp"

#include <Eigen/Core>

#include <array>
#include <span>
#include <utility>

namespace kds::collision {

/// How a tree is placed about the centre of its body.
struct TreePose {
  std::span<const ObbNode> nodes;
  double unit;  ///< length of the nodes' unit in the world
  Eigen::Matrix3d rotation;
};

/// A stretch of time that a descent sees as [0, 1].
struct TimeSlice {
  double begin;
  double end;

  double length() const { return end - begin; }
};

/// Part of a slice.
struct StepWindow {
  float begin = 0;
  float end = 1;
};

/// Rounding of a moment of a slice: moments nearer to each other than this count as simultaneous.
inline constexpr float step_rounding = 0x1p-21F;

/// The window in seconds, rounded outward.
inline TimeWindow in_seconds(const TimeSlice& slice, const StepWindow& window) {
  const auto moment = [&](float step) { return slice.begin + static_cast<double>(step) * slice.length(); };
  return {window.begin <= step_rounding ? slice.begin : moment(window.begin - step_rounding),
          window.end >= 1 - step_rounding ? slice.end : moment(window.end + step_rounding)};
}

/// The moment in the slice, rounded upward.
inline float in_steps(const TimeSlice& slice, double tau) {
  if (!(tau < slice.end)) return 1;
  return static_cast<float>((tau - slice.begin) / slice.length()) + step_rounding;
}

/// Motion during a slice, in units of the pair's size, for the box tests.
///
/// All lengths of a pair are divided by `size`, the sum of the radii of the shapes; during a slice their centres are at
/// most about that far apart, so that every number is of order 1 and floats suffice. Margin: `rounding`, plus
/// `quick_margin` contact gaps at the end of the slice.
///
/// Derivation of `rounding`, in roundings of a float (2^-24) of numbers of order 1: the turned axes are good to 10, the
/// place of a centre to 12, a projection of it to 20 and of both boxes' edges to 40; axes that are orthonormal only to
/// 6 cost 18; the times at which an interval is entered and left are good to 4, which at these speeds are places good
/// to 16. That is 94; 128 leaves room. A larger margin is slower (boxes that far apart are opened), a smaller one might
/// miss contacts.
///
/// Paths of degree n >= 3: during a slice all terms above the linear one come to less than half of the size, so that
/// they are of order 1 too. Each has its coefficient turned and rounded (4) and goes through Horner's rule for the
/// tangent's place and speed (2 n each): 24 n, 120 more for n = 5; 256 are charged.
template <int Degree>
struct SliceMotion {
  static constexpr float rounding = (Degree <= 2 ? 128 : 256) * 0x1p-24F;

  SliceMotion(const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap, const TimeSlice& slice, double size);

  std::array<Eigen::Vector3d, std::size_t{Degree} + 1>
      r;  ///< centre of b relative to a: coefficients about the slice's begin
  double size;
  float margin;
  float bend;  ///< length of the quadratic coefficient, or the most that half of the second derivative has; rounded up
};

/// Separating-axis test of two oriented boxes over a stretch of time.
///
/// Each of the 15 axes lets the boxes overlap during a stretch of time, and they can touch only during the intersection
/// of all of them. A quadratic path is replaced by its chord over the window, and the boxes grow by the distance that
/// the path can have from the chord, |r2| length^2 / 4: as windows shrink on the way down, this soon vanishes. A path
/// of a higher degree is replaced by its tangent in the middle of the window, which it leaves by no more than half of
/// the second derivative's bound times (length / 2)^2: the same formula. Conservative: the window contains every time
/// at which a test of leaves may report contact. Products of edges are not normalised; they are no longer than 1, so
/// that for them the margin is wider than needed, and parallel edges, whose product is only rounding error, never
/// separate.
/// Paper: [Gottschalk96] section 5 for the axes, [Eberly01] for time.
template <int Degree>
class BoxPairTest {
 public:
  BoxPairTest(const TreePose& a, const TreePose& b, const SliceMotion<Degree>& motion);

  /// The data that depend only on the box of a: kept while it is tested with several boxes of b.
  struct Frame {
    std::array<Lanes, 3> turn;  ///< column k: coordinate k of b's model along the axes of a's box
    std::array<Lanes, std::size_t{Degree} + 1> motion;  ///< of b's model origin along them
    Lanes half_extents;
  };
  Frame frame(const ObbNode& a) const;

  /// Shrinks the window to the times at which the boxes may touch; false if there are none.
  bool operator()(const Frame& a, const ObbNode& b, StepWindow& window) const;

 private:
  std::array<std::array<float, 3>, 3> turn_;                     ///< model of b -> model of a
  std::array<Eigen::Vector3f, std::size_t{Degree} + 1> motion_;  ///< of b's centre in the model coordinates of a
  float unit_a_;
  float unit_b_;
  float margin_;
  float bend_;
};

/// The same for an oriented box and a ball that moves: the three axes of the box, and the ball around it.
template <int Degree>
class BoxBallTest {
 public:
  BoxBallTest(const TreePose& a, double radius, const SliceMotion<Degree>& motion);
  bool operator()(const ObbNode& a, StepWindow& window) const;

 private:
  std::array<Eigen::Vector3f, std::size_t{Degree} + 1> motion_;
  float unit_;
  float radius_;
  float margin_;
  float bend_;
};

#define KDS_DECLARE(degree)                   \
  extern template struct SliceMotion<degree>; \
  extern template class BoxPairTest<degree>;  \
  extern template class BoxBallTest<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

/// A search for the earliest contact. Parts that begin after the best hit so far are left out, but parts that begin
/// together with it are not: the winner among equal times must not depend on the order of the walk.
struct EarliestFirst {
  float best = 1;  ///< no later than this; the leaf lowers it, rounded upward

  bool wants(const StepWindow& window) const { return window.begin <= best; }
  void narrow(StepWindow& window) const { window.end = window.end < best ? window.end : best; }
  static bool before(const StepWindow& x, const StepWindow& y) { return x.begin <= y.begin; }
};

/// A search for any contact at the begin of the slice, first where it may last longest.
struct AnyAtOnce {
  bool found = false;  ///< set by the leaf

  bool wants(const StepWindow& window) const { return !found && window.begin <= 0; }
  static void narrow(StepWindow&) {}
  static bool before(const StepWindow& x, const StepWindow& y) { return x.end >= y.end; }
};

/// Calls leaf(node of a, node of b, window) for the pairs of leaves that can touch within the window and that the goal
/// wants, the most promising first. The larger box of a pair is opened.
template <int Degree, class Goal, class Leaf>
class TreePairDescent {
 public:
  TreePairDescent(const TreePose& a, const TreePose& b, const BoxPairTest<Degree>& test, Goal& goal, Leaf& leaf)
      : a_(a), b_(b), test_(test), goal_(goal), leaf_(leaf) {}

  void run() {
    StepWindow window;
    const auto frame = test_.frame(a_.nodes[0]);
    if (test_(frame, b_.nodes[0], window)) visit(a_.nodes[0], frame, b_.nodes[0], window);
  }

 private:
  using Frame = typename BoxPairTest<Degree>::Frame;

  void visit(const ObbNode& a, const Frame& frame, const ObbNode& b, StepWindow window) {
    goal_.narrow(window);
    if (a.is_leaf() && b.is_leaf()) return leaf_(a, b, window);
    if (b.is_leaf() || (!a.is_leaf() && a.radius * a_.unit >= b.radius * b_.unit)) {
      const std::array<const ObbNode*, 2> child{&a_.nodes[a.first], &a_.nodes[a.first + 1]};
      const std::array<Frame, 2> frames{test_.frame(*child[0]), test_.frame(*child[1])};
      in_order(
          window, [&](std::size_t i, StepWindow& w) { return test_(frames[i], b, w); },
          [&](std::size_t i, const StepWindow& w) { visit(*child[i], frames[i], b, w); });
    } else {
      const std::array<const ObbNode*, 2> child{&b_.nodes[b.first], &b_.nodes[b.first + 1]};
      in_order(
          window, [&](std::size_t i, StepWindow& w) { return test_(frame, *child[i], w); },
          [&](std::size_t i, const StepWindow& w) { visit(a, frame, *child[i], w); });
    }
  }

  template <class Test, class Visit>
  void in_order(const StepWindow& window, const Test& test, const Visit& visit) {
    std::array<StepWindow, 2> windows{window, window};
    const std::array<bool, 2> possible{test(0, windows[0]), test(1, windows[1])};
    const std::size_t first = possible[0] && (!possible[1] || Goal::before(windows[0], windows[1])) ? 0 : 1;
    for (const std::size_t i : {first, 1 - first}) {
      if (possible[i] && goal_.wants(windows[i])) visit(i, windows[i]);
    }
  }

  const TreePose& a_;
  const TreePose& b_;
  const BoxPairTest<Degree>& test_;
  Goal& goal_;
  Leaf& leaf_;
};

/// The same with a ball in place of the second tree: leaf(node of a, window).
template <int Degree, class Goal, class Leaf>
class TreeBallDescent {
 public:
  TreeBallDescent(const TreePose& a, const BoxBallTest<Degree>& test, Goal& goal, Leaf& leaf)
      : a_(a), test_(test), goal_(goal), leaf_(leaf) {}

  void run() {
    StepWindow window;
    if (test_(a_.nodes[0], window)) visit(a_.nodes[0], window);
  }

 private:
  void visit(const ObbNode& a, StepWindow window) {
    goal_.narrow(window);
    if (a.is_leaf()) return leaf_(a, window);
    const std::array<const ObbNode*, 2> child{&a_.nodes[a.first], &a_.nodes[a.first + 1]};
    std::array<StepWindow, 2> windows{window, window};
    const std::array<bool, 2> possible{test_(*child[0], windows[0]), test_(*child[1], windows[1])};
    const std::size_t first = possible[0] && (!possible[1] || Goal::before(windows[0], windows[1])) ? 0 : 1;
    for (const std::size_t i : {first, 1 - first}) {
      if (possible[i] && goal_.wants(windows[i])) visit(*child[i], windows[i]);
    }
  }

  const TreePose& a_;
  const BoxBallTest<Degree>& test_;
  Goal& goal_;
  Leaf& leaf_;
};

}  // namespace kds::collision
