// A moving capsule and a triangle.
#pragma once

#include "collision/degrees.hpp"
#include "collision/narrow_phase/convex_touch.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/round_touch.hpp"
#include "collision/narrow_phase/segment_ways.hpp"
#include "collision/narrow_phase/separating_axes.hpp"
#include "collision/narrow_phase/time_spans.hpp"
#include "collision/narrow_phase/touch_pieces.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>

namespace kds::collision {

/// When a capsule touches a triangle: their distance is below radius + contact gap. The two keep their orientations
/// (those that turn: turning/), so this is equivalent to the centre of the capsule being that near to a prism, the sum
/// of the triangle and the capsule's segment. The set of such places is the union of 21 convex pieces: slabs over two
/// triangles and three parallelograms, cylinders about nine edges, balls about six corners, and the inside of the
/// prism, where the segment goes through the triangle. Same members as BallTouch, whose comments apply here too.
///
/// Margins. The sides of a slab lie a gap farther out each, and so do those across its corners (each corner of a
/// parallelogram, the sharp ones of a triangle): seen along a slab, no place in it is more than sqrt(2) gaps from the
/// parallelogram, 8.1 from the triangle; see BallTouch. The inside of the prism, half a radius within its faces, has no
/// margin: places nearer to a face are in another piece. It is left out if the prism is no thicker than that.
///
/// An edge e and the segment s may be parallel, or nearly so. The slab of the two stands in a frame of the longer one
/// of them, L: a direction across both, from their product, made orthogonal to L; and one across that and L. The
/// product is known to 2^-53 of itself (accurate_cross), but e itself to a rounding of the corners alone, which tilts
/// the frame about L by 3 x 2^-53 of the size of the triangle over the width of the parallelogram: so no corner of it
/// is out of the plane by more than 3 roundings, and places over its rim that the tilt excludes are nearer to an edge
/// than that plus the radius. ContactGap has 8 roundings for axes that are not quite across their edges. Where the
/// product vanishes the parallelogram is an edge, and any direction across does.
template <int Degree>
class CapsuleTouch {
 public:
  using Path = std::array<Eigen::Vector3d, std::size_t{Degree} + 1>;  ///< polynomial of tau

  /// As that of BallTouch.
  CapsuleTouch(const PlacedTriangle& triangle, const PlacedCapsule& capsule, const RelativeMotion<Degree>& motion,
               const ContactGap<Degree>& gap, bool sharp, double horizon, const TimeWindow& interest);

  double first_inside(double tau) const { return pieces_.first_inside(tau); }
  double enter(double tau) const { return pieces_.enter(tau); }
  double leave(double tau) const { return pieces_.leave(tau); }
  bool approaching(double tau) const { return direction(tau).approaching; }
  TouchDirection direction(double tau) const;
  double turning(double tau, double end) const;

 private:
  using Corners = std::span<const Eigen::Vector3d>;

  /// A parallelogram's slab has both sides of five directions, a ball about a corner one condition, and one for each
  /// edge that ends there.
  static constexpr std::size_t most_conditions = 16;
  using Pieces = TouchPieces<Degree, 21, most_conditions>;
  using Piece = typename Pieces::Piece;

  Eigen::Vector3d corner(std::size_t i, double end) const { return triangle_.vertices[i] + end * half_; }

  void add_inside();
  void add_triangle(double end, bool sharp);
  void add_parallelogram(std::size_t edge);
  void add_line(const Eigen::Vector3d& begin, const Eigen::Vector3d& to, Corners beside, double end);
  void add_point(const Eigen::Vector3d& at, Corners around, double end);
  void add(const Piece& piece);
  SpansOf<Degree> below(const Eigen::Vector3d& normal, double distance, bool with_gap = true) const;
  void bound(Piece& piece, const Eigen::Vector3d& out, Corners corners, double more = 0) const;
  bool matters(const Path& path) const;
  SpansOf<Degree> within(const Path& path) const;
  Path from(const Eigen::Vector3d& at) const;
  NearestPart part_of(const SegmentWay& way) const;
  NearestPart nearest_part(const Eigen::Vector3d& place, double gap) const;
  auto approach_to(const PolyhedronPart& part) const requires(Degree <= 2) {
    return PartApproach<Degree>(part, motion_, radius_, gap_, part.dimension == 2 ? tilt_of(triangle_) : 0.0);
  }

  PlacedTriangle triangle_;
  Eigen::Vector3d half_;
  double radius_;
  RelativeMotion<Degree> motion_;
  ContactGap<Degree> gap_;
  double horizon_;
  TimeWindow interest_;
  Pieces pieces_;
};

#define KDS_DECLARE(degree) extern template class CapsuleTouch<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
