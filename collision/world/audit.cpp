// How the world checks itself.
#include "kds/audit.hpp"
#include "collision/motions.hpp"
#include "collision/world/engine.hpp"

#include <algorithm>
#include <string>

namespace kds::collision {

template <class Motion>
void Engine<Motion>::audit(double t) const {
  require_whole("World::audit");
  t = std::max(t, clock_.now);
  // Where it is known that no event follows, the broad phase is left behind.
  if (broad_phase_->next_time() <= t) t = clock_.now;
  broad_phase_->audit(t);
  // Work of this instant may still have to be done.
  if (bodies_.any_waits() || !pairs_.tested() || volumes_.next_time() <= t) return;
  for (const auto& [sensor, owner] : bodies_.attachments().all()) {
    if (bodies_.motion(sensor) == bodies_.motion(owner)) continue;
    throw AuditFailure("World: sensor " + std::to_string(bodies_.id_of(sensor)) + " does not move with body " +
                       std::to_string(bodies_.id_of(owner)));
  }
  parts().each([t](const auto& part) { part.audit(t); });
  if (broad_phase_->next_time() <= t) return;
  for (BodySlot a = 0; a < bodies_.slots(); ++a) {
    for (BodySlot b = a + 1; b < bodies_.slots(); ++b) {
      if (!bodies_[a].entered || !bodies_[b].entered || !bodies_.may_collide(a, b) || pairs_.listed(a, b)) continue;
      if (!volumes_.overlap(a, b, t, broad_phase_->exact())) continue;
      throw AuditFailure("World: bodies " + std::to_string(bodies_.id_of(a)) + " and " +
                         std::to_string(bodies_.id_of(b)) +
                         ": the bounding volumes overlap and the pair is not active");
    }
  }
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
