// How bodies are added to the world and removed.
#include "collision/free_turning.hpp"
#include "collision/in_parts.hpp"
#include "collision/motions.hpp"
#include "collision/profile.hpp"
#include "collision/response/inertia.hpp"
#include "collision/response/mass_properties.hpp"
#include "collision/response/principal_inertia.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/number_text.hpp"
#include "collision/vectors.hpp"
#include "collision/world/checked_pieces.hpp"
#include "collision/world/engine.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace kds::collision {
namespace {

/// The least ratio of the least to the greatest moment of inertia of a body that precesses.
constexpr double flattest_inertia = 0x1p-40;

template <class Motion>
void validate(const BasicBodyDescription<Motion>& description) {
  const auto fail = [](const std::string& what) { throw std::invalid_argument(what); };
  if (description.motion.empty()) fail("motion: has no piece");
  require_pieces(std::span<const Motion>(description.motion), "motion");
  if (!description.fixed) require_size(description.mass, "mass");
  if (!can_move_by<Motion>(description.shape)) {
    const std::string name = std::string("shape: a ") + kind_name(description.shape);
    fail(name + " cannot move on paths of degree " + std::to_string(Motion::degree) + ": at most 2");
  }
  if constexpr (turns<Motion>) {
    for (std::size_t i = 0; i < description.motion.size(); ++i) {
      require_no_spin(description.shape, description.motion[i], "motion[" + std::to_string(i) + "]");
    }
    if (description.orientation.coeffs() != Eigen::Quaterniond::Identity().coeffs()) {
      fail("orientation: a body that turns has that of its motion");
    }
    if (description.inertia.moment() != 0) require_size(description.inertia.moment(), "inertia");
    if (description.inertia.tensor()) require_size(checked_inertia(*description.inertia.tensor())(0, 0), "inertia");
    if (!(description.friction >= 0 && description.friction <= largest_magnitude)) {
      fail("friction: must be in [0, " + detail::power_text(largest_magnitude) + "]");
    }
    if (!(std::abs(description.tangential_restitution) <= 1)) fail("tangential_restitution: must be in [-1, 1]");
    if (!(description.rolling_friction >= 0 && description.rolling_friction <= largest_magnitude)) {
      fail("rolling_friction: must be in [0, " + detail::power_text(largest_magnitude) + "]");
    }
  } else {
    const auto refuse = [&](const char* member) { fail(std::string(member) + ": bodies of this world do not turn"); };
    if (description.inertia.moment() != 0 || description.inertia.tensor()) refuse("inertia");
    if (description.friction != 0) refuse("friction");
    if (description.tangential_restitution != 0) refuse("tangential_restitution");
    if (description.rolling_friction != 0) refuse("rolling_friction");
  }
  switch (description.volume) {
    case BoundingVolume::shape:
    case BoundingVolume::sphere:
      break;
    default:
      fail("volume: unknown");
  }
  if (unbounded(description.shape)) {
    const std::string name = kind_name(description.shape);
    if (!description.fixed) fail("fixed: a " + name + " has no mass: it has to be fixed");
    if (description.box) fail("box: a " + name + " has no bounding box");
    if (description.volume != BoundingVolume::shape) fail("volume: a " + name + " has no bounding sphere");
  }
  if (description.self_contacts && !bends(description.shape)) {
    fail(std::string("self_contacts: a ") + kind_name(description.shape) + " does not bend, and never meets itself");
  }
  if (!(description.restitution >= 0 && description.restitution <= 1)) fail("restitution: must be in [0, 1]");
}

/// The tensor of inertia of a body that turns freely. Precondition: the description is valid, and gives no moment.
template <class Motion>
Eigen::Matrix3d tensor_of(const BasicBodyDescription<Motion>& description) {
  const Shape& shape = description.shape;
  if (description.inertia.tensor()) return checked_inertia(*description.inertia.tensor());
  const MassProperties solid = mass_properties(shape, description.mass);
  if (!(solid.centre.norm() <= inertia_tolerance * place(shape, Eigen::Quaterniond::Identity()).bounding_radius)) {
    std::ostringstream text;
    text << "inertia: the centre of mass of this " << kind_name(shape) << " is at (" << solid.centre[0] << ", "
         << solid.centre[1] << ", " << solid.centre[2]
         << "), and free bodies turn about their origin: subtract it from the "
         << (std::holds_alternative<Compound>(shape) ? "positions of the parts" : "vertices")
         << ", or give their inertia";
    throw std::invalid_argument(text.str());
  }
  return solid.inertia;
}

}  // namespace

template <class Motion>
void Engine<Motion>::reserve(std::size_t bodies) {
  require_editable("World::reserve");
  if (bodies > no_body) {
    throw std::length_error("World::reserve: " + std::to_string(bodies) + " bodies are more than there are slots");
  }
  bodies_.reserve(bodies);
  walls_.reserve(bodies);
  if (bodies <= reserved_) return;
  reserved_ = static_cast<BodySlot>(bodies);
  broad_phase_->reserve(reserved_);
  pairs_.reserve(reserved_);
}

/// A sensor with the motion of its owner.
template <class Motion>
BodyId Engine<Motion>::add_attached(const Description& description) {
  const auto fail = [](const std::string& what) { throw std::invalid_argument(what); };
  const BodySlot owner = bodies_.slot_of(*description.attached_to);
  if (!description.sensor) fail("attached_to: only a sensor can be attached to a body");
  if (!description.motion.empty()) fail("motion: a sensor that is attached to a body has the motion of that");
  if (bodies_.attachments().owner(owner) != no_body) {
    fail("attached_to: body " + std::to_string(*description.attached_to) + " is attached to another itself");
  }
  if (turns<Motion> && keeps_orientation(description.shape)) {
    fail(std::string("attached_to: a ") + kind_name(description.shape) + " does not turn, as body " +
         std::to_string(*description.attached_to) + " may");
  }
  Description alone = description;
  alone.attached_to.reset();
  alone.motion = {bodies_.motion(owner)};
  const BodyId id = add_body(alone);
  scripts_.clear(body_slot(id));  // Its owner's begins both.
  bodies_.attach(body_slot(id), owner);
  return id;
}

template <class Motion>
BodyId Engine<Motion>::add_body(const Description& description) {
  require_editable("World::add_body");
  if (description.attached_to) return add_attached(description);
  validate(description);
  if (collision::bends(description.shape) && options_.response != Response::none && !description.sensor &&
      !description.fixed) {
    throw std::invalid_argument("fixed: contacts do not move a mesh that bends: it has to be fixed, or a sensor");
  }
  std::optional<PrincipalInertia> principal;  // of one that precesses
  if constexpr (turns<Motion>) {
    // Nothing else changes how a body turns.
    const bool responds = options_.response == Response::elastic && !description.fixed && !description.sensor;
    if (responds && description.inertia.moment() == 0) {
      const Eigen::Matrix3d tensor = tensor_of(description);
      if (is_spherical(tensor)) {
        Description whole = description;
        whole.inertia = tensor(0, 0);
        return add_body(whole);
      }
      principal = principal_inertia(tensor);
      if (!(principal->moments.minCoeff() >= flattest_inertia * principal->moments.maxCoeff())) {
        throw std::invalid_argument("inertia: its least moment must be at least " +
                                    detail::power_text(flattest_inertia) + " of the greatest");
      }
      for (std::size_t i = 0; i < description.motion.size(); ++i) {
        require_steady_clock(description.motion[i], clock_.now, "motion[" + std::to_string(i) + "]");
      }
    }
  }
  count_edit();
  const double ball = ball_radius(description.shape);
  std::shared_ptr<const PlacedShape> shape;
  if (ball > 0 && description.orientation.coeffs() == Eigen::Quaterniond::Identity().coeffs()) [[likely]] {
    require_radius(ball);
  } else {
    shape = std::make_shared<const PlacedShape>(place(description.shape, description.orientation));
  }
  return bodies_.id_of(change_or_fail([&] { return put(description, std::move(shape), principal); }));
}

/// Null for a ball that is not rotated.
template <class Motion>
inline BodySlot Engine<Motion>::put(const Description& description, std::shared_ptr<const PlacedShape> shape,
                                    [[maybe_unused]] const std::optional<PrincipalInertia>& principal) {
  // Pieces that are over are skipped; the rest is a script.
  auto piece = description.motion.begin();
  while (std::next(piece) != description.motion.end() && path_of(*std::next(piece)).start <= clock_.now) ++piece;
  if (has_mesh(description.shape)) make_room_for_meshes();
  const BodySlot slot = bodies_.add(description, std::move(shape), *piece);
  if constexpr (turns<Motion>) {
    if (principal) {
      bodies_[slot].tumbles = true;
      tumbling_.add(slot, *principal);
    }
  }
  if (path_of(*piece).start <= clock_.now) {
    if (tumbling_.has(slot)) bodies_.move(slot, tumbling_.take_up(slot, *piece, clock_.now));
    bodies_.wait(slot);
    ++piece;
  }
  volumes_.add(slot, description.box);
  if (piece != description.motion.end()) scripts_.add(slot, {piece, description.motion.end()});
  return slot;
}

/// As soon as there is a mesh all volumes include contact gaps: this enlarges the volumes of the bodies that are there.
template <class Motion>
void Engine<Motion>::make_room_for_meshes() {
  if (!volumes_.make_room_for_meshes()) return;
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
    if (bodies_[slot].entered) update_volume(slot, volumes_.box(slot));
  }
}

/// Tells the broad phase of a volume that has changed although nothing has moved.
template <class Motion>
void Engine<Motion>::update_volume(BodySlot slot, const KineticBox<Motion::degree>& box) {
  if (bodies_.in_broad_phase(slot)) broad_phase_->update(slot, box, clock_.now, pairs_);
  pairs_.box_changed(slot);
  volumes_.schedule(slot);
}

/// Tells the broad phase of all bodies that are about to enter; if they do so in several parts, before the first.
template <class Motion>
void Engine<Motion>::expect_new_bodies() {
  constexpr std::size_t sample = 256;
  expected_ = bodies_.slots();
  const std::span<const BodySlot> waiting = bodies_.waiting();
  const std::size_t step = std::max<std::size_t>(waiting.size() / sample, 1);
  std::vector<Entry> entries;
  std::vector<KineticBox<Motion::degree>> boxes;
  boxes.reserve(waiting.size() / step + 1);
  for (std::size_t i = 0; i < waiting.size(); i += step) {
    const BodySlot slot = waiting[i];
    if (slot == no_body || !bodies_.in_broad_phase(slot) || volumes_.from_caller(slot)) continue;
    boxes.push_back(volumes_.renew(slot));
    entries.push_back({slot, &boxes.back()});
  }
  broad_phase_->expect(bodies_.waits(), static_cast<BodySlot>(bodies_.slots()), entries, clock_.now);
}

template <class Motion>
void Engine<Motion>::enter_new_bodies(std::size_t most) {
  if (most < bodies_.waits() && expected_ < bodies_.slots()) expect_new_bodies();
  enter(bodies_.take_waiting(most), Begin::entering);
}

template <class Motion>
void Engine<Motion>::enter(std::span<const BodySlot> entering, Begin begin) {
  // Events of the others that are due now come first, so that they are not attributed to the new bodies.
  while (broad_phase_->advance(clock_.now, pairs_)) {
  }
  std::vector<BodySlot> unbounded;
  std::vector<Entry> entries;
  entries.reserve(entering.size());
  for (const BodySlot slot : entering) {
    Body& b = bodies_[slot];
    if (!b.alive || b.entered) continue;
    b.entered = true;
    if (bodies_.unbounded(slot)) {
      unbounded.push_back(slot);
      continue;
    }
    entries.push_back({slot, nullptr});
  }
  const auto boxes = std::make_unique_for_overwrite<KineticBox<Motion::degree>[]>(entries.size());
  // The functions of callers are called by the calling thread, and in order.
  const std::size_t threads = volumes_.any_from_callers() ? 1 : threads_for(entries.size(), options_.threads);
  in_parts(entries.size(), threads, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      entries[i].box = new (&boxes[i]) KineticBox<Motion::degree>(volumes_.renew(entries[i].slot));  // not copied there
    }
  });
  const std::span<const Entry> all(entries);
  std::size_t colliding = entries.size();
  if (bodies_.filters()) {
    const auto rest = std::stable_partition(entries.begin(), entries.end(),
                                            [&](const Entry& entry) { return bodies_.in_broad_phase(entry.slot); });
    colliding = static_cast<std::size_t>(rest - entries.begin());
  }
  pairs_.set_begin(begin);
  {
    const Stopwatch watch(profile(), Work::update);
    broad_phase_->insert(all.first(colliding), clock_.now, pairs_);
  }
  if (!unbounded_.empty()) {
    for (const Entry& entry : entries) unbounded_.begin_pairs(entry.slot);
  }
  for (const BodySlot slot : unbounded) unbounded_.add(slot, begin);
  pairs_.set_begin(Begin::moving);
  walls_.schedule(entries);
  for (const Entry& entry : entries) {
    if (!self_contacts_.enter(entry.slot)) continue;
    const BodyId id = bodies_.id_of(entry.slot);
    reports_.add(Reports::Kind::overlap, id, id, self_contacts_.contact(entry.slot));
  }
  if (!volumes_.any_ends()) return;
  for (const Entry& entry : entries) volumes_.schedule(entry.slot);
}

template <class Motion>
void Engine<Motion>::take_up_bounce() {
  if (bounced_ == no_body) return;
  const BodySlot slot = std::exchange(bounced_, no_body);
  set_motion(slot, Motion(bodies_.motion(slot)), false);
}

template <class Motion>
void Engine<Motion>::remove_body(BodyId id) {
  require_editable("World::remove_body", bodies_.contains(id) ? body_slot(id) : no_body);
  const BodySlot slot = bodies_.slot_of(id);
  count_edit();
  change_or_fail([&] {
    while (!bodies_.attachments().sensors(slot).empty()) take_out(bodies_.attachments().sensors(slot).front());
    take_out(slot);
  });
}

template <class Motion>
void Engine<Motion>::take_out(BodySlot slot) {
  if (bounced_ == slot) bounced_ = no_body;
  resting_.forget(slot);
  if (self_contacts_.touching(slot)) {  // Reports the separation, or nothing if the overlap has not been reported yet.
    const BodyId id = bodies_.id_of(slot);
    if (!reports_.take_back(Reports::Kind::overlap, id, id)) {
      reports_.add(Reports::Kind::separation, id, id, self_contacts_.contact(slot));
    }
  }
  self_contacts_.remove(slot);
  scripts_.clear(slot);
  tumbling_.remove(slot);
  walls_.remove(slot);
  if (bodies_[slot].entered && bodies_.in_broad_phase(slot)) broad_phase_->remove(slot, clock_.now, pairs_);
  unbounded_.remove(slot);
  volumes_.remove(slot);
  pairs_.remove(slot);
  reports_.forget(bodies_.id_of(slot), bodies_[slot].user_data);
  bodies_.remove(slot);
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
