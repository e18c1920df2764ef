// Eigen's quaternions, without all else that is in its geometry module.
//
// Eigen/Geometry includes four modules of decompositions. Whatever includes a world would compile these, in a sixth of
// the time that a small program takes, and no world uses them. Programs that use more of Eigen include it themselves.
#pragma once

#include <Eigen/Core>

// The parts of the module are not the same in other versions. All of those are included here on which the code of
// quaternions depends, the vector instructions too, in its order: so it is the same where Eigen/Geometry comes after.
#if !EIGEN_VERSION_AT_LEAST(3, 4, 50)
#include <Eigen/src/Core/util/DisableStupidWarnings.h>
// clang-format off
#include <Eigen/src/Geometry/OrthoMethods.h>
#include <Eigen/src/Geometry/EulerAngles.h>
#include <Eigen/src/Geometry/RotationBase.h>
#include <Eigen/src/Geometry/Quaternion.h>
#include <Eigen/src/Geometry/AngleAxis.h>
#if defined(EIGEN_VECTORIZE_SSE) || defined(EIGEN_VECTORIZE_NEON)
#include <Eigen/src/Geometry/arch/Geometry_SIMD.h>
#endif
// clang-format on
#include <Eigen/src/Core/util/ReenableStupidWarnings.h>
#else
#include <Eigen/Geometry>
#endif
