// How far apart two shapes are, and along which direction.
#pragma once

#include "collision/degrees.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"

#include <Eigen/Core>

namespace kds::collision {

/// The direction in which two shapes are farthest apart, and by how much.
struct SurfaceGap {
  double width;            ///< in units of length; negative where they overlap
  Eigen::Vector3d normal;  ///< unit, from a to b
};

/// The gap between a and b at t, in doubles: accurate to some roundings of the coordinates. Precondition: neither is a
/// mesh, a half-space or a compound.
template <int Degree>
SurfaceGap surface_gap(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t);

/// The gap of a and b along a unit vector from a to b: negative where their slabs overlap. Shapes with a gap > 0 along
/// any direction do not touch. Precondition: neither bends, and the normal is that of a half-space, if one is.
template <int Degree>
double gap_along(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, const Eigen::Vector3d& normal,
                 double t);

#define KDS_DECLARE(degree)                                                                                         \
  extern template SurfaceGap surface_gap(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double); \
  extern template double gap_along(const TranslatingShape<degree>&, const TranslatingShape<degree>&,                \
                                   const Eigen::Vector3d&, double);
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
