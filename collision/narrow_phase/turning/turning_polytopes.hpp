// Two convex polytopes that turn: by which planes they are apart, by exact signs.
#pragma once

#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/normal_along_edge.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "collision/narrow_phase/turning/parallel_edges.hpp"
#include "collision/narrow_phase/turning/polytope_pair.hpp"
#include "collision/narrow_phase/turning/seen_polytope.hpp"

#include <Eigen/Core>

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
/// Which ways may be open in a stretch of time is told in doubles, and in proportion to the corners (PolytopePair).
template <int Degree>
class TurningPolytopes : public PolytopePair<Degree> {
 public:
  using Base = PolytopePair<Degree>;
  using typename Base::Frame, typename Base::RigidMotion, typename Base::Way;

  TurningPolytopes(const RigidMotion& a, const ConvexCore& core_a, const RigidMotion& b, const ConvexCore& core_b)
      : TurningPolytopes(a, TurningPolytope(core_a), b, TurningPolytope(core_b)) {}
  TurningPolytopes(const RigidMotion& a, TurningPolytope core_a, const RigidMotion& b, TurningPolytope core_b)
      : Base(a, std::move(core_a), b, std::move(core_b)), turned_alike_(turned_alike()) {}

  /// Those conditions that are not above a value at the time of a frame; all of them if there is no frame.
  struct Conditions {
    const Frame* frame = nullptr;
    double limit = 0;
  };
  static Conditions all(Way) { return {}; }
  /// What cannot be reached in the time of the stretch need not be looked at.
  Conditions unsure(const Frame& frame, Way, double stretch) const {
    if (!frame.certain) return {};
    return {&frame, this->error(frame) + this->fastest(frame, stretch) * stretch};
  }

  /// Calls test(certificate) for conditions of a way until it returns false.
  template <class Test>
  bool every_condition(Way way, const Conditions& which, const Test& test) const;

  bool known_to_separate_nothing(Way way) const;
  /// Whether all conditions of a way are zero at all times.
  template <class Vanishes>
  bool separates_nothing(Way way, const Vanishes& vanishes) const {
    if (way < faces()) return false;
    return every_condition(way, all(way), vanishes);
  }

  /// The same pair with the first one smaller: each face is farther inside by `margin` at least. None where nothing of
  /// it would be left.
  std::optional<TurningPolytopes> smaller(double margin) const;

 protected:
  using Base::a_, Base::b_, Base::polytope_a_, Base::polytope_b_, Base::faces, Base::faces_a, Base::has_face;
  using typename Base::EdgePair;

  bool turned_alike() const {
    return a_.orientation.coeffs() == b_.orientation.coeffs() && a_.angular_velocity == b_.angular_velocity &&
           (a_.spin().still() || a_.path.start == b_.path.start);
  }
  /// Whether two edges are known to be parallel at all times: those of bodies that are turned alike, and those along a
  /// common axis about which both bodies turn, as in all scenes that are planar.
  bool stay_parallel(std::size_t of_a, std::size_t of_b) const;

  template <class Test>
  static bool every_corner(const RigidMotion& of_face, const TurningPolytope& polytope, std::size_t face,
                           const RigidMotion& of_corner, const TurningPolytope& other, const SeenPolytope* seen_face,
                           const SeenPolytope* seen_other, const Eigen::Vector3d& way, double limit, const Test& test);

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
bool TurningPolytopes<Degree>::every_condition(Way way, const Conditions& which, const Test& test) const {
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
  const EdgePair pair = this->edge_pair(way);
  std::array<double, 5> value{};
  if (frame) value = this->edge_values(*frame, pair);
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

template <int Degree>
bool TurningPolytopes<Degree>::known_to_separate_nothing(Way way) const {
  if (way < faces()) return false;
  const EdgePair pair = this->edge_pair(way);
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

template <int Degree>
std::optional<TurningPolytopes<Degree>> TurningPolytopes<Degree>::smaller(double margin) const {
  const double inner = polytope_a_.middle().below;
  if (!(inner > margin)) return std::nullopt;
  return TurningPolytopes(a_, polytope_a_.drawn_in(margin / inner), b_, polytope_b_);
}

}  // namespace kds::collision
