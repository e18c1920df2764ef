// When a vertex meets a face, or an edge an edge, whose points each move on their own.
#pragma once

#include "certificates/point_motion.hpp"

#include <array>
#include <cstdint>
#include <limits>

namespace kds::certificates {

/// What is known of the contact of two features between two times.
enum class FeatureContactStatus : std::uint8_t {
  none,       ///< certified: the features do not touch in [t0, t1]
  contact,    ///< certified: they touch, for the first time in [time, latest]
  at_start,   ///< at t0 they are no farther apart than the tolerance
  undecided,  ///< at `time` they are no farther apart than the tolerance, and have not touched before
};

/// How near two features count as touching.
///
/// The distance is min(absolute, relative * size), but at least 2^-38 size (4e-12), which leaves the margins of
/// rounding far behind (some 2^-1069 where there are no normal numbers of that size); size is the greatest coordinate,
/// in absolute value, of a difference between a point of one feature and one of the other at t0, plus what that
/// coordinate changes until t1. It scales with the query, and does not know where in the world it is. Larger is faster
/// by little; smaller reports fewer near misses.
///
/// Precondition: neither number is a NaN. What is negative, or less than the least, counts as the least.
struct ContactTolerance {
  double relative = 1e-6;  ///< of the size, as in most published comparisons of such tests
  double absolute = std::numeric_limits<double>::infinity();  ///< in units of length
  /// In units of length, >= 0. Features touch where they are this near: that of a ball is the radius of the ball around
  /// a vertex, of a capsule that around an edge, of cloth its own. Twice as slow as 0, and contacts are `undecided`.
  double thickness = 0;
};

/// The answer to a query. Features touch where their distance is the thickness or less.
///
/// Laws. (1) Nothing is missed: if the features touch at any time in [t0, t1], ends included, the status is not `none`.
/// (2) Never late: the first touch is not before `time`. (3) No false alarm beyond the tolerance: at `time` the
/// distance of the features is at most `distance`, and that at most the thickness and the tolerance (and what they move
/// while the clock goes on by a few ulps: at t = 1e9 s it cannot tell times 1e-7 s apart). With tolerances below 1e-8
/// size a rare degenerate query runs out of steps before that, and `distance` says so. (4) Where the status is
/// `contact` they do touch, not after `latest`. All of this is about the exact motion of the exact points given:
/// roundings are included.
struct FeatureContact {
  FeatureContactStatus status = FeatureContactStatus::none;
  double time = std::numeric_limits<double>::infinity();    ///< s; infinity if none
  double latest = std::numeric_limits<double>::infinity();  ///< s; infinity unless the status is `contact`
  double distance = 0;                                      ///< units of length; an upper bound, at `time`
  double tolerance = 0;  ///< units of length; the one that was used, beyond the thickness
  /// Where: weights of the four points in the order of the arguments. A vertex has weight 1 and the points of its face
  /// sum to 1; the two points of each edge sum to 1.
  std::array<double, 4> weights{};
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit; from face to vertex, from second edge to first
  int steps = 0;                                     ///< how many times the axis was changed

  explicit operator bool() const { return status != FeatureContactStatus::none; }
};

/// First contact of a vertex with the face a, b, c in [t0, t1]; of the edge from a to b with that from c to d.
///
/// Method: the kinetic separating axis. Take the direction between the closest points; as a certificate ("all corners
/// of the one lie beyond all corners of the other along it") it fails at a closed-form root; jump there, take the new
/// direction, until the features are within the tolerance or nothing fails any more. Axes that turn with the features
/// (their plane at once, edges after a few steps) keep the steps few. Derivations, margins and figures:
/// docs/features.md. Faces without area and edges without length are segments and points, and are welcome.
///
/// Cost: for linear paths 0.06 - 0.1 us without a contact, 0.25 us with one, 1.7 us at worst seen; a third more for
/// quadratic ones. Paths that do not start at t0 cost 0.2 - 0.5 us more (they are moved there in double-double).
/// Precondition: t0 <= t1. Throws std::invalid_argument if a time or a coordinate is not finite, or a size is 2^1000 or
/// more.
template <int Degree>
FeatureContact vertex_face_contact(const PointMotion<Degree>& vertex, const PointMotion<Degree>& a,
                                   const PointMotion<Degree>& b, const PointMotion<Degree>& c, double t0, double t1,
                                   const ContactTolerance& tolerance = {});
template <int Degree>
FeatureContact edge_edge_contact(const PointMotion<Degree>& a, const PointMotion<Degree>& b,
                                 const PointMotion<Degree>& c, const PointMotion<Degree>& d, double t0, double t1,
                                 const ContactTolerance& tolerance = {});

/// The control points of four paths, by degree, over a stretch of time: path k is the sum of control[i][k] times the
/// Bernstein polynomial i of s = (t - t0) / (t1 - t0). For straight paths control[0] is where the points begin, and
/// control[1] where they end.
template <int Degree>
using ControlPoints = std::array<std::array<Eigen::Vector3d, 4>, std::size_t{Degree} + 1>;

/// The same of paths by control points, which are exact: stretches that follow on each other meet exactly. The first
/// contact in [from, t1]; precondition: t0 <= from <= t1.
template <int Degree>
FeatureContact vertex_face_contact(const ControlPoints<Degree>& control, double t0, double t1, double from,
                                   const ContactTolerance& tolerance = {});
template <int Degree>
FeatureContact edge_edge_contact(const ControlPoints<Degree>& control, double t0, double t1, double from,
                                 const ContactTolerance& tolerance = {});

/// Four points on straight paths, from begin[k] at time 0 to end[k] at time 1, both exact: the form of the published
/// benchmarks and of simulators with deforming meshes. Vertex, then face; or edge, then edge. Throws as the others do.
FeatureContact vertex_face_contact(const std::array<Eigen::Vector3d, 4>& begin,
                                   const std::array<Eigen::Vector3d, 4>& end, const ContactTolerance& tolerance = {});
FeatureContact edge_edge_contact(const std::array<Eigen::Vector3d, 4>& begin, const std::array<Eigen::Vector3d, 4>& end,
                                 const ContactTolerance& tolerance = {});

#define KDS_DECLARE(name, degree)                                                                             \
  extern template FeatureContact name(const PointMotion<degree>&, const PointMotion<degree>&,                 \
                                      const PointMotion<degree>&, const PointMotion<degree>&, double, double, \
                                      const ContactTolerance&);                                               \
  extern template FeatureContact name<degree>(const ControlPoints<degree>&, double, double, double,           \
                                              const ContactTolerance&);
KDS_DECLARE(vertex_face_contact, 1)
KDS_DECLARE(vertex_face_contact, 2)
KDS_DECLARE(edge_edge_contact, 1)
KDS_DECLARE(edge_edge_contact, 2)
#undef KDS_DECLARE

}  // namespace kds::certificates
