// What can be asked about a mesh and one other moving shape, for each kind of shape.
#pragma once

#include "collision/narrow_phase/ball_touch.hpp"
#include "collision/narrow_phase/contact_patch.hpp"
#include "collision/narrow_phase/convex_touch.hpp"
#include "collision/narrow_phase/mesh_contact.hpp"
#include "collision/narrow_phase/mesh_partners.hpp"
#include "collision/narrow_phase/near_spans.hpp"
#include "collision/narrow_phase/obb_descent.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/separating_axes.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>

namespace kds::collision::detail {

/// s; contacts that lie farther ahead than 10^60 are none. Keeps polynomials of the time from overflowing.
inline constexpr double farthest = 0x1p200;

/// Nor are contacts predicted for times at which the contact gap has grown to this part of the radii, and fourfold. A
/// straight path gets there only if its speed is nothing but rounding (bodies that move alike), a curved one if it goes
/// out 2^43 radii and comes back. Larger predicts more of such contacts, and more slowly.
inline constexpr double widest_gap = 0x1p-4;

// ---- Questions -----------------------------------------------------------------------------------------------------

/// The answers for one kind of b and one degree of motion.
template <int Degree, class Partner>
class Query {
 public:
  using Part = typename Partner::Part;
  static constexpr bool with_ball = std::is_same_v<Part, PlacedBall>;
  using Touching = std::conditional_t<with_ball, BallTouch<Degree>, ConvexTouch<Degree, Part>>;

  Query(const PlacedShape& a, const PlacedShape& b, const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap)
      : a_(a), b_(b), shape_b_(b), motion_(motion), gap_(gap), radii_(a.bounding_radius + b.bounding_radius) {
    for (std::size_t i = 0; i <= Degree; ++i) margin_[i] = quick_margin * gap.c[i];
    last_ = last_time();
  }

  std::optional<MeshTouch> first_contact(double tau0, double tau1, ContactMode mode) const {
    std::optional<MeshTouch> best;
    double passed_over = -TimeSpans::infinity;  // until then triangles touch that were passed over
    bool sliced = false;
    slice_by_slice({tau0, tau1}, [&](const TimeSlice& slice) {
      EarliestFirst goal;
      if (best) goal.best = in_steps(slice, best->tau);
      walk(goal, slice,
           [&](std::uint32_t i, const PlacedTriangle& triangle, std::uint32_t j, const Part& part, TimeWindow window) {
             const bool lower = best && std::tuple(i, j) < std::tuple(best->triangle_a, best->triangle_b);
             if (best && (best->tau < window.begin || (best->tau == window.begin && !lower))) return;
             // Before the window nothing touches, unless in an earlier slice.
             if (sliced) window.begin = tau0;
             const double tau = first_time(triangle, part, window, tau0, mode, passed_over);
             // The window reaches a little past the best hit.
             if (tau == TimeSpans::infinity || (best && (tau > best->tau || (tau == best->tau && !lower)))) return;
             best = MeshTouch{tau, i, j};
             goal.best = std::min(goal.best, in_steps(slice, tau));
           });
      sliced = true;
      return best && best->tau <= slice.end;
    });
    if (best) best->foremost = best->tau > tau0 && !(passed_over > best->tau);
    return best;
  }

  /// When the boxes around the whole shapes may first touch, or infinity.
  double apart_until(double tau0, double tau1) const {
    double first = TimeSpans::infinity;
    slice_by_slice({tau0, tau1}, [&](const TimeSlice& slice) {
      const SliceMotion<Degree> motion(motion_, gap_, slice, radii_);
      StepWindow window;
      bool near = false;
      if constexpr (with_ball) {
        near = BoxBallTest<Degree>(a_.pose, b_.part.radius, motion)(a_.pose.nodes[0], window);
      } else {
        const BoxPairTest<Degree> test(a_.pose, b_.pose, motion);
        near = test(test.frame(a_.pose.nodes[0]), b_.pose.nodes[0], window);
      }
      if (near) first = in_seconds(slice, window).begin;
      return near;
    });
    return first;
  }

  bool touching(double tau) const { return contact_end(tau) != tau; }

  /// Jumps from the end of one contact to the end of another that still holds there.
  double first_free_time(double tau, double limit) const {
    while (tau <= limit) {
      const double end = contact_end(tau);
      if (end == tau) return tau;
      tau = end;
    }
    return TimeSpans::infinity;
  }

  MeshTouchPlace where(double tau, const MeshTouch* known) const {
    if (known) {
      if (const auto place = where_foremost(tau, *known)) return *place;
    }
    // Ranked: touches and approaches, touches, is near; then by when it began (near: by how near), then by triangle.
    using Rank = std::tuple<int, double, std::uint32_t, std::uint32_t>;
    std::optional<Rank> best;
    TouchDirection direction{};
    slice_by_slice({tau, tau}, [&](const TimeSlice& slice) {
      EarliestFirst goal;
      walk(
          goal, slice,
          [&](std::uint32_t i, const PlacedTriangle& triangle, std::uint32_t j, const Part& part, TimeWindow window) {
            if (!may_touch(triangle, part, motion_, margin_, window)) return;
            const Touching touch = touching_of(triangle, part, {0, last_});
            const TouchDirection here = touch.direction(tau);
            const bool inside = touch.first_inside(tau) == tau;
            const Rank rank{inside ? (here.approaching ? 0 : 1) : 2, inside ? touch.enter(tau) : here.separation, i, j};
            if (best && !(rank < *best)) return;
            best = rank;
            direction = here;
          });
      return true;
    });
    if (!best) return without_contact(tau);
    return describe(tau, direction, std::get<2>(*best), std::get<3>(*best));
  }

 private:
  /// A time after which there is nothing to look for; a function of shapes and motion alone. By then even the bounding
  /// balls are apart for good, or the gap has become so wide that it tells nothing: see `widest_gap`.
  double last_time() const {
    const auto& g = gap_.c;
    const double excess = g[0] - std::max(4 * g[0], widest_gap * radii_);
    if constexpr (Degree == 1) {
      return g[1] > 0 ? std::min(-excess / g[1], farthest) : farthest;
    } else {
      double last = farthest;
      if (g[1] > 0 || g[2] > 0) last = std::min(last, quadratic_roots(excess, g[1], g[2]).rising);
      // By the triangle inequality: |r2| tau^2 <= |r0| + |r1| tau + reach.
      const auto& r = motion_.coefficients;
      const double c2 = r[2].norm() - margin_[2];
      if (!(c2 > 0)) return last;
      const auto roots = quadratic_roots(-(r[0].norm() + radii_ + margin_[0]), -(r[1].norm() + margin_[1]), c2);
      return std::min(roots.rising * (1 + ContactGap<Degree>::roundings), last);
    }
  }

  /// Calls run(slice) for the parts of the window in which the bounding balls are in reach of each other, in order,
  /// until it returns true. In each the margin is about the same and the path about straight, see `slice_end`.
  template <class Run>
  void slice_by_slice(const TimeWindow& window, const Run& run) const {
    std::array<double, Degree + 1> reach = margin_;
    reach[0] += radii_;
    const TimeSpans spans = near_spans(motion_.coefficients, reach, last_);
    for (std::size_t i = 0; i < 2; ++i) {
      double begin = std::max(window.begin, spans.begin[i]);
      const double end = std::min({window.end, spans.end[i], last_});
      while (begin <= end) {
        const TimeSlice slice{begin, slice_end(begin, end)};
        if (run(slice)) return;
        if (slice.end >= end || !(slice.end > begin)) break;
        begin = slice.end;
      }
    }
  }

  /// A slice ends before the margin has grown both twofold and to a large part of the shapes (that is, soon only where
  /// bodies hardly move but their speeds are known less well than they are slow), and before a curved path is too far
  /// from its chord for the box tests to be any use. At rest there is nothing but the present.
  double slice_end(double begin, double end) const {
    constexpr double large = 0x1p-8;
    constexpr double most_bend = 0x1p-3;
    const auto& r = motion_.coefficients;
    if constexpr (Degree == 1) {
      if (r[1].isZero(0) && gap_.c[1] == 0) return begin;
    } else {
      const double bend = r[2].norm();
      if (bend > 0) end = std::min(end, begin + std::sqrt(4 * most_bend * radii_ / bend));
    }
    const double most = std::max(2 * gap_(begin), large * radii_);
    while (gap_(end) > most) {
      const double earlier = begin + (end - begin) / 4;
      if (!(earlier > begin)) break;
      end = earlier;
    }
    return end;
  }

  /// Calls visit(triangle, placed triangle, triangle or 0, part, window) where they may touch within the slice.
  template <class Goal, class Visit>
  void walk(Goal& goal, const TimeSlice& slice, const Visit& visit) const {
    const SliceMotion<Degree> motion(motion_, gap_, slice, radii_);
    if constexpr (with_ball) {
      const BoxBallTest<Degree> test(a_.pose, b_.part.radius, motion);
      const auto leaf = [&](const ObbNode& node, const StepWindow& steps) {
        const TimeWindow window = in_seconds(slice, steps);
        a_.each(node, [&](std::uint32_t i, const PlacedTriangle& triangle) { visit(i, triangle, 0, b_.part, window); });
      };
      TreeBallDescent<Degree, Goal, decltype(leaf)>(a_.pose, test, goal, leaf).run();
    } else {
      const BoxPairTest<Degree> test(a_.pose, b_.pose, motion);
      const auto leaf = [&](const ObbNode& node_a, const ObbNode& node_b, const StepWindow& steps) {
        const TimeWindow window = in_seconds(slice, steps);
        a_.each(node_a, [&](std::uint32_t i, const PlacedTriangle& triangle) {
          b_.each(node_b, [&](std::uint32_t j, const Part& part) { visit(i, triangle, j, part, window); });
        });
      };
      TreePairDescent<Degree, Goal, decltype(leaf)>(a_.pose, b_.pose, test, goal, leaf).run();
    }
  }

  /// Good for times in the window.
  Touching touching_of(const PlacedTriangle& triangle, const Part& part, const TimeWindow& window) const {
    if constexpr (with_ball) {
      return Touching(triangle, part, motion_, gap_, last_, window);
    } else {
      return Touching(triangle, part, motion_, gap_);
    }
  }

  /// The first contact in [tau, limit], or TimeSpans::infinity. Raises `passed_over` to the ends of those before it.
  static double first_time(const Touching& touch, double tau, double limit, ContactMode mode, double& passed_over) {
    for (;;) {
      tau = touch.first_inside(tau);
      if (tau > limit) return TimeSpans::infinity;
      if (mode == ContactMode::transparent || touch.approaching(tau)) return tau;
      const double end = touch.leave(tau);
      passed_over = std::max(passed_over, end);
      tau = touch.turning(tau, end);
      if (tau == TimeSpans::infinity) return tau;
    }
  }

  /// The same of two parts that touch, if at all, within a window.
  double first_time(const PlacedTriangle& triangle, const Part& part, TimeWindow window, double tau0, ContactMode mode,
                    double& passed_over) const {
    if constexpr (Degree == 1 && !with_ball) {
      return first_time(Touching(triangle, part, motion_, gap_, window), tau0, window.end, mode, passed_over);
    } else {
      if (!may_touch(triangle, part, motion_, margin_, window)) return TimeSpans::infinity;
      return first_time(touching_of(triangle, part, window), tau0, window.end, mode, passed_over);
    }
  }

  /// The answer of where() from a contact that first_contact has found to be `foremost`: the first of all that hold at
  /// tau, if it still holds and approaches. No other need be looked for then. Else nothing.
  std::optional<MeshTouchPlace> where_foremost(double tau, const MeshTouch& known) const {
    if (!known.foremost) return std::nullopt;
    bool near = false;
    slice_by_slice({tau, tau}, [&](const TimeSlice&) { return near = true; });
    if (!near) return std::nullopt;
    const PlacedTriangle triangle = a_.triangle({a_.mesh.triangles()[known.triangle_a], known.triangle_a});
    std::optional<MeshTouchPlace> place;
    const auto look = [&](const Part& part) {
      const Touching touch = touching_of(triangle, part, {0, last_});
      if (touch.first_inside(tau) != tau || touch.enter(tau) != known.tau) return;
      const TouchDirection here = touch.direction(tau);
      if (here.approaching) place = describe(tau, here, known.triangle_a, known.triangle_b);
    };
    if constexpr (std::is_same_v<Part, PlacedTriangle>) {
      look(b_.triangle({b_.mesh.triangles()[known.triangle_b], known.triangle_b}));
    } else {
      look(b_.part);
    }
    return place;
  }

  /// The end of some contact that holds at tau, preferably a late one; tau itself if there is none.
  double contact_end(double tau) const {
    double end = tau;
    slice_by_slice({tau, farthest}, [&](const TimeSlice& slice) {
      if (slice.begin > tau) return true;
      AnyAtOnce goal;
      walk(goal, slice,
           [&](std::uint32_t, const PlacedTriangle& triangle, std::uint32_t, const Part& part, TimeWindow window) {
             if (goal.found || !may_touch(triangle, part, motion_, margin_, window) || window.begin > tau) return;
             const Touching touch = touching_of(triangle, part, {0, last_});
             if (touch.first_inside(tau) != tau) return;
             end = touch.leave(tau);
             goal.found = true;
           });
      return true;
    });
    return end;
  }

  MeshTouchPlace describe(double tau, const TouchDirection& direction, std::uint32_t i, std::uint32_t j) const {
    const Eigen::Vector3d offset = motion_.position(tau);
    const LeafTriangle leaf_a{a_.mesh.triangles()[i], i};
    const PlacedTriangle triangle = a_.triangle(leaf_a);
    MeshTouchPlace where{Eigen::Vector3d::Zero(), direction.normal, {}, {}};
    if constexpr (with_ball) {
      const NearestPoint nearest = nearest_point(triangle, offset);
      where.point = nearest.point;
      where.feature_a = nearest_feature(nearest, leaf_a);
    } else {
      const double tolerance = gap_(tau);
      const Support of_a = triangle_support(triangle, leaf_a, direction.normal, tolerance);
      where.feature_a = of_a.feature;
      const auto finish = [&](const auto& of_b) {
        where.feature_b = of_b.feature;
        where.point = patch_centre(of_a.vertices, of_b.vertices, offset, direction.normal);
      };
      if constexpr (Partner::solid) {
        finish(box_support(shape_b_, -direction.normal));
      } else {
        const LeafTriangle leaf_b{b_.mesh.triangles()[j], j};
        finish(triangle_support(b_.triangle(leaf_b), leaf_b, -direction.normal, tolerance));
      }
    }
    return where;
  }

  /// Asked at a time when nothing is near: halfway between the centres.
  MeshTouchPlace without_contact(double tau) const {
    const Eigen::Vector3d offset = motion_.position(tau);
    const double distance = offset.norm();
    return {0.5 * offset,
            distance > 0 ? Eigen::Vector3d(offset / distance) : Eigen::Vector3d(Eigen::Vector3d::UnitX()),
            {},
            {}};
  }

  PlacedMesh a_;
  Partner b_;
  const PlacedShape& shape_b_;
  RelativeMotion<Degree> motion_;
  ContactGap<Degree> gap_;
  std::array<double, Degree + 1> margin_;
  double radii_;
  double last_;
};

}  // namespace kds::collision::detail
