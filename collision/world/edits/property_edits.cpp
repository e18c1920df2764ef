// How the properties of bodies are changed, and timers are set.
#include "collision/motions.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/world/edits/edits.hpp"
#include "kds/number_text.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace kds::collision {

template <class Motion>
void Edits<Motion>::set_mass(BodyId id, double mass) {
  begin("World::set_mass");
  const BodySlot slot = bodies_.slot_of(id);
  require_size(mass, "World::set_mass: mass");
  if (bodies_.fixed(slot)) {
    throw std::invalid_argument("World::set_mass: body " + std::to_string(id) + " is fixed, and has none");
  }
  count();
  guard_.change([&] {
    const double factor = mass / bodies_[slot].mass;
    bodies_.set_mass(slot, mass);
    if constexpr (turns<Motion>) {
      if (tumbling_.has(slot)) tumbling_.scale(slot, factor);
    }
    if (resting_.carries(slot)) motions_.move_freely(slot, parts_.free_motion(slot, clock_.now));
  });
}

template <class Motion>
void Edits<Motion>::set_restitution(BodyId id, double restitution) {
  begin("World::set_restitution");
  const BodySlot slot = bodies_.slot_of(id);
  if (!(restitution >= 0 && restitution <= 1)) {
    throw std::invalid_argument("World::set_restitution: restitution: must be in [0, 1]");
  }
  count();
  bodies_[slot].restitution = restitution;
}

template <class Motion>
void Edits<Motion>::give_filter(BodySlot slot, const CollisionFilter& after) {
  const CollisionFilter before = bodies_.filter(slot);
  if (before == after) return;
  count();
  if (!bodies_[slot].entered) return bodies_.set_filter(slot, after);
  const auto change = [&] {
    bodies_.set_filter(slot, after);
    pairs_.filter_changed(slot, before);
  };
  guard_.change([&] { membership_.filter_anew(slot, change); });
}

template <class Motion>
void Edits<Motion>::set_filter(BodyId id, std::uint32_t category, std::uint32_t collides_with) {
  begin("World::set_filter");
  const BodySlot slot = bodies_.slot_of(id);
  give_filter(slot, {category, collides_with, bodies_.filter(slot).group});
}

template <class Motion>
void Edits<Motion>::set_group(BodyId id, std::uint32_t group) {
  begin("World::set_group");
  const BodySlot slot = bodies_.slot_of(id);
  CollisionFilter filter = bodies_.filter(slot);
  filter.group = group;
  give_filter(slot, filter);
}

template <class Motion>
void Edits<Motion>::ignore_pair(BodyId a, BodyId b, bool ignored) {
  begin("World::ignore_pair");
  const BodySlot of_a = bodies_.slot_of(a);
  const BodySlot of_b = bodies_.slot_of(b);
  if (a == b) throw std::invalid_argument("World::ignore_pair: body " + std::to_string(a) + " and itself are no pair");
  if (bodies_.ignored().contains(of_a, of_b) == ignored) return;
  count();
  if (!bodies_[of_a].entered || !bodies_[of_b].entered) return bodies_.ignore(of_a, of_b, ignored);
  const auto change = [&] {
    bodies_.ignore(of_a, of_b, ignored);
    pairs_.ignoring_changed(of_a, of_b);
  };
  guard_.change([&] { membership_.filter_anew(of_a, change); });
}

template <class Motion>
void Edits<Motion>::set_user_data(BodyId id, std::uint64_t user_data) {
  bodies_[bodies_.slot_of(id)].user_data = user_data;
}

template <class Motion>
TimerId Edits<Motion>::set_timer(double t) {
  begin("World::set_timer");
  if (!(t >= clock_.now && t < never)) {
    throw std::invalid_argument("World::set_timer: " + number_text(t) + " is not a finite time from now on (" +
                                number_text(clock_.now) + ")");
  }
  count(false);
  return timers_.set(t);
}

template <class Motion>
bool Edits<Motion>::cancel_timer(TimerId timer) {
  begin("World::cancel_timer");
  count(false);
  return timers_.cancel(timer);
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Edits<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
