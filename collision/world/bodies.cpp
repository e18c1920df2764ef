#include "collision/world/bodies.hpp"

#include "collision/motions.hpp"
#include "collision/world/bodies_image.hpp"

#include <algorithm>
#include <cmath>
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
  const bool free = std::find(free_.begin(), free_.end(), slot) != free_.end();
  const bool retired = slot < bodies_.size() && !bodies_[slot].alive && !free;
  const bool removed = body_generation(id) < generation(slot) || (retired && body_generation(id) == generation(slot));
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
  if (!free_.empty()) {
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
  Body& added = bodies_[slot];
  added.bounding_radius = shape ? shape->bounding_radius : ball;
  added.shape = std::move(shape);
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
BodySlot Bodies<Motion>::take_in(const Bodies& from, BodySlot number) {
  const BodySlot slot = new_slot();
  bodies_[slot] = from.bodies_[number];
  movers_[slot] = from.movers_[number];
  if constexpr (turns<Motion>) motions_[slot] = from.motions_[number];
  bodies_[slot].entered = false;
  filters_ = filters_ || filter(slot) != CollisionFilter{};
  sensors_ = sensors_ || bodies_[slot].sensor;
  ++alive_;
  if (numbers_.size() <= slot) numbers_.resize(bodies_.size());
  numbers_[slot] = number;
  return slot;
}

template <class Motion>
void Bodies<Motion>::set_filter(BodySlot slot, const CollisionFilter& filter) {
  bodies_[slot].filter = filter;
  filters_ = filters_ || filter != CollisionFilter{};
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
  std::erase(waiting_, slot);  // otherwise the next body in this slot would enter in its place
  bodies_[slot] = Body{};
  ignored_.forget(slot);
  attachments_.detach(slot);
  --alive_;
  if (generations_.size() <= slot) generations_.resize(bodies_.size());
  if (generations_[slot] == last_generation) return;
  ++generations_[slot];
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
bool Bodies<Motion>::waits(BodySlot slot) const {
  return std::find(waiting_.begin(), waiting_.end(), slot) != waiting_.end();
}

template <class Motion>
std::vector<BodySlot> Bodies<Motion>::take_waiting(std::size_t most) {
  if (most >= waiting_.size()) return std::exchange(waiting_, {});
  const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(most);
  std::vector<BodySlot> taken(waiting_.begin(), end);
  waiting_.erase(waiting_.begin(), end);
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

template <class Motion>
typename Bodies<Motion>::Image Bodies<Motion>::image() const {
  Image image;
  image.meshes = meshes();
  for (BodySlot slot = 0; slot < bodies_.size(); ++slot) {
    const Body& b = bodies_[slot];
    auto& to = image.bodies.emplace_back();
    if (!b.alive) continue;
    to.alive = true, to.entered = b.entered;
    to.placed = shape(slot);
    if (const auto mesh = mesh_of(to.placed.shape)) {
      to.mesh =
          static_cast<std::uint32_t>(std::find(image.meshes.begin(), image.meshes.end(), mesh) - image.meshes.begin());
    }
    to.motion = motion(slot);
    to.mass = b.mass, to.inverse_mass = b.inverse_mass, to.restitution = b.restitution;
    to.filter = b.filter, to.volume = b.volume, to.sensor = b.sensor;
    to.self_contacts = b.self_contacts, to.user_data = b.user_data;
    to.meetings = b.meetings, to.burst_start = b.burst_start;
    if constexpr (turns<Motion>) {
      to.inverse_inertia = b.inverse_inertia;
      to.friction = b.friction, to.tangential_restitution = b.tangential_restitution;
      to.rolling_friction = b.rolling_friction;
      to.tumbles = b.tumbles;
    }
    if constexpr (Motion::degree <= 2) to.force = free_acceleration(slot);
    if constexpr (Motion::degree >= 3) to.given = b.given;
  }
  image.generations = generations_, image.free = free_, image.waiting = waiting_;
  image.ignored = ignored_.pairs(), image.attached = attachments_.all();
  return image;
}

template <class Motion>
void Bodies<Motion>::set_shape(BodySlot slot, PlacedShape placed) {
  Body& b = bodies_[slot];
  const double ball = ball_radius(placed.shape);
  b.bounding_radius = placed.bounding_radius;
  movers_[slot].radius = ball > 0 ? ball : Mover::no_radius;
  if (!(ball > 0) || !placed.rotation.isIdentity(0)) b.shape = std::make_shared<const PlacedShape>(std::move(placed));
}

template <class Motion>
void Bodies<Motion>::become(const Image& image) {
  generations_ = image.generations, free_ = image.free, waiting_ = image.waiting;
  const std::size_t count = image.bodies.size();
  bodies_.clear(), movers_.clear();
  bodies_.resize(count), movers_.resize(count);
  if constexpr (turns<Motion>) motions_.resize(count);
  alive_ = 0;
  ignored_.clear(), attachments_.clear();
  for (const auto& [a, b] : image.ignored) ignore(a, b, true);
  for (const auto& [sensor, owner] : image.attached) attach(sensor, owner);
  for (BodySlot slot = 0; slot < count; ++slot) {
    const auto& from = image.bodies[slot];
    if (!from.alive) continue;
    ++alive_;
    Body& b = bodies_[slot];
    b.alive = true, b.entered = from.entered;
    set_shape(slot, from.placed);
    move(slot, from.motion);
    b.mass = from.mass, b.inverse_mass = from.inverse_mass, b.restitution = from.restitution;
    set_filter(slot, from.filter);
    b.volume = from.volume, b.sensor = from.sensor;
    b.self_contacts = from.self_contacts, b.user_data = from.user_data;
    if constexpr (turns<Motion>) {
      b.inverse_inertia = from.inverse_inertia;
      b.friction = from.friction, b.tangential_restitution = from.tangential_restitution;
      b.rolling_friction = from.rolling_friction;
      b.tumbles = from.tumbles;
    }
    sensors_ = sensors_ || b.sensor;
    b.meetings = from.meetings, b.burst_start = from.burst_start;
    if constexpr (Motion::degree == 2) b.force = from.force;
    if constexpr (Motion::degree >= 3) b.given = from.given;
  }
}

#define KDS_INSTANTIATE(motion) template class Bodies<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
