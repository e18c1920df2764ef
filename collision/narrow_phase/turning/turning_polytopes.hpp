// Two convex polytopes that turn: by which planes they are apart, and for how long.
#pragma once

#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/normal_along_edge.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "collision/narrow_phase/hull_distance.hpp"
#include "collision/narrow_phase/turning/pair_frame.hpp"
#include "collision/narrow_phase/turning/parallel_edges.hpp"
#include "collision/narrow_phase/turning/seen_polytope.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace kds::collision {

/// Two polytopes do not penetrate if a plane has the one on one closed side and the other on the other. Of such planes
/// there is one across a face of either, or along an edge of each, if there is any: the faces of the difference of the
/// two, which are the *ways* of being apart.
///
/// A way of a face says that all corners of the other are beyond it. One of an edge u of a and an edge v of b, with n =
/// u x v or its opposite from a to b, that n . (q - p) >= 0 for points p, q of the two, and that each body has its edge
/// outermost: both faces at u, with the outward normals N, M to its left and right, are below the plane, which is N . v
/// >= 0 and M . v <= 0 (n turned round: <= 0 and >= 0), and so are those at v. As the bodies are convex, all of them
/// then is. All these are turning certificates. Edges that are parallel at all times separate nothing: all conditions
/// are zero then, and only then.
///
/// The number of ways is that of the faces and twice the product of the edges: doubles tell for some thirty operations
/// that one is blocked. Cost: the first contact of two hulls of 8, 20, 40 corners that turn by a radian in that time
/// 0.06, 0.24, 0.85 ms.
template <int Degree>
class TurningPolytopes {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;

  TurningPolytopes(const RigidMotion& a, const ConvexCore& core_a, const RigidMotion& b, const ConvexCore& core_b)
      : TurningPolytopes(a, TurningPolytope(core_a), b, TurningPolytope(core_b)) {}
  TurningPolytopes(const RigidMotion& a, TurningPolytope core_a, const RigidMotion& b, TurningPolytope core_b)
      : ways(number_of_ways(*core_a.structure, *core_b.structure)),
        a_(a),
        b_(b),
        polytope_a_(std::move(core_a)),
        polytope_b_(std::move(core_b)),
        turned_alike_(turned_alike()) {}

  /// Faces of a, faces of b, pairs of edges with either sense of their product.
  int ways;

  /// The pair as it is at a time, in doubles.
  template <class Seen>
  struct FrameOf : PairFrame<Degree> {
    FrameOf(const TurningPolytopes& pair, double t)
        : PairFrame<Degree>(pair.a_, pair.b_, t),
          a(pair.polytope_a_, this->turn_a),
          b(pair.polytope_b_, this->turn_b) {}
    Seen a, b;
  };
  using Frame = FrameOf<SeenPolytope>;
  Frame frame(double t) const { return {*this, t}; }

  /// Those conditions that are not above a value at the time of a frame; all of them if there is no frame.
  struct Conditions {
    const Frame* frame = nullptr;
    double limit = 0;
  };
  static Conditions all(int) { return {}; }
  /// What cannot be reached in the time of the stretch need not be looked at.
  Conditions unsure(const Frame& frame, int, double stretch) const {
    if (!frame.certain) return {};
    return {&frame, error(frame) + fastest(frame, stretch) * stretch};
  }

  /// Calls test(certificate) for conditions of a way until it returns false.
  template <class Test>
  bool every_condition(int way, const Conditions& which, const Test& test) const;

  /// How far the corners are beyond a face; for edges the least of how far they are beyond each other, times the sine
  /// of their angle, and of how far their faces are below the plane.
  double gaps(const Frame& frame, std::vector<double>& gap) const;

  /// A bound on how fast these change.
  double fastest(const PairFrame<Degree>& frame, double stretch) const {
    return frame.fastest(polytope_a_.radius, polytope_b_.radius, stretch);
  }

  /// A time from t on until which they are apart; t where doubles do not tell, or where it would be hardly later.
  double apart_until(double t, double horizon) const { return farther_apart_until(0, t, horizon); }

  /// How deep the two are in each other at t, in doubles: along the way that is the least blocked.
  double depth(double t) const;

  bool known_to_separate_nothing(int way) const;
  /// Whether all conditions of a way are zero at all times.
  template <class Vanishes>
  bool separates_nothing(int way, const Vanishes& vanishes) const {
    if (way < faces()) return false;
    return every_condition(way, all(way), vanishes);
  }

  /// The same pair with the first one smaller: each face is farther inside by `margin` at least. None where nothing of
  /// it would be left.
  std::optional<TurningPolytopes> smaller(double margin) const;

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
  int faces_a() const { return static_cast<int>(polytope_a_.structure->faces.size()); }
  int faces() const { return faces_a() + static_cast<int>(polytope_b_.structure->faces.size()); }
  static int number_of_ways(const HullStructure& a, const HullStructure& b) {
    return static_cast<int>(a.faces.size() + b.faces.size() + 2 * a.edges.size() * b.edges.size());
  }
  EdgePair edge_pair(int way) const {
    const auto k = static_cast<std::size_t>(way - faces());
    const std::size_t edges_b = polytope_b_.structure->edges.size();
    return {k / 2 / edges_b, k / 2 % edges_b, k % 2 != 0};
  }
  bool turned_alike() const {
    return a_.orientation.coeffs() == b_.orientation.coeffs() && a_.angular_velocity == b_.angular_velocity &&
           (a_.spin().still() || a_.path.start == b_.path.start);
  }
  double error(const PairFrame<Degree>& frame) const {
    if (!frame.certain) return never;
    const double lengths = norm(frame.way.value) + polytope_a_.radius + polytope_b_.radius;
    return frame.way_error + PairFrame<Degree>::rounding * lengths;
  }
  /// The vector from the nearest point of a to that of b; zero if they overlap.
  template <class Seen>
  Eigen::Vector3d way_between_nearest(const FrameOf<Seen>& frame) const {
    const auto farthest = [&](const Eigen::Vector3d& along) {
      return Eigen::Vector3d(frame.way.value + frame.b.farthest(along) - frame.a.farthest(-along));
    };
    return nearest_to_origin(farthest, frame.way.value).point;
  }
  /// As apart_until, but farther apart than `grown`.
  double farther_apart_until(double grown, double t, double horizon) const;

  /// Whether two edges are known to be parallel at all times: those of bodies that are turned alike, and those along a
  /// common axis about which both bodies turn, as in all scenes that are planar.
  bool stay_parallel(std::size_t of_a, std::size_t of_b) const;

  /// In the order of every_condition.
  std::array<double, 5> edge_values(const Frame& frame, const EdgePair& pair) const;
  template <class Test>
  static bool every_corner(const RigidMotion& of_face, const TurningPolytope& polytope, std::size_t face,
                           const RigidMotion& of_corner, const TurningPolytope& other, const SeenPolytope* seen_face,
                           const SeenPolytope* seen_other, const Eigen::Vector3d& way, double limit, const Test& test);
  double wait_along(const FrameOf<SeenCorners>& frame, const Eigen::Vector3d& n, double grown, bool with_a,
                    double stretch) const;

  const RigidMotion& a_;
  const RigidMotion& b_;
  TurningPolytope polytope_a_, polytope_b_;

 private:
  bool turned_alike_;
  /// steady_directions() of a and b, once they are asked for.
  mutable std::optional<std::array<std::vector<Eigen::Vector3d>, 2>> steady_;
};

// ---------------------------------------------------------------------------------------------------------------------

/// `way`: from the origin of the body of the face to that of the other, where they are seen.
template <int Degree>
template <class Test>
bool TurningPolytopes<Degree>::every_corner(const RigidMotion& of_face, const TurningPolytope& polytope,
                                            std::size_t face, const RigidMotion& of_corner,
                                            const TurningPolytope& other, const SeenPolytope* seen_face,
                                            const SeenPolytope* seen_other, const Eigen::Vector3d& way, double limit,
                                            const Test& test) {
  const auto corners = polytope.face(face);
  for (const std::uint32_t i : other.structure->corners) {
    if (seen_face) {
      const Eigen::Vector3d& on_face = seen_face->points[polytope.structure->faces[face][0]];
      if (dot(seen_face->normals[face], way + seen_other->points[i] - on_face) > limit) continue;
    }
    if (!test(certificates::VertexFaceSeparation<Degree>{of_corner, of_face, other.points[i], corners})) return false;
  }
  return true;
}

template <int Degree>
template <class Test>
bool TurningPolytopes<Degree>::every_condition(int way, const Conditions& which, const Test& test) const {
  const Frame* const frame = which.frame;
  const SeenPolytope* const seen_a = frame ? &frame->a : nullptr;
  const SeenPolytope* const seen_b = frame ? &frame->b : nullptr;
  const Eigen::Vector3d between = frame ? frame->way.value : Eigen::Vector3d(Eigen::Vector3d::Zero());
  if (way < faces_a()) {
    return every_corner(a_, polytope_a_, static_cast<std::size_t>(way), b_, polytope_b_, seen_a, seen_b, between,
                        which.limit, test);
  }
  if (way < faces()) {
    return every_corner(b_, polytope_b_, static_cast<std::size_t>(way - faces_a()), a_, polytope_a_, seen_b, seen_a,
                        -between, which.limit, test);
  }
  const EdgePair pair = edge_pair(way);
  std::array<double, 5> value{};
  if (frame) value = edge_values(*frame, pair);
  const auto& faces_at_u = polytope_a_.structure->edges[pair.of_a].faces;
  const auto& faces_at_v = polytope_b_.structure->edges[pair.of_b].faces;
  const std::array<bool, 5> given{true, has_face(faces_at_u[0]), has_face(faces_at_u[1]), has_face(faces_at_v[0]),
                                  has_face(faces_at_v[1])};
  const auto matters = [&](std::size_t k) { return given[k] && (!frame || !(value[k] > which.limit)); };
  const std::array<Eigen::Vector3d, 2> u = polytope_a_.edge(pair.of_a), u_back{u[1], u[0]};
  const std::array<Eigen::Vector3d, 2> v = polytope_b_.edge(pair.of_b), v_back{v[1], v[0]};
  using certificates::NormalAlongEdge;
  // An edge from a to b: the product has to point from b to a for EdgeEdgeSeparation.
  return (!matters(0) || test(certificates::EdgeEdgeSeparation<Degree>{a_, b_, pair.forward ? u_back : u, v})) &&
         (!matters(1) ||
          test(NormalAlongEdge<Degree>{a_, b_, polytope_a_.face(faces_at_u[0]), pair.forward ? v : v_back})) &&
         (!matters(2) ||
          test(NormalAlongEdge<Degree>{a_, b_, polytope_a_.face(faces_at_u[1]), pair.forward ? v_back : v})) &&
         (!matters(3) ||
          test(NormalAlongEdge<Degree>{b_, a_, polytope_b_.face(faces_at_v[0]), pair.forward ? u : u_back})) &&
         (!matters(4) ||
          test(NormalAlongEdge<Degree>{b_, a_, polytope_b_.face(faces_at_v[1]), pair.forward ? u_back : u}));
}

/// The products of normals and edges are times the radii, which are less than what `fastest` takes for lengths: so they
/// change no faster than that. Edges without faces are outermost.
template <int Degree>
std::array<double, 5> TurningPolytopes<Degree>::edge_values(const Frame& frame, const EdgePair& pair) const {
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
double TurningPolytopes<Degree>::gaps(const Frame& frame, std::vector<double>& gap) const {
  const Eigen::Vector3d& between = frame.way.value;
  const auto of_face = [](const SeenPolytope& of, std::size_t f, const SeenPolytope& other,
                          const Eigen::Vector3d& way) {
    const Eigen::Vector3d& n = of.normals[f];
    return dot(n, way + other.farthest(-n) - of.points[of.structure->faces[f][0]]);
  };
  std::size_t way = 0;
  for (std::size_t f = 0; f < frame.a.normals.size(); ++f) gap[way++] = of_face(frame.a, f, frame.b, between);
  for (std::size_t f = 0; f < frame.b.normals.size(); ++f) gap[way++] = of_face(frame.b, f, frame.a, -between);
  // As edge_values() for all edges. A normal and an edge are multiplied once for all that this edge is paired with: for
  // hulls of 20 corners that is a quarter of the work.
  const double size = polytope_a_.radius + polytope_b_.radius;
  const std::size_t edges_b = frame.b.edges.size();
  std::vector<double> along_b(frame.a.normals.size() * edges_b);  // by faces of a and edges of b
  for (std::size_t f = 0; f < frame.a.normals.size(); ++f) {
    for (std::size_t j = 0; j < edges_b; ++j) {
      along_b[f * edges_b + j] = size * dot(frame.a.normals[f], frame.b.edges[j]);
    }
  }
  std::vector<double> along_a(frame.b.normals.size());  // by faces of b, of one edge of a
  for (std::size_t i = 0; i < frame.a.edges.size(); ++i) {
    const HullEdge& edge_a = polytope_a_.structure->edges[i];
    const Eigen::Vector3d& u = frame.a.edges[i];
    for (std::size_t f = 0; f < along_a.size(); ++f) along_a[f] = size * dot(frame.b.normals[f], u);
    for (std::size_t j = 0; j < edges_b; ++j) {
      const HullEdge& edge_b = polytope_b_.structure->edges[j];
      const Eigen::Vector3d apart = between + frame.b.points[edge_b.ends[0]] - frame.a.points[edge_a.ends[0]];
      const double distance = dot(cross(u, frame.b.edges[j]), apart);
      double least = distance, greatest = distance;  // of what is positive if the product points from a to b
      const auto take = [&](double value) { least = std::min(least, value), greatest = std::max(greatest, value); };
      if (has_face(edge_a.faces[0])) take(along_b[edge_a.faces[0] * edges_b + j]);
      if (has_face(edge_a.faces[1])) take(-along_b[edge_a.faces[1] * edges_b + j]);
      if (has_face(edge_b.faces[0])) take(along_a[edge_b.faces[0]]);
      if (has_face(edge_b.faces[1])) take(-along_a[edge_b.faces[1]]);
      gap[way++] = -greatest;
      gap[way++] = least;
    }
  }
  return error(frame);
}

/// How long all of b is beyond all of a by more than `grown`, along a direction that turns with one of them: that one
/// then reaches as far as it does now.
template <int Degree>
double TurningPolytopes<Degree>::wait_along(const FrameOf<SeenCorners>& frame, const Eigen::Vector3d& n, double grown,
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
double TurningPolytopes<Degree>::farther_apart_until(double grown, double t, double horizon) const {
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
template <int Degree>
double TurningPolytopes<Degree>::depth(double t) const {
  const Frame frame = this->frame(t);
  std::vector<double> gap(static_cast<std::size_t>(ways));
  gaps(frame, gap);
  double least = never;
  for (int way = 0; way < ways; ++way) {
    if (way < faces()) {
      least = std::min(least, -gap[static_cast<std::size_t>(way)]);
      continue;
    }
    const EdgePair pair = edge_pair(way);
    const double sine = norm(cross(frame.a.edges[pair.of_a], frame.b.edges[pair.of_b]));
    const auto value = edge_values(frame, pair);
    if (sine > 0x1p-20 && std::min({value[1], value[2], value[3], value[4]}) >= 0) {
      least = std::min(least, -value[0] / sine);
    }
  }
  return std::max(0.0, least);
}

template <int Degree>
bool TurningPolytopes<Degree>::known_to_separate_nothing(int way) const {
  if (way < faces()) return false;
  const EdgePair pair = edge_pair(way);
  return stay_parallel(pair.of_a, pair.of_b);
}

template <int Degree>
bool TurningPolytopes<Degree>::stay_parallel(std::size_t of_a, std::size_t of_b) const {
  using namespace parallel_edges;
  if (turned_alike_) return are_parallel(polytope_a_, of_a, polytope_b_, of_b);
  if (!steady_) steady_ = {steady_directions(a_, polytope_a_), steady_directions(b_, polytope_b_)};
  const Eigen::Vector3d &u = (*steady_)[0][of_a], &v = (*steady_)[1][of_b];
  if (u.isZero(0) || v.isZero(0) || !maybe_parallel(u, v)) return false;
  return known_parallel_at_start(a_, polytope_a_.edge(of_a), b_, polytope_b_.edge(of_b));
}

/// Towards the middle of its corners, which is inside, by a part of the way.
template <int Degree>
std::optional<TurningPolytopes<Degree>> TurningPolytopes<Degree>::smaller(double margin) const {
  const HullStructure& structure = *polytope_a_.structure;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : structure.corners) middle += polytope_a_.points[i];
  middle /= static_cast<double>(structure.corners.size());
  double inner = never;
  for (std::size_t f = 0; f < structure.faces.size(); ++f) {
    inner = std::min(inner, dot(polytope_a_.normals()[f], polytope_a_.points[structure.faces[f][0]] - middle));
  }
  if (!(inner > margin)) return std::nullopt;
  std::vector<Eigen::Vector3d> points = polytope_a_.points;
  for (Eigen::Vector3d& x : points) x += (middle - x) * (margin / inner);
  return TurningPolytopes(a_, TurningPolytope(structure, points), b_, polytope_b_);
}

}  // namespace kds::collision
