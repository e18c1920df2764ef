#include "collision/world/edits/edits.hpp"

#include "collision/free_turning.hpp"
#include "collision/in_parts.hpp"
#include "collision/motions.hpp"
#include "collision/profile.hpp"
#include "collision/response/inertia.hpp"
#include "collision/response/mass_properties.hpp"
#include "collision/response/principal_inertia.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/vectors.hpp"
#include "collision/world/edits/checked_pieces.hpp"
#include "kds/number_text.hpp"

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
      fail("friction: must be in [0, " + power_text(largest_magnitude) + "]");
    }
    if (!(std::abs(description.tangential_restitution) <= 1)) fail("tangential_restitution: must be in [-1, 1]");
    if (!(description.rolling_friction >= 0 && description.rolling_friction <= largest_magnitude)) {
      fail("rolling_friction: must be in [0, " + power_text(largest_magnitude) + "]");
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
Edits<Motion>::Edits(WorldParts<Motion>& parts, MotionUpdates<Motion>& motions, Membership<Motion>& membership,
                     Guard& guard, CallersClock& callers)
    : options_(parts.options),
      clock_(parts.clock),
      counters_(parts.counters),
      bodies_(parts.bodies),
      scripts_(parts.scripts),
      timers_(parts.timers),
      tumbling_(parts.tumbling),
      volumes_(parts.volumes),
      resting_(parts.resting),
      pairs_(parts.pairs),
      self_contacts_(parts.self_contacts),
      parts_(parts),
      motions_(motions),
      membership_(membership),
      guard_(guard),
      callers_(callers) {}

template <class Motion>
void Edits<Motion>::begin(const char* function, BodySlot removed) {
  guard_.require_changeable(function);
  const BodySlot late = motions_.awaiting_report();
  if (late != no_body && late != removed) guard_.change([&] { motions_.take_up_reported(); });
  if (!guard_.stepping() && clock_.now > callers_.now) [[unlikely]]
    guard_.change([&] { parts_.go_back(callers_.now); });
}

template <class Motion>
void Edits<Motion>::count(bool of_bodies) {
  const bool due_now = of_bodies || callers_.next_time == callers_.now;
  callers_.forget_next_event(due_now && !guard_.stepping() ? callers_.now : -never);
  if (!guard_.stepping()) return;
  limit_.count(clock_.now, options_.zeno.interval, std::max<std::uint64_t>(options_.most_edits, 64 * bodies_.size()));
}

template <class Motion>
void Edits<Motion>::reserve(std::size_t bodies) {
  begin("World::reserve");
  parts_.reserve(bodies);
}

/// A sensor with the motion of its owner.
template <class Motion>
BodyId Edits<Motion>::add_attached(const Description& description) {
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
BodyId Edits<Motion>::add_body(const Description& description) {
  begin("World::add_body");
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
        throw std::invalid_argument("inertia: its least moment must be at least " + power_text(flattest_inertia) +
                                    " of the greatest");
      }
      for (std::size_t i = 0; i < description.motion.size(); ++i) {
        require_steady_clock(description.motion[i], clock_.now, "motion[" + std::to_string(i) + "]");
      }
    }
  }
  count();
  const double ball = ball_radius(description.shape);
  std::shared_ptr<const PlacedShape> shape;
  if (ball > 0 && description.orientation.coeffs() == Eigen::Quaterniond::Identity().coeffs()) [[likely]] {
    require_radius(ball);
  } else {
    shape = std::make_shared<const PlacedShape>(place(description.shape, description.orientation));
  }
  return bodies_.id_of(guard_.change([&] { return put(description, std::move(shape), principal); }));
}

/// Null for a ball that is not rotated.
template <class Motion>
inline BodySlot Edits<Motion>::put(const Description& description, std::shared_ptr<const PlacedShape> shape,
                                   [[maybe_unused]] const std::optional<PrincipalInertia>& principal) {
  // Pieces that are over are skipped; the rest is a script.
  auto piece = description.motion.begin();
  while (std::next(piece) != description.motion.end() && path_of(*std::next(piece)).start <= clock_.now) ++piece;
  if (has_mesh(description.shape)) membership_.make_room_for_meshes();
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

template <class Motion>
void Edits<Motion>::remove_body(BodyId id) {
  begin("World::remove_body", bodies_.contains(id) ? body_slot(id) : no_body);
  const BodySlot slot = bodies_.slot_of(id);
  count();
  guard_.change([&] { membership_.take_out_with_sensors(slot); });
}

#define KDS_INSTANTIATE(motion) template class Edits<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
