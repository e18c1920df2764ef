#include "collision/world/world_parts.hpp"

#include "collision/motions.hpp"
#include "collision/world/new_broad_phase.hpp"
#include "kds/arithmetic/strict.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

/// Returns the options, or throws.
const WorldOptions& validated(const WorldOptions& options) {
  require_strict_arithmetic("World");
  validate(options);
  return options;
}

struct PairCollector final : PairListener {
  std::vector<std::pair<BodySlot, BodySlot>> pairs;
  void pair_began(BodySlot a, BodySlot b, double) override { pairs.emplace_back(a, b); }
  void pair_ended(BodySlot a, BodySlot b, double) override { std::erase(pairs, std::pair(a, b)); }
};

}  // namespace

template <class Motion>
WorldParts<Motion>::WorldParts(const WorldOptions& given)
    : options(validated(given)),
      clock{options.start_time, options.start_time + options.window},
      tumbling(bodies, options, counters),
      volumes(bodies, options, clock),
      walls(bodies, options.walls, clock),
      resting(bodies, options, clock),
      pairs(bodies, volumes, resting, reports, options, clock, counters, profile()),
      unbounded(bodies, clock, pairs),
      self_contacts(bodies, clock) {
  make_broad_phase();
}

template <class Motion>
void WorldParts<Motion>::make_broad_phase() {
  const auto box_of = [this](BodySlot slot) { return volumes.box(slot); };
  broad_phase = new_broad_phase<Motion::degree>(options, clock.now, profile(), box_of, volumes.kdops());
  broad_phase->extend_horizon(clock.now, clock.horizon);
  expected = 0;
  pairs.expect_exact(broad_phase->exact());
}

template <class Motion>
void WorldParts<Motion>::rebuild_broad_phase() {
  make_broad_phase();
  broad_phase->reserve(reserved);
  PairCollector found;
  std::vector<typename BroadPhase<Motion::degree>::Entry> entries;
  std::vector<KineticBox<Motion::degree>> boxes;
  for (BodySlot slot = 0; slot < bodies.slots(); ++slot) {
    if (!bodies[slot].entered || !bodies.in_broad_phase(slot)) continue;
    entries.push_back({slot, nullptr});
    boxes.push_back(volumes.renew(slot));
    volumes.schedule(slot);
  }
  for (std::size_t i = 0; i < entries.size(); ++i) entries[i].box = &boxes[i];
  broad_phase->insert(entries, clock.now, found);
  unbounded.find();
  unbounded.every_pair([&](BodySlot a, BodySlot b) { found.pair_began(a, b, clock.now); });
  std::sort(found.pairs.begin(), found.pairs.end());
  pairs.list_anew(found.pairs);
}

template <class Motion>
void WorldParts<Motion>::go_back(double t) {
  if (clock.now == t) return;
  clock.now = t;
  counters.broad_phase = all_counters().broad_phase;
  rebuild_broad_phase();
}

template <class Motion>
void WorldParts<Motion>::extend_horizon(double limit) {
  if (!(limit > clock.horizon)) return;
  constexpr double farthest = 1;  // s, for bodies that turn, whose contacts are searched turn by turn
  const double window = turns<Motion> ? std::min(options.window, farthest) : options.window;
  clock.horizon = std::max(limit, clock.horizon + window);
  broad_phase->extend_horizon(clock.now, clock.horizon);
  list().each([](auto& part) { part.extend_horizon(); });
}

template <class Motion>
void WorldParts<Motion>::reserve(std::size_t size) {
  if (size > no_body) {
    throw std::length_error("World::reserve: " + std::to_string(size) + " bodies are more than there are slots");
  }
  bodies.reserve(size);
  walls.reserve(size);
  if (size <= reserved) return;
  reserved = static_cast<BodySlot>(size);
  broad_phase->reserve(reserved);
  pairs.reserve(reserved);
}

template <class Motion>
Motion WorldParts<Motion>::free_motion(BodySlot slot, double t) const {
  if (!resting.carries(slot)) return bodies.motion(slot);
  Motion motion = bodies.motion(slot).restarted(t);
  for (std::size_t i = 2; i <= Motion::degree; ++i) {
    if constexpr (turns<Motion>) {
      motion.path.coefficients[i] = bodies.free_term(slot, i, t);
    } else {
      motion.coefficients[i] = bodies.free_term(slot, i, t);
    }
  }
  return motion;
}

template <class Motion>
WorldCounters WorldParts<Motion>::all_counters() const {
  WorldCounters all = counters;
  all.broad_phase = counters.broad_phase + broad_phase->counters();  // and before it was loaded
  return all;
}

#define KDS_INSTANTIATE(motion) template struct WorldParts<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
