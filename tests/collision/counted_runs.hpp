// Runs of scenes that are checked after each event, and what is counted in their logs.
#pragma once

#include "tests/collision/random_scenes.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace kds::collision::tests {

inline WorldOptions with(Response response, BroadPhaseKind broad_phase = BroadPhaseKind::kinetic_sap) {
  WorldOptions options;
  options.response = response;
  options.broad_phase = broad_phase;
  options.rate = 16;
  options.report_pairs = true;
  return options;
}

inline std::size_t count(const std::vector<Event>& events, Kind kind) {
  return static_cast<std::size_t>(
      std::count_if(events.begin(), events.end(), [kind](const Event& e) { return e.kind == kind; }));
}
inline std::size_t count_at(const std::vector<Event>& events, double t) {
  return static_cast<std::size_t>(
      std::count_if(events.begin(), events.end(), [t](const Event& e) { return e.time() == t; }));
}
inline std::vector<Event> contacts_of(const std::vector<Event>& events) {
  std::vector<Event> result;
  for (const Event& e : events) {
    if (e.kind == Kind::contact) result.push_back(e);
  }
  return result;
}

template <int Degree>
std::vector<Event> run_audited(const std::vector<BodyDescription<Degree>>& bodies, const WorldOptions& options,
                               double end) {
  return run(Scene<Degree>{bodies, end}, options, {.audit = true});
}

}  // namespace kds::collision::tests
