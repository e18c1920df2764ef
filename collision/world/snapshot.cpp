// Worlds saved, and loaded again: the sum of their parts.
#include "kds/framework/snapshot.hpp"
#include "collision/motions.hpp"
#include "collision/world/engine.hpp"
#include "collision/world/engine_image.hpp"
#include "collision/world/image_tools.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace kds::collision {
namespace {

/// The version of the image's layout: it changes with the members, so that bytes of another layout are refused as such.
constexpr int snapshot_form = 16;

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

template <class Motion>
typename Engine<Motion>::Image Engine<Motion>::image() const {
  using Parts = decltype(parts());
  static_assert(Parts::template all_are_parts<typename Bodies<Motion>::Image> && Parts::in_order());
  return {.now = clock_.now,
          .callers_now = callers_now_,
          .horizon = clock_.horizon,
          .looked_for_until = looked_for_until_,
          .counters = counters(),
          .edits = edits_,
          .bodies = bodies_.image(),
          .parts = parts().images(),
          .pending = reports_.image()};
}

template <class Motion>
typename Engine<Motion>::Image Engine<Motion>::image_without_bodies(double t) const {
  Image image;
  image.now = image.callers_now = t;
  image.horizon = t + options_.window;
  image.counters = counters();
  image.edits = edits_;
  image.bodies = bodies_.image_without_bodies();
  std::get<Timers::Image>(image.parts) = timers_.image();
  std::get<typename Volumes<Motion>::Image>(image.parts) = volumes_.image();
  return image;
}

template <class Motion>
void Engine<Motion>::become(const Image& image) {
  const auto change = [&] {
    clock_ = {image.now, image.horizon};
    callers_now_ = image.callers_now;
    looked_for_until_ = image.looked_for_until;
    idle_until_ = next_time_ = -never;
    idle_for_ever_ = false;
    edits_ = image.edits;
    bodies_.become(image.bodies);
    reports_.become(image.pending);
    parts().become(image.parts);
    rebuild_broad_phase();
    counters_ = image.counters;
    counters_.broad_phase = image.counters.broad_phase - broad_phase_->counters();
  };
  change_or_fail(change);
  failure_ = nullptr;
}

template <class Motion>
template <class Archive>
void Engine<Motion>::archive(Archive& archive, Image& image) const {
  // A world that is broken by an exception may be loaded: then it is valid again.
  if (!Archive::loading || stepping_ || volumes_.calling()) require_idle("World::archive");
  archive.tag((turns<Motion> ? "World of bodies that turn, of degree " : "World of degree ") +
              std::to_string(Motion::degree) + ", form " + std::to_string(snapshot_form));
  archive_options(archive, options_, broad_phase_->exact(), turns<Motion>);
  image.archive(archive, bodies_.meshes());
  if constexpr (Archive::loading) image.check(options_);
}

template <class Motion>
template <class Archive>
void Engine<Motion>::archive(Archive& archive) {
  if constexpr (Archive::loading) {
    Image loaded;
    this->archive(archive, loaded);
    if (loaded.bodies.lent()) image::fail("it is of a scene in parts, and its bodies are in these");
    become(loaded);
  } else {
    require_idle("World::archive");
    Image saved = image();
    this->archive(archive, saved);
  }
}

#define KDS_INSTANTIATE(motion)                                              \
  KDS_TEMPLATE_PART class Engine<motion>;                                    \
  template void Engine<motion>::archive(kds::detail::Writer&);               \
  template void Engine<motion>::archive(kds::detail::Reader&);               \
  template void Engine<motion>::archive(kds::detail::Writer&, Image&) const; \
  template void Engine<motion>::archive(kds::detail::Reader&, Image&) const;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
