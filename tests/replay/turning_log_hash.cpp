// The event logs of worlds whose bodies turn, with each broad phase, in windows, with snapshots on the way, and in
// domains: see replay.hpp. The file in the repository is made by: turning_log_hash > tests/replay/golden_turning.txt
#include "collision/response/mass_properties.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/replay/divided.hpp"
#include "tests/replay/replay.hpp"
#include "tests/replay/scenes.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace kds::replay {
namespace {

using kds::tests::random_vector;

/// Writes everything down.
template <int Degree>
struct Recorder final : TurningWorld<Degree>::Listener {
  using W = TurningWorld<Degree>;
  using Kind = collision::tests::Kind;

  std::vector<Event> events;

  void contact(W&, const PairEvent& e) override { events.push_back({Kind::contact, e.a, e.b, e.contact}); }
  void separation(W&, const PairEvent& e) override { events.push_back({Kind::separation, e.a, e.b, e.contact}); }
  void overlap(W&, const PairEvent& e) override { events.push_back({Kind::overlap, e.a, e.b, e.contact}); }
  void wall(W&, const WallEvent& e) override {
    events.push_back({Kind::wall, e.body, static_cast<BodyId>(e.wall), e.contact});
  }
  void rests(W&, const PairEvent& e) override { events.push_back({Kind::rests, e.a, e.b, e.contact}); }
  void wakes(W&, const PairEvent& e) override { events.push_back({Kind::wakes, e.a, e.b, e.contact}); }
  void pair_began(W&, BodyId a, BodyId b, double t) override {
    events.push_back({Kind::pair_began, a, b, {.time = t}});
  }
  void pair_ended(W&, BodyId a, BodyId b, double t) override {
    events.push_back({Kind::pair_ended, a, b, {.time = t}});
  }
};

Shape dumb_bell() {
  return collision::compound(std::vector<collision::CompoundPart>{{Box{Vector3d(0.25, 0.0625, 0.0625)}},
                                                                  {Box{Vector3d::Constant(0.1875)}, {0.375, 0, 0}},
                                                                  {Box{Vector3d::Constant(0.1875)}, {-0.375, 0, 0}}});
}

Shape table() {
  std::vector<collision::CompoundPart> parts{{Box{Vector3d(0.4, 0.3, 0.05)}, {0, 0, 0.15}}};
  for (const double x : {-0.35, 0.35}) {
    for (const double y : {-0.25, 0.25}) parts.push_back({Box{Vector3d(0.05, 0.05, 0.15)}, {x, y, -0.05}});
  }
  return collision::compound(collision::about_centre_of_mass(parts));
}

Shape hammer() {
  return collision::compound(std::vector<collision::CompoundPart>{{Box{Vector3d(0.4, 0.05, 0.05)}},
                                                                  {MeshShape{rational_torus(), 0.25}, {0.3, 0, 0}}});
}

/// What the bodies of a scene are.
enum class Bodies { boxes, rods_and_balls, rings, precessing, mixture, capsules, crates, heap, in_a_room, compounds };

constexpr double end_time = 2;
constexpr int most_bodies = 64;  // on a lattice of 4 x 4 x 4

template <int Degree>
void fill(TurningWorld<Degree>& world, Bodies bodies, std::uint64_t seed) {
  kds::tests::Random random(seed);
  const auto ring = rational_torus();
  const Shape tetrahedron = convex_hull({{0.5, 0.5, 0.5}, {0.5, -0.5, -0.5}, {-0.5, 0.5, -0.5}, {-0.5, -0.5, 0.5}});
  const bool heap = bodies == Bodies::heap;
  const bool crates = bodies == Bodies::crates || heap;
  const int count = crates ? 8 : bodies == Bodies::rings ? 12 : 24;
  for (int i = 0; i < count; ++i) {
    const int place = (i * 37) % most_bodies;
    typename TurningWorld<Degree>::Motion motion{};
    motion.path.coefficients[0] = Vector3d(place % 4, place / 4 % 4, place / 16) * 1.5 + random_vector(random, 0.2);
    if (heap) motion.path.coefficients[0] = Vector3d(i % 2, i / 2 % 2, i / 4) * 0.9 + random_vector(random, 0.05);
    if (heap) motion.path.coefficients[0] += Vector3d(2.5, 2.5, 0.5);
    motion.path.coefficients[1] = random_vector(random, heap ? 0.25 : 1.5);
    if constexpr (Degree == 2) motion.path.coefficients[2] = Vector3d(0, 0, crates ? -5 : -1);
    const double w = random.between(-1, 1);
    const Vector3d q = random_vector(random, 1);
    motion.orientation = Eigen::Quaterniond(w, q[0], q[1], q[2]);
    motion.angular_velocity = random_vector(random, i % 4 == 0 ? 20 : 3);
    typename TurningWorld<Degree>::Description body{.shape = Box{Vector3d(0.4, 0.4, 0.4)}, .motion = {motion}};
    const bool mixed = bodies == Bodies::mixture;
    if ((bodies == Bodies::rods_and_balls || mixed) && i % 2 == 0) {
      body.shape = Box{Vector3d(0.8, 0.1, 0.15)}, body.inertia = 0.2;
    } else if ((bodies == Bodies::rods_and_balls || mixed) && i % 4 == 1) {
      body.shape = Sphere{0.4};
    } else if (bodies == Bodies::rings || mixed) {
      body.shape = MeshShape{ring, 0.5}, body.inertia = 0.1;
    }
    // Three moments, or those of a top: which move such bodies in pieces where contacts are resolved.
    if (bodies == Bodies::precessing) body.shape = Box{Vector3d(0.3, i % 2 == 0 ? 0.3 : 0.4, 0.6)};
    // All kinds meet capsules, which precess as tops where contacts are resolved.
    if (bodies == Bodies::capsules || bodies == Bodies::in_a_room) {
      if (i % 2 == 0) body.shape = Capsule{i % 4 == 0 ? 0.25 : 0.125, i % 3 == 0 ? 0.25 : 0.5};
      if (i % 8 == 1) body.shape = Sphere{0.4};
      if (i % 8 == 3) body.shape = tetrahedron, body.inertia = 0.05;
      if (i % 8 == 5) body.shape = MeshShape{ring, 0.5}, body.inertia = 0.1;
    }
    if (crates && i % 2 == 0) body.shape = Box{Vector3d(0.3, 0.4, 0.2)};
    // Dumb-bells and tables, which precess, and a hammer whose head is a mesh meet all kinds.
    if (bodies == Bodies::compounds) {
      if (i % 2 == 0) body.shape = i % 4 == 0 ? dumb_bell() : table();
      if (i % 8 == 1) body.shape = Sphere{0.4};
      if (i % 8 == 3) body.shape = Capsule{0.25, 0.25};
      if (i % 8 == 5) body.shape = hammer(), body.inertia = 0.1;
      if (i % 8 == 7) body.shape = i % 16 == 7 ? Shape(MeshShape{ring, 0.5}) : tetrahedron, body.inertia = 0.1;
    }
    body.friction = crates ? 0.5 : i % 3 == 0 ? 0.25 : 0;
    body.restitution = crates ? 0.25 : i % 5 == 0 ? 0.5 : 1;
    body.fixed = i == 7 && !crates;
    if (heap && i % 4 == 3) body.shape = Sphere{0.3};  // which roll, until that is braked
    body.rolling_friction = heap ? 0.0625 : 0;
    world.add_body(body);
  }
  const auto add_fixed = [&](const Shape& shape, const Vector3d& at, const Eigen::Quaterniond& orientation) {
    typename TurningWorld<Degree>::Motion motion{};
    motion.path.coefficients.fill(Vector3d::Zero());
    motion.path.coefficients[0] = at;
    motion.orientation = orientation;
    typename TurningWorld<Degree>::Description body{.shape = shape, .motion = {motion}};
    body.fixed = true, body.friction = 0.5, body.restitution = crates ? 0.25 : 0.75;
    body.rolling_friction = 1;
    world.add_body(body);
  };
  if (crates) {  // They fall on a floor, and most come to rest.
    add_fixed(Box{Vector3d(4, 4, 0.25)}, Vector3d(3, 3, -0.75), Eigen::Quaterniond::Identity());
  }
  if (bodies != Bodies::in_a_room) return;
  for (int d = 0; d < 3; ++d) {  // Its walls are half-spaces.
    for (const double side : {-1.0, 1.0}) {
      add_fixed(HalfSpace{side * Vector3d::Unit(d), -4.5}, Vector3d::Constant(2.25), {8, 1, -2, 0.5});
    }
  }
}

/// How a world is driven to the end.
enum class Drive { at_once, in_windows, by_snapshots };

template <int Degree>
std::vector<Event> run(Bodies bodies, const WorldOptions& options, Drive drive) {
  Recorder<Degree> listener;
  auto world = std::make_unique<TurningWorld<Degree>>(options, &listener);
  fill(*world, bodies, 11);
  if (drive != Drive::at_once) {
    for (int k = 1; k < 8; ++k) {
      world->advance_to(end_time * k / 8);
      if (drive != Drive::by_snapshots) continue;
      const auto image = save(*world);
      world = std::make_unique<TurningWorld<Degree>>(options, &listener);
      restore(image, *world);
    }
  }
  world->advance_to(end_time);
  return listener.events;
}

template <int Degree>
void add_worlds(std::vector<Replay>& replays) {
  constexpr std::array kinds{
      std::pair{Bodies::boxes, "boxes"},         std::pair{Bodies::rods_and_balls, "rods-and-balls"},
      std::pair{Bodies::rings, "rings"},         std::pair{Bodies::precessing, "precessing"},
      std::pair{Bodies::mixture, "mixture"},     std::pair{Bodies::capsules, "capsules"},
      std::pair{Bodies::crates, "crates"},       std::pair{Bodies::heap, "heap"},
      std::pair{Bodies::in_a_room, "in-a-room"}, std::pair{Bodies::compounds, "compounds"}};
  for (const auto& [bodies, name] : kinds) {
    for (const Response response : {Response::none, Response::elastic}) {
      if ((bodies == Bodies::crates || bodies == Bodies::heap) && (Degree == 1 || response == Response::none)) continue;
      Replay replay{
          "turning/" + std::to_string(Degree) + '/' + name + (response == Response::elastic ? "/elastic" : "/none"),
          {}};
      const auto add = [&, what = bodies](std::string way, BroadPhaseKind broad_phase, Drive drive) {
        WorldOptions options{.response = response, .broad_phase = broad_phase};
        options.rate = broad_phase == BroadPhaseKind::sap ? 30 : 0;
        options.report_pairs = true;
        if (what == Bodies::heap) options.shortest_flight = 4e-3;
        if (response == Response::elastic && what != Bodies::crates && what != Bodies::heap &&
            what != Bodies::in_a_room)
          options.walls = Walls{Vector3d::Constant(-1), Vector3d::Constant(6)};
        replay.ways.push_back({std::move(way), [=](EventHash& hash) {
                                 for (const Event& event : run<Degree>(what, options, drive)) hash.event(event);
                               }});
        return options;
      };
      for (const auto& [broad_phase, way, what] : broad_phases) add(std::string(way), broad_phase, Drive::at_once);
      const WorldOptions options = add("windows", BroadPhaseKind::automatic, Drive::in_windows);
      add("snapshots", BroadPhaseKind::automatic, Drive::by_snapshots);
      add_divisions<certificates::RigidMotion<Degree>>(
          replay, 2,
          {.options = options,
           .end_time = end_time,
           .fill = [what = bodies](TurningWorld<Degree>& world) { fill(world, what, 11); },
           .run = [=, what = bodies] { return run<Degree>(what, options, Drive::at_once); },
           .untold =
               [](const Event& event) { return is_pair_event(event) || event.kind == Kind::rebound_suppressed; }});
      replays.push_back(std::move(replay));
    }
  }
}

std::vector<Replay> all_replays() {
  std::vector<Replay> replays;
  add_worlds<1>(replays);
  add_worlds<2>(replays);
  return replays;
}

}  // namespace
}  // namespace kds::replay

int main(int argc, char** argv) { return kds::replay::main_of(argc, argv, kds::replay::all_replays); }
