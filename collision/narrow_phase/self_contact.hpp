// Contacts of a mesh that bends with itself.
#pragma once

#include "collision/narrow_phase/contact.hpp"
#include "collision/shapes/mesh_script.hpp"

namespace kds::collision {

/// A mesh touches itself while two of its features without a common vertex are no farther apart than the part
/// `bending_tolerance` of its radius, up to twice that once they have touched; the laws are those of BendingContact.
/// Times are functions of the script alone: how the body moves makes no difference.
///
/// Cost: O(n) and more for each piece between keyframes that is looked at, since all neighbours are.

/// The first time t in [t0, horizon] at which it comes into contact with itself, t0 if it is, or `never`.
double first_self_contact(const MeshScript& script, double t0, double horizon);
/// Whether it touches itself from t on.
bool in_self_contact(const MeshScript& script, double t);
/// The first time t in [t0, horizon] from which on it does not, or `never`.
double first_self_separation(const MeshScript& script, double t0, double horizon);
/// Where it touches itself at t, in the coordinates of the body: the features that approach each other first, then the
/// closest. The point is on the feature a.
Contact self_contact_at(const MeshScript& script, double t);

}  // namespace kds::collision
