// What will meet what, as bodies move now: without changing the world.
#pragma once

#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/queries/approach.hpp"
#include "collision/queries/hit.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/world.hpp"

#include <optional>
#include <vector>

namespace kds::collision {

// All go by the motions of now(), as if nothing changed them before: no contact, no wall, and no later piece of a
// script. Masks play no part. Times are those of the world's own contacts, bit for bit. Each throws
// std::invalid_argument for an `until` that is not a finite time from now() on, and what World::visit_swept throws.
// Several threads may ask at once while none does anything else.

/// The first body, in [now(), until], that a shape meets which is in no world: a bullet before it is fired, or a place
/// that is to be kept free. Bodies that overlap it at now() are met at now(). The motion must have begun by now();
/// where bodies turn it has the orientation, and the shape is placed without one. Throws std::invalid_argument for a
/// shape that was not made by place(), and a motion out of range. Cost: as a ray's (casts.hpp) in one piece, with tests
/// that take as long as the pairs' of a world.
template <class Motion>
std::optional<Hit> next_contact(const BasicWorld<Motion>& world, const PlacedShape& shape, const Motion& motion,
                                double until, const BodyFilter& filter = {});

/// All bodies that it meets in [now(), until], each once, when they first meet, by time: of a place, who enters it
/// before then. Cost: a test for each body in the box around the whole way.
template <class Motion>
std::vector<Hit> next_contacts(const BasicWorld<Motion>& world, const PlacedShape& shape, const Motion& motion,
                               double until, const BodyFilter& filter = {});

/// The first body that a body of the world meets; none if it has not entered. Mode `resolved`: what it touches at now()
/// is met only if the two approach each other; `transparent`: what it overlaps is met at now().
template <class Motion>
std::optional<Hit> next_contact_of(const BasicWorld<Motion>& world, BodyId body, double until,
                                   const BodyFilter& filter = {}, ContactMode mode = ContactMode::resolved);

/// All bodies that a body of the world meets, each once, by time.
template <class Motion>
std::vector<Hit> next_contacts_of(const BasicWorld<Motion>& world, BodyId body, double until,
                                  const BodyFilter& filter = {}, ContactMode mode = ContactMode::resolved);

/// When and where two bodies of the world meet, if they do and both have entered; the normal points from a to b.
template <class Motion>
std::optional<Contact> next_contact_between(const BasicWorld<Motion>& world, BodyId a, BodyId b, double until,
                                            ContactMode mode = ContactMode::resolved);

/// When the centres of two bodies of the world are nearest in [now(), until]: approach.hpp, of their paths. Throws
/// std::invalid_argument where one of them has not entered.
template <class Motion>
Approach closest_approach(const BasicWorld<Motion>& world, BodyId a, BodyId b, double until);

}  // namespace kds::collision
