// Worlds saved, and loaded again: the sum of their parts.
#include "kds/framework/snapshot.hpp"
#include "collision/motions.hpp"
#include "collision/world/bodies_image.hpp"
#include "collision/world/checked_pieces.hpp"
#include "collision/world/engine.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/reports_image.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision {
namespace {

/// The version of the image's layout: it changes with the members, so that bytes of another layout are refused as such.
constexpr int snapshot_form = 11;

/// Options that decide events. Broad phase, window, threads and profile may differ.
template <class Archive>
void archive_options(Archive& archive, const WorldOptions& options, bool exact, bool turns_bodies) {
  const auto same = [&](const char* what, auto value) {
    auto found = value;
    archive(found);
    if (found != value) {
      throw std::runtime_error(std::string("snapshot: it is of a world with other options: ") + what);
    }
  };
  same("response", static_cast<std::uint32_t>(options.response));
  same("walls", std::uint32_t{options.walls.has_value()});
  if (options.walls) {
    for (int d = 0; d < 3; ++d) same("walls", options.walls->min[d]), same("walls", options.walls->max[d]);
    same("walls.restitution", options.walls->restitution);
  }
  same("zeno.contacts", options.zeno.contacts);
  same("zeno.interval", options.zeno.interval);
  same("shortest_flight", options.shortest_flight);
  if (turns_bodies) same("orientation_error", options.orientation_error);
  same("report_pieces", std::uint32_t{options.report_pieces});
  same("report_pairs", std::uint32_t{options.report_pairs});
  if (!options.report_pairs) return;
  same("broad_phase, which reports its pairs", std::uint32_t{exact});
  same("kdop, whose pairs are reported", options.kdop);
}

}  // namespace

/// A copy of all that decides later events. Broad phases and times that are functions of the motions are not in it.
/// State that depends on the past is: contact times of known pairs, the places of resting contacts, pairs that are let
/// pass, the counts of the Zeno policy, reports not yet made.
template <class Motion>
struct Engine<Motion>::Image {
  double now = 0, callers_now = 0, horizon = 0;
  bool room_for_meshes = false;
  WorldCounters counters;
  EditLimit edits;
  typename Bodies<Motion>::Image bodies;
  typename Scripts<Motion>::Image scripts;
  Timers::Image timers;
  typename Tumbling<Motion>::Image tumbling;
  typename Pairs<Motion>::Image pairs;
  typename SelfContacts<Motion>::Image self_contacts;
  typename Resting::Image resting;
  std::vector<Reports::Report> pending;

  template <class Archive>
  void archive(Archive& archive, const std::vector<std::shared_ptr<const Mesh>>& known) {
    archive(now, callers_now, horizon, room_for_meshes, counters, edits);
    bodies.archive(archive, known);
    archive(scripts, timers, tumbling, pairs, self_contacts, resting, pending);
  }

  /// Throws std::runtime_error if a body turns that keeps its orientation, or will, or may with the body that it is
  /// attached to.
  void check_orientations() const {
    if constexpr (turns<Motion>) {
      const auto still = [](const Motion& piece) { return piece.angular_velocity.isZero(0); };
      for (BodySlot slot = 0; slot < bodies.bodies.size(); ++slot) {
        if (!bodies.alive(slot) || !keeps_orientation(bodies.bodies[slot].placed.shape)) continue;
        const std::vector<Motion> none, &later = slot < scripts.of.size() ? scripts.of[slot] : none;
        image::require(still(bodies.bodies[slot].motion) && std::all_of(later.begin(), later.end(), still) &&
                           bodies.owner(slot) == no_body,
                       "bodies", slot, "it keeps its orientation, and turns");
      }
    }
  }

  /// Throws std::runtime_error, naming what is wrong, unless it may be an image of a world with these options, which
  /// can then become it.
  void check(const WorldOptions& options) const {
    if (!std::isfinite(now)) image::fail("now: is not finite");
    if (!image::is_to_come(horizon, now)) image::fail("horizon: is before now");
    if (!std::isfinite(callers_now) || callers_now > now) image::fail("clock: is after now, or not finite");
    if (!edits.began_by(now)) image::fail("edits: are counted from a time after now");
    bodies.check(now);
    scripts.check(now, [&](BodySlot slot) { return bodies.alive(slot); });
    timers.check(now);
    check_orientations();
    tumbling.check(bodies, now);
    std::vector<char> enters(bodies.bodies.size());
    for (const BodySlot slot : bodies.waiting) enters[slot] = 1;
    for (BodySlot slot = 0; slot < bodies.bodies.size(); ++slot) {
      const bool later = slot < scripts.of.size() && !scripts.of[slot].empty();
      const BodySlot owner = bodies.owner(slot);
      const bool with_owner = owner != no_body && !bodies.entered(owner);
      image::require(!bodies.alive(slot) || bodies.entered(slot) || enters[slot] || later || with_owner, "bodies", slot,
                     "it never enters");
    }
    pairs.check(bodies, now, options);
    self_contacts.check(bodies);
    resting.check(bodies, now, options);
    check_reports(pending, bodies, now);
  }
};

template <class Motion>
typename Engine<Motion>::Image Engine<Motion>::image() const {
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
    if (!volumes_.from_caller(slot)) continue;
    throw std::invalid_argument("World: body " + std::to_string(bodies_.id_of(slot)) +
                                " cannot be saved: it has a box function");
  }
  return {.now = clock_.now,
          .callers_now = callers_now_,
          .horizon = clock_.horizon,
          .room_for_meshes = volumes_.has_room_for_meshes(),
          .counters = counters(),
          .edits = edits_,
          .bodies = bodies_.image(),
          .scripts = scripts_.image(),
          .timers = timers_.image(),
          .tumbling = tumbling_.image(),
          .pairs = pairs_.image(),
          .self_contacts = self_contacts_.image(),
          .resting = resting_.image(),
          .pending = reports_.image()};
}

template <class Motion>
void Engine<Motion>::become(const Image& image) {
  clock_ = {image.now, image.horizon};
  callers_now_ = image.callers_now;
  idle_until_ = next_time_ = -never;
  idle_for_ever_ = false;
  edits_ = image.edits;
  bodies_.become(image.bodies);
  scripts_.become(image.scripts);
  timers_.become(image.timers);
  tumbling_.become(image.tumbling);
  volumes_.become(image.room_for_meshes);
  reports_.become(image.pending);
  resting_.become(image.resting);
  pairs_.become(image.pairs);
  self_contacts_.become(image.self_contacts);
  walls_.become();
  rebuild_broad_phase();
  counters_ = image.counters;
  counters_.broad_phase = image.counters.broad_phase - broad_phase_->counters();
}

template <class Motion>
template <class Archive>
void Engine<Motion>::archive(Archive& archive) {
  // A world that is broken by an exception may be loaded: then it is valid again.
  if (!Archive::loading || stepping_ || volumes_.calling()) require_idle("World::archive");
  archive.tag((turns<Motion> ? "World of bodies that turn, of degree " : "World of degree ") +
              std::to_string(Motion::degree) + ", form " + std::to_string(snapshot_form));
  archive_options(archive, options_, broad_phase_->exact(), turns<Motion>);
  if constexpr (Archive::loading) {
    Image loaded;
    loaded.archive(archive, bodies_.meshes());
    loaded.check(options_);
    change_or_fail([&] { become(loaded); });
    failure_ = nullptr;
  } else {
    Image saved = image();
    saved.archive(archive, {});
  }
}

#define KDS_INSTANTIATE(motion)                                \
  KDS_TEMPLATE_PART class Engine<motion>;                      \
  template void Engine<motion>::archive(kds::detail::Writer&); \
  template void Engine<motion>::archive(kds::detail::Reader&);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
