// How the parts of a world are checked.
#include "kds/audit.hpp"
#include "collision/motions.hpp"
#include "collision/world/world_parts.hpp"

#include <algorithm>
#include <string>

namespace kds::collision {

template <class Motion>
void WorldParts<Motion>::audit(double t) const {
  t = std::max(t, clock.now);
  // Where it is known that no event follows, the broad phase is left behind.
  if (broad_phase->next_time() <= t) t = clock.now;
  broad_phase->audit(t);
  // Work of this instant may still have to be done.
  if (bodies.any_waits() || !pairs.tested() || volumes.next_time() <= t) return;
  for (const auto& [sensor, owner] : bodies.attachments().all()) {
    if (bodies.motion(sensor) == bodies.motion(owner)) continue;
    throw AuditFailure("World: sensor " + std::to_string(bodies.id_of(sensor)) + " does not move with body " +
                       std::to_string(bodies.id_of(owner)));
  }
  list().each([t](const auto& part) { part.audit(t); });
  if (broad_phase->next_time() <= t) return;
  for (BodySlot a = 0; a < bodies.slots(); ++a) {
    for (BodySlot b = a + 1; b < bodies.slots(); ++b) {
      if (!bodies[a].entered || !bodies[b].entered || !bodies.may_collide(a, b) || pairs.listed(a, b)) continue;
      if (!volumes.overlap(a, b, t, broad_phase->exact())) continue;
      throw AuditFailure("World: bodies " + std::to_string(bodies.id_of(a)) + " and " +
                         std::to_string(bodies.id_of(b)) + ": the bounding volumes overlap and the pair is not active");
    }
  }
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART struct WorldParts<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
