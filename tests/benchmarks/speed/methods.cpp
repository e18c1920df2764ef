#include "tests/benchmarks/speed/methods.hpp"

#include "collision/broad_phase/broad_phase_kind.hpp"

#include <bit>
#include <stdexcept>

namespace speed {
namespace {

using kds::collision::BodyId;
using kds::collision::BroadPhaseKind;

std::vector<Method> list_methods() {
  std::vector<Method> list;
  for (const auto& known : kds::collision::broad_phases) {
    list.push_back({std::string(known.name), known.kind});
    // Half a million pairs at 1 000 bodies, 100 bytes each.
    if (known.kind == BroadPhaseKind::all_pairs) list.back().most_bodies = 4000;
  }
  return list;
}

/// Adds up a hash of each event.
class Hasher final : public kds::collision::WorldListener<1> {
 public:
  using World = kds::collision::World<1>;

  Hasher(Outcome& outcome, std::vector<Meeting>* meetings) : outcome_(outcome), meetings_(meetings) {}

  void contact(World&, const kds::collision::PairEvent& e) override {
    note(1, e.a, e.b, e.contact);
    if (meetings_) meetings_->push_back({e.contact.time, e.a, e.b});
  }
  void separation(World&, const kds::collision::PairEvent& e) override { note(2, e.a, e.b, e.contact); }
  void overlap(World&, const kds::collision::PairEvent& e) override { note(3, e.a, e.b, e.contact); }
  void wall(World&, const kds::collision::WallEvent& e) override {
    note(4, e.body, static_cast<BodyId>(e.wall), e.contact);
  }
  void rebound_suppressed(World&, const kds::collision::PairEvent& e) override { note(5, e.a, e.b, e.contact); }

 private:
  static std::uint64_t mix(std::uint64_t h, std::uint64_t x) {
    h = (h ^ x) * 0x9E3779B97F4A7C15u;
    return h ^ (h >> 29);
  }
  void note(std::uint64_t kind, BodyId a, BodyId b, const kds::collision::Contact& c) {
    std::uint64_t h = mix(kind, std::uint64_t{a} << 32 | b);
    h = mix(h, std::bit_cast<std::uint64_t>(c.time));
    for (int d = 0; d < 3; ++d) {
      h = mix(h, std::bit_cast<std::uint64_t>(c.point[d]));
      h = mix(h, std::bit_cast<std::uint64_t>(c.normal[d]));
    }
    outcome_.hash += h;
    ++outcome_.events;
  }

  Outcome& outcome_;
  std::vector<Meeting>* meetings_;
};

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> list = list_methods();
  return list;
}

const Method& method(const std::string& name) {
  for (const Method& m : methods()) {
    if (m.name == name) return m;
  }
  throw std::invalid_argument("there is no method " + name);
}

kds::collision::WorldOptions world_options(const BallScene& scene, const Method& method, const Drive& drive) {
  kds::collision::WorldOptions options;
  options.start_time = scene.start_time;
  options.window = drive.duration;
  options.response = kds::collision::Response::elastic;
  options.broad_phase = method.kind;
  options.rate = drive.rate;
  options.threads = drive.threads;
  options.walls = kds::collision::Walls{Eigen::Vector3d::Zero(), scene.side};
  return options;
}

void add_balls(kds::collision::World<1>& world, const BallScene& scene) {
  world.reserve(scene.balls.size());
  kds::collision::BodyDescription<1> body;
  body.motion.resize(1);
  for (const BallScene::Ball& ball : scene.balls) {
    body.shape = kds::collision::Sphere{ball.radius};
    body.motion[0] = {{ball.position, ball.velocity}, ball.start};
    world.add_body(body);
  }
}

Outcome run_method(const BallScene& scene, const Method& method, const Drive& drive, std::vector<Meeting>* meetings) {
  Outcome outcome;
  Hasher hasher(outcome, meetings);
  const HardwareCounters hardware;
  const double begin = drive.clock();
  kds::collision::World<1> world(world_options(scene, method, drive), &hasher);
  add_balls(world, scene);
  world.advance_to(scene.start_time);
  outcome.after_setup = world.counters();
  const double middle = drive.clock();
  const double end = scene.start_time + drive.duration;
  for (std::uint64_t frame = 1;; ++frame) {
    const double t = scene.start_time + static_cast<double>(frame) / drive.rate;
    if (!(t < end)) break;
    world.advance_to(t);
  }
  world.advance_to(end);
  outcome.run = drive.clock() - middle;
  outcome.setup = middle - begin;
  outcome.counters = world.counters();
  outcome.hardware = hardware.read();
  return outcome;
}

}  // namespace speed
