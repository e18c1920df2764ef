// The state of a world as plain data: the sum of its parts' images.
#pragma once

#include "collision/world/bodies_image.hpp"
#include "collision/world/edits/checked_pieces.hpp"
#include "collision/world/engine.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/reports_image.hpp"
#include "collision/world/world_part.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace kds::collision {

/// Throws std::runtime_error if a body of this image turns that keeps its orientation, or will, or may with the body
/// that it is attached to. `to_come`: pieces of motion, by slot.
template <class Motion>
void check_orientations([[maybe_unused]] const typename Bodies<Motion>::Image& bodies,
                        [[maybe_unused]] const std::vector<std::vector<Motion>>& to_come) {
  if constexpr (turns<Motion>) {
    const auto still = [](const Motion& piece) { return piece.angular_velocity.isZero(0); };
    for (BodySlot slot = 0; slot < bodies.bodies.size(); ++slot) {
      if (!bodies.alive(slot) || !keeps_orientation(bodies.bodies[slot].placed.shape)) continue;
      const std::vector<Motion> none, &later = slot < to_come.size() ? to_come[slot] : none;
      image::require(still(bodies.bodies[slot].motion) && std::all_of(later.begin(), later.end(), still) &&
                         bodies.owner(slot) == no_body,
                     "bodies", slot, "it keeps its orientation, and turns");
    }
  }
}

/// A copy of all that decides later events. Broad phases and times that are functions of the motions are not in it.
/// State that depends on the past is: contact times of known pairs, the places of resting contacts, pairs that are let
/// pass, the counts of the Zeno policy, reports not yet made. If it is of a world that has lent its bodies, there is
/// none of this but the timers.
template <class Motion>
struct Engine<Motion>::Image {
  double now = 0, callers_now = 0, horizon = 0, looked_for_until = never;
  WorldCounters counters;
  EditLimit edits;
  typename Bodies<Motion>::Image bodies;
  typename decltype(std::declval<WorldParts<Motion>&>().list())::Images parts;
  std::vector<Reports::Report> pending;

  template <class Archive>
  void archive(Archive& archive, const std::vector<std::shared_ptr<const Mesh>>& known) {
    archive(now, callers_now, horizon, looked_for_until, counters, edits);
    bodies.archive(archive, known);
    std::apply([&](auto&... part) { (part.archive(archive), ...); }, parts);
    if (!bodies.lent()) archive(pending);
  }

  /// Throws std::runtime_error, naming what is wrong, unless it may be an image of a world with these options, which
  /// can then become it.
  void check(const WorldOptions& options) const {
    if (!std::isfinite(now)) image::fail("now: is not finite");
    if (!image::is_to_come(horizon, now)) image::fail("horizon: is before now");
    if (std::isnan(looked_for_until)) image::fail("looked_for_until: is not a number");
    if (!std::isfinite(callers_now) || callers_now > now) image::fail("clock: is after now, or not finite");
    if (!edits.began_by(now)) image::fail("edits: are counted from a time after now");
    bodies.check(now);
    std::apply([&](const auto&... part) { (part.check(bodies, now, options), ...); }, parts);
    const auto& scripts = std::get<typename Scripts<Motion>::Image>(parts);
    check_orientations(bodies, scripts.of);
    std::vector<char> enters(bodies.bodies.size());
    for (const BodySlot slot : bodies.waiting) enters[slot] = 1;
    for (BodySlot slot = 0; slot < bodies.bodies.size(); ++slot) {
      const bool later = slot < scripts.of.size() && !scripts.of[slot].empty();
      const BodySlot owner = bodies.owner(slot);
      const bool with_owner = owner != no_body && !bodies.entered(owner);
      image::require(!bodies.alive(slot) || bodies.entered(slot) || enters[slot] || later || with_owner, "bodies", slot,
                     "it never enters");
    }
    check_reports(pending, bodies, now);
  }
};

}  // namespace kds::collision
