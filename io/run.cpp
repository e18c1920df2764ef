#include "io/run.hpp"

#include "collision/parallel/parallel_world.hpp"
#include "collision/world.hpp"
#include "io/scene_world.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace kds::io {
namespace {

using kds::collision::body_slot;
using kds::collision::BodyId;
using kds::collision::BroadPhaseKind;
using kds::collision::Contact;
using kds::collision::motion_as;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

BroadPhaseKind choose(const std::string& name) {
  for (const auto& broad_phase : kds::collision::broad_phases) {
    if (broad_phase.name == name) return broad_phase.kind;
  }
  throw std::invalid_argument("RunOptions.broad_phase: there is no \"" + name + "\"");
}

/// Bodies are added in the order of the scene and none is removed: their slots are their places in it.
Event to_event(EventKind kind, const kds::collision::PairEvent& event) {
  const Contact& c = event.contact;
  return {c.time, kind, body_slot(event.a), body_slot(event.b), c.point, c.normal, c.feature_a, c.feature_b};
}
Event to_event(EventKind kind, const kds::collision::WallEvent& event) {
  const Contact& c = event.contact;
  return {c.time, kind, body_slot(event.body), static_cast<std::uint32_t>(event.wall), c.point, c.normal, {}, {}};
}

/// Hands on what the world tells.
template <class Motion>
class Teller final : public kds::collision::BasicWorldListener<Motion> {
 public:
  using World = kds::collision::BasicWorld<Motion>;
  using PairEvent = kds::collision::PairEvent;
  using WallEvent = kds::collision::WallEvent;

  Teller(EventSink& sink, Response response) : sink_(sink), response_(response) {}

  void contact(World& world, const PairEvent& event) override {
    tell(EventKind::contact, event);
    tell_motions(world, event);
  }
  void separation(World&, const PairEvent& event) override { tell(EventKind::separation, event); }
  void overlap(World&, const PairEvent& event) override { tell(EventKind::overlap, event); }
  void rebound_suppressed(World& world, const PairEvent& event) override { tell_motions(world, event); }
  void moved(World& world, BodyId id) override { tell_motion(world, id); }
  bool hears_pieces() const override { return sink_.hears_motions(); }

  void wall(World& world, const WallEvent& event) override {
    tell_wall(EventKind::wall, event);
    tell_motion(world, event.body);
  }
  void rests(World&, const PairEvent& event) override { tell(EventKind::rest, event); }
  void wakes(World&, const PairEvent& event) override { tell(EventKind::wake, event); }
  void rests_at_wall(World&, const WallEvent& event) override { tell_wall(EventKind::rest_at_wall, event); }
  void wakes_at_wall(World&, const WallEvent& event) override { tell_wall(EventKind::wake_at_wall, event); }
  void passes(World&, const PairEvent& event) override { tell(EventKind::pass, event); }
  void pair_began(World&, BodyId a, BodyId b, double t) override { tell_volumes(EventKind::pair_begin, a, b, t); }
  void pair_ended(World&, BodyId a, BodyId b, double t) override { tell_volumes(EventKind::pair_end, a, b, t); }

 private:
  void tell(EventKind kind, const PairEvent& event) { sink_.on_event(to_event(kind, event)); }
  void tell_wall(EventKind kind, const WallEvent& event) { sink_.on_event(to_event(kind, event)); }
  void tell_volumes(EventKind kind, BodyId a, BodyId b, double t) {
    sink_.on_event({t, kind, body_slot(a), body_slot(b), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), {}, {}});
  }
  void tell_motions(const World& world, const PairEvent& event) {
    if (response_ == Response::none) return;
    tell_motion(world, event.a);
    tell_motion(world, event.b);
  }
  void tell_motion(const World& world, BodyId id) {
    if (!world.contains(id)) return;
    sink_.on_motion(body_slot(id), motion_as<MotionPiece>(world.motion(id)));
  }

  EventSink& sink_;
  Response response_;
};

/// The same of a scene that is divided, whose listener is not told of motions.
class DividedTeller final : public kds::collision::ParallelListener {
 public:
  using PairEvent = kds::collision::PairEvent;
  using WallEvent = kds::collision::WallEvent;

  explicit DividedTeller(EventSink& sink) : sink_(sink) {}

  void contact(const PairEvent& event) override { sink_.on_event(to_event(EventKind::contact, event)); }
  void separation(const PairEvent& event) override { sink_.on_event(to_event(EventKind::separation, event)); }
  void overlap(const PairEvent& event) override { sink_.on_event(to_event(EventKind::overlap, event)); }
  void wall(const WallEvent& event) override { sink_.on_event(to_event(EventKind::wall, event)); }
  void rests(const PairEvent& event) override { sink_.on_event(to_event(EventKind::rest, event)); }
  void wakes(const PairEvent& event) override { sink_.on_event(to_event(EventKind::wake, event)); }
  void rests_at_wall(const WallEvent& event) override { sink_.on_event(to_event(EventKind::rest_at_wall, event)); }
  void wakes_at_wall(const WallEvent& event) override { sink_.on_event(to_event(EventKind::wake_at_wall, event)); }
  void passes(const PairEvent& event) override { sink_.on_event(to_event(EventKind::pass, event)); }

 private:
  EventSink& sink_;
};

kds::collision::WorldOptions world_options(const Scene& scene, const RunOptions& options) {
  const BroadPhaseKind broad_phase = choose(options.broad_phase);
  if (broad_phase == BroadPhaseKind::sap && !(options.rate > 0)) {
    throw std::invalid_argument("RunOptions.rate: must be > 0 for the broad phase \"sap\"");
  }
  kds::collision::WorldOptions world_options;
  world_options.start_time = scene.begin_time;
  world_options.response = scene.response;
  world_options.broad_phase = broad_phase;
  world_options.kdop = options.kdop;
  world_options.orientation_error = options.orientation_error;
  world_options.shortest_flight = options.shortest_flight;
  world_options.rate = options.rate;
  world_options.report_pairs = options.pairs;
  world_options.profile = options.profile;
  world_options.threads = options.threads;
  if (scene.end_time > scene.begin_time) world_options.window = scene.end_time - scene.begin_time;
  if (scene.domain && scene.domain->reflects) {
    world_options.walls = kds::collision::Walls{scene.domain->min, scene.domain->max, scene.domain->restitution};
  }
  return world_options;
}

/// The times at which something happens `rate` times a second: begin + 1 / rate, begin + 2 / rate...
class Beat {
 public:
  /// `rate`: 0 if there are none. Those up to `now` are over.
  Beat(double begin, double rate, double now) : begin_(begin), rate_(rate) {
    if (!(rate > 0)) return;
    count_ = std::max(1.0, std::floor((now - begin) * rate) - 1);
    while (next() <= now) ++count_;
  }
  double next() const { return rate_ > 0 ? begin_ + count_ / rate_ : kds::never; }
  void pass() { ++count_; }

 private:
  double begin_;
  double rate_;
  double count_ = 1;
};

/// Runs a world up to the end of a scene. It has the scene's bodies, at begin_time or as they are when a run goes on.
template <class World>
void run_to_end(World& world, const Scene& scene, const RunOptions& options, EventSink& sink) {
  const double begin = scene.begin_time;
  const double end = scene.end_time;
  double rate = options.rate;
  if (options.steady_progress && end > begin) {
    const double steady = 100 / (end - begin);
    if (std::isfinite(steady)) rate = std::max(rate, steady);  // not of a run below 1e-306 s
  }
  Beat results(begin, rate, world.now());
  Beat checkpoints(begin, options.checkpoint_every > 0 ? 1 / options.checkpoint_every : 0, world.now());
  for (;;) {
    const double t = std::min(results.next(), checkpoints.next());
    if (!(t < end)) break;
    world.advance_to(t);
    if (t == results.next()) {
      sink.on_time(t);
      results.pass();
    }
    if (t == checkpoints.next()) {
      if constexpr (requires { world.save_parts(options.checkpoint_bodies); }) {
        options.checkpoint(world.save_parts(options.checkpoint_bodies), t);
      } else {
        options.checkpoint(kds::save(world), t);
      }
      checkpoints.pass();
    }
  }
  world.advance_to(end);
  sink.on_time(end);
}

/// Fills a world with the bodies of a scene, or a state to go on from, and runs it. `added(id, description)` is called
/// for each body that is added, `begun()` before the run.
template <class World, class Added, class Begun>
RunResult run_in(World& world, const Scene& scene, const RunOptions& options, EventSink& sink, double setup_start,
                 const Added& added, const Begun& begun) {
  if (options.resume) {
    if constexpr (requires { world.load_parts(*options.resume, options.resume_bodies); }) {
      world.load_parts(*options.resume, options.resume_bodies);
    } else {
      kds::restore(*options.resume, world);
    }
    if (world.size() != scene.size()) {
      throw std::invalid_argument("the state to go on from is of " + std::to_string(world.size()) +
                                  " bodies, and the scene has " + std::to_string(scene.size()));
    }
    if (!(world.now() <= scene.end_time)) throw std::invalid_argument("the state to go on from is after the end");
  } else {
    if constexpr (requires { world.add_shares(0, {}); }) {
      if (scene.is_share()) {
        const auto body = [&](std::size_t i) { return describe<typename World::Motion>(scene.bodies[i]); };
        world.add_shares(scene.bodies.size(), body);
      }
    }
    for (const SceneBody& body : scene.bodies) {
      if (scene.is_share()) break;
      const auto description = describe<typename World::Motion>(body);
      added(world.add_body(description), description);
    }
    world.advance_to(scene.begin_time);
  }
  const double begin = world.now();
  const double run_start = cpu_seconds();
  begun();
  run_to_end(world, scene, options, sink);
  const double run_end = cpu_seconds();

  RunResult result;
  result.broad_phase = world.broad_phase();
  result.setup_cpu_seconds = run_start - setup_start;
  result.run_cpu_seconds = run_end - run_start;
  result.sim_seconds = scene.end_time - begin;
  result.bodies = scene.size();
  result.peak_memory_bytes = peak_memory();
  return result;
}

/// The work of a world, or of the worlds of all domains.
void note_work(const kds::collision::WorldCounters& work, RunResult& result) {
  result.swaps = work.broad_phase.swaps;
  result.certificates = work.broad_phase.certificates;
  result.box_updates = work.broad_phase.box_updates;
  result.pairs_begun = work.pairs_begun;
  result.pair_tests = work.pair_tests;
  result.contacts = work.contacts;
  result.separations = work.separations;
  result.overlaps = work.overlaps;
  result.wall_contacts = work.wall_contacts;
  result.motion_updates = work.motion_updates;
  result.rotation_pieces = work.rotation_pieces;
  result.orientation_resets = work.orientation_resets;
  result.held = work.rebounds_suppressed;
}

template <class Motion>
RunResult run_with(const Scene& scene, const RunOptions& options, EventSink& sink) {
  const double setup_start = cpu_seconds();
  Teller<Motion> teller(sink, scene.response);
  kds::collision::BasicWorld<Motion> world(world_options(scene, options), &teller);
  kds::collision::WorldCounters before;
  const auto added = [&](BodyId id, const auto& description) {
    // Of a body that precesses the first piece is none of the scene's.
    if (!(world.motion(id) == description.motion.front())) {
      sink.on_motion(body_slot(id), motion_as<MotionPiece>(world.motion(id)));
    }
  };
  RunResult result = run_in(world, scene, options, sink, setup_start, added, [&] {
    if (options.resume) before = world.counters();
  });
  note_work(world.counters() - before, result);
  result.profile = world.work_profile();
  return result;
}

/// What is told of the run of a process.
struct OwnRun {
  kds::collision::WorldCounters work{};
  kds::collision::MessageCounters messages{};
  double setup_cpu_seconds = 0, run_cpu_seconds = 0;
  std::uint64_t peak_memory_bytes = 0;

  template <class Archive>
  void archive(Archive& archive) {
    archive(work, messages, setup_cpu_seconds, run_cpu_seconds, peak_memory_bytes);
  }
};
static_assert(std::is_trivially_copyable_v<kds::collision::WorldCounters>);

/// In process 0 the work of the worlds of all, and what the busiest took; in others their own.
void share(kds::collision::Team& team, OwnRun mine, RunResult& result) {
  kds::collision::Letters letters;
  if (team.rank() != 0) letters.to(0)(mine);
  team.exchange(std::move(letters), [&](std::size_t, auto& reader) {
    OwnRun other;
    reader(other);
    mine.work = mine.work + other.work;
    mine.messages.letters += other.messages.letters, mine.messages.bytes += other.messages.bytes;
    mine.setup_cpu_seconds = std::max(mine.setup_cpu_seconds, other.setup_cpu_seconds);
    mine.run_cpu_seconds = std::max(mine.run_cpu_seconds, other.run_cpu_seconds);
    mine.peak_memory_bytes = std::max(mine.peak_memory_bytes, other.peak_memory_bytes);
  });
  note_work(mine.work, result);
  result.exchanges = mine.messages.exchanges, result.messages = mine.messages.letters;
  result.bytes_exchanged = mine.messages.bytes;
  result.setup_cpu_seconds = mine.setup_cpu_seconds, result.run_cpu_seconds = mine.run_cpu_seconds;
  result.peak_memory_bytes = mine.peak_memory_bytes;
}

template <class Motion>
RunResult run_divided(const Scene& scene, const RunOptions& options, EventSink& sink) {
  const double setup_start = cpu_seconds();
  DividedTeller teller(sink);
  kds::collision::BasicParallelWorld<Motion> world(
      world_options(scene, options), {.threads = options.threads, .domains = options.domains, .steps = options.steps},
      &teller, options.processes);
  kds::collision::WorldCounters before;
  RunResult result = run_in(
      world, scene, options, sink, setup_start, [](BodyId, const auto&) {},
      [&] {
        if (options.resume) before = world.work();
      });
  kds::collision::Team team(options.processes);
  result.processes = team.count();
  share(team,
        {world.work() - before, world.messages(), result.setup_cpu_seconds, result.run_cpu_seconds,
         result.peak_memory_bytes},
        result);
  const auto counters = world.counters();
  result.contacts = counters.contacts, result.separations = counters.separations;
  result.overlaps = counters.overlaps, result.wall_contacts = counters.wall_contacts;
  result.domains = world.domains();
  result.windows = counters.windows, result.windows_failed = counters.windows_failed;
  result.bodies_owned = counters.bodies_owned, result.bodies_known = counters.bodies_known;
  return result;
}

}  // namespace

RunResult run(const Scene& scene, const RunOptions& options, EventSink& sink) {
  using kds::certificates::PointMotion;
  using kds::certificates::RigidMotion;
  // A World does not go on from bodies in blocks, but one of a single domain does.
  const bool divided = options.domains != 1 || options.processes || (options.resume && options.resume_bodies);
  if (scene.is_share() && !options.processes) throw std::invalid_argument("run: it is a share of a scene");
  if (divided && (options.pairs || options.profile)) {
    throw std::invalid_argument(
        "RunOptions.domains: volumes are not told of, nor work profiled, in a scene that is divided");
  }
  if (divided && options.checkpoint_every > 0 && !options.checkpoint_bodies) {
    throw std::invalid_argument("RunOptions.checkpoint_bodies: is needed in a scene that is divided");
  }
  const auto run_of = [&]<class Motion>(std::type_identity<Motion>) {
    return divided ? run_divided<Motion>(scene, options, sink) : run_with<Motion>(scene, options, sink);
  };
  if (scene.turning) {
    return scene.degree() == 2 ? run_of(std::type_identity<RigidMotion<2>>())
                               : run_of(std::type_identity<RigidMotion<1>>());
  }
  return scene.degree() == 2 ? run_of(std::type_identity<PointMotion<2>>())
                             : run_of(std::type_identity<PointMotion<1>>());
}

}  // namespace kds::io
