#include "examples/jobs/conjunctions/screening.hpp"

#include "collision/world.hpp"
#include "examples/jobs/conjunctions/passes.hpp"
#include "examples/jobs/conjunctions/trajectory.hpp"
#include "examples/jobs/cpu_time.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace conjunctions {
namespace {

using namespace kds::collision;

/// Ids of bodies are places in the catalogue, since none is removed.
class Listener : public WorldListener<5> {
 public:
  explicit Listener(Passes& passes) : passes_(passes) {}

  void contact(World<5>& world, const PairEvent& event) override { begin(world, event, false); }
  /// Near at the start.
  void overlap(World<5>& world, const PairEvent& event) override { begin(world, event, true); }
  void separation(World<5>&, const PairEvent& event) override { passes_.end(event.a, event.b, event.contact.time); }

  /// Motions change no more before `until`.
  void look_ahead(const World<5>& world, double until) {
    until_ = until;
    passes_.visit([&](BodyId a, BodyId b) { look(world, a, b); });
  }

 private:
  void begin(const World<5>& world, const PairEvent& event, bool at_start) {
    passes_.begin(event.a, event.b, event.contact.time, at_start);
    look(world, event.a, event.b);
  }
  void look(const World<5>& world, BodyId a, BodyId b) {
    passes_.look(a, b, world.motion(a), world.motion(b), world.now(), until_);
  }

  Passes& passes_;
  double until_ = 0;
};

}  // namespace

void check(const Screening& options) {
  const auto require = [](const char* name, double value) {
    if (!(value > 0 && value < 1e6)) {
      throw std::invalid_argument(std::string("Screening.") + name + ": " + std::to_string(value) +
                                  " is not between 0 and a million");
    }
  };
  require("distance", options.distance);
  require("hours", options.hours);
}

ScreeningCost screen(std::span<const Elements> catalogue, const Screening& options,
                     const std::function<void(const Conjunction&)>& found) {
  check(options);
  ScreeningCost cost;
  jobs::CpuTime time;
  const double end = options.hours * 3600;
  Passes passes(options.distance, found);
  Listener listener(passes);
  World<5> world({.window = tick, .response = Response::none}, &listener);
  world.reserve(catalogue.size());
  std::vector<Trajectory> trajectories(catalogue.begin(), catalogue.end());
  std::vector<std::pair<BodyId, Path>> pieces;
  for (int k = 0; k * tick < end; ++k) {
    pieces.clear();
    for (std::size_t i = 0; i < trajectories.size(); ++i) {
      if (trajectories[i].ends_at(k)) pieces.emplace_back(i, trajectories[i].next());
    }
    cost.pieces += pieces.size();
    time.charge(cost.interpolation);
    for (const auto& [id, piece] : pieces) {
      if (k == 0) {
        world.add_body({.shape = Sphere{options.distance / 2}, .motion = {piece}});
      } else {
        world.update_motion(id, piece);
      }
    }
    time.charge(cost.broad_phase);
    const double until = std::min((k + 1) * tick, end);
    listener.look_ahead(world, until);
    world.advance_to(until);
    time.charge(cost.pairs);
  }
  passes.end_all(end);
  cost.candidates = world.counters().pair_tests;
  return cost;
}

}  // namespace conjunctions
