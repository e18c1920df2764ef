#include "tests/fuzz/random_piles/measure.hpp"

#include "collision/world.hpp"
#include "kds/audit.hpp"
#include "tests/fuzz/random_piles/meter.hpp"

#include <algorithm>
#include <ctime>
#include <exception>
#include <string>

namespace kds::piles {
namespace {

using collision::BodyId;
using collision::PairEvent;
using collision::WallEvent;
using collision::World;

/// Samples between audits.
constexpr int audits_every = 16;

double seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Measures a world as it runs.
class Listener : public collision::WorldListener<2> {
 public:
  Listener(const Scene& scene, Result& result) : meter(scene, result) {}

  Meter meter;

  void look_at_touched(World<2>& world) {
    take_motions(world);
    meter.look_at_touched(world.now());
  }
  void look_at_all(World<2>& world) {
    take_motions(world);
    meter.look_at_all(world.now());
  }
  void take_motions(World<2>& world) {
    for (std::size_t i = 0; i < meter.places.size(); ++i) {
      const auto& motion = world.motion(BodyId(i));
      meter.places[i] = motion.position(world.now());
      meter.velocities[i] = motion.velocity(world.now());
    }
  }

  void contact(World<2>&, const PairEvent& e) override { touch(e.a), touch(e.b); }
  void rebound_suppressed(World<2>&, const PairEvent& e) override { touch(e.a), touch(e.b); }
  void wall(World<2>&, const WallEvent& e) override { touch(e.body); }
  void moved(World<2>&, BodyId id) override { touch(id); }

 private:
  void touch(BodyId id) { meter.touch(static_cast<std::size_t>(std::uint64_t{id})); }
};

}  // namespace

bool found(const Budget& budget, const Result& result) {
  return std::any_of(result.findings.begin(), result.findings.end(), [&](const Finding& finding) {
    return finding.what == budget.sought && finding.worst >= budget.least;
  });
}

Result measure(const Scene& scene, const Budget& budget) {
  Result result;
  Listener listener(scene, result);
  Meter& meter = listener.meter;
  const double begin = seconds();
  const auto used = [&] { return seconds() - begin; };
  World<2> world({.response = collision::Response::elastic, .walls = scene.walls}, &listener);
  try {
    for (const Description& body : scene.bodies) world.add_body(body);
    bool stalls = false;
    for (int i = 1; !stalls && (i - 1) * sample < scene.seconds; ++i) {
      const double until = std::min(i * sample, scene.seconds);
      while (!stalls && world.step(until)) {
        ++result.events;
        listener.look_at_touched(world);
        stalls = result.events > budget.steps || ((result.events & 255) == 0 && used() > budget.seconds);
        if (!budget.sought.empty() && found(budget, result)) return result;
      }
      listener.look_at_all(world);
      if (i % audits_every != 0) continue;
      try {
        world.audit();
      } catch (const AuditFailure& failure) {
        meter.find("audit", world.now(), 1, failure.what());
      }
    }
    if (stalls) {
      meter.find("stall", world.now(), static_cast<double>(result.events),
                 std::to_string(result.events) + " steps, " + std::to_string(used()) + " s of CPU");
    }
  } catch (const std::exception& failure) {
    meter.find("throws", world.now(), 1, failure.what());
  }
  result.seconds = used();
  result.reached = world.now();
  listener.take_motions(world);
  result.kinetic = meter.kinetic();
  return result;
}

}  // namespace kds::piles
