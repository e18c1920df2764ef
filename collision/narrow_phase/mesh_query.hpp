// The queries about a mesh and one other moving shape, for each kind of shape.
#pragma once

#include "collision/narrow_phase/ball_touch.hpp"
#include "collision/narrow_phase/contact_patch.hpp"
#include "collision/narrow_phase/convex_touch.hpp"
#include "collision/narrow_phase/mesh_contact.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/mesh_partners.hpp"
#include "collision/narrow_phase/mesh_times.hpp"
#include "collision/narrow_phase/obb_descent.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/separating_axes.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/shapes/support.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>

namespace kds::collision::detail {

/// The answers for one kind of b and one degree of motion.
template <int Degree, class Partner>
class Query : private PairTimes<Degree> {
 public:
  using Part = typename Partner::Part;
  static constexpr bool with_ball = std::is_same_v<Part, PlacedBall>;
  using Touching = typename Partner::template Touching<Degree>;
  /// Times are those of convex pieces, of which only those that matter within a window are made.
  static constexpr bool in_pieces = !std::is_same_v<Touching, ConvexTouch<Degree, Part>>;

  Query(const PlacedShape& a, const PlacedShape& b, const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap)
      : PairTimes<Degree>(motion, gap, a.bounding_radius + b.bounding_radius), a_(a), b_(b), shape_b_(b) {}

  std::optional<MeshTouch> first_contact(double tau0, double tau1, ContactMode mode) const {
    std::optional<MeshTouch> best;
    double passed_over = -TimeSpans::infinity;  // until then triangles that were passed over touch
    bool sliced = false;
    slice_by_slice({tau0, tau1}, [&](const TimeSlice& slice) {
      EarliestFirst goal;
      if (best) goal.best = in_steps(slice, best->tau);
      walk(goal, slice,
           [&](std::uint32_t i, const PlacedTriangle& triangle, std::uint32_t j, const Part& part, TimeWindow window) {
             const bool lower = best && std::tuple(i, j) < std::tuple(best->triangle_a, best->triangle_b);
             if (best && (best->tau < window.begin || (best->tau == window.begin && !lower))) return;
             // Nothing touches before the window, except in an earlier slice.
             if (sliced) window.begin = tau0;
             const double tau = first_time(triangle, part, window, tau0, mode, passed_over);
             // The window ends a little after the best hit.
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

  bool touching(double tau) const {
    bool any = false;
    first_touching({tau, tau}, [&](const PlacedTriangle& triangle, const Part& part) {
      any = in_pieces || leave(triangle, part, tau) != tau;
    });
    return any;
  }

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
    // Order: touches and approaches, touches, is near; then by the time at which it began (if near: by the distance),
    // then by triangle.
    using Rank = std::tuple<int, double, std::uint32_t, std::uint32_t>;
    std::optional<Rank> best;
    TouchDirection direction{};
    slice_by_slice({tau, tau}, [&](const TimeSlice& slice) {
      EarliestFirst goal;
      walk(goal, slice,
           [&](std::uint32_t i, const PlacedTriangle& triangle, std::uint32_t j, const Part& part, TimeWindow window) {
             if (!may_touch(triangle, part, motion_, margin_, window)) return;
             // How parts that only overlap, or have just parted, touch does not depend on what is around them.
             const PlacedTriangle alone{triangle.vertices};
             const Touching by_itself = touching_of(alone, by_itself_too(part), {tau, tau});
             const bool inside = by_itself.first_inside(tau) == tau;
             const TouchDirection here = inside ? touching_of(triangle, part, {tau, tau}).direction(tau)
                                                : by_itself.direction(tau);
             const auto met = [&] {  // or it is behind what is around it
               return !in_pieces || here.separation <= -gap_(tau) ||
                      touching_of(triangle, part, {tau, tau}).first_inside(tau) == tau;
             };
             const double since = inside ? by_itself.enter(tau) : here.separation;
             const Rank rank{inside ? (here.approaching && met() ? 0 : 1) : 2, since, i, j};
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

  static Part by_itself_too(const Part& part) {
    if constexpr (std::is_same_v<Part, PlacedTriangle>) return {part.vertices};
    return part;
  }

  /// Whether sharp corners may meet.
  bool sharp() const {
    if constexpr (std::is_same_v<Part, PlacedTriangle>) return a_.mesh.sharp() && b_.mesh.sharp();
    return a_.mesh.sharp();
  }

  /// Valid for times in the window; leave(tau) as far as the pieces that the two come near to within it go.
  Touching touching_of(const PlacedTriangle& triangle, const Part& part, const TimeWindow& window) const {
    if constexpr (in_pieces) {
      return Touching(triangle, part, motion_, gap_, sharp(), last_, window);
    } else {
      return Touching(triangle, part, motion_, gap_, sharp());
    }
  }

  /// The time until which two parts touch that touch at tau. Of the pieces only those are made that contain the end of
  /// one before.
  double leave(const PlacedTriangle& triangle, const Part& part, double tau) const {
    for (double end = tau;; tau = end) {
      end = touching_of(triangle, part, {tau, tau}).leave(tau);
      if (!in_pieces || end == tau || end == TimeSpans::infinity) return end;
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

  /// The same for two parts that touch, if at all, within a window.
  double first_time(const PlacedTriangle& triangle, const Part& part, TimeWindow window, double tau0, ContactMode mode,
                    double& passed_over) const {
    if constexpr (Degree == 1 && !in_pieces) {
      return first_time(Touching(triangle, part, motion_, gap_, sharp(), window), tau0, window.end, mode, passed_over);
    } else {
      if (!may_touch(triangle, part, motion_, margin_, window)) return TimeSpans::infinity;
      if constexpr (with_ball) {
        const Touching touch = Touching::until_met(triangle, part, motion_, gap_, sharp(), last_, window, tau0);
        const double tau = touch.first_inside(tau0);
        if (tau > window.end) return TimeSpans::infinity;
        if (mode == ContactMode::transparent || touch.approaching(tau)) return tau;
      }
      return first_time(touching_of(triangle, part, window), tau0, window.end, mode, passed_over);
    }
  }

  /// The answer of where() if first_contact has found a contact to be `foremost`, the first of all that hold at tau,
  /// and it still holds and approaches: then no other need be searched. Otherwise nothing.
  std::optional<MeshTouchPlace> where_foremost(double tau, const MeshTouch& known) const {
    if (!known.foremost) return std::nullopt;
    bool near = false;
    slice_by_slice({tau, tau}, [&](const TimeSlice&) { return near = true; });
    if (!near) return std::nullopt;
    const PlacedTriangle triangle = a_.triangle({a_.mesh.triangles()[known.triangle_a], known.triangle_a});
    std::optional<MeshTouchPlace> place;
    const auto look = [&](const Part& part) {
      const Touching touch = touching_of(triangle, part, {tau, tau});
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
    first_touching({tau, farthest},
                   [&](const PlacedTriangle& triangle, const Part& part) { end = leave(triangle, part, tau); });
    return end;
  }

  /// Calls visit(triangle, part) for the first parts found that touch when the window begins, preferably such as are
  /// near each other for a large part of it.
  template <class Visit>
  void first_touching(const TimeWindow& times, const Visit& visit) const {
    slice_by_slice(times, [&](const TimeSlice& slice) {
      const double tau = times.begin;
      if (slice.begin > tau) return true;
      AnyAtOnce goal;
      walk(goal, slice,
           [&](std::uint32_t, const PlacedTriangle& triangle, std::uint32_t, const Part& part, TimeWindow window) {
             if (goal.found || !may_touch(triangle, part, motion_, margin_, window) || window.begin > tau) return;
             if (touching_of(triangle, part, {tau, tau}).first_inside(tau) != tau) return;
             visit(triangle, part);
             goal.found = true;
           });
      return true;
    });
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
    } else if constexpr (std::is_same_v<Part, PlacedCapsule>) {
      const NearestStretch nearest = nearest_stretch(triangle, offset, b_.part.half, gap_(tau));
      where.point = nearest.point;
      where.feature_a = nearest_feature(nearest_point(triangle, nearest.core), leaf_a);
      where.feature_b = capsule_feature(nearest);
    } else {
      const double tolerance = gap_(tau);
      const Support of_a = triangle_support(triangle, leaf_a, direction.normal, tolerance);
      where.feature_a = of_a.feature;
      const auto finish = [&](const auto& of_b) {
        where.feature_b = of_b.feature;
        where.point = patch_centre(of_a.vertices, of_b.vertices, offset, direction.normal);
      };
      if constexpr (Partner::solid) {
        finish(supporting_feature(shape_b_, -direction.normal));
      } else {
        const LeafTriangle leaf_b{b_.mesh.triangles()[j], j};
        finish(triangle_support(b_.triangle(leaf_b), leaf_b, -direction.normal, tolerance));
      }
    }
    return where;
  }

  /// For a time at which nothing is near: halfway between the centres.
  MeshTouchPlace without_contact(double tau) const {
    const Eigen::Vector3d offset = motion_.position(tau);
    const double distance = norm(offset);
    return {0.5 * offset,
            distance > 0 ? Eigen::Vector3d(offset / distance) : Eigen::Vector3d(Eigen::Vector3d::UnitX()),
            {},
            {}};
  }

  using PairTimes<Degree>::slice_by_slice;
  using PairTimes<Degree>::motion_;
  using PairTimes<Degree>::gap_;
  using PairTimes<Degree>::margin_;
  using PairTimes<Degree>::radii_;
  using PairTimes<Degree>::last_;

  PlacedMesh a_;
  Partner b_;
  const PlacedShape& shape_b_;
};

}  // namespace kds::collision::detail
