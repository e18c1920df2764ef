// When two convex shapes penetrate, of which one is a polytope.
#pragma once

#include "certificates/polytope_separation.hpp"
#include "collision/degrees.hpp"
#include "collision/narrow_phase/convex_core.hpp"
#include "collision/narrow_phase/difference_planes.hpp"
#include "collision/narrow_phase/gap_conditions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/quick_distance.hpp"
#include "collision/narrow_phase/quick_motion.hpp"
#include "collision/shapes/polytope.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

/// A convex polytope (a) and a ball, a capsule, a box or another polytope, from `now` to the horizon.
///
/// The two keep their orientations (those that turn: turning/), so the difference of their cores (ConvexCore) is a
/// polytope that stays as it is, grown by the radius of b. They penetrate while the place of b as seen from a is
/// inside. That is a union of convex *pieces*: the difference itself, which is what is inside of all its planes; and if
/// there is a radius, for each corner, edge and face of its surface the places that are between its sides and nearer
/// than the radius to the point, line or plane that it spans.
///
/// Of the planes of the difference only those are made that the place of b comes near (DifferencePlanes). The parts of
/// the surface are those that a corner, edge or face of a makes with an end, or with the segment, of b. Some are
/// inside: which ones need not be known.
///
/// The shapes are those that the matrices of their rotations make of the points given, taken as exact, and so are all
/// signs. A filter in doubles decides most, as in RoundedZonotope.
///
/// Cost: about as the product of the edges of both: two hulls of 8, 20, 40 corners take 17, 66, 210 us for the first
/// contact, and 4 to 15 us to tell until when they do not meet (hulls_apart_until()).
template <int Degree>
class RoundedPolytope {
 public:
  using Body = TranslatingShape<Degree>;
  using Quick = QuickMotion<Degree>;

  class Piece;

  /// With `even_apart` planes are made even if the shapes are apart: for outmost().
  RoundedPolytope(const Body& a, const Body& b, double now, double horizon, bool even_apart = false);
  RoundedPolytope(const RoundedPolytope&) = delete;  // refers to itself
  RoundedPolytope& operator=(const RoundedPolytope&) = delete;

  /// As those of RoundedZonotope.
  template <class Visit>
  void every_piece(const Visit& visit) const;
  template <class Visit>
  void earliest_pieces(double horizon, const Visit& visit) const;

  /// The outward unit normal of the plane of the difference that the place of b is the farthest beyond now, or the
  /// least deep below, in doubles. Precondition: made with `even_apart`.
  Eigen::Vector3d outmost() const { return planes_.outmost(0).normal; }

 private:
  using Along = typename Quick::Along;

  using Plane = typename DifferencePlanes<Degree>::Plane;

  TimeWindow after_end() const { return {motion_.end(), motion_.end()}; }
  bool near(const Along& along, double side, double within);
  bool near(const Plane& plane) { return !plane.known || near(plane.along, 1, plane.height + radius_); }
  void find_first_planes();
  template <class Visit>
  void every_part(const Visit& visit) const;

  const Body& a_;
  const Body& b_;
  ConvexCore core_a_, core_b_;
  certificates::HullDifference hulls_;
  std::array<std::vector<Eigen::Vector3d>, 2> places_;  ///< of the points of a and b, rounded
  double radius_;
  Quick motion_;
  std::array<Along, 3> coordinates_;
  mutable DifferencePlanes<Degree> planes_;  ///< which grow, as they are needed
  TimeWindow window_;                        ///< in which b's place may be near at all
  bool apart_ = false;
  bool even_apart_;
};

/// One convex piece. All functions are exact.
template <int Degree>
class RoundedPolytope<Degree>::Piece {
 public:
  /// The first double t in [from, horizon] just after which b's place is in the piece, or `never`.
  double first_inside(double from, double horizon) const {
    return first_all_closed(*this, std::max(from, earliest()), horizon);
  }
  bool inside(double t) const { return all_closed(*this, t); }
  /// Precondition: inside(t).
  double first_outside(double t, double horizon) const { return first_any_open(*this, t, horizon); }

  /// A time before which it is not in the piece.
  double earliest() const { return pair_->motion_.time_before(window_.begin); }

  // ---- For gap_conditions.hpp: the gaps of the planes of the difference, or of the sides of a part and the last one
  // its distance.

  std::size_t size() const { return solid_ ? pair_->planes_.found().size() : sides_.size() + 1; }
  bool surely_closed(std::size_t i, double t) const;
  double closed_until(std::size_t i, double t) const;
  double opened_by(std::size_t i) const;
  double failure_time(std::size_t i, double t, double horizon) const;
  double recovery_time(std::size_t i, double t, double horizon) const;
  bool closed(std::size_t i, double t) const;
  bool find_more(double from, double until) const { return solid_ && pair_->planes_.find_more(from, until); }

 private:
  friend RoundedPolytope;

  struct Side {
    certificates::DifferenceSide side;
    bool known;
    Along along;
    double height;
  };

  explicit Piece(const RoundedPolytope& pair);
  Piece(const RoundedPolytope& pair, const certificates::DifferencePart& part,
        std::span<const certificates::DifferenceSide> sides);

  bool add_distance();
  bool add_side(const certificates::DifferenceSide& side);
  bool possible() const { return window_.begin <= window_.end; }
  /// Looks at the distance; false if b's place is not in the piece by a time.
  bool cut(double until) { return solid_ || distance_.size() < 2 || distance_.cut_until(window_, until); }
  bool is_distance(std::size_t i) const { return !solid_ && i == sides_.size(); }
  template <class Ask>
  auto filter(std::size_t i, const Ask& ask) const;
  template <class Ask>
  auto with_gap(std::size_t i, const Ask& ask) const;

  const RoundedPolytope* pair_;
  bool solid_;  ///< the difference itself
  certificates::DifferencePart part_{};
  std::vector<Side> sides_;
  QuickDistance<Degree> distance_;
  TimeWindow window_;
};

// ---------------------------------------------------------------------------------------------------------------------

/// Calls visit(part, sides) until it returns false.
template <int Degree>
template <class Visit>
void RoundedPolytope<Degree>::every_part(const Visit& visit) const {
  using certificates::DifferenceEdge;
  using certificates::DifferencePart;
  using certificates::DifferenceSide;
  const HullStructure& of_a = core_a_.structure();
  const HullStructure& of_b = core_b_.structure();
  std::vector<DifferenceSide> sides;
  const auto segment = [&](std::uint32_t i0, std::uint32_t j0, std::uint32_t i1, std::uint32_t j1,
                           const DifferenceEdge& edge) {
    const DifferenceEdge back{edge.of_b, edge.to, edge.from};
    sides = {{{i0, j0}, back, false, {}}, {{i1, j1}, edge, false, {}}};
    return visit(DifferencePart{1, {i0, j0}, {edge, edge}}, sides);
  };
  for (const std::uint32_t j : of_b.corners) {
    for (const std::vector<std::uint32_t>& face : of_a.faces) {
      const auto [p, q, r] = spanning_corners(face);
      const std::array<DifferenceEdge, 2> normal{{{false, p, q}, {false, p, r}}};
      sides.clear();
      for (std::size_t k = 0; k < face.size(); ++k) {
        const std::uint32_t from = face[k], to = face[(k + 1) % face.size()];
        sides.push_back({{from, j}, {false, from, to}, true, normal});
      }
      if (!visit(DifferencePart{2, {p, j}, normal}, sides)) return;
    }
    for (const HullEdge& edge : of_a.edges) {
      const auto [from, to] = edge.ends;
      if (!segment(from, j, to, j, {false, from, to})) return;
    }
    for (const std::uint32_t i : of_a.corners) {
      sides.clear();
      if (!visit(DifferencePart{0, {i, j}, {}}, sides)) return;
    }
  }
  for (const HullEdge& edge_b : of_b.edges) {
    const auto [j, l] = edge_b.ends;
    const DifferenceEdge v{true, j, l}, v_back{true, l, j};
    for (const std::uint32_t i : of_a.corners) {
      if (!segment(i, j, i, l, v)) return;
    }
    for (const HullEdge& edge_a : of_a.edges) {
      const auto [i, k] = edge_a.ends;
      const DifferenceEdge u{false, i, k}, u_back{false, k, i};
      const std::array<DifferenceEdge, 2> normal{u, v};
      sides = {{{i, j}, u, true, normal},
               {{k, j}, v, true, normal},
               {{i, l}, u_back, true, normal},
               {{i, j}, v_back, true, normal}};
      if (!visit(DifferencePart{2, {i, j}, normal}, sides)) return;
    }
  }
}

template <int Degree>
template <class Visit>
void RoundedPolytope<Degree>::every_piece(const Visit& visit) const {
  if (apart_) return;
  const auto pass = [&](const Piece& piece) { return !piece.possible() || visit(piece); };
  if (!pass(Piece(*this)) || !(radius_ > 0)) return;
  every_part(
      [&](const certificates::DifferencePart& part, const auto& sides) { return pass(Piece(*this, part, sides)); });
}

template <int Degree>
template <class Visit>
void RoundedPolytope<Degree>::earliest_pieces(double horizon, const Visit& visit) const {
  std::vector<Piece> pieces;
  every_piece([&](const Piece& piece) {
    pieces.push_back(piece);
    return true;
  });
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& x, const Piece& y) { return x.window_.begin < y.window_.begin; });
  double until = horizon;
  for (Piece& piece : pieces) {
    if (piece.earliest() > until) return;
    if (piece.cut(until)) until = std::min(until, visit(std::as_const(piece)));
  }
}

#define KDS_DECLARE(degree) extern template class RoundedPolytope<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
