// What the world checks of itself: pairs, and contacts that are held.
#include "kds/audit.hpp"
#include "collision/vectors.hpp"
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
  if (disturbed_.empty()) audit_holds(t);
  audit_overlapping(t);
  for (BodyId a = 0; a < bodies_.size(); ++a) {
    for (BodyId b = a + 1; b < bodies_.size(); ++b) {
      if (!bodies_[a].entered || !bodies_[b].entered) continue;
      const PairSlot slot = find_pair(a, b);
      if (slot != no_pair && pairs_[slot].listed) continue;
      if ((bodies_[a].category & bodies_[b].collides_with) == 0 ||
          (bodies_[b].category & bodies_[a].collides_with) == 0) {
        continue;
      }
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

/// Each hold is of two bodies that are there (or one and a wall), is listed with them and no others, and is held: along
/// its normal the two have no relative velocity but for rounding, as drop_broken() measures it, and accelerations that
/// cancel. What is due to be let go lies ahead.
template <int Degree>
void World<Degree>::audit_holds(double t) const {
  const auto fail = [](HoldSlot slot, const char* what) {
    throw AuditFailure("World: hold " + std::to_string(slot) + ": " + what);
  };
  std::size_t listed = 0;
  std::size_t expected = 0;
  for (BodyId id = 0; id < bodies_.size(); ++id) {
    for (const HoldSlot slot : bodies_[id].holds) {
      ++listed;
      if (slot >= holds_.size() || !holds_[slot].alive) fail(slot, "a body is held by what is none");
      if (holds_[slot].a != id && holds_[slot].b != id) fail(slot, "a body is held that has no part in it");
    }
  }
  for (HoldSlot slot = 0; slot < holds_.size(); ++slot) {
    const Hold& hold = holds_[slot];
    if (!hold.alive) {
      if (releases_.contains(slot)) fail(slot, "it is over, and is to be let go");
      continue;
    }
    const bool at_wall = hold.b == no_body;
    expected += at_wall ? 1 : 2;
    for (const BodyId id : {hold.a, at_wall ? hold.a : hold.b}) {
      if (!contains(id) || !bodies_[id].entered) fail(slot, "a body is not there");
      const auto& known = bodies_[id].holds;
      if (std::count(known.begin(), known.end(), slot) != 1) fail(slot, "a body does not know it");
    }
    if (at_wall && (hold.wall < 0 || hold.wall > 5 || !options_.walls)) fail(slot, "there is no such wall");
    if (std::abs(norm(hold.normal) - 1) > 0x1p-40) fail(slot, "its normal has no unit length");
    if (releases_.time(slot) < t) fail(slot, "it should have been let go");
    if (hold.fresh) continue;
    const Eigen::Vector3d a = movers_[hold.a].motion.velocity(t);
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    if (!at_wall) b = movers_[hold.b].motion.velocity(t);
    double largest = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
    if constexpr (Degree >= 2) {  // Accelerations cancel along the normal, but for rounding, and act since the start.
      for (const BodyId id : {hold.a, at_wall ? hold.a : hold.b}) {
        largest += 2 * bodies_[id].force.cwiseAbs().maxCoeff() * (1 + t - movers_[id].motion.start);
      }
    }
    if (std::abs(dot(hold.normal, b - a)) > 16 * rate_rounding * largest) {
      fail(slot, "the bodies part or press on along its normal");
    }
  }
  if (listed != expected) fail(static_cast<HoldSlot>(holds_.size()), "bodies list more holds than there are");
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
