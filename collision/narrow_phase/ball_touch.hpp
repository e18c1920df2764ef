// A moving ball and a triangle.
#pragma once

#include "collision/degrees.hpp"
#include "collision/narrow_phase/convex_touch.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/near_spans.hpp"
#include "collision/narrow_phase/nearest_point.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/round_touch.hpp"
#include "collision/narrow_phase/separating_axes.hpp"
#include "collision/narrow_phase/time_spans.hpp"
#include "collision/narrow_phase/touch_pieces.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>

namespace kds::collision {

/// When a ball touches a triangle: their distance is below radius + contact gap. The set of such places of the ball's
/// centre is the union of seven convex pieces: a prism over the face, three cylinders about the edges, three balls
/// about the vertices. Each side of the prism lies a gap farther out, so that a corner of half the angle theta lies a
/// gap / sin(theta) farther out; where corners may be sharp, sides across them cut them off. So in no piece the ball is
/// more than 8.1 gaps away from the triangle. Same members as ConvexTouch; closed forms for linear motion, for
/// quadratic motion quartics whose sign changes are bracketed between those of their derivatives, beyond that exact
/// signs (curve_spans.hpp).
///
/// To decide a sign, squared distances are never expanded about tau = 0, but evaluated from the place of the centre at
/// tau, or exactly: so their error is that of the distance, which the contact gap covers, however small the ball.
template <int Degree>
class BallTouch {
 public:
  using Path = std::array<Eigen::Vector3d, std::size_t{Degree} + 1>;  ///< polynomial of tau

  /// Motion of the ball relative to the triangle's body. `horizon`: no contact after it; it must be a function of the
  /// bodies and motion alone, since the answers depend on it. Parts of the triangle that the ball is not near within
  /// the window of interest are left out: answers for times outside must not be used. `sharp`: whether the triangle may
  /// have a sharp corner (Mesh::sharp).
  BallTouch(const PlacedTriangle& triangle, const PlacedBall& ball, const RelativeMotion<Degree>& motion,
            const ContactGap<Degree>& gap, bool sharp, double horizon, const TimeWindow& interest);

  /// The same for first_inside(tau) and approaching() there alone. Most balls that meet a triangle meet its face, and
  /// edges and corners that they could only meet later are left out.
  static BallTouch until_met(const PlacedTriangle& triangle, const PlacedBall& ball,
                             const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap, bool sharp,
                             double horizon, const TimeWindow& interest, double tau);

  double first_inside(double tau) const { return pieces_.first_inside(tau); }
  double enter(double tau) const { return pieces_.enter(tau); }
  double leave(double tau) const { return pieces_.leave(tau); }
  bool approaching(double tau) const { return direction(tau).approaching; }
  TouchDirection direction(double tau) const;
  double turning(double tau, double end) const;

 private:
  BallTouch(const PlacedTriangle& triangle, const PlacedBall& ball, const RelativeMotion<Degree>& motion,
            const ContactGap<Degree>& gap, double horizon, const TimeWindow& interest);

  /// A slab has eight conditions at most, a ball about a vertex one, and one for each edge that ends there.
  static constexpr std::size_t most_conditions = 16;
  using Pieces = TouchPieces<Degree, 7, most_conditions>;
  using Piece = typename Pieces::Piece;

  void add_face(bool sharp);
  void add_rim();
  void add_edge(std::size_t i);
  void add_vertex(std::size_t i);
  SpansOf<Degree> below(const Eigen::Vector3d& normal, double distance) const;
  bool matters(const Path& path) const;
  SpansOf<Degree> within(const Path& path) const;
  PolyhedronPart part(int dimension, std::size_t i) const;
  NearestPart nearest_part(const Eigen::Vector3d& place, double gap) const;
  auto approach_to(const PolyhedronPart& part) const requires(Degree <= 2) {
    return PartApproach<Degree>(part, motion_, radius_, gap_, part.dimension == 2 ? tilt_of(triangle_) : 0.0);
  }
  Path from(std::size_t vertex) const;
  Path across_edge(std::size_t i) const;

  PlacedTriangle triangle_;
  double radius_;
  RelativeMotion<Degree> motion_;
  ContactGap<Degree> gap_;
  double horizon_;
  TimeWindow interest_;
  Pieces pieces_;
};

#define KDS_DECLARE(degree) extern template class BallTouch<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
