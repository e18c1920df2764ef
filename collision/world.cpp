// The public functions of a world: each is a call of what its engine is made of.
#include "collision/world.hpp"

#include "collision/motions.hpp"
#include "collision/world/engine.hpp"
#include "kds/framework/snapshot.hpp"

#include <algorithm>
#include <utility>

namespace kds::collision {
namespace {

template <class Motion>
const detail::Body<Motion>& body_of(const Engine<Motion>& engine, BodyId id) {
  return engine.bodies()[engine.bodies().slot_of(id)];
}

}  // namespace

template <class Motion>
BasicWorld<Motion>::BasicWorld(const WorldOptions& options, Listener* listener)
    : engine_(std::make_unique<Engine<Motion>>(*this, options, listener)) {}

template <class Motion>
BasicWorld<Motion>::~BasicWorld() = default;

template <class Motion>
BodyId BasicWorld<Motion>::add_body(const Description& description) {
  return engine_->edits().add_body(description);
}

template <class Motion>
void BasicWorld<Motion>::reserve(std::size_t bodies) {
  engine_->edits().reserve(bodies);
}

template <class Motion>
void BasicWorld<Motion>::remove_body(BodyId id) {
  engine_->edits().remove_body(id);
}

template <class Motion>
void BasicWorld<Motion>::update_motion(BodyId id, const Motion& motion) {
  engine_->edits().update_motion(id, {&motion, 1});
}

template <class Motion>
void BasicWorld<Motion>::update_motion(BodyId id, std::span<const Motion> pieces) {
  engine_->edits().update_motion(id, pieces);
}

template <class Motion>
void BasicWorld<Motion>::append_motion(BodyId id, std::span<const Motion> pieces) {
  engine_->edits().append_motion(id, pieces);
}

template <class Motion>
void BasicWorld<Motion>::update_vertices(BodyId id, std::vector<MeshScript::Keyframe> keyframes) {
  engine_->edits().update_vertices(id, std::move(keyframes));
}

template <class Motion>
void BasicWorld<Motion>::set_mass(BodyId id, double mass) {
  engine_->edits().set_mass(id, mass);
}

template <class Motion>
void BasicWorld<Motion>::set_restitution(BodyId id, double restitution) {
  engine_->edits().set_restitution(id, restitution);
}

template <class Motion>
void BasicWorld<Motion>::set_filter(BodyId id, std::uint32_t category, std::uint32_t collides_with) {
  engine_->edits().set_filter(id, category, collides_with);
}

template <class Motion>
void BasicWorld<Motion>::set_group(BodyId id, std::uint32_t group) {
  engine_->edits().set_group(id, group);
}

template <class Motion>
void BasicWorld<Motion>::ignore_pair(BodyId a, BodyId b, bool ignored) {
  engine_->edits().ignore_pair(a, b, ignored);
}

template <class Motion>
void BasicWorld<Motion>::set_user_data(BodyId id, std::uint64_t user_data) {
  engine_->edits().set_user_data(id, user_data);
}

template <class Motion>
TimerId BasicWorld<Motion>::set_timer(double t) {
  return engine_->edits().set_timer(t);
}

template <class Motion>
bool BasicWorld<Motion>::cancel_timer(TimerId timer) {
  return engine_->edits().cancel_timer(timer);
}

template <class Motion>
void BasicWorld<Motion>::advance_to(double t) {
  engine_->advance_to(t);
}

template <class Motion>
bool BasicWorld<Motion>::step(double limit) {
  return engine_->step(limit);
}

template <class Motion>
bool BasicWorld<Motion>::advance_for(double budget_seconds, double t) {
  return engine_->advance_for(budget_seconds, t);
}

template <class Motion>
double BasicWorld<Motion>::next_time() const {
  return engine_->next_time();
}

template <class Motion>
bool BasicWorld<Motion>::process() {
  return engine_->process();
}

template <class Motion>
void BasicWorld<Motion>::extend_horizon(double /*now*/, double horizon) {
  engine_->extend_horizon(horizon);
}

template <class Motion>
void BasicWorld<Motion>::audit(double t) const {
  engine_->audit(t);
}

template <class Motion>
double BasicWorld<Motion>::now() const {
  return engine_->now();
}

template <class Motion>
std::size_t BasicWorld<Motion>::size() const {
  return engine_->bodies().size();
}

template <class Motion>
bool BasicWorld<Motion>::contains(BodyId id) const {
  return engine_->bodies().contains(id);
}

template <class Motion>
const Motion& BasicWorld<Motion>::motion(BodyId id) const {
  return engine_->motion(id);
}

template <class Motion>
Motion BasicWorld<Motion>::free_motion(BodyId id) const {
  return engine_->queries().free_motion(id);
}

template <class Motion>
PlacedShape BasicWorld<Motion>::shape(BodyId id) const {
  const auto& bodies = engine_->bodies();
  return bodies.shape(bodies.slot_of(id));
}

template <class Motion>
double BasicWorld<Motion>::mass(BodyId id) const {
  return body_of(*engine_, id).mass;
}

template <class Motion>
bool BasicWorld<Motion>::sensor(BodyId id) const {
  return body_of(*engine_, id).sensor;
}

template <class Motion>
bool BasicWorld<Motion>::fixed(BodyId id) const {
  const auto& bodies = engine_->bodies();
  return bodies.fixed(bodies.slot_of(id));
}

template <class Motion>
double BasicWorld<Motion>::restitution(BodyId id) const {
  return body_of(*engine_, id).restitution;
}

template <class Motion>
std::uint32_t BasicWorld<Motion>::category(BodyId id) const {
  const auto& bodies = engine_->bodies();
  return bodies.filter(bodies.slot_of(id)).category;
}

template <class Motion>
std::uint32_t BasicWorld<Motion>::collides_with(BodyId id) const {
  const auto& bodies = engine_->bodies();
  return bodies.filter(bodies.slot_of(id)).collides_with;
}

template <class Motion>
std::uint32_t BasicWorld<Motion>::group(BodyId id) const {
  const auto& bodies = engine_->bodies();
  return bodies.filter(bodies.slot_of(id)).group;
}

template <class Motion>
bool BasicWorld<Motion>::ignores_pair(BodyId a, BodyId b) const {
  const auto& bodies = engine_->bodies();
  return bodies.ignored().contains(bodies.slot_of(a), bodies.slot_of(b));
}

template <class Motion>
std::optional<BodyId> BasicWorld<Motion>::attached_to(BodyId id) const {
  const auto& bodies = engine_->bodies();
  const BodySlot owner = bodies.attachments().owner(bodies.slot_of(id));
  return owner == no_body ? std::nullopt : std::optional(bodies.id_of(owner));
}

template <class Motion>
std::uint64_t BasicWorld<Motion>::user_data(BodyId id) const {
  return body_of(*engine_, id).user_data;
}

template <class Motion>
bool BasicWorld<Motion>::touching(BodyId a, BodyId b) const {
  return engine_->queries().touching(a, b);
}

template <class Motion>
bool BasicWorld<Motion>::resting(BodyId a, BodyId b) const {
  return engine_->queries().resting(a, b);
}

template <class Motion>
bool BasicWorld<Motion>::resting_at_wall(BodyId a, int wall) const {
  return engine_->queries().resting_at_wall(a, wall);
}

template <class Motion>
void BasicWorld<Motion>::visit_partners(BodyId id, BodyVisitor visit) const {
  engine_->queries().visit_partners(id, visit);
}

template <class Motion>
void BasicWorld<Motion>::visit_bodies(BodyVisitor visit) const {
  const Bodies<Motion>& bodies = engine_->bodies();
  std::vector<BodyId> ids;
  ids.reserve(bodies.size());
  for (BodySlot slot = 0; slot < bodies.slots(); ++slot) {
    if (bodies.alive(slot)) ids.push_back(bodies.id_of(slot));
  }
  if (!std::is_sorted(ids.begin(), ids.end())) std::sort(ids.begin(), ids.end());
  for (const BodyId id : ids) visit(id);
}

template <class Motion>
WorldCounters BasicWorld<Motion>::counters() const {
  return engine_->counters();
}

template <class Motion>
std::string_view BasicWorld<Motion>::broad_phase() const {
  return engine_->parts().broad_phase->name();
}

template <class Motion>
const Profile& BasicWorld<Motion>::work_profile() const {
  return engine_->parts().work_profile;
}

template <class Motion>
void BasicWorld<Motion>::visit_overlapping(const Eigen::Vector3d& min, const Eigen::Vector3d& max,
                                           BodyVisitor visit) const {
  engine_->queries().visit_overlapping(min, max, visit);
}

template <class Motion>
void BasicWorld<Motion>::visit_swept(const KineticBox<Motion::degree>& box, double until, BodyVisitor visit) const {
  engine_->queries().visit_swept(box, until, visit);
}

template <class Motion>
template <class Archive>
void BasicWorld<Motion>::archive(Archive& archive) {
  engine_->archive(archive);
}

#define KDS_INSTANTIATE(motion)                                    \
  template class BasicWorld<motion>;                               \
  template void BasicWorld<motion>::archive(kds::detail::Writer&); \
  template void BasicWorld<motion>::archive(kds::detail::Reader&);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
