// The ways of finding contacts that the accuracy benchmark compares, each timed on this thread's clock.
#pragma once

#include "tests/benchmarks/accuracy/contacts.hpp"
#include "tests/benchmarks/accuracy/samplers.hpp"
#include "tests/benchmarks/accuracy/scenes.hpp"
#include "tests/benchmarks/thread_time.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace accuracy {

using kds::benchmarks::thread_seconds;

enum class Method {
  event_driven,  ///< the engine: kinetic sweep and prune, exact contacts
  swept,         ///< the engine on swept boxes, a frame each 1 / rate: exact contacts too
  polling,       ///< kinetic sweep and prune, its active pairs tested at samples
  discrete,      ///< sweep and prune over samples
};

inline const char* name(Method method) {
  switch (method) {
    case Method::event_driven: return "event-driven";
    case Method::swept: return "swept";
    case Method::polling: return "polling";
    case Method::discrete: return "discrete";
  }
  return "?";
}

struct Outcome {
  double setup = 0;  ///< CPU s up to the first instant
  double run = 0;    ///< CPU s from there to the end
  std::vector<Report> reports;
};

template <int Degree>
std::vector<TrueContact> run_world(const Scene<Degree>& scene, kds::collision::BroadPhaseKind kind, double rate,
                                   Outcome& outcome) {
  ContactList<Degree> list;
  kds::collision::WorldOptions options;
  options.window = scene.end_time;
  options.broad_phase = kind;
  options.rate = rate;
  const double begin = thread_seconds();
  kds::collision::World<Degree> world(options, &list);
  for (const auto& body : scene.bodies) world.add_body(body);
  world.advance_to(0);
  const double middle = thread_seconds();
  world.advance_to(scene.end_time);
  outcome.run = thread_seconds() - middle;
  outcome.setup = middle - begin;
  for (const TrueContact& c : list.contacts) outcome.reports.push_back({c.a, c.b, c.begin});
  return list.contacts;
}

template <int Degree>
std::vector<PlacedShape> placed_shapes(const Scene<Degree>& scene) {
  std::vector<PlacedShape> shapes;
  for (const auto& body : scene.bodies) shapes.push_back(kds::collision::place(body.shape, body.orientation));
  return shapes;
}

template <int Degree>
std::vector<kds::certificates::PointMotion<Degree>> motions(const Scene<Degree>& scene) {
  std::vector<kds::certificates::PointMotion<Degree>> result;
  for (const auto& body : scene.bodies) result.push_back(body.motion[0]);
  return result;
}

/// Samples at 1 / rate, 2 / rate ... up to the end.
template <class Sampler, int Degree, class... Arguments>
Outcome run_sampler(const Scene<Degree>& scene, double rate, const Arguments&... arguments) {
  Outcome outcome;
  const double begin = thread_seconds();
  const auto shapes = placed_shapes(scene);
  const auto paths = motions(scene);
  Sampler sampler(shapes, paths, arguments...);
  const double middle = thread_seconds();
  const auto samples = static_cast<std::uint64_t>(std::floor(scene.end_time * rate));
  for (std::uint64_t k = 1; k <= samples; ++k) sampler.sample(static_cast<double>(k) / rate, outcome.reports);
  outcome.run = thread_seconds() - middle;
  outcome.setup = middle - begin;
  return outcome;
}

template <int Degree>
Outcome run(const Scene<Degree>& scene, Method method, double rate) {
  using kds::collision::BroadPhaseKind;
  Outcome outcome;
  switch (method) {
    case Method::event_driven: run_world(scene, BroadPhaseKind::automatic, 0, outcome); break;
    case Method::swept: run_world(scene, BroadPhaseKind::sap, rate, outcome); break;
    case Method::polling: return run_sampler<PollingSampler<Degree>>(scene, rate, scene.end_time);
    case Method::discrete: return run_sampler<DiscreteSampler<Degree>>(scene, rate);
  }
  return outcome;
}

}  // namespace accuracy
