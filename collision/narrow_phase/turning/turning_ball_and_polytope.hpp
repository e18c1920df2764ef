// A ball and a convex polytope or a segment that turns: from which part of the polytope the ball is apart, and for how
// long.
#pragma once

#include "certificates/turning/ball_triangle_separation.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/hull_distance.hpp"
#include "collision/narrow_phase/turning/pair_frame.hpp"
#include "collision/narrow_phase/turning/seen_polytope.hpp"
#include "collision/narrow_phase/turning/way_widths.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace kds::collision {

/// A convex core (a) and a ball (b) are apart while the centre is no nearer to the core than the radius (the sum of the
/// radii, if the core has one too). The distance is that to the plane of a face, or to the line of an edge where the
/// centre is on the far side of it from both faces, or to a corner from which all edges lead away. Where one of these
/// *ways* holds, the half space, the wedge or the cone that holds the core is no nearer; and whichever part of it is
/// the nearest, its way holds if they are apart. (Compare TurningTriangleAndBall.)
template <int Degree>
class TurningBallAndPolytope {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;

  TurningBallAndPolytope(const RigidMotion& a, const ConvexCore& core, const RigidMotion& b, double radius)
      : ways(number_of_ways(core.structure())), a_(a), b_(b), polytope_(core), radii_{core.radius(), radius} {
    edges_at_.resize(polytope_.points.size());
    for (std::uint32_t e = 0; e < polytope_.structure->edges.size(); ++e) {
      for (const std::uint32_t end : polytope_.structure->edges[e].ends) edges_at_[end].push_back(e);
    }
  }

  /// Faces, edges, corners.
  int ways;

  /// The two at a time, the polytope as `Seen` sees it.
  template <class Seen>
  struct FrameOf : PairFrame<Degree> {
    FrameOf(const TurningBallAndPolytope& pair, double t)
        : PairFrame<Degree>(pair.a_, pair.b_, t), a(pair.polytope_, this->turn_a) {}
    Seen a;
  };
  using Frame = FrameOf<SeenPolytope>;
  Frame frame(double t) const { return {*this, t}; }

  // Conditions are few, and all are looked at.
  using Conditions = std::uint32_t;
  static constexpr Conditions all(int) { return ~Conditions{0}; }
  Conditions unsure(const Frame&, int way, double) const { return all(way); }
  static bool known_to_separate_nothing(int) { return false; }
  template <class Vanishes>
  static bool separates_nothing(int, const Vanishes&) {
    return false;
  }

  template <class Test>
  bool every_condition(int way, Conditions, const Test& test) const;

  std::vector<WayWidth<int>> near_ways(const Frame& frame, double stretch) const;
  double error(const PairFrame<Degree>& frame) const {
    if (!frame.certain) return never;
    return 4 * frame.way_error + PairFrame<Degree>::rounding * (norm(frame.way.value) + polytope_.radius + radius());
  }

  double fastest(const PairFrame<Degree>& frame, double stretch) const {
    return frame.fastest(polytope_.radius, 0, stretch);
  }

  double apart_until(double t, double horizon) const;

  /// How deep the ball is in the core, if its centre is not.
  double depth(double t) const {
    const double distance = norm(way_from_core(frame(t)));
    return distance > 0 ? std::max(0.0, radius() - distance) : never;
  }

  /// The same pair with a smaller ball; none where nothing of it is left.
  std::optional<TurningBallAndPolytope> smaller(double margin) const {
    if (!(radius() > margin)) return std::nullopt;
    TurningBallAndPolytope pair = *this;
    pair.radii_ = {radius() - margin, 0};
    return pair;
  }

  double time_of_turning() const {
    const double rate = norm(a_.angular_velocity);
    return rate > 0 ? 0.5 / rate : never;
  }

 private:
  using Part = certificates::TrianglePart;
  using Triangle = certificates::detail::BallAndTriangle<Degree>;

  double radius() const { return radii_[0] + radii_[1]; }
  std::size_t face_count() const { return polytope_.structure->faces.size(); }
  std::size_t edge_count() const { return polytope_.structure->edges.size(); }
  static int number_of_ways(const HullStructure& core) {
    return static_cast<int>(core.faces.size() + core.edges.size() + core.corners.size());
  }
  std::uint32_t other_end(std::uint32_t edge, std::uint32_t end) const {
    const auto& ends = polytope_.structure->edges[edge].ends;
    return ends[0] == end ? ends[1] : ends[0];
  }
  /// The corner of a face after one of its corners.
  const Eigen::Vector3d& next_corner(std::uint32_t face, std::uint32_t corner) const {
    const std::vector<std::uint32_t>& corners = polytope_.structure->faces[face];
    const auto at = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), corner) - corners.begin());
    return polytope_.points[corners[(at + 1) % corners.size()]];
  }
  Triangle part(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r,
                typename Part::Kind kind) const {
    return {b_.path, a_, {p, q, r}, {kind, 0}};
  }
  /// From the nearest point of the core to the centre of the ball; zero if that is inside.
  template <class Seen>
  Eigen::Vector3d way_from_core(const FrameOf<Seen>& frame) const {
    const auto farthest = [&](const Eigen::Vector3d& along) {
      return Eigen::Vector3d(frame.way.value - frame.a.farthest(-along));
    };
    return nearest_to_origin(farthest, frame.way.value).point;
  }

  const RigidMotion& a_;
  const RigidMotion& b_;
  TurningPolytope polytope_;
  std::array<double, 2> radii_;
  std::vector<std::vector<std::uint32_t>> edges_at_;  ///< by points
};

// ---------------------------------------------------------------------------------------------------------------------

template <int Degree>
template <class Test>
bool TurningBallAndPolytope<Degree>::every_condition(int way, Conditions, const Test& test) const {
  using certificates::BallBeyondPart;
  using certificates::CentreBeyondPart;
  const HullStructure& structure = *polytope_.structure;
  const auto k = static_cast<std::size_t>(way);
  if (k < face_count()) {
    const auto [p, q, r] = polytope_.face(k);
    const Triangle face = part(p, q, r, Part::Kind::face);
    return test(CentreBeyondPart<Degree>{face, 0}) && test(BallBeyondPart<Degree>{face, radii_});
  }
  if (k < face_count() + edge_count()) {
    const HullEdge& edge = structure.edges[k - face_count()];
    const auto [from, to] = edge.ends;
    const Eigen::Vector3d &p = polytope_.points[from], &q = polytope_.points[to];
    if (edge.faces[0] != HullStructure::no_face) {
      const Triangle left = part(p, q, next_corner(edge.faces[0], to), Part::Kind::edge);
      const Triangle right = part(q, p, next_corner(edge.faces[1], from), Part::Kind::edge);
      if (!test(CentreBeyondPart<Degree>{left, 0}) || !test(CentreBeyondPart<Degree>{right, 0})) return false;
    }
    return test(BallBeyondPart<Degree>{part(p, q, q, Part::Kind::edge), radii_});
  }
  const std::uint32_t corner = structure.corners[k - face_count() - edge_count()];
  const Eigen::Vector3d& p = polytope_.points[corner];
  for (const std::uint32_t e : edges_at_[corner]) {
    const Eigen::Vector3d& q = polytope_.points[other_end(e, corner)];
    if (!test(CentreBeyondPart<Degree>{part(p, q, q, Part::Kind::corner), 0})) return false;
  }
  return test(BallBeyondPart<Degree>{part(p, p, p, Part::Kind::corner), radii_});
}

/// All: there are as many as faces, edges and corners.
template <int Degree>
std::vector<WayWidth<int>> TurningBallAndPolytope<Degree>::near_ways(const Frame& frame, double) const {
  const HullStructure& structure = *polytope_.structure;
  const Eigen::Vector3d& centre = frame.way.value;
  std::vector<WayWidth<int>> found;
  const auto take = [&found](double width) { found.push_back({static_cast<int>(found.size()), width}); };
  for (std::size_t f = 0; f < face_count(); ++f) {
    take(dot(frame.a.normals[f], centre - frame.a.points[structure.faces[f][0]]) - radius());
  }
  for (std::size_t e = 0; e < edge_count(); ++e) {
    const HullEdge& edge = structure.edges[e];
    const Eigen::Vector3d d = centre - frame.a.points[edge.ends[0]];
    const Eigen::Vector3d& u = frame.a.edges[e];
    double width = norm(cross(u, d)) - radius();
    if (edge.faces[0] != HullStructure::no_face) {
      width = std::min(
          {width, dot(cross(u, frame.a.normals[edge.faces[0]]), d), dot(cross(frame.a.normals[edge.faces[1]], u), d)});
    }
    take(width);
  }
  for (const std::uint32_t i : structure.corners) {
    const Eigen::Vector3d d = centre - frame.a.points[i];
    double width = norm(d) - radius();
    for (const std::uint32_t e : edges_at_[i]) {
      width = std::min(width, (structure.edges[e].ends[0] == i ? -1 : 1) * dot(frame.a.edges[e], d));
    }
    take(width);
  }
  return found;
}

template <int Degree>
double TurningBallAndPolytope<Degree>::apart_until(double t, double horizon) const {
  t = balls_apart_until(a_, b_, polytope_.radius, radius(), t, horizon);
  if (t == never) return never;
  const FrameOf<SeenCorners> frame(*this, t);
  const Eigen::Vector3d apart = way_from_core(frame);
  if (!frame.certain || !(norm(apart) - radius() > error(frame))) return t;
  const Eigen::Vector3d n = normalized(apart);
  const double all = (horizon - t) * (1 + 0x1p-40);
  const double stretch = frame.stretch(polytope_.radius + radius(), all);
  // The direction from the nearest point, with which it turns; the spin of the ball does not matter.
  const TurningBounds bounds(frame, frame.rate_a, polytope_.radius, 0, stretch);
  Jet f = dot(turning(n, frame.spin_a), frame.way);
  f.value -= dot(n, frame.a.farthest(n)) + radius() + PairFrame<Degree>::rounding * radius() + bounds.rounding;
  double wait = positive_for(f, bounds.third, stretch);
  if (stretch < all && time_of_turning() != never) {
    for (const Eigen::Vector3d& along : {n, normalized(frame.way.value)}) {
      const double covered = frame.a.revolving_extent(along, frame.spin_a) + radius();
      wait = std::max(wait, revolving_apart_for(frame, along, covered));
    }
  }
  return after_wait(t, wait, stretch);
}

}  // namespace kds::collision
