// Which motions the engine is compiled for.
//
// A world and its parts are templates of how bodies move (body_motion.hpp), compiled once for each of these; what is
// about paths alone is a template of their degree (degrees.hpp).
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/degrees.hpp"

/// KDS_FOR_EACH_MOTION(instantiate), in a .cpp: instantiate(motion) for the motions of the library that is compiled.
#ifdef KDS_SPLINE_DEGREES
#define KDS_FOR_EACH_MOTION(instantiate)                                              \
  instantiate(certificates::PointMotion<3>) instantiate(certificates::PointMotion<4>) \
      instantiate(certificates::PointMotion<5>)
#else
#define KDS_FOR_EACH_MOTION(instantiate) \
  instantiate(certificates::PointMotion<1>) instantiate(certificates::PointMotion<2>)
#endif

/// The same for all that a program is linked with, in a header: for `extern template`.
#ifdef KDS_SPLINES
#define KDS_FOR_ALL_MOTIONS(declare)                                                                                \
  declare(certificates::PointMotion<1>) declare(certificates::PointMotion<2>) declare(certificates::PointMotion<3>) \
      declare(certificates::PointMotion<4>) declare(certificates::PointMotion<5>)
#else
#define KDS_FOR_ALL_MOTIONS(declare) declare(certificates::PointMotion<1>) declare(certificates::PointMotion<2>)
#endif
