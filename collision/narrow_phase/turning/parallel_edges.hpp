// Edges of two polytopes that turn: which are known to be parallel at all times.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/turned_vector.hpp"
#include "collision/narrow_phase/turning/seen_polytope.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/arithmetic/plain_number.hpp"
#include "kds/turning/turning_sum.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace kds::collision::parallel_edges {

using Edge = std::array<Eigen::Vector3d, 2>;

/// Of unit vectors that are known to 2^-50.
inline bool maybe_parallel(const Eigen::Vector3d& u, const Eigen::Vector3d& v) { return norm(cross(u, v)) <= 0x1p-46; }

/// In the coordinates of their bodies; exact.
inline bool are_parallel(const TurningPolytope& a, std::size_t of_a, const TurningPolytope& b, std::size_t of_b) {
  if (!maybe_parallel(a.edges()[of_a], b.edges()[of_b])) return false;
  const Edge u = a.edge(of_a), v = b.edge(of_b);
  const auto n = certificates::cross(certificates::difference_of<Exact>(u[0], u[1]),
                                     certificates::difference_of<Exact>(v[0], v[1]));
  return std::all_of(n.begin(), n.end(), [](const Exact& x) { return x.sign() == 0; });
}

// Axes and edges along an axis of coordinates have components that are zero, which doubles tell exactly, whatever bits
// the corners have. Others are rounded, and so are hardly ever parallel: of these nothing is known below.

/// The direction of an edge as its body begins to turn, of any length.
template <int Degree>
certificates::VectorOf<PlainNumber> direction_at_start(const certificates::RigidMotion<Degree>& motion,
                                                       const Edge& edge) {
  return certificates::Turner<PlainNumber>(motion).at_start(certificates::difference_of<PlainNumber>(edge[0], edge[1]));
}

template <int Degree>
bool known_parallel_at_start(const certificates::RigidMotion<Degree>& a, const Edge& edge_a,
                             const certificates::RigidMotion<Degree>& b, const Edge& edge_b) {
  return kds::detail::is_known_zero(certificates::cross(direction_at_start(a, edge_a), direction_at_start(b, edge_b)));
}

/// By edges, their directions in the axes of the world if they are known to keep them for all time, since the body does
/// not turn, or turns about them; zero for the others.
template <int Degree>
std::vector<Eigen::Vector3d> steady_directions(const certificates::RigidMotion<Degree>& motion,
                                               const TurningPolytope& polytope) {
  const Eigen::Quaterniond turned = motion.orientation.normalized();
  const Eigen::Vector3d axis = motion.angular_velocity.normalized();
  const auto spin = certificates::vector_of<PlainNumber>(motion.angular_velocity);
  std::vector<Eigen::Vector3d> steady;
  for (std::size_t e = 0; e < polytope.edges().size(); ++e) {
    const Eigen::Vector3d along = turned * polytope.edges()[e];
    const bool keeps = motion.spin().still() ||
                       (maybe_parallel(along, axis) && kds::detail::is_known_zero(certificates::cross(
                                                           spin, direction_at_start(motion, polytope.edge(e)))));
    steady.push_back(keeps ? along : Eigen::Vector3d(Eigen::Vector3d::Zero()));
  }
  return steady;
}

}  // namespace kds::collision::parallel_edges
