// What callers do with a periodic world, and how contacts are answered.
#include "collision/periodic/periodic_world.hpp"

#include "collision/motion_range.hpp"
#include "collision/response/impulse.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/vectors.hpp"
#include "collision/world/queue_room.hpp"
#include "kds/audit.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <variant>

namespace kds::collision {
namespace {

/// The bits of the categories of bodies: see PeriodicWorld::image_bits.
constexpr std::uint32_t body_categories = 0xffff;

/// Two bodies part at least at this rate, relative to their speeds: more than what roundings may leave of an approach.
constexpr double least_rebound = 0x1p-44;

WorldOptions world_options(const PeriodicOptions& options) {
  validate(options);
  WorldOptions world = options.world;
  world.response = Response::callback;
  bool any = false;
  Walls walls;
  walls.restitution = options.wall_restitution;
  for (int d = 0; d < 3; ++d) {
    const bool here = options.boundaries[static_cast<std::size_t>(d)] == Boundary::walls;
    any = any || here;
    constexpr double far = 0x1p200;  // there is none on this axis
    walls.min[d] = here ? options.min[d] : -far;
    walls.max[d] = here ? options.max[d] : far;
  }
  if (any) world.walls = walls;
  return world;
}

template <int Degree>
void require_supported(const BodyDescription<Degree>& description, double now) {
  const auto fail = [](const char* what) { throw std::invalid_argument(what); };
  if (description.motion.size() > 1) fail("motion: has more than one piece, and bodies of a periodic world have one");
  if (description.motion.empty()) fail("motion: has no piece");
  if (!in_range(description.motion[0])) refuse_motion(description.motion[0], "motion[0]");
  if (!(description.motion[0].start <= now)) fail("motion[0].start: is after now()");
  if (description.sensor) fail("sensor: a periodic world has none");
  if (description.box) fail("box: a periodic world has no box functions");
  if (bends(description.shape)) fail("shape: a mesh that bends cannot be in a periodic world");
  if (unbounded(description.shape)) fail("shape: a half-space cannot be in a periodic world");
  if (description.category > body_categories) fail("category: a periodic world has 16 bits for it");
}

}  // namespace

template <int Degree>
PeriodicWorld<Degree>::PeriodicWorld(const PeriodicOptions& options, Listener* listener)
    : options_(options),
      lattice_(options),
      listener_(listener ? listener : &silent_),
      world_(world_options(options), this),
      thermal_(options.seed) {}

template <int Degree>
bool PeriodicWorld<Degree>::contains(BodyId id) const {
  const BodySlot slot = body_slot(id);
  return slot < reals_.size() && reals_[slot].alive && keys_.id(slot) == id;
}

template <int Degree>
const typename PeriodicWorld<Degree>::Real& PeriodicWorld<Degree>::real(BodyId id) const {
  if (!contains(id)) [[unlikely]] {
    const BodySlot slot = body_slot(id);
    const bool removed = slot < reals_.size() && body_generation(id) <= keys_.generation(slot);
    throw std::out_of_range("PeriodicWorld: there is no body " + std::to_string(id) + " (generation " +
                            std::to_string(body_generation(id)) + " of slot " + std::to_string(slot) + "): it " +
                            (removed ? "was removed" : "has never been there"));
  }
  return reals_[body_slot(id)];
}

template <int Degree>
void PeriodicWorld<Degree>::set_role(BodyId in_world, BodySlot owner, const Offset& offset) {
  if (roles_.size() <= body_slot(in_world)) roles_.resize(body_slot(in_world) + 1);
  roles_[body_slot(in_world)] = {owner, offset};
}

template <int Degree>
const typename PeriodicWorld<Degree>::Motion& PeriodicWorld<Degree>::motion(BodyId id) const {
  return world_.motion(real(id).in_world);
}

template <int Degree>
typename PeriodicWorld<Degree>::Owner PeriodicWorld<Degree>::owner(BodyId in_world) const {
  static_cast<void>(world_.mass(in_world));  // throws, if there is none
  return {id_of(role(in_world).owner), role(in_world).offset};
}

template <int Degree>
void PeriodicWorld<Degree>::reserve(std::size_t bodies) {
  world_.reserve(bodies + bodies / 4);
  reals_.reserve(bodies);
}

template <int Degree>
BodyId PeriodicWorld<Degree>::add_body(const Description& description) {
  require_supported(description, now());
  const double radius = place(description.shape, description.orientation).bounding_radius;
  require_room(std::max(radius, greatest_radius_));
  const Offset into = way_into_box(description.motion[0]);
  const Eigen::Quaterniond& q = description.orientation;
  Description inside = description;
  inside.motion[0] = lattice_.moved(inside.motion[0], into);
  inside.collides_with &= body_categories;
  inside.collides_with |= inside.collides_with << image_bits;
  const BodyId in_world = world_.add_body(inside);
  const bool reused = !free_.empty() && keys_.can_give(free_.back());
  const BodySlot slot = reused ? free_.back() : static_cast<BodySlot>(reals_.size());
  reused ? free_.pop_back() : void(reals_.emplace_back());
  keys_.give(slot);
  make_room(leaving_, reals_.size());
  set_role(in_world, slot, {});
  reals_[slot] = {.in_world = in_world,
                  .inverse_mass = description.fixed ? 0 : 1 / description.mass,
                  .restitution = description.restitution,
                  .radius = radius,
                  .alive = true,
                  .placed_at = now(),
                  .crossings = -into,
                  .orientation = {q.x(), q.y(), q.z(), q.w()}};
  ++size_;
  if (radius > greatest_radius_) note_largest(radius);
  find_zones(reals_[slot]);
  update_place(reals_[slot]);
  return id_of(slot);
}

template <int Degree>
void PeriodicWorld<Degree>::remove_body(BodyId id) {
  Real& body = real(id);
  for (const Image& image : body.images) end_image(image);
  world_.remove_body(body.in_world);
  set_role(body.in_world, no_body, {});
  leaving_.clear(body_slot(id));
  body = {};
  free_.push_back(body_slot(id));
  --size_;
}

template <int Degree>
void PeriodicWorld<Degree>::update_motion(BodyId id, const Motion& motion) {
  Real& body = real(id);
  if (!in_range(motion)) refuse_motion(motion, "PeriodicWorld::update_motion: motion");
  const Offset into = way_into_box(motion);
  world_.update_motion(body.in_world, lattice_.moved(motion, into));
  body.crossings = body.crossings + -into;
  body.placed_at = now();
  move_images(body);
  find_zones(body);
  update_place(body);
}

template <int Degree>
void PeriodicWorld<Degree>::set_restitution(BodyId id, double restitution) {
  Real& body = real(id);
  world_.set_restitution(body.in_world, restitution);
  body.restitution = restitution;
}

template <int Degree>
bool PeriodicWorld<Degree>::step(double limit) {
  if (!(limit < never)) {
    throw std::invalid_argument(
        "PeriodicWorld::step: bodies may cross the ends of the box for ever, so it needs a limit");
  }
  for (;;) {
    const double next = leaving_.empty() ? never : leaving_.top().time;
    told_ = false;
    if (world_.step(std::min(next, limit))) {
      if (told_) return true;
      continue;
    }
    if (next > limit) return false;
    cross();
  }
}

template <int Degree>
void PeriodicWorld<Degree>::advance_to(double t) {
  if (!(t >= now() && t < never)) {
    throw std::invalid_argument("PeriodicWorld::advance_to: " + number_text(t) + " is not a finite time from now on (" +
                                number_text(now()) + ")");
  }
  while (step(t)) {
  }
}

/// A body has another motion, which its images follow.
template <int Degree>
void PeriodicWorld<Degree>::take_up(Real& body, const Motion& motion) {
  world_.update_motion(body.in_world, motion);
  follow(body);
}

template <int Degree>
void PeriodicWorld<Degree>::follow(Real& body) {
  move_images(body);
  schedule(body);
}

template <int Degree>
void PeriodicWorld<Degree>::move_images(Real& body) {
  if (!body.near_an_end()) return;
  const Motion motion = world_.motion(body.in_world);
  for (const Image& image : body.images) world_.update_motion(image.id, lattice_.moved(motion, image.offset));
}

template <int Degree>
PeriodicEvent PeriodicWorld<Degree>::event_of(const PairEvent& pair) const {
  const Role& a = role(pair.a);
  const Role& b = role(pair.b);
  PeriodicEvent event{id_of(a.owner),   id_of(b.owner),  b.offset + -a.offset, pair.contact, 0,
                      pair.user_data_a, pair.user_data_b};
  const bool swap = event.a > event.b;
  if (swap) {
    std::swap(event.a, event.b);
    std::swap(event.user_data_a, event.user_data_b);
    std::swap(event.contact.feature_a, event.contact.feature_b);
    event.offset = -event.offset;
    event.contact.normal = Eigen::Vector3d::Zero() - event.contact.normal;  // no negative zeros
  }
  const Offset& of_a = swap ? b.offset : a.offset;
  if (of_a != Offset{}) event.contact.point -= lattice_.displacement(of_a, event.contact.time);
  return event;
}

/// The same arithmetic as that of a World in mode `elastic`, for the same bits.
template <int Degree>
void PeriodicWorld<Degree>::strike(PeriodicEvent& event) {
  Real& a = real(event.a);
  Real& b = real(event.b);
  const double inverse_masses = a.inverse_mass + b.inverse_mass;
  if (inverse_masses == 0) return;
  const double t = event.contact.time;
  const Eigen::Vector3d& n = event.contact.normal;
  Motion motion_a = world_.free_motion(a.in_world).restarted(t);
  Motion motion_b = world_.free_motion(b.in_world).restarted(t);
  Eigen::Vector3d& v_a = motion_a.coefficients[1];
  Eigen::Vector3d& v_b = motion_b.coefficients[1];
  const Eigen::Vector3d sliding = lattice_.velocity(event.offset);
  const double approach = -dot(n, v_b + sliding - v_a);
  const bool soon = t - a.last_contact < options_.elastic_within || t - b.last_contact < options_.elastic_within;
  const double restitution = soon ? 1 : std::min(a.restitution, b.restitution);
  const double least = least_rebound * (norm(v_a) + norm(v_b) + norm(sliding));
  double change = std::max(0.0, (1 + restitution) * approach);
  if (restitution * approach < least) change = std::max(0.0, approach) + least;
  change_relative_velocity(v_a, v_b, n, change, a.inverse_mass, b.inverse_mass);
  event.impulse = change / inverse_masses;
  a.last_contact = b.last_contact = t;
  if (a.inverse_mass != 0) take_up(a, motion_a);
  if (b.inverse_mass != 0) take_up(b, motion_b);
}

template <int Degree>
void PeriodicWorld<Degree>::contact(World<Degree>&, const PairEvent& pair) {
  told_ = true;
  ++counters_.contacts;
  PeriodicEvent event = event_of(pair);
  strike(event);
  listener_->contact(*this, event);
}

/// Where a body has come in at the other side, or an image has been made, what it passes through is known already.
template <int Degree>
void PeriodicWorld<Degree>::overlap(World<Degree>&, const PairEvent& pair) {
  const PeriodicEvent event = event_of(pair);
  if (real(event.a).placed_at != now() && real(event.b).placed_at != now()) return;
  told_ = true;
  listener_->overlap(*this, event);
}

template <int Degree>
void PeriodicWorld<Degree>::passes(World<Degree>&, const PairEvent& pair) {
  told_ = true;
  listener_->passes(*this, event_of(pair));
}

/// An image meets the wall at the same time as its body, and follows it.
template <int Degree>
void PeriodicWorld<Degree>::wall(World<Degree>&, const WallEvent& in_world) {
  const BodySlot slot = role(in_world.body).owner;
  Real& body = reals_[slot];
  if (body.in_world != in_world.body) return;
  WallEvent event = in_world;
  event.body = id_of(slot);
  told_ = true;
  const double temperature = options_.wall_temperatures[static_cast<std::size_t>(event.wall)];
  if (temperature > 0 && body.inverse_mass != 0) {
    Motion motion = world_.free_motion(body.in_world).restarted(event.contact.time);
    const double inward = event.wall % 2 == 0 ? 1 : -1;
    motion.coefficients[1] = thermal_.through_plane(event.wall / 2, inward, temperature * body.inverse_mass);
    take_up(body, motion);
  } else {
    follow(body);
  }
  listener_->wall(*this, event);
}

template <int Degree>
void PeriodicWorld<Degree>::moved(World<Degree>&, BodyId in_world) {
  Real& body = reals_[role(in_world).owner];
  if (body.in_world == in_world) follow(body);
}

#define KDS_INSTANTIATE(degree) template class PeriodicWorld<degree>;
KDS_INSTANTIATE(1)
KDS_INSTANTIATE(2)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
