#include "collision/world/bodies.hpp"

#include "certificates/turning/rotation.hpp"
#include "collision/motions.hpp"
#include "collision/world/bodies_image.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

/// A new motion whose position differs from the old one's by more than this, relative to the coordinates and the body's
/// size, is a jump: far above the rounding of a restarted motion, far below any jump that a caller would intend.
constexpr double jump_tolerance = 0x1p-40;

}  // namespace

template <class Motion>
void Bodies<Motion>::refuse(BodyId id) const {
  const BodySlot slot = body_slot(id);
  const bool removed = slot < slots() && body_generation(id) <= keys_.generation(slot);
  throw std::out_of_range("World: there is no body " + std::to_string(id) + " (generation " +
                          std::to_string(body_generation(id)) + " of slot " + std::to_string(slot) + "): it " +
                          (removed ? "was removed" : "has never been there"));
}

template <class Motion>
bool Bodies<Motion>::is_jump(BodySlot slot, const Motion& to, double t) const {
  const Eigen::Vector3d before = path(slot).position(t);
  const Eigen::Vector3d after = path_of(to).position(t);
  const double scale = before.cwiseAbs().maxCoeff() + after.cwiseAbs().maxCoeff() + finite_radius(slot);
  double farthest = (after - before).cwiseAbs().maxCoeff();
  if constexpr (turns<Motion>) {
    const certificates::Rotation from = motion(slot).rotation(t), into = to.rotation(t);
    for (int d = 0; d < 3; ++d) {
      const Eigen::Vector3d turned = into(Eigen::Vector3d::Unit(d)) - from(Eigen::Vector3d::Unit(d));
      farthest = std::max(farthest, turned.cwiseAbs().maxCoeff() * bodies_[slot].bounding_radius);
    }
  }
  return farthest > jump_tolerance * scale;
}

template <class Motion>
inline BodySlot Bodies<Motion>::new_slot() {
  if (!free_.empty() && keys_.can_give(free_.back())) {
    const BodySlot slot = free_.back();
    free_.pop_back();
    return slot;
  }
  const auto slot = static_cast<BodySlot>(bodies_.size());
  bodies_.emplace_back();
  movers_.emplace_back();
  if constexpr (turns<Motion>) motions_.emplace_back();
  return slot;
}

template <class Motion>
BodySlot Bodies<Motion>::add(const Description& description, std::shared_ptr<const PlacedShape> shape,
                             const Motion& motion) {
  const double ball = ball_radius(shape ? shape->shape : description.shape);
  const BodySlot slot = new_slot();
  keys_.give(slot);
  Body& added = bodies_[slot];
  added.bounding_radius = shape ? shape->bounding_radius : ball;
  keep_shape(slot, std::move(shape));
  added.mass = description.mass;
  added.inverse_mass = description.fixed ? 0 : 1 / description.mass;
  if constexpr (turns<Motion>) {
    const double moment = description.inertia.moment();
    added.inverse_inertia = description.fixed || moment == 0 ? 0 : 1 / moment;
    added.friction = description.friction, added.tangential_restitution = description.tangential_restitution;
    added.rolling_friction = description.rolling_friction;
  }
  added.restitution = description.restitution;
  set_filter(slot, {description.category, description.collides_with, description.group});
  added.volume = description.volume;
  added.sensor = description.sensor;
  added.self_contacts = description.self_contacts;
  added.user_data = description.user_data;
  sensors_ = sensors_ || description.sensor;
  added.alive = true;
  move(slot, motion);
  movers_[slot].radius = ball > 0 ? ball : Mover::no_radius;
  accelerate_freely(slot, motion);
  ++alive_;
  return slot;
}

template <class Motion>
BodySlot Bodies<Motion>::take_in(const Bodies& from, BodySlot of) {
  const BodySlot slot = new_slot();
  bodies_[slot] = from.bodies_[of];
  movers_[slot] = from.movers_[of];
  if constexpr (turns<Motion>) motions_[slot] = from.motions_[of];
  bodies_[slot].entered = false;
  keep_shape(slot, from.kept_shape(of));
  set_filter(slot, from.filter(of));
  sensors_ = sensors_ || bodies_[slot].sensor;
  ++alive_;
  keys_.set_number(slot, from.number(of));
  keys_.set_generation(slot, from.keys_.generation(of));
  return slot;
}

template <class Motion>
void Bodies<Motion>::set_filter(BodySlot slot, const CollisionFilter& filter) {
  if (filter == this->filter(slot)) return;
  if (filter_.size() <= slot) filter_.resize(bodies_.size());
  filter_[slot] = filter;
  filters_ = true;
}

template <class Motion>
void Bodies<Motion>::keep_shape(BodySlot slot, std::shared_ptr<const PlacedShape> shape) {
  bodies_[slot].shape = shape.get();
  if (!shape && shapes_.size() <= slot) return;
  if (shapes_.size() <= slot) shapes_.resize(bodies_.size());
  shapes_[slot] = std::move(shape);
}

template <class Motion>
void Bodies<Motion>::ignore(BodySlot a, BodySlot b, bool ignored) {
  if (ignored) {
    ignored_.add(a, b);
  } else {
    ignored_.remove(a, b);
  }
  filters_ = true;
}

template <class Motion>
void Bodies<Motion>::attach(BodySlot sensor, BodySlot owner) {
  attachments_.attach(sensor, owner);
  filters_ = true;
}

template <class Motion>
void Bodies<Motion>::set_mass(BodySlot slot, double mass) {
  Body& body = bodies_[slot];
  if constexpr (turns<Motion>) body.inverse_inertia *= body.mass / mass;
  body.mass = mass, body.inverse_mass = 1 / mass;
}

template <class Motion>
void Bodies<Motion>::remove(BodySlot slot) {
  if (waits(slot)) wait_no_more(slot);
  keep_shape(slot, nullptr);
  set_filter(slot, {});
  bodies_[slot] = Body{};
  ignored_.forget(slot);
  attachments_.detach(slot);
  --alive_;
  free_.push_back(slot);
}

template <class Motion>
void Bodies<Motion>::reserve(std::size_t bodies) {
  bodies_.reserve(bodies);
  movers_.reserve(bodies);
  if constexpr (turns<Motion>) motions_.reserve(bodies);
  waiting_.reserve(bodies);
}

template <class Motion>
void Bodies<Motion>::wait(BodySlot slot) {
  waiting_.push_back(slot);
  if (waits_at_.size() <= slot) waits_at_.resize(bodies_.size());
  waits_at_[slot] = static_cast<std::uint32_t>(waiting_.size());
  ++waits_;
}

/// The next body in this slot must not enter in its place, which stays empty until half of all places are.
template <class Motion>
void Bodies<Motion>::wait_no_more(BodySlot slot) {
  waiting_[std::exchange(waits_at_[slot], 0) - 1] = no_body;
  if (2 * --waits_ >= waiting_.size() - taken_) return;
  const std::vector<BodySlot> places = std::exchange(waiting_, {});
  const std::size_t first = std::exchange(taken_, 0);
  waits_ = 0;
  for (std::size_t i = first; i < places.size(); ++i) {
    if (places[i] != no_body) wait(places[i]);
  }
}

template <class Motion>
std::vector<BodySlot> Bodies<Motion>::take_waiting(std::size_t most) {
  std::vector<BodySlot> taken;
  taken.reserve(std::min(most, waits_));
  while (taken.size() < most && any_waits()) {
    const BodySlot slot = waiting_[taken_++];
    if (slot == no_body) continue;
    taken.push_back(slot);
    waits_at_[slot] = 0;
    --waits_;
  }
  if (!any_waits()) {
    std::vector<BodySlot>().swap(waiting_);
    LargeVector<std::uint32_t>().swap(waits_at_);
    taken_ = 0;
  }
  return taken;
}

template <class Motion>
std::vector<std::shared_ptr<const Mesh>> Bodies<Motion>::meshes() const {
  std::vector<std::shared_ptr<const Mesh>> result;
  for (BodySlot slot = 0; slot < bodies_.size(); ++slot) {
    if (!bodies_[slot].alive) continue;
    const auto mesh = mesh_of(shape(slot).shape);
    if (mesh && std::find(result.begin(), result.end(), mesh) == result.end()) result.push_back(mesh);
  }
  return result;
}

/// Copies the members that are the same in a body and in its image, either way.
template <class Motion, class From, class To>
static void copy_properties(const From& from, To& to) {
  to.mass = from.mass, to.inverse_mass = from.inverse_mass, to.restitution = from.restitution;
  to.volume = from.volume, to.sensor = from.sensor, to.self_contacts = from.self_contacts;
  to.user_data = from.user_data;
  to.meetings = static_cast<std::uint32_t>(from.meetings), to.burst_start = from.burst_start;
  if constexpr (turns<Motion>) {
    to.inverse_inertia = from.inverse_inertia;
    to.friction = from.friction, to.tangential_restitution = from.tangential_restitution;
    to.rolling_friction = from.rolling_friction;
    to.tumbles = from.tumbles;
  }
  if constexpr (Motion::degree >= 3) to.given = from.given;
}

template <class Motion>
template <class One>
void Bodies<Motion>::describe(BodySlot slot, One& one, const std::vector<std::shared_ptr<const Mesh>>& meshes) const {
  const Body& b = bodies_[slot];
  if (!b.alive) return;
  one.alive = true, one.entered = b.entered;
  one.placed = shape(slot);
  if (const auto mesh = mesh_of(one.placed.shape)) {
    one.mesh = static_cast<std::uint32_t>(std::find(meshes.begin(), meshes.end(), mesh) - meshes.begin());
  }
  one.motion = motion(slot);
  copy_properties<Motion>(b, one);
  one.filter = filter(slot);
  if constexpr (Motion::degree <= 2) one.force = free_acceleration(slot);
}

template <class Motion>
typename Bodies<Motion>::Image Bodies<Motion>::image() const {
  Image image;
  image.meshes = meshes();
  for (BodySlot slot = 0; slot < bodies_.size(); ++slot) describe(slot, image.bodies.emplace_back(), image.meshes);
  image.generations = keys_.generations(), image.next_id = keys_.next_id(), image.free = free_;
  std::copy_if(waiting().begin(), waiting().end(), std::back_inserter(image.waiting),
               [](BodySlot slot) { return slot != no_body; });
  image.ignored = ignored_.pairs(), image.attached = attachments_.all();
  return image;
}

template <class Motion>
typename Bodies<Motion>::Image Bodies<Motion>::image_without_bodies() const {
  Image image;
  image.elsewhere = {.slots = lent_ > 0 ? lent_ : bodies_.size(), .bodies = alive_};
  image.generations = keys_.generations(), image.next_id = keys_.next_id(), image.free = free_;
  image.ignored = ignored_.pairs(), image.attached = attachments_.all();
  return image;
}

template <class Motion>
typename Bodies<Motion>::Image Bodies<Motion>::image_of(std::span<const BodySlot> slots,
                                                        std::vector<std::shared_ptr<const Mesh>> meshes) const {
  Image image;
  image.meshes = std::move(meshes);
  image.bodies.reserve(slots.size());
  for (const BodySlot slot : slots) describe(slot, image.bodies.emplace_back(), image.meshes);
  return image;
}

template <class Motion>
BodySlot Bodies<Motion>::put(const Image& image, std::size_t place, BodySlot number, const Bodies& whole) {
  const BodySlot slot = new_slot();
  keys_.set_number(slot, number);
  keys_.set_generation(slot, whole.keys_.generation(number));
  become(slot, image.bodies[place]);
  return slot;
}

template <class Motion>
void Bodies<Motion>::put_back(const Image& image, std::size_t place, BodySlot slot) {
  become(slot, image.bodies[place]);
}

template <class Motion>
void Bodies<Motion>::lend() {
  lent_ = bodies_.size();
  // Swapping gives their memory back; assigning `{}` would not.
  LargeVector<Mover>().swap(movers_);
  LargeVector<Motion>().swap(motions_);
  LargeVector<Body>().swap(bodies_);
  LargeVector<std::shared_ptr<const PlacedShape>>().swap(shapes_);
  LargeVector<CollisionFilter>().swap(filter_);
  LargeVector<std::uint32_t>().swap(waits_at_);
  std::vector<BodySlot>().swap(waiting_);
  taken_ = waits_ = 0;
}

template <class Motion>
void Bodies<Motion>::lend(std::size_t bodies) {
  lent_ = alive_ = bodies;
  keys_.become({}, bodies);
}

template <class Motion>
bool Bodies<Motion>::has_lent(BodyId id) const {
  const BodySlot slot = body_slot(id);
  return slot < lent_ && keys_.id(slot) == id && std::find(free_.begin(), free_.end(), slot) == free_.end();
}

template <class Motion>
void Bodies<Motion>::take_back() {
  bodies_.resize(lent_), movers_.resize(lent_);
  if constexpr (turns<Motion>) motions_.resize(lent_);
  alive_ = lent_ = 0;
}

template <class Motion>
void Bodies<Motion>::set_shape(BodySlot slot, PlacedShape placed) {
  Body& b = bodies_[slot];
  const double ball = ball_radius(placed.shape);
  b.bounding_radius = placed.bounding_radius;
  movers_[slot].radius = ball > 0 ? ball : Mover::no_radius;
  if (!(ball > 0) || !placed.rotation.isIdentity(0)) {
    keep_shape(slot, std::make_shared<const PlacedShape>(std::move(placed)));
  }
}

template <class Motion>
void Bodies<Motion>::become(const Image& image) {
  keys_.become(image.generations, image.next_id);
  free_ = image.free;
  const std::size_t count = image.bodies.size();
  bodies_.clear(), movers_.clear(), shapes_.clear(), filter_.clear(), waits_at_.clear();
  bodies_.resize(count), movers_.resize(count);
  if constexpr (turns<Motion>) motions_.resize(count);
  lent_ = image.elsewhere.slots, alive_ = image.elsewhere.bodies;
  ignored_.clear(), attachments_.clear();
  for (const auto& [a, b] : image.ignored) ignore(a, b, true);
  for (const auto& [sensor, owner] : image.attached) attach(sensor, owner);
  for (BodySlot slot = 0; slot < count; ++slot) {
    if (image.bodies[slot].alive) become(slot, image.bodies[slot]);
  }
  waiting_.clear();
  taken_ = waits_ = 0;
  for (const BodySlot slot : image.waiting) wait(slot);
}

template <class Motion>
template <class One>
void Bodies<Motion>::become(BodySlot slot, const One& one) {
  ++alive_;
  Body& b = bodies_[slot];
  b.alive = true, b.entered = one.entered;
  set_shape(slot, one.placed);
  move(slot, one.motion);
  copy_properties<Motion>(one, b);
  set_filter(slot, one.filter);
  sensors_ = sensors_ || b.sensor;
  if constexpr (Motion::degree == 2) b.force = one.force;
}

#define KDS_INSTANTIATE(motion) template class Bodies<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
