// How the motions of bodies are changed.
#include "collision/motion_range.hpp"
#include "collision/motions.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/world/edits/checked_pieces.hpp"
#include "collision/world/edits/edits.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace kds::collision {

template <class Motion>
void Edits<Motion>::update_motion(BodyId id, std::span<const Motion> pieces) {
  begin("World::update_motion");
  const BodySlot slot = bodies_.slot_of(id);
  require_own_motion(slot, "World::update_motion");
  constexpr const char* name = "World::update_motion: motion";
  if (pieces.empty()) throw std::invalid_argument(std::string(name) + ": has no piece");
  if (pieces.size() > 1) {
    require_pieces(pieces, name);
  } else if (!in_range(pieces[0])) {
    refuse_motion(pieces[0], name);
  }
  if (path_of(pieces[0]).start > clock_.now) {
    throw std::invalid_argument("World::update_motion: the motion starts at " + number_text(path_of(pieces[0]).start) +
                                ", after the clock at " + number_text(clock_.now));
  }
  require_turns_for(slot, pieces, name);
  count();
  auto next = std::upper_bound(pieces.begin(), pieces.end(), clock_.now,
                               [](double t, const Motion& piece) { return t < path_of(piece).start; });
  guard_.change([&] {
    const Motion& now = *std::prev(next);
    motions_.give(slot, tumbling_.has(slot) ? tumbling_.take_up(slot, now, clock_.now) : now);
    scripts_.add(slot, {next, pieces.end()});
  });
}

template <class Motion>
void Edits<Motion>::append_motion(BodyId id, std::span<const Motion> pieces) {
  begin("World::append_motion");
  const BodySlot slot = bodies_.slot_of(id);
  require_own_motion(slot, "World::append_motion");
  constexpr const char* name = "World::append_motion: motion";
  require_pieces(pieces, name);
  if (pieces.empty()) return;
  const double last = std::max(scripts_.last_start(slot), clock_.now);
  if (!(path_of(pieces[0]).start > last)) {
    throw std::invalid_argument(std::string(name) + "[0].start: " + number_text(path_of(pieces[0]).start) +
                                " is not after the clock and the last piece, " + number_text(last));
  }
  require_turns_for(slot, pieces, name);
  count();
  guard_.change([&] { scripts_.append(slot, pieces); });
}

/// Checks what is required of the motions of a body that keeps its orientation, and of one that precesses.
template <class Motion>
void Edits<Motion>::require_turns_for(BodySlot slot, std::span<const Motion> pieces, const char* name) const {
  if constexpr (turns<Motion>) {
    const bool keeps = bodies_[slot].shape && keeps_orientation(bodies_[slot].shape->shape);
    if (!tumbling_.has(slot) && !keeps) return;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      std::string one = name;
      if (pieces.size() > 1) one.append("[").append(std::to_string(i)).append("]");
      if (keeps) require_no_spin(bodies_[slot].shape->shape, pieces[i], one);
      if (tumbling_.has(slot)) require_steady_clock(pieces[i], clock_.now, one);
    }
  }
}

template <class Motion>
void Edits<Motion>::update_vertices(BodyId id, std::vector<MeshScript::Keyframe> keyframes) {
  begin("World::update_vertices");
  const BodySlot slot = bodies_.slot_of(id);
  if (!bodies_.bends(slot)) {
    throw std::invalid_argument("World::update_vertices: body " + std::to_string(id) + " is a " +
                                kind_name(bodies_.shape(slot).shape) + ", which does not bend");
  }
  const PlacedShape& before = *bodies_[slot].shape;
  const MeshScript& script = *std::get<BendingMesh>(before.shape).script;
  PlacedShape after;
  try {
    const BendingMesh bent{std::make_shared<const MeshScript>(script.continued(clock_.now, std::move(keyframes)))};
    after = place_turned(bent, before.rotation);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("World::update_vertices: ") + error.what());
  }
  count();
  guard_.change([&] {
    ++counters_.motion_updates;
    bodies_.set_shape(slot, std::move(after));
    volumes_.shape_changed(slot);
    if (bodies_[slot].entered) motions_.set(slot, bodies_.motion(slot), false);
    self_contacts_.changed(slot);
  });
}

template <class Motion>
void Edits<Motion>::require_own_motion(BodySlot slot, const char* function) const {
  const BodySlot owner = bodies_.attachments().owner(slot);
  if (owner == no_body) return;
  throw std::invalid_argument(std::string(function) + ": body " + std::to_string(bodies_.id_of(slot)) +
                              " is attached to body " + std::to_string(bodies_.id_of(owner)) + ", whose motion it has");
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Edits<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
