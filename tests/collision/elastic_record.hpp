// Runs of the world written down for the exact proof of tests/support/exact_elastic.hpp.
#pragma once

#include "tests/collision/event_log.hpp"
#include "tests/support/exact_bodies.hpp"
#include "tests/support/exact_elastic.hpp"

#include <utility>
#include <vector>

namespace kds::collision::tests {

template <int Degree>
oracle::Piece exact_piece(const certificates::PointMotion<Degree>& motion) {
  oracle::Piece piece{motion.start, {}};
  for (const auto& c : motion.coefficients) piece.coefficients.push_back({c[0], c[1], c[2]});
  return piece;
}

/// The scene and what the world says of it, up to the first contact whose rebound is suppressed (from there on what is
/// right is another question), or up to this many events: a body between a fixed one and a wall that close in has
/// events without number.
template <int Degree>
oracle::ElasticRun record(const Scene<Degree>& scene, const WorldOptions& options, std::size_t most_events = 100) {
  oracle::ElasticRun run;
  run.start = options.start_time;
  run.end = options.start_time + scene.end_time;
  if (options.walls) {
    const auto& [min, max, restitution] = *options.walls;
    run.walls = oracle::ElasticWalls{{min[0], min[1], min[2]}, {max[0], max[1], max[2]}, restitution};
  }
  EventLog<Degree> log;
  World<Degree> world(options, &log);
  for (const auto& description : scene.bodies) {
    const BodyId id = world.add_body(description);
    const oracle::Body exact = oracle::exact_body(description);
    run.bodies.push_back({exact.shape, exact.motion.front(), world.shape(id).bounding_radius, description.mass,
                          description.fixed, description.restitution});
  }
  std::vector<std::vector<oracle::Piece>> motions;
  log.then = [&](World<Degree>& w, const Event&) {
    motions.emplace_back();
    for (BodyId id = 0; id < scene.bodies.size(); ++id) motions.back().push_back(exact_piece(w.motion(id)));
  };
  const auto suppressed = [&] { return world.counters().rebounds_suppressed > 0; };
  while (!suppressed() && log.events.size() < most_events && world.step(run.end)) {
  }
  run.cut = suppressed() || log.events.size() >= most_events;
  if (run.cut) run.end = world.now();
  for (std::size_t i = 0; i < log.events.size(); ++i) {
    const Event& e = log.events[i];
    if (e.kind == Kind::rebound_suppressed) break;
    oracle::ElasticEvent event{oracle::ElasticEvent::Kind::contact,
                               body_slot(e.a),
                               body_slot(e.b),
                               e.time(),
                               {e.contact.normal[0], e.contact.normal[1], e.contact.normal[2]},
                               std::move(motions[i])};
    if (e.kind == Kind::overlap) event.kind = oracle::ElasticEvent::Kind::overlap;
    if (e.kind == Kind::wall) event.kind = oracle::ElasticEvent::Kind::wall;
    run.events.push_back(std::move(event));
  }
  // A contact is told before its rebound is said to be suppressed, and its motions are already those of rest.
  if (suppressed()) run.events.pop_back();
  return run;
}

}  // namespace kds::collision::tests
