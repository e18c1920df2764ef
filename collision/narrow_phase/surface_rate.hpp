// How the surface of a mesh that bends moves where it is touched.
#pragma once

#include "collision/motions.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"

#include <Eigen/Core>

namespace kds::collision {

/// How the surface of a body moves where it touches, from a time on, beyond the motion of the body.
struct SurfaceRate {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();     ///< units of length a second
  Eigen::Vector3d normal_rate = Eigen::Vector3d::Zero();  ///< of the normal of the contact, 1/s, as it turns along
};

/// That of a mesh that bends, by the velocities of the vertices of the feature; of shapes that do not bend it is zero.
/// `is_a`: whether the body is the first of the contact. The body itself does not turn.
template <class Motion>
SurfaceRate surface_rate(const MovingShape<Motion>& body, const Contact& contact, bool is_a);

#define KDS_DECLARE(motion) extern template SurfaceRate surface_rate(const MovingShape<motion>&, const Contact&, bool);
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
