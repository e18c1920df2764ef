// Runs that write their events apart, with threads in the place of processes.
#pragma once

#include "io/event_csv.hpp"
#include "io/event_parts.hpp"
#include "io/run.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/support/random_numbers.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::io::tests {

/// The events as the file has them.
class Lines final : public EventSink {
 public:
  explicit Lines(const Scene& scene) : scene_(scene) {}
  void on_event(const Event& event) override { append_csv_line(text, event, scene_); }

  std::string text{event_csv_header};

 private:
  const Scene& scene_;
};

inline std::string events_of_one_world(const Scene& scene) {
  Lines lines(scene);
  run(scene, {}, lines);
  return lines.text;
}

/// Balls and boxes in a box, of which some are sensors, some are fixed, some enter later, and some fall.
inline Scene random_scene(std::uint64_t seed) {
  kds::tests::Random random(seed);
  Scene scene;
  const std::size_t bodies = 10 + random.below(120);
  const bool coarse = random.one_in(3), falls = random.one_in(5), sensors = random.one_in(2), enter = random.one_in(5);
  const double side = std::ceil(std::cbrt(static_cast<double>(bodies)) * random.between(1.2, 3));
  const auto number = [&](double low, double high) {
    const double value = random.between(low, high);
    return coarse ? std::round(value) : value;
  };
  for (std::size_t i = 0; i < bodies; ++i) {
    SceneBody body;
    body.name = 'b' + std::to_string(i);
    body.shape = kds::collision::Sphere{coarse ? 0.5 : 0.3};
    if (random.one_in(4)) body.shape = kds::collision::Box{Eigen::Vector3d(0.3, 0.25, 0.2)};
    body.sensor = sensors && random.one_in(6);
    body.fixed = random.one_in(10);
    body.restitution = falls ? 0.5 : 1;
    MotionPiece piece;
    piece.path.coefficients.fill(Eigen::Vector3d::Zero());
    for (int d = 0; d < 3; ++d) {
      piece.path.coefficients[0][d] = number(0, side);
      if (!body.fixed) piece.path.coefficients[1][d] = number(-2, 2);
    }
    if (falls && !body.fixed) piece.path.coefficients[2][2] = -2;
    piece.path.start = enter && random.one_in(8) ? number(0, 1) : 0;
    body.motion.push_back(piece);
    scene.bodies.push_back(body);
  }
  scene.end_time = 3;
  scene.response = random.one_in(4) ? Response::none : Response::elastic;
  if (falls || random.one_in(2)) {
    scene.domain = Domain{Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(side + 1), true};
  }
  return scene;
}

struct ApartOptions {
  std::size_t processes = 2;
  std::size_t domains = 4;
  std::uint64_t run = 1;
  std::uint64_t section = 1;
  double rate = 0;              ///< Hz: so often steps end
  double checkpoint_every = 0;  ///< 0: the run is in one part
  std::size_t ends_at = 0;      ///< the checkpoint after which, and more events, it is ended early; 0: it is not
};

inline constexpr std::uint64_t scene_number = 77;

/// The state of a run in several parts.
struct Progress {
  kds::Snapshot world{};
  std::vector<FilePlace> parts{};
  std::vector<std::vector<char>> bodies{};
};

struct Ended : std::runtime_error {
  Ended() : std::runtime_error("it is ended early") {}
};

/// Runs a scene whose events go to parts of `file`. `progress`: from which it goes on, if it has begun; then that of
/// its last checkpoint. Returns what process 0 has counted.
inline RunResult run_apart(const Scene& scene, const std::string& file, const ApartOptions& options,
                           Progress* progress = nullptr) {
  RunResult result;
  const Progress before = progress ? *progress : Progress();
  std::mutex mutex;
  std::vector<std::vector<char>> bodies;  // of the next checkpoint
  const auto work = [&](kds::collision::Processes& processes) {
    kds::collision::Team team(&processes);
    const PartOf of{
        .scene = scene_number, .bodies = scene.bodies.size(), .run = options.run, .section = options.section};
    auto parts = progress ? EventsApart(file, of, team, before.parts) : EventsApart(file, of, team);
    EventSinks sinks;
    if (team.rank() == 0) sinks.add(parts.own());
    RunOptions run_options;
    run_options.domains = options.domains, run_options.processes = &processes, run_options.steps = &parts.own();
    run_options.rate = options.rate, run_options.checkpoint_every = options.checkpoint_every;
    if (!before.parts.empty()) run_options.resume = &before.world;
    if (!before.bodies.empty()) {
      run_options.resume_bodies = [&, next = team.rank()](std::vector<char>& block) mutable {
        if (next >= before.bodies.size()) return false;
        block = before.bodies[next];
        next += team.count();
        return true;
      };
    }
    run_options.checkpoint_bodies = [&](std::vector<char> block) {
      const std::scoped_lock lock(mutex);
      bodies.push_back(std::move(block));
    };
    std::size_t checkpoints = 0;
    run_options.checkpoint = [&](const kds::Snapshot& world, double /*time*/) {
      if (options.ends_at > 0 && checkpoints++ == options.ends_at) throw Ended();
      auto places = parts.places();
      const std::scoped_lock lock(mutex);
      if (team.rank() == 0) *progress = {world, std::move(places), std::exchange(bodies, {})};
    };
    const RunResult mine = run(scene, run_options, sinks);
    parts.close();
    team.of_first(true);
    parts.commit();
    if (team.rank() == 0) result = mine;
  };
  try {
    kds::collision::tests::ThreadProcesses(options.processes).run(work);
  } catch (const Ended&) {
  }
  return result;
}

inline std::string merged_parts(const Scene& scene, const std::string& file, std::size_t threads = 1) {
  EventParts parts(file, scene_number, scene.bodies.size());
  std::string text;
  merge_as_csv(parts, scene, threads, [&](std::string_view lines) { text += lines; });
  return text;
}

}  // namespace kds::io::tests
