// Tensors of inertia: which ones a body can have, their inverses and rotations.
//
// A tensor of inertia is a symmetric matrix, mass * length^2, about the centre of mass. Its moments are the
// eigenvalues: for a solid body positive, and none greater than the sum of the two others.
#pragma once

#include <Eigen/Core>

namespace kds::collision {

/// Two tensors that are meant to be equal may differ by this part of the greatest entry: 2^-47. The vertices of a mesh
/// may have been turned by a matrix that is off a rotation by 16 x 2^-52 (rotation_margin in shapes/shape_kind.hpp),
/// which changes squares of lengths by twice that. The other roundings (mass_properties.hpp) are smaller. With a
/// greater number bodies that visibly precess would count as spherical; with a smaller one turned cubes would not.
inline constexpr double inertia_tolerance = 0x1p-47;

/// Whether the three moments are equal, up to inertia_tolerance: diagonal entries differ, and others are off zero, by
/// no more than that part of the greatest entry. Such a body does not precess: when it is free, its angular velocity
/// does not change. Treating a body that is off by the tolerance in this way neglects a change of direction of the
/// angular velocity of at most 2^-46 rad for each radian turned.
bool is_spherical(const Eigen::Matrix3d& inertia);

/// Checks a tensor, and returns it made symmetric to the last bit (the mean of opposite entries). Throws
/// std::invalid_argument, with one line that says what is wrong, if it is not finite, not symmetric up to
/// inertia_tolerance, not positive definite, if its greatest moment exceeds the sum of the two others by more than 4 x
/// inertia_tolerance of all three, or if its greatest entry is not from 2^-617 to 2^617 (a mass times the square of a
/// length at the ends of their range, and a quarter or four times that).
Eigen::Matrix3d checked_inertia(const Eigen::Matrix3d& inertia);

/// The inverse of a tensor that checked_inertia() accepts, symmetric to the last bit. Each entry is rounded once, as
/// long as the greatest moment is at most 2^40 times the least; beyond, it is within 2^-92 times their quotient of the
/// greatest entry.
Eigen::Matrix3d inverse_inertia(const Eigen::Matrix3d& inertia);

/// R T R^T, symmetric to the last bit: a tensor, or the inverse of one, of a body that was turned by R. Each entry is
/// within 16 x 2^-53 times the sum of the magnitudes of all entries of T, R being orthogonal up to roundings.
Eigen::Matrix3d turned_tensor(const Eigen::Matrix3d& tensor, const Eigen::Matrix3d& rotation);

namespace detail {

/// Whether a symmetric matrix is positive definite, by the signs of its leading minors: up to an eigenvalue of 2^-96 of
/// the greatest entry.
bool positive_definite(const Eigen::Matrix3d& m);

}  // namespace detail

}  // namespace kds::collision
