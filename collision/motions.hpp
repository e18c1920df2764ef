// The types of motion that the library is compiled for.
//
// A world and its parts are templates of the type of motion (body_motion.hpp), compiled once for each of these; code
// that needs only paths is a template of their degree (degrees.hpp). Those for bodies that turn are in a separate
// library, kds::collision_turning, from the same files: a program that does not link it has no cost from them.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/degrees.hpp"
#ifdef KDS_TURNING
#include "certificates/turning/rigid_motion.hpp"
#endif

// KDS_FOR_EACH_MOTION(instantiate), in a .cpp: instantiate(motion) for the motions of the library that is compiled.
// KDS_FOR_EACH_PATH(instantiate): the same for those of bodies that keep their orientation.
#ifdef KDS_SPLINE_DEGREES
#define KDS_FOR_EACH_PATH(instantiate)                                                \
  instantiate(certificates::PointMotion<3>) instantiate(certificates::PointMotion<4>) \
      instantiate(certificates::PointMotion<5>)
#else
#define KDS_FOR_EACH_PATH(instantiate) \
  instantiate(certificates::PointMotion<1>) instantiate(certificates::PointMotion<2>)
#endif

#ifdef KDS_TURNING_MOTIONS
#define KDS_FOR_EACH_MOTION(instantiate) \
  instantiate(certificates::RigidMotion<1>) instantiate(certificates::RigidMotion<2>)
#else
#define KDS_FOR_EACH_MOTION(instantiate) KDS_FOR_EACH_PATH(instantiate)
#endif

// KDS_FOR_EACH_QUADRATIC(instantiate): the same for those whose paths are of degree 2 at most: worlds of these can
// hold meshes that bend.
#if defined(KDS_SPLINE_DEGREES)
#define KDS_FOR_EACH_QUADRATIC(instantiate)
#else
#define KDS_FOR_EACH_QUADRATIC(instantiate) KDS_FOR_EACH_MOTION(instantiate)
#endif

// The same for all that a program is linked with, in a header: for `extern template`. (KDS_TURNING is defined for all
// that link kds::collision_turning.)
#ifdef KDS_SPLINES
#define KDS_FOR_ALL_PATHS(declare)                                                                                  \
  declare(certificates::PointMotion<1>) declare(certificates::PointMotion<2>) declare(certificates::PointMotion<3>) \
      declare(certificates::PointMotion<4>) declare(certificates::PointMotion<5>)
#else
#define KDS_FOR_ALL_PATHS(declare) declare(certificates::PointMotion<1>) declare(certificates::PointMotion<2>)
#endif

#ifdef KDS_TURNING
#define KDS_FOR_ALL_MOTIONS(declare) \
  KDS_FOR_ALL_PATHS(declare) declare(certificates::RigidMotion<1>) declare(certificates::RigidMotion<2>)
#else
#define KDS_FOR_ALL_MOTIONS(declare) KDS_FOR_ALL_PATHS(declare)
#endif

namespace kds::collision {

/// Whether worlds of bodies with this type of motion are compiled in the libraries that a program is linked with. One
/// who compiles a world for a motion of their own specialises it.
template <class Motion>
inline constexpr bool has_compiled_world = false;
#define KDS_DECLARE(motion) \
  template <>               \
  inline constexpr bool has_compiled_world<motion> = true;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision

#ifdef KDS_TURNING
#define KDS_FOR_ALL_QUADRATIC(declare)                                                                              \
  declare(certificates::PointMotion<1>) declare(certificates::PointMotion<2>) declare(certificates::RigidMotion<1>) \
      declare(certificates::RigidMotion<2>)
#else
#define KDS_FOR_ALL_QUADRATIC(declare) declare(certificates::PointMotion<1>) declare(certificates::PointMotion<2>)
#endif
