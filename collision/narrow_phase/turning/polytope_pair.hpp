// Two convex polytopes that turn, as doubles see them: which planes may keep them apart, and for how long they do.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/hull_distance.hpp"
#include "collision/narrow_phase/turning/near_features.hpp"
#include "collision/narrow_phase/turning/pair_frame.hpp"
#include "collision/narrow_phase/turning/seen_polytope.hpp"
#include "collision/narrow_phase/turning/way_widths.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace kds::collision {

/// The ways of being apart of TurningPolytopes: planes across a face of either, or along an edge of each.
///
/// There are as many ways as faces, and twice as many as the products of the edges, and few of them are ever near:
/// which may be open in a stretch of time is told at a cost in proportion to the corners.
///
/// Law. Let x and y be points inside of a and b, d the vector from x to y, and let a way be open. Of the plane's unit
/// normal n, from a to b, an edge u of a and an edge v of b then hold, with p on u and q on v: n . (q - p) >= 0, and n
/// is a sum of the normals of the two faces at u, and -n of those at v, with weights that are not negative. As n is a
/// unit vector, these weights have a sum of 1 at least. So n . (p - x) is no less than what x is below the nearer of
/// the planes of these two faces, n . (y - q) no less than the same of y, and the sum of the two is n . d - n . (q - p)
/// <= |d|. Of a face n . (p - x) alone is no more than |d|. How far x and y are below faces does not change, and d is
/// known, as is how fast it may change. That the polytopes are convex is not needed, so that roundings do not matter.
template <int Degree>
class PolytopePair {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;
  using Way = std::int64_t;

  PolytopePair(const RigidMotion& a, TurningPolytope core_a, const RigidMotion& b, TurningPolytope core_b)
      : ways(number_of_ways(*core_a.structure, *core_b.structure)),
        a_(a),
        b_(b),
        polytope_a_(std::move(core_a)),
        polytope_b_(std::move(core_b)) {}

  /// Faces of a, faces of b, pairs of edges with either sense of their product.
  Way ways;

  /// The pair as it is at a time, in doubles.
  template <class Seen>
  struct FrameOf : PairFrame<Degree> {
    FrameOf(const PolytopePair& pair, double t)
        : PairFrame<Degree>(pair.a_, pair.b_, t),
          a(pair.polytope_a_, this->turn_a),
          b(pair.polytope_b_, this->turn_b) {}
    Seen a, b;
  };
  using Frame = FrameOf<SeenPolytope>;
  Frame frame(double t) const { return {*this, t}; }

  /// Those that are not certainly closed just after all times of a stretch, and how wide they are: how far the corners
  /// are beyond a face; for edges the least of how far they are beyond each other, times the sine of their angle, and
  /// of how far their faces are below the plane.
  std::vector<WayWidth<Way>> near_ways(const Frame& frame, double stretch) const;
  /// A bound on the error of these widths.
  double error(const PairFrame<Degree>& frame) const {
    if (!frame.certain) return never;
    const double lengths = norm(frame.way.value) + polytope_a_.radius + polytope_b_.radius;
    return frame.way_error + PairFrame<Degree>::rounding * lengths;
  }

  /// A bound on how fast these change.
  double fastest(const PairFrame<Degree>& frame, double stretch) const {
    return frame.fastest(polytope_a_.radius, polytope_b_.radius, stretch);
  }

  /// How far ahead closed_wait() can tell; for how much of that a condition of a way is broken for certain, all the
  /// time.
  double stretch(const Frame& frame, double longest) const {
    return frame.certain ? frame.stretch(polytope_a_.radius + polytope_b_.radius, longest) : longest;
  }
  double closed_wait(const Frame& frame, Way way, double stretch) const;
  /// Whether it is along two edges that are parallel but for 2^-10.
  bool is_thin(const Frame& frame, Way way) const {
    if (way < faces()) return false;
    const EdgePair pair = edge_pair(way);
    return !(norm(cross(frame.a.edges[pair.of_a], frame.b.edges[pair.of_b])) > 0x1p-10);
  }

  /// A time from t on until which they are apart; t where doubles do not tell, or where it would be hardly later.
  double apart_until(double t, double horizon) const { return farther_apart_until(0, t, horizon); }

  /// How deep the two are in each other at t, in doubles: along the way that is the least blocked.
  double depth(double t) const;

  /// The time in which the directions of the two change by about half a radian.
  double time_of_turning() const {
    const double rates = norm(a_.angular_velocity) + norm(b_.angular_velocity);
    return rates > 0 ? 0.5 / rates : never;
  }

 protected:
  struct EdgePair {
    std::size_t of_a, of_b;
    bool forward;  ///< the product of the edges, lower end to higher, points from a to b
  };

  static bool has_face(std::uint32_t face) { return face != HullStructure::no_face; }
  Way faces_a() const { return static_cast<Way>(polytope_a_.structure->faces.size()); }
  Way faces() const { return faces_a() + static_cast<Way>(polytope_b_.structure->faces.size()); }
  static Way number_of_ways(const HullStructure& a, const HullStructure& b) {
    return static_cast<Way>(a.faces.size() + b.faces.size() + 2 * a.edges.size() * b.edges.size());
  }
  Way way_of_edges(std::size_t of_a, std::size_t of_b) const {
    return faces() + 2 * static_cast<Way>(of_a * polytope_b_.structure->edges.size() + of_b);
  }
  EdgePair edge_pair(Way way) const {
    const auto k = static_cast<std::size_t>(way - faces());
    const std::size_t edges_b = polytope_b_.structure->edges.size();
    return {k / 2 / edges_b, k / 2 % edges_b, k % 2 != 0};
  }
  /// A point of b as seen from one of a, and which corners these are.
  struct CornerOfDifference {
    Eigen::Vector3d way;
    std::array<std::uint32_t, 2> corners;
    friend const Eigen::Vector3d& point_of(const CornerOfDifference& x) { return x.way; }
  };
  /// The points of the two that are the nearest to each other, as sums of their corners.
  template <class Seen>
  auto nearest_points(const FrameOf<Seen>& frame) const {
    const auto farthest = [&](const Eigen::Vector3d& along) {
      const std::uint32_t of_a = frame.a.farthest_corner(-along), of_b = frame.b.farthest_corner(along);
      return CornerOfDifference{frame.way.value + frame.b.points[of_b] - frame.a.points[of_a], {of_a, of_b}};
    };
    return nearest_to_origin(farthest, frame.way.value);
  }
  /// The vector from the nearest point of a to that of b; zero if they overlap.
  template <class Seen>
  Eigen::Vector3d way_between_nearest(const FrameOf<Seen>& frame) const {
    return nearest_points(frame).point;
  }

  /// Points inside of the two, and a bound on their distance at the time of a frame.
  struct PointsInside {
    std::array<PointInside, 2> of;
    double distance;
  };
  /// Of those that are near each other; none where doubles do not tell.
  std::optional<PointsInside> points_inside(const Frame& frame) const;
  /// All features where there are no such points.
  NearFeaturePair near_pair(const std::optional<PointsInside>& inside, double within) const;
  /// The least depth along one of these.
  double depth_among(const Frame& frame, const NearFeaturePair& near) const;
  /// As apart_until, but farther apart than `grown`.
  double farther_apart_until(double grown, double t, double horizon) const;

  double face_width(const Frame& frame, Way way) const;
  /// Of both senses of a pair of edges: that of its way, and of the next one.
  std::array<double, 2> edge_widths(const Frame& frame, std::size_t of_a, std::size_t of_b) const;
  /// In the order of every_condition.
  std::array<double, 5> edge_values(const Frame& frame, const EdgePair& pair) const;
  double wait_along(const FrameOf<SeenCorners>& frame, const Eigen::Vector3d& n, double grown, bool with_a,
                    double stretch) const;

  const RigidMotion& a_;
  const RigidMotion& b_;
  TurningPolytope polytope_a_, polytope_b_;
};

// ---------------------------------------------------------------------------------------------------------------------

/// The products of normals and edges are times the radii, which are less than what `fastest` takes for lengths: so they
/// change no faster than that. Edges without faces are outermost.
template <int Degree>
std::array<double, 5> PolytopePair<Degree>::edge_values(const Frame& frame, const EdgePair& pair) const {
  const HullEdge& edge_a = polytope_a_.structure->edges[pair.of_a];
  const HullEdge& edge_b = polytope_b_.structure->edges[pair.of_b];
  const Eigen::Vector3d& u = frame.a.edges[pair.of_a];
  const Eigen::Vector3d& v = frame.b.edges[pair.of_b];
  const double sense = pair.forward ? 1 : -1;
  const double size = sense * (polytope_a_.radius + polytope_b_.radius);
  const Eigen::Vector3d apart = frame.way.value + frame.b.points[edge_b.ends[0]] - frame.a.points[edge_a.ends[0]];
  const auto along = [size](const SeenPolytope& of, std::uint32_t face, const Eigen::Vector3d& edge) {
    return has_face(face) ? size * dot(of.normals[face], edge) : never;
  };
  return {sense * dot(cross(u, v), apart), along(frame.a, edge_a.faces[0], v), along(frame.a, edge_a.faces[1], -v),
          along(frame.b, edge_b.faces[0], u), along(frame.b, edge_b.faces[1], -u)};
}

template <int Degree>
double PolytopePair<Degree>::face_width(const Frame& frame, Way way) const {
  const auto of_face = [](const SeenPolytope& of, std::size_t f, const SeenPolytope& other,
                          const Eigen::Vector3d& between) {
    const Eigen::Vector3d& n = of.normals[f];
    return dot(n, between + other.farthest(-n) - of.points[of.structure->faces[f][0]]);
  };
  if (way < faces_a()) return of_face(frame.a, static_cast<std::size_t>(way), frame.b, frame.way.value);
  return of_face(frame.b, static_cast<std::size_t>(way - faces_a()), frame.a, -frame.way.value);
}

template <int Degree>
std::array<double, 2> PolytopePair<Degree>::edge_widths(const Frame& frame, std::size_t of_a, std::size_t of_b) const {
  const auto value = edge_values(frame, {of_a, of_b, true});  // of the other sense they are the opposites
  double least = value[0], greatest = value[0];
  for (std::size_t k = 1; k < value.size(); ++k) {
    if (value[k] == never) continue;
    least = std::min(least, value[k]), greatest = std::max(greatest, value[k]);
  }
  return {-greatest, least};
}

/// By the same sums of corners as the vector between the nearest points; they need not be these for what follows.
template <int Degree>
auto PolytopePair<Degree>::points_inside(const Frame& frame) const -> std::optional<PointsInside> {
  if (!frame.certain) return std::nullopt;
  const auto nearest = nearest_points(frame);
  std::array<Eigen::Vector3d, 2> place{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (std::size_t i = 0; i < nearest.corners.size(); ++i) {
    const auto& [of_a, of_b] = nearest.corners[i].corners;
    place[0] += nearest.weights[i] * polytope_a_.points[of_a];
    place[1] += nearest.weights[i] * polytope_b_.points[of_b];
  }
  auto a = point_inside(polytope_a_, place[0]), b = point_inside(polytope_b_, place[1]);
  if (!a || !b) return std::nullopt;
  const double distance = norm(frame.way.value + frame.b.seen(b->point) - frame.a.seen(a->point)) + error(frame);
  return PointsInside{{std::move(*a), std::move(*b)}, distance};
}

template <int Degree>
NearFeaturePair PolytopePair<Degree>::near_pair(const std::optional<PointsInside>& inside, double within) const {
  const HullStructure &a = *polytope_a_.structure, &b = *polytope_b_.structure;
  if (!inside) return {{all_features(a), all_features(b)}, never};
  return {{features_near(a, inside->of[0], within), features_near(b, inside->of[1], within)}, within};
}

template <int Degree>
auto PolytopePair<Degree>::near_ways(const Frame& frame, double stretch) const -> std::vector<WayWidth<Way>> {
  const auto inside = points_inside(frame);
  double within = 0, least = -never;  // what is narrower does not open
  if (inside) {
    const double speed = norm(frame.way.rate) + frame.rate_error + norm(frame.way.bend) * stretch +
                         frame.rate_a * norm(inside->of[0].point) + frame.rate_b * norm(inside->of[1].point);
    within = (inside->distance + speed * stretch) * (1 + 0x1p-30);
    least = -error(frame) - fastest(frame, stretch) * stretch;
  }
  const NearFeaturePair near = near_pair(inside, within);
  std::vector<WayWidth<Way>> found;
  const auto take = [&](Way way, double width) {
    if (!(width < least)) found.push_back({way, width});
  };
  for (const std::uint32_t f : near.of[0].faces) take(f, face_width(frame, f));
  for (const std::uint32_t f : near.of[1].faces) take(faces_a() + f, face_width(frame, faces_a() + f));
  near.every_pair_of_edges([&](std::uint32_t u, std::uint32_t v) {
    const auto widths = edge_widths(frame, u, v);
    take(way_of_edges(u, v), widths[0]);
    take(way_of_edges(u, v) + 1, widths[1]);
  });
  return found;
}

/// Of a face by the deepest corner; of two edges by any of the conditions. Unit vectors that are multiplied change by
/// their relative rotation alone.
template <int Degree>
double PolytopePair<Degree>::closed_wait(const Frame& frame, Way way, double stretch) const {
  if (!frame.certain) return 0;
  const auto negative_for = [stretch](const Jet& f, double rounding, double third) {
    return positive_for(Jet{-f.value - rounding, -f.rate, -f.bend}, third, stretch);
  };
  const auto of_a = [&](const Eigen::Vector3d& x) { return turning(x, frame.spin_a); };
  const auto of_b = [&](const Eigen::Vector3d& x) { return turning(x, frame.spin_b); };
  const double rates = frame.rate_a + frame.rate_b;
  const auto distance_for = [&](const VectorJet& n, double rate, std::uint32_t p, std::uint32_t q) {
    const TurningBounds bounds(frame, rate, polytope_a_.radius, polytope_b_.radius, stretch);
    const VectorJet apart = frame.way + of_b(frame.b.points[q]) - of_a(frame.a.points[p]);
    return negative_for(dot(n, apart), bounds.rounding, bounds.third);
  };
  if (way < faces_a()) {
    const auto face = static_cast<std::size_t>(way);
    const Eigen::Vector3d& n = frame.a.normals[face];
    return distance_for(of_a(n), frame.rate_a, polytope_a_.structure->faces[face][0], frame.b.farthest_corner(-n));
  }
  if (way < faces()) {
    const auto face = static_cast<std::size_t>(way - faces_a());
    const Eigen::Vector3d& n = frame.b.normals[face];
    return distance_for(-1.0 * of_b(n), frame.rate_b, frame.a.farthest_corner(-n),
                        polytope_b_.structure->faces[face][0]);
  }
  const EdgePair pair = edge_pair(way);
  const HullEdge &edge_a = polytope_a_.structure->edges[pair.of_a], &edge_b = polytope_b_.structure->edges[pair.of_b];
  const double sense = pair.forward ? 1 : -1;
  const VectorJet u = of_a(sense * frame.a.edges[pair.of_a]), v = of_b(frame.b.edges[pair.of_b]);
  double wait = distance_for(cross(u, v), rates, edge_a.ends[0], edge_b.ends[0]);
  for (std::size_t k = 0; k < 2; ++k) {
    const double side = k == 0 ? 1 : -1;
    const auto product_for = [&](const Jet& f) {
      return negative_for(side * f, PairFrame<Degree>::rounding, rates * rates * rates * (1 + 0x1p-40));
    };
    if (has_face(edge_a.faces[k])) {
      wait = std::max(wait, product_for(sense * dot(of_a(frame.a.normals[edge_a.faces[k]]), v)));
    }
    if (has_face(edge_b.faces[k])) wait = std::max(wait, product_for(dot(of_b(frame.b.normals[edge_b.faces[k]]), u)));
  }
  return wait;
}

/// How long all of b is beyond all of a by more than `grown`, along a direction that turns with one of them: that one
/// then reaches as far as it does now.
template <int Degree>
double PolytopePair<Degree>::wait_along(const FrameOf<SeenCorners>& frame, const Eigen::Vector3d& n, double grown,
                                        bool with_a, double stretch) const {
  const VectorJet jet = turning(n, with_a ? frame.spin_a : frame.spin_b);
  const TurningBounds bounds(frame, with_a ? frame.rate_a : frame.rate_b, polytope_a_.radius, polytope_b_.radius,
                             stretch);
  Jet base = dot(jet, frame.way);
  base.value -= bounds.rounding + (1 + PairFrame<Degree>::rounding) * grown;
  base.value -= (with_a ? dot(n, frame.a.farthest(n)) : -dot(n, frame.b.farthest(-n)));
  const SeenCorners& other = with_a ? frame.b : frame.a;
  double wait = stretch;
  for (const std::uint32_t i : other.structure->corners) {
    const Jet of_other = dot(jet, turning(other.points[i], with_a ? frame.spin_b : frame.spin_a));
    wait = std::min(wait, positive_for(with_a ? base + of_other : base - of_other, bounds.third, wait));
  }
  return wait;
}

template <int Degree>
double PolytopePair<Degree>::farther_apart_until(double grown, double t, double horizon) const {
  t = balls_apart_until(a_, b_, polytope_a_.radius + grown, polytope_b_.radius, t, horizon);
  if (t == never) return never;
  const FrameOf<SeenCorners> frame(*this, t);
  const Eigen::Vector3d apart = way_between_nearest(frame);
  const double roundings = error(frame) + PairFrame<Degree>::rounding * grown;
  if (!frame.certain || !(norm(apart) - grown > roundings)) return t;
  const Eigen::Vector3d n = normalized(apart);
  const double all = (horizon - t) * (1 + 0x1p-40);
  const double stretch = frame.stretch(polytope_a_.radius + polytope_b_.radius + grown, all);
  double wait = wait_along(frame, n, grown, true, stretch);
  if (wait < stretch) wait = std::max(wait, wait_along(frame, n, grown, false, stretch));
  if (stretch < all && this->time_of_turning() != never) {
    for (const Eigen::Vector3d& along : {n, normalized(frame.way.value)}) {
      const double covered =
          grown + frame.a.revolving_extent(along, frame.spin_a) + frame.b.revolving_extent(-along, frame.spin_b);
      wait = std::max(wait, revolving_apart_for(frame, along, covered));
    }
  }
  // Where corners slide along faces proofs get on by a ten-thousandth of the stretch each. An exact look at two hulls
  // costs a dozen of them, one at rounded ones, which have more ways, far more.
  return grown > 0 ? after_wait(t, wait, stretch) : after_wait(t, wait, stretch, 0x1p-4);
}

/// Edges that are nearly parallel, or not outermost, say nothing.
///
/// Planes are sought that the two are less deep beyond than D, the depth along a face: by the law above, with -D for
/// the zero in n . (q - p) >= 0, of the pairs of edges with a sum of no more than |d| + D. Their normals may be off by
/// 2^-23 from where the law has them, since edges are outermost here as doubles see it, and the sine of their angle is
/// 2^-20 at least: so 2^-17 of all lengths is added. At edges that are flat but for that the other sense may count,
/// too.
template <int Degree>
double PolytopePair<Degree>::depth(double t) const {
  constexpr double slack = 0x1p-17;
  const Frame frame = this->frame(t);
  std::optional<PointsInside> inside;
  if (!has_flat_edge(polytope_a_) && !has_flat_edge(polytope_b_)) inside = points_inside(frame);
  double within = 0;
  if (inside) {
    const Way of_a = static_cast<Way>(inside->of[0].nearest_face());
    const Way of_b = faces_a() + static_cast<Way>(inside->of[1].nearest_face());
    const double along_face = -std::max(face_width(frame, of_a), face_width(frame, of_b));
    const double lengths = norm(frame.way.value) + polytope_a_.radius + polytope_b_.radius;
    within = inside->distance + std::max(along_face, 0.0) + slack * lengths;
  }
  return depth_among(frame, near_pair(inside, within));
}

template <int Degree>
double PolytopePair<Degree>::depth_among(const Frame& frame, const NearFeaturePair& near) const {
  constexpr double least_sine = 0x1p-20;
  double least = never;
  for (const std::uint32_t f : near.of[0].faces) least = std::min(least, -face_width(frame, f));
  for (const std::uint32_t f : near.of[1].faces) least = std::min(least, -face_width(frame, faces_a() + f));
  near.every_pair_of_edges([&](std::uint32_t u, std::uint32_t v) {
    const double sine = norm(cross(frame.a.edges[u], frame.b.edges[v]));
    if (!(sine > least_sine)) return;
    for (const bool forward : {false, true}) {
      const auto value = edge_values(frame, {u, v, forward});
      if (std::min({value[1], value[2], value[3], value[4]}) >= 0) least = std::min(least, -value[0] / sine);
    }
  });
  return std::max(0.0, least);
}

}  // namespace kds::collision
