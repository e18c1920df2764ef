// Rays and shapes that are cast through a world as it stands now, and what overlaps a shape.
#pragma once

#include "collision/motions.hpp"
#include "collision/queries/hit.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/world.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace kds::collision {

// All look at the bodies where they are at now(): as if all stood still, positions rounded to doubles, orientations of
// bodies that turn too. Masks play no part, nor do walls; bodies that enter later are not there. The world is not
// changed. What is cast meets a ball, a box, a capsule or a hull at the first double, of the part of its way, just
// after which it penetrates it, and a mesh early by at most the margin of its contacts (narrow_phase.hpp); and it meets
// at 0 what it overlaps there. Meshes are surfaces, all others solid. Bodies that are only touched are not met.
//
// They throw std::invalid_argument where coordinates are not finite or out of the range of shape.hpp, for shapes that
// were not made by place(), and what World::visit_overlapping throws. Several threads may ask at once while none does
// anything else.

/// A way from one point to another, straight.
struct Ray {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
};

/// The first body that the ray meets, or nothing. contact.time is the part of the way to it, from 0 to 1.
///
/// Cost: the way is followed in cbrt(n) pieces, n being the number of bodies, until one is met; the boxes of each are
/// asked for, and each body whose box is met is tested (figures in docs/queries.md).
template <class Motion>
std::optional<Hit> cast(const BasicWorld<Motion>& world, const Ray& ray, const BodyFilter& filter = {});

/// The same of a shape in its orientation (place()) whose centre goes the way. Not of a mesh that bends, nor of a
/// half-space.
template <class Motion>
std::optional<Hit> cast(const BasicWorld<Motion>& world, const PlacedShape& shape, const Ray& way,
                        const BodyFilter& filter = {});

/// All bodies that are met on the whole way, each once, by time.
template <class Motion>
std::vector<Hit> cast_all(const BasicWorld<Motion>& world, const Ray& ray, const BodyFilter& filter = {});
template <class Motion>
std::vector<Hit> cast_all(const BasicWorld<Motion>& world, const PlacedShape& shape, const Ray& way,
                          const BodyFilter& filter = {});

/// The bodies that a shape penetrates whose centre is at a point, in the order in which they were added. Not of a mesh
/// that bends, nor of a half-space: what these penetrate, next_contacts() (future.hpp) tells, until now().
template <class Motion>
std::vector<BodyId> overlapping(const BasicWorld<Motion>& world, const PlacedShape& shape, const Eigen::Vector3d& at,
                                const BodyFilter& filter = {});

}  // namespace kds::collision
