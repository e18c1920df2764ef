// What the world checks of itself.
#include "kds/audit.hpp"
#include "collision/world.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace kds::collision {

template <int Degree>
void World<Degree>::audit(double t) const {
  require_whole("World::audit");
  t = std::max(t, now_);
  broad_phase_->audit(t);
  const auto fail = [](BodyId a, BodyId b, const char* what) {
    throw AuditFailure("World: bodies " + std::to_string(a) + " and " + std::to_string(b) + ": " + what);
  };
  const bool volumes_due = !volumes_.empty() && volumes_.top().time <= t;
  if (!entering_.empty() || !dirty_.empty() || volumes_due) return;  // Work of this instant is still to be done.
  if (resting_.settled()) resting_.audit(t, options_.walls.has_value());
  audit_overlapping(t);
  for (BodyId a = 0; a < bodies_.size(); ++a) {
    for (BodyId b = a + 1; b < bodies_.size(); ++b) {
      if (!bodies_[a].entered || !bodies_[b].entered) continue;
      const PairSlot slot = find_pair(a, b);
      if (slot != no_pair && pairs_[slot].listed) continue;
      if (!may_collide(a, b)) continue;
      if (broad_phase_->next_time() <= t) continue;
      if (volumes_overlap(a, b, t)) fail(a, b, "the bounding volumes overlap and the pair is not active");
    }
  }
}

/// Pairs that the broad phase does not list are those that overlap, and what overlaps penetrates or is about to
/// separate at this instant.
template <int Degree>
void World<Degree>::audit_overlapping(double t) const {
  std::size_t unlisted = 0;
  for (PairSlot slot = 0; slot < pairs_.size(); ++slot) {
    const Pair& pair = pairs_[slot];
    if (!pair.alive) continue;
    const auto fail = [&](const char* what) {
      throw AuditFailure("World: bodies " + std::to_string(pair.a) + " and " + std::to_string(pair.b) + ": " + what);
    };
    unlisted += pair.listed ? 0 : 1;
    if (!pair.overlapping && !pair.listed) fail("a pair that neither overlaps nor is listed");
    if (!pair.overlapping || pair.passes_at == t || contacts_.time(slot) <= t) continue;
    if (!in_contact(moving(pair.a), moving(pair.b), t)) fail("they count as overlapping, and do not penetrate");
  }
  if (unlisted != unlisted_) throw AuditFailure("World: pairs that are not listed are miscounted");
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
