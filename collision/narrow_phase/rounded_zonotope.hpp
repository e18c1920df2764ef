// When two convex shapes penetrate that are zonotopes grown by a radius.
#pragma once

#include "certificates/zonotope_separation.hpp"
#include "collision/degrees.hpp"
#include "collision/narrow_phase/gap_conditions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/quick_distance.hpp"
#include "collision/narrow_phase/quick_motion.hpp"
#include "collision/narrow_phase/zonotope_cells.hpp"
#include "collision/shapes/rounded_core.hpp"

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace kds::collision {

/// Two shapes, balls, capsules or a capsule and a box, from `now` to the horizon.
///
/// The two keep their orientations (those that turn: turning/), so their difference is a solid that does not change:
/// the sum of the segments of both, a zonotope, grown by the sum of the radii. They penetrate while the place of b
/// relative to a, a point on a line or a parabola, is inside. That is a union of convex *pieces*: for each cell of the
/// zonotope's surface (vertex, segment, parallelogram) the places that are between its sides and nearer than the radius
/// to the point, line or plane that it spans; and the zonotope itself, where it is solid. If the radius is zero only
/// the last is left: boxes have their own tests (box_and_box.hpp), and so have a box and a ball (box_and_ball.hpp), for
/// which the pieces are fewer and simpler since the axes of the box are orthogonal.
///
/// The shapes are those that the columns of their rotations describe, taken as exact, and so are all signs: there is no
/// margin, and no bound on how nearly parallel two capsules are. Parallel capsules, a capsule along a face or an edge
/// of a box, and one that meets exactly the side between two pieces are no special cases, see ZonotopeCells.
///
/// A filter in doubles leaves few pieces, and decides most of them: its directions across faces are known to some
/// roundings, or not used (`unknown_normal`).
/// Paper: [Ericson05] section 5.5.7 for the moving point.
/// Differs: zonotopes in the place of boxes.
/// Cost: 0.2 us (a capsule and a ball), 0.5 us (two capsules) or 2 us (a capsule and a box) typically to find a time
/// until which they do not meet; 1, 2.5 and 10 us for the first contact.
template <int Degree>
class RoundedZonotope {
 public:
  using Body = TranslatingShape<Degree>;
  using Quick = QuickMotion<Degree>;
  using Cell = certificates::ZonotopeCell;

  class Piece;

  RoundedZonotope(const Body& a, const Body& b, double now, double horizon);
  RoundedZonotope(const RoundedZonotope&) = delete;  // refers to itself
  RoundedZonotope& operator=(const RoundedZonotope&) = delete;

  /// A time before which directions across the shapes show that they do not penetrate; `never` if they never do.
  double apart_until() const { return apart_ ? never : motion_.time_before(hull_.begin); }

  /// Calls visit(piece) for the pieces in which b's place may be between `now` and the horizon, in no particular order,
  /// until it returns false.
  template <class Visit>
  void every_piece(const Visit& visit) const;

  /// The same, the earliest first as far as is known, and only those in which it may be by a time: at first the
  /// horizon, then the time that visit(piece) returns.
  template <class Visit>
  void earliest_pieces(double horizon, const Visit& visit) const;

 private:
  RoundedZonotope(const Body& a, const Body& b, const RoundedCore& core_a, const RoundedCore& core_b, double now,
                  double horizon);

  using Along = typename Quick::Along;
  static constexpr std::size_t most_generators = certificates::most_generators;
  static constexpr std::size_t most_faces = most_generators * (most_generators - 1) / 2;
  /// 24 parallelograms, 32 segments and 16 vertices of four generators, if doubles decide of none that it is inside,
  /// and the zonotope.
  static constexpr std::size_t most_pieces = 73;

  /// Two generators that are not parallel, and the direction across them.
  struct Face {
    std::array<std::uint8_t, 2> spanned;
    Eigen::Vector3d normal;  ///< unit, up to some roundings
    bool known;              ///< whether `normal` is accurate to some roundings
    Along along;
    double half_width;  ///< of the zonotope
  };

  TimeWindow after_end() const { return {motion_.end(), motion_.end()}; }
  const Face& face(const Cell& cell) const;
  bool solid() const { return faces_.size() >= 3; }

  const Body& a_;
  const Body& b_;
  RoundedCore core_;  ///< of the difference; its radius is rounded
  std::array<double, 2> radii_;
  ZonotopeCells cells_;
  Quick motion_;
  std::array<Along, 3> coordinates_;
  boost::container::static_vector<Along, most_generators> along_;  ///< of the generators' directions
  boost::container::static_vector<Face, most_faces> faces_;
  TimeWindow hull_;  ///< in which b's place may be near at all
  bool apart_ = false;
};

/// One convex piece. All functions are exact.
template <int Degree>
class RoundedZonotope<Degree>::Piece {
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

  // ---- For gap_conditions.hpp: gaps 2 k and 2 k + 1 are the two ends of a generator that sweeps the cell, or the
  // sides of the zonotope beyond face k; the last one of a cell is the distance from the point, line or plane that it
  // spans.

  std::size_t size() const { return 2 * sides_.size() + (solid_ ? 0 : 1); }
  bool surely_closed(std::size_t i, double t) const;
  double closed_until(std::size_t i, double t) const;
  double opened_by(std::size_t i) const;
  double failure_time(std::size_t i, double t, double horizon) const;
  double recovery_time(std::size_t i, double t, double horizon) const;
  bool closed(std::size_t i, double t) const;

 private:
  friend RoundedZonotope;

  /// Two opposite gaps along an axis, as the filter sees them.
  struct Side {
    Along along;
    double half_width;
    bool known;
  };

  Piece(const RoundedZonotope& pair, const Cell& cell);
  explicit Piece(const RoundedZonotope& pair);  ///< the zonotope itself

  void add_cell();
  bool possible() const { return window_.begin <= window_.end; }
  /// Looks at the distance; false if b's place is not in the piece by a time.
  bool cut(double until) { return solid_ || distance_.size() < 2 || distance_.cut_until(window_, until); }
  bool is_distance(std::size_t i) const { return i == 2 * sides_.size(); }
  static double side(std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; }

  template <class Ask>
  auto with_gap(std::size_t i, const Ask& ask) const;

  const RoundedZonotope* pair_;
  Cell cell_;
  bool solid_;  ///< the zonotope itself
  boost::container::static_vector<Side, most_faces> sides_;
  QuickDistance<Degree> distance_;
  TimeWindow window_;
};

// ---------------------------------------------------------------------------------------------------------------

template <int Degree>
template <class Visit>
void RoundedZonotope<Degree>::every_piece(const Visit& visit) const {
  if (apart_) return;
  const auto pass = [&](const Piece& piece) { return !piece.possible() || visit(piece); };
  if (solid() && !pass(Piece(*this))) return;
  cells_.every_cell([&](const Cell& cell) { return pass(Piece(*this, cell)); });
}

template <int Degree>
template <class Visit>
void RoundedZonotope<Degree>::earliest_pieces(double horizon, const Visit& visit) const {
  boost::container::static_vector<Piece, most_pieces> pieces;
  every_piece([&](const Piece& piece) {
    pieces.push_back(piece);
    return true;
  });
  boost::container::static_vector<Piece*, most_pieces> sorted;
  for (Piece& piece : pieces) sorted.push_back(&piece);
  std::sort(sorted.begin(), sorted.end(), [](const Piece* x, const Piece* y) {
    return std::pair(x->window_.begin, x) < std::pair(y->window_.begin, y);
  });
  double until = horizon;
  for (Piece* const piece : sorted) {
    if (piece->earliest() > until) return;
    if (piece->cut(until)) until = std::min(until, visit(std::as_const(*piece)));
  }
}

#define KDS_DECLARE(degree) extern template class RoundedZonotope<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
