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
constexpr int snapshot_form = 20;

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
  using List = decltype(parts_.list());
  static_assert(List::template all_are_parts<typename Bodies<Motion>::Image> && List::in_order());
  return {.now = clock_.now,
          .callers_now = callers_.now,
          .horizon = clock_.horizon,
          .looked_for_until = callers_.looked_for_until,
          .counters = parts_.all_counters(),
          .edits = edits_.limit(),
          .bodies = parts_.bodies.image(),
          .parts = parts_.list().images(),
          .pending = parts_.reports.image()};
}

template <class Motion>
typename Engine<Motion>::Image Engine<Motion>::image_without_bodies(double t) const {
  Image image;
  image.now = image.callers_now = t;
  image.horizon = t + parts_.options.window;
  image.counters = parts_.all_counters();
  image.edits = edits_.limit();
  image.bodies = parts_.bodies.image_without_bodies();
  std::get<Timers::Image>(image.parts) = parts_.timers.image();
  std::get<typename Volumes<Motion>::Image>(image.parts) = parts_.volumes.image();
  return image;
}

template <class Motion>
void Engine<Motion>::become(const Image& image) {
  const auto change = [&] {
    clock_ = {image.now, image.horizon};
    callers_.now = image.callers_now;
    callers_.looked_for_until = image.looked_for_until;
    callers_.forget_next_event();
    edits_.set_limit(image.edits);
    parts_.bodies.become(image.bodies);
    parts_.reports.become(image.pending);
    parts_.list().become(image.parts);
    parts_.rebuild_broad_phase();
    parts_.counters = image.counters;
    parts_.counters.broad_phase = image.counters.broad_phase - parts_.broad_phase->counters();
  };
  guard_.change(change);
  guard_.mend();
}

template <class Motion>
template <class Archive>
void Engine<Motion>::archive(Archive& archive, Image& image) const {
  // A world that is broken by an exception may be loaded: then it is valid again.
  if (!Archive::loading || guard_.stepping() || guard_.in_box_function()) guard_.require_idle("World::archive");
  archive.tag((turns<Motion> ? "World of bodies that turn, of degree " : "World of degree ") +
              std::to_string(Motion::degree) + ", form " + std::to_string(snapshot_form));
  archive_options(archive, parts_.options, parts_.broad_phase->exact(), turns<Motion>);
  image.archive(archive, parts_.bodies.meshes());
  if constexpr (Archive::loading) image.check(parts_.options);
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
    guard_.require_idle("World::archive");
    look_at_all();
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
