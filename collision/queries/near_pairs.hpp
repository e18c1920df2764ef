// Which bodies are in contact now, and which will come near each other.
#pragma once

#include "collision/body_id.hpp"
#include "collision/motions.hpp"
#include "collision/queries/approach.hpp"
#include "collision/queries/hit.hpp"
#include "collision/world.hpp"

#include <vector>

namespace kds::collision {

/// Two bodies of a world, a with the lower id.
struct BodyPair {
  BodyId a{};
  BodyId b{};

  friend bool operator==(const BodyPair&, const BodyPair&) = default;
};

/// All pairs of bodies that are in contact at now(): that touch or rest on each other, as World::visit_partners() says;
/// by (a, b), in order of the ids. Throws what that throws. Cost: O(n) and O(pairs).
template <class Motion>
std::vector<BodyPair> contact_pairs(const BasicWorld<Motion>& world);

/// Two bodies, a with the lower id, and when their centres are nearest.
struct NearPair {
  BodyPair pair;
  Approach approach;
};

/// All pairs of bodies whose centres come nearer to each other than `distance` in [now(), until], each with its closest
/// approach there (closest_approach() in approach.hpp, bit for bit); by its time, those of one time by (a, b). As if
/// nothing changed the motions of now() before (future.hpp). Bodies that enter later are not there, nor are
/// half-spaces, whose centre is any point of their plane. The world is not changed, masks play no part, and several
/// threads may ask at once while none does anything else.
///
/// Throws std::invalid_argument unless `distance` > 0, finite, and `until` is a finite time from now() on, and what
/// World::visit_swept throws. Cost: World::visit_swept of a box as large as the distance around each centre, and a
/// closest approach for each pair that it finds; so it grows with how far bodies move until then. Where a body has its
/// centre outside of its bounding box (a hull or a mesh may), all boxes are larger by its bounding radius.
template <class Motion>
std::vector<NearPair> pairs_nearer_than(const BasicWorld<Motion>& world, double distance, double until,
                                        const BodyFilter& filter = {});

}  // namespace kds::collision
