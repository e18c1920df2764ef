// Two convex polytopes or segments that turn, grown by radii: by which of their parts they are apart, and for how long.
#pragma once

#include "certificates/turning/distance_of_parts.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/turning/turning_polytopes.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace kds::collision {

/// Two cores, polytopes, segments or triangles, are apart while they are no nearer than r > 0, the sum of the radii
/// that they are grown by.
///
/// Besides the *ways* of TurningPolytopes, with a distance each (from the plane of a face to all corners of the other;
/// between the lines of two edges), there are those of a corner of the one and an edge of the other, and of two
/// corners. A corner and the line of an edge are no nearer than r; with n, the perpendicular from the line to the
/// corner, no edge at the corner leads back (AwayFromLine), and the corner is outside of both faces at the edge
/// (AcrossSide): so the one core is beyond the plane across n through the corner, the other below that through the
/// edge. Two corners are no nearer than r, and all edges at either lead away from the other (PastEnd). Whichever
/// parts are the nearest, their way holds if the cores are apart; of edges that are parallel, that of an end and the
/// other edge.
template <int Degree>
class TurningRoundedPolytopes : public TurningPolytopes<Degree> {
 public:
  using Base = TurningPolytopes<Degree>;
  using RigidMotion = typename Base::RigidMotion;
  using Frame = typename Base::Frame;
  using Conditions = typename Base::Conditions;
  using Way = typename Base::Way;

  TurningRoundedPolytopes(const RigidMotion& a, const ConvexCore& core_a, const RigidMotion& b,
                          const ConvexCore& core_b)
      : TurningRoundedPolytopes(a, TurningPolytope(core_a), b, TurningPolytope(core_b),
                                {core_a.radius(), core_b.radius()}) {}
  TurningRoundedPolytopes(const RigidMotion& a, const TurningPolytope& core_a, const RigidMotion& b,
                          const TurningPolytope& core_b, const std::array<double, 2>& radii)
      : Base(a, core_a, b, core_b), radii_(radii), edges_at_{edges_at(core_a), edges_at(core_b)} {
    first_corner_and_edge_ = this->ways;
    first_edge_and_corner_ = first_corner_and_edge_ + corners(core_a) * edges(core_b);
    first_corners_ = first_edge_and_corner_ + edges(core_a) * corners(core_b);
    this->ways = first_corners_ + corners(core_a) * corners(core_b);
  }

  Conditions unsure(const Frame& frame, Way, double stretch) const {
    if (!frame.certain) return {};
    return {&frame, error(frame) + fastest(frame, stretch) * stretch};
  }
  template <class Test>
  bool every_condition(Way way, const Conditions& which, const Test& test) const;

  /// All: of one of the two they are few, as only segments and triangles are grown.
  std::vector<WayWidth<Way>> near_ways(const Frame& frame, double stretch) const;
  double error(const PairFrame<Degree>& frame) const {
    return Base::error(frame) + PairFrame<Degree>::rounding * radius();
  }
  double fastest(const PairFrame<Degree>& frame, double stretch) const {
    return frame.fastest(this->polytope_a_.radius, this->polytope_b_.radius + radius(), stretch);
  }
  double apart_until(double t, double horizon) const { return this->farther_apart_until(radius(), t, horizon); }

  /// How deep the two are in each other, unless the cores overlap: then no smaller radius parts them.
  double depth(double t) const {
    const double distance = norm(this->way_between_nearest(this->frame(t)));
    return distance > 0 ? std::max(0.0, radius() - distance) : never;
  }
  bool known_to_separate_nothing(Way way) const {
    return way < first_corner_and_edge_ && Base::known_to_separate_nothing(way);
  }
  // Of ways that those of hulls are a part of, what is known of these.
  double closed_wait(const Frame& frame, Way way, double stretch) const {
    return way < first_corner_and_edge_ ? Base::closed_wait(frame, way, stretch) : 0;
  }
  bool is_thin(const Frame& frame, Way way) const { return way < first_corner_and_edge_ && Base::is_thin(frame, way); }
  /// Only ways of edges that are parallel can.
  template <class Vanishes>
  bool separates_nothing(Way way, const Vanishes& vanishes) const {
    if (way < this->faces() || way >= first_corner_and_edge_) return false;
    return every_condition(way, this->all(way), vanishes);
  }

  /// The same pair with a smaller radius; none where that would not be above zero.
  std::optional<TurningRoundedPolytopes> smaller(double margin) const {
    if (!(radius() > margin)) return std::nullopt;
    TurningRoundedPolytopes pair = *this;
    pair.set_radius(radius() - margin);
    return pair;
  }

 protected:
  double radius() const { return radii_[0] + radii_[1]; }
  void set_radius(double radius) { radii_ = {radius, 0}; }

 private:
  /// One of the two bodies, as a certificate sees it.
  struct Side {
    const RigidMotion& motion;
    const TurningPolytope& polytope;
    const std::vector<std::vector<std::uint32_t>>& edges_at;
    const SeenPolytope* seen;  ///< null if it is not seen
  };
  struct Sides {
    Side first, second;
    Eigen::Vector3d way;  ///< from the first to the second, where they are seen
    double limit;

    Sides turned_round() const { return {second, first, -way, limit}; }
    /// From a point of the first to one of the second.
    Eigen::Vector3d between(std::uint32_t i, std::uint32_t j) const {
      return way + second.seen->points[j] - first.seen->points[i];
    }
    bool matters(double value) const { return !(value > limit); }
  };
  Sides sides(const Frame* frame, double limit) const {
    return {{this->a_, this->polytope_a_, edges_at_[0], frame ? &frame->a : nullptr},
            {this->b_, this->polytope_b_, edges_at_[1], frame ? &frame->b : nullptr},
            frame ? frame->way.value : Eigen::Vector3d(Eigen::Vector3d::Zero()),
            limit};
  }

  static Way corners(const TurningPolytope& core) { return static_cast<Way>(core.structure->corners.size()); }
  static Way edges(const TurningPolytope& core) { return static_cast<Way>(core.structure->edges.size()); }
  static std::vector<std::vector<std::uint32_t>> edges_at(const TurningPolytope& core) {
    std::vector<std::vector<std::uint32_t>> edges(core.points.size());
    for (std::uint32_t e = 0; e < core.structure->edges.size(); ++e) {
      for (const std::uint32_t end : core.structure->edges[e].ends) edges[end].push_back(e);
    }
    return edges;
  }
  static std::uint32_t other_end(const Side& side, std::uint32_t edge, std::uint32_t end) {
    const auto& ends = side.polytope.structure->edges[edge].ends;
    return ends[0] == end ? ends[1] : ends[0];
  }

  /// A certificate of a part of the first side at its point i and the point j of the second.
  template <class Formula>
  static certificates::BetweenParts<Degree, Formula> between(const Sides& sides, std::uint32_t i, std::uint32_t j,
                                                             const Formula& formula) {
    return {sides.first.motion, sides.second.motion, sides.first.polytope.points[i], sides.second.polytope.points[j],
            formula};
  }

  template <class Test>
  bool every_plane_distance(const Sides& sides, std::size_t face, const Test& test) const;
  template <class Test>
  bool every_side_and_end(const Sides& sides, std::uint32_t edge, std::uint32_t corner, const Test& test) const;
  template <class Test>
  bool every_end(const Sides& sides, std::uint32_t i, std::uint32_t j, const Test& test) const;

  /// Calls visit(sides, edge of the first, corner of the second) or visit(sides, corner, corner) for a way.
  template <class OfEdge, class OfCorner>
  auto with_parts(const Sides& sides, Way way, const OfEdge& of_edge, const OfCorner& of_corner) const;
  double edge_and_corner_gap(const Sides& sides, std::uint32_t edge, std::uint32_t corner) const;
  double corners_gap(const Sides& sides, std::uint32_t i, std::uint32_t j) const;

  std::array<double, 2> radii_;
  std::array<std::vector<std::vector<std::uint32_t>>, 2> edges_at_;  ///< by points
  /// The first way of a kind: corner of a and edge of b; edge of a and corner of b; corner and corner.
  Way first_corner_and_edge_, first_edge_and_corner_, first_corners_;
};

// ---------------------------------------------------------------------------------------------------------------------

template <int Degree>
template <class OfEdge, class OfCorner>
auto TurningRoundedPolytopes<Degree>::with_parts(const Sides& sides, Way way, const OfEdge& of_edge,
                                                 const OfCorner& of_corner) const {
  const auto& of_a = *this->polytope_a_.structure;
  const auto& of_b = *this->polytope_b_.structure;
  if (way < first_edge_and_corner_) {
    const auto k = static_cast<std::size_t>(way - first_corner_and_edge_);
    return of_edge(sides.turned_round(), static_cast<std::uint32_t>(k % of_b.edges.size()),
                   of_a.corners[k / of_b.edges.size()]);
  }
  if (way < first_corners_) {
    const auto k = static_cast<std::size_t>(way - first_edge_and_corner_);
    return of_edge(sides, static_cast<std::uint32_t>(k / of_b.corners.size()), of_b.corners[k % of_b.corners.size()]);
  }
  const auto k = static_cast<std::size_t>(way - first_corners_);
  return of_corner(sides, of_a.corners[k / of_b.corners.size()], of_b.corners[k % of_b.corners.size()]);
}

/// The signs of distances are those of the base.
template <int Degree>
template <class Test>
bool TurningRoundedPolytopes<Degree>::every_plane_distance(const Sides& sides, std::size_t face,
                                                           const Test& test) const {
  const Side& first = sides.first;
  const std::uint32_t on_face = spanning_corners(first.polytope.structure->faces[face])[0];
  const certificates::PlaneApart formula{first.polytope.face(face), radii_};
  for (const std::uint32_t j : sides.second.polytope.structure->corners) {
    if (first.seen && !sides.matters(dot(first.seen->normals[face], sides.between(on_face, j)) - radius())) {
      continue;
    }
    if (!test(between(sides, on_face, j, formula))) return false;
  }
  return true;
}

template <int Degree>
template <class Test>
bool TurningRoundedPolytopes<Degree>::every_side_and_end(const Sides& sides, std::uint32_t edge, std::uint32_t corner,
                                                         const Test& test) const {
  using certificates::EdgeEnds;
  const Side &first = sides.first, &second = sides.second;
  const HullEdge& of_first = first.polytope.structure->edges[edge];
  const std::uint32_t from = of_first.ends[0], to = of_first.ends[1];
  const EdgeEnds line = first.polytope.edge(edge);
  Eigen::Vector3d u, d, across;
  if (first.seen) {
    u = first.seen->edges[edge];
    d = sides.between(from, corner);
    across = d - u * dot(u, d);
  }
  // Both faces of a triangle end on the same side.
  const auto next = [&](std::size_t side) {
    const std::vector<std::uint32_t>& corners = first.polytope.structure->faces[of_first.faces[side]];
    const auto at = std::find(corners.begin(), corners.end(), side == 0 ? to : from) - corners.begin();
    return corners[(static_cast<std::size_t>(at) + 1) % corners.size()];
  };
  const std::size_t faces = !this->has_face(of_first.faces[0]) ? 0 : (next(0) == next(1) ? 1 : 2);
  for (std::size_t side = 0; side < faces; ++side) {
    if (first.seen) {
      const Eigen::Vector3d away = cross(u, first.seen->normals[of_first.faces[side]]) * (side == 0 ? 1.0 : -1.0);
      if (!sides.matters(dot(away, d))) continue;
    }
    const Eigen::Vector3d& third = first.polytope.points[next(side)];
    const certificates::AcrossSide formula{side == 0 ? certificates::FaceCorners{line[0], line[1], third}
                                                     : certificates::FaceCorners{line[1], line[0], third}};
    if (!test(between(sides, from, corner, formula))) return false;
  }
  const bool of_a = &first.polytope == &this->polytope_a_;
  for (const std::uint32_t e : second.edges_at[corner]) {
    if (of_a ? this->stay_parallel(edge, e) : this->stay_parallel(e, edge)) continue;  // zero at all times
    const std::uint32_t end = other_end(second, e, corner);
    if (first.seen) {
      const double sense = second.polytope.structure->edges[e].ends[0] == corner ? 1 : -1;
      if (!sides.matters(sense * dot(second.seen->edges[e], across))) continue;
    }
    const EdgeEnds away{second.polytope.points[corner], second.polytope.points[end]};
    if (!test(between(sides, from, corner, certificates::AwayFromLine{line, away}))) return false;
  }
  if (first.seen && !sides.matters(norm(cross(u, d)) - radius())) return true;
  return test(between(sides, from, corner, certificates::LineApart{line, radii_}));
}

template <int Degree>
template <class Test>
bool TurningRoundedPolytopes<Degree>::every_end(const Sides& sides, std::uint32_t i, std::uint32_t j,
                                                const Test& test) const {
  const auto leads_away = [&](const Sides& seen, std::uint32_t at, std::uint32_t other) {
    const Side& side = seen.first;
    for (const std::uint32_t e : side.edges_at[at]) {
      const std::uint32_t end = other_end(side, e, at);
      if (side.seen) {
        const double sense = side.polytope.structure->edges[e].ends[0] == at ? -1 : 1;
        if (!seen.matters(sense * dot(side.seen->edges[e], seen.between(at, other)))) continue;
      }
      const certificates::PastEnd formula{{side.polytope.points[end], side.polytope.points[at]}};
      if (!test(between(seen, at, other, formula))) return false;
    }
    return true;
  };
  if (!leads_away(sides, i, j) || !leads_away(sides.turned_round(), j, i)) return false;
  if (sides.first.seen && !sides.matters(norm(sides.between(i, j)) - radius())) return true;
  return test(between(sides, i, j, certificates::PointsApart{radii_}));
}

template <int Degree>
template <class Test>
bool TurningRoundedPolytopes<Degree>::every_condition(Way way, const Conditions& which, const Test& test) const {
  const Sides both = sides(which.frame, which.limit);
  if (way < first_corner_and_edge_) {
    if (!Base::every_condition(way, which, test)) return false;
    if (way < this->faces_a()) return every_plane_distance(both, static_cast<std::size_t>(way), test);
    if (way < this->faces()) {
      return every_plane_distance(both.turned_round(), static_cast<std::size_t>(way - this->faces_a()), test);
    }
    const auto pair = this->edge_pair(way);
    const certificates::EdgeEnds u = this->polytope_a_.edge(pair.of_a), v = this->polytope_b_.edge(pair.of_b);
    const auto& u_ends = this->polytope_a_.structure->edges[pair.of_a].ends;
    const auto& v_ends = this->polytope_b_.structure->edges[pair.of_b].ends;
    if (which.frame) {
      const double sine = norm(cross(which.frame->a.edges[pair.of_a], which.frame->b.edges[pair.of_b]));
      if (this->edge_values(*which.frame, pair)[0] - radius() * sine > which.limit) return true;
    }
    return test(between(both, u_ends[0], v_ends[0], certificates::LinesApart{u, v, radii_}));
  }
  return with_parts(
      both, way,
      [&](const Sides& seen, std::uint32_t edge, std::uint32_t corner) {
        return every_side_and_end(seen, edge, corner, test);
      },
      [&](const Sides& seen, std::uint32_t i, std::uint32_t j) { return every_end(seen, i, j, test); });
}

template <int Degree>
double TurningRoundedPolytopes<Degree>::edge_and_corner_gap(const Sides& sides, std::uint32_t edge,
                                                            std::uint32_t corner) const {
  const SeenPolytope &first = *sides.first.seen, &second = *sides.second.seen;
  const HullEdge& of_first = first.structure->edges[edge];
  const Eigen::Vector3d& u = first.edges[edge];
  const Eigen::Vector3d d = sides.between(of_first.ends[0], corner);
  const Eigen::Vector3d across = d - u * dot(u, d);
  double gap = norm(across) - radius();
  if (this->has_face(of_first.faces[0])) {
    gap = std::min(
        {gap, dot(cross(u, first.normals[of_first.faces[0]]), d), dot(cross(first.normals[of_first.faces[1]], u), d)});
  }
  for (const std::uint32_t e : sides.second.edges_at[corner]) {
    const double sense = second.structure->edges[e].ends[0] == corner ? 1 : -1;
    gap = std::min(gap, sense * dot(second.edges[e], across));
  }
  return gap;
}

template <int Degree>
double TurningRoundedPolytopes<Degree>::corners_gap(const Sides& sides, std::uint32_t i, std::uint32_t j) const {
  const Eigen::Vector3d d = sides.between(i, j);
  double gap = norm(d) - radius();
  const auto take = [&gap](const Side& side, std::uint32_t at, const Eigen::Vector3d& away) {
    for (const std::uint32_t e : side.edges_at[at]) {
      const double sense = side.seen->structure->edges[e].ends[0] == at ? -1 : 1;
      gap = std::min(gap, sense * dot(side.seen->edges[e], away));
    }
  };
  take(sides.first, i, d);
  take(sides.second, j, -d);
  return gap;
}

/// For each way the least by which one of its conditions is above zero, as a length: a distance less r (between two
/// edges times the sine of their angle), or the product of the vector between two points with a vector of length 1 at
/// most (a unit vector, or its part across a line), which turns no faster than both bodies together.
template <int Degree>
auto TurningRoundedPolytopes<Degree>::near_ways(const Frame& frame, double) const -> std::vector<WayWidth<Way>> {
  std::vector<WayWidth<Way>> found;
  found.reserve(static_cast<std::size_t>(this->ways));
  for (Way way = 0; way < this->faces(); ++way) found.push_back({way, this->face_width(frame, way) - radius()});
  for (std::size_t u = 0; u < frame.a.edges.size(); ++u) {
    for (std::size_t v = 0; v < frame.b.edges.size(); ++v) {
      const double within = radius() * norm(cross(frame.a.edges[u], frame.b.edges[v]));
      const double apart = this->edge_values(frame, {u, v, true})[0];
      const auto widths = this->edge_widths(frame, u, v);
      const Way way = this->way_of_edges(u, v);
      found.push_back({way, std::min(widths[0], -apart - within)});
      found.push_back({way + 1, std::min(widths[1], apart - within)});
    }
  }
  const Sides both = sides(&frame, 0);
  for (Way way = first_corner_and_edge_; way < this->ways; ++way) {
    const double width = with_parts(
        both, way,
        [&](const Sides& seen, std::uint32_t edge, std::uint32_t corner) {
          return edge_and_corner_gap(seen, edge, corner);
        },
        [&](const Sides& seen, std::uint32_t i, std::uint32_t j) { return corners_gap(seen, i, j); });
    found.push_back({way, width});
  }
  return found;
}

}  // namespace kds::collision
