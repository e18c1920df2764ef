// Contacts of meshes are a function of the pair: bounding volumes hold the contact gap too, whatever the broad phase.
#include "kds/framework/snapshot.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace kds::collision::test_mesh_volumes {
namespace {

using namespace tests;

/// A method and the volumes it sees.
struct Way {
  BroadPhaseKind method;
  int kdop = 6;
};
constexpr Way ways[] = {{BroadPhaseKind::all_pairs},
                        {BroadPhaseKind::automatic},
                        {BroadPhaseKind::grid},
                        {BroadPhaseKind::kinetic_sap},
                        {BroadPhaseKind::sap},
                        {BroadPhaseKind::kinetic_sap, 14},
                        {BroadPhaseKind::kinetic_sap, 18},
                        {BroadPhaseKind::kinetic_sap, 26}};

template <int Degree>
std::vector<Event> run_as(const Way& way, const Scene<Degree>& scene, WorldOptions options) {
  options.broad_phase = way.method;
  options.kdop = way.kdop;
  options.rate = 16 / scene.end_time;
  return run(scene, options);
}

/// Runs the scene in every way; all must give the events that testing all pairs gives. Returns these.
template <int Degree>
std::vector<Event> same_in_all_ways(const Scene<Degree>& scene, const WorldOptions& options) {
  const std::vector<Event> expected = run_as(ways[0], scene, options);
  for (const Way& way : ways) {
    INFO("method " << static_cast<int>(way.method) << ", k-DOP " << way.kdop);
    CHECK(run_as(way, scene, options) == expected);
  }
  return expected;
}

/// A cube at rest, and what comes towards it along x, at a height.
struct Passage {
  const char* what;
  double clock;     ///< s, at the start
  double distance;  ///< of the centres, along x
  double speed;
  double height;
  bool touches;
};
constexpr Passage passages[] = {
    {"near and slow", 0, 10, 1, 0.3, true},
    {"fast", 0, 100, 500, 0.3, true},
    {"clock 1e3 s", 1e3, 100, 500, 0.3, true},
    {"clock 1e6 s, fast", 1e6, 100, 500, 0.3, true},
    {"clock 1e9 s", 1e9, 10, 1, 0.3, true},
    {"clock 1e9 s, beside within the gap", 1e9, 10, 1, 2 + 5e-7, true},
    {"clock 1e9 s, beside beyond the gap", 1e9, 10, 1, 2 + 5e-6, false},
    {"a path of 1e8", 0, 1e8, 1e8, 0.3, true},
    {"a path of 1e9, beside within the gap", 0, 1e9, 1e9, 2 + 1e-6, true},
};

/// Half edges of boxes and cubes, and radii of balls, are 1.
std::vector<Shape> partners() { return {MeshShape{cube(), 1}, Sphere{1}, Box{{1, 1, 1}}}; }

template <int Degree>
Scene<Degree> scene_of(const Passage& passage, const Shape& partner, BoundingVolume volume) {
  const Vector3d from(passage.distance, passage.height, 0.2);
  Scene<Degree> scene;
  scene.bodies = {body<Degree>(MeshShape{cube(), 1}, motion<Degree>(zero, zero, zero, passage.clock)),
                  body<Degree>(partner, motion<Degree>(from, {-passage.speed, 0, 0}, zero, passage.clock))};
  for (auto& b : scene.bodies) b.volume = volume;
  scene.end_time = 2 * passage.distance / passage.speed;
  return scene;
}

TEMPLATE_TEST_CASE_SIG("Contacts of meshes do not depend on the broad phase", "[mesh]", ((int Degree), Degree), 1, 2) {
  for (const Passage& passage : passages) {
    for (const Shape& partner : partners()) {
      for (const auto volume : {BoundingVolume::shape, BoundingVolume::sphere}) {
        for (const auto response : {Response::none, Response::elastic}) {
          INFO(passage.what << ", partner " << partner.index() << ", volume " << static_cast<int>(volume)
                            << ", response " << static_cast<int>(response));
          WorldOptions options;
          options.response = response;
          options.start_time = passage.clock;
          const auto events = same_in_all_ways(scene_of<Degree>(passage, partner, volume), options);
          // Of two that pass beside each other the ball's lowest point has only the gap to touch in, as the others.
          const bool touched = !events.empty();
          CHECK(touched == passage.touches);
          if (response == Response::none && touched) CHECK(events.size() == 2);
        }
      }
    }
  }
}

TEMPLATE_TEST_CASE_SIG("Contacts of meshes that graze each other do not depend on the broad phase", "[mesh][random]",
                       ((int Degree), Degree), 1, 2) {
  int touched = 0, passed = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    const double clock = random.one_in(3) ? 0 : std::pow(10, random.between(0, 9));
    const double speed = std::pow(10, random.between(-2, 6));
    const double distance = std::pow(10, random.between(0.7, 8));
    // As ContactGap for the part that counts here, see there.
    const double gap = 64 * 0x1p-53 * (4 + 2 * distance) + 4 * 0x1p-52 * clock * speed;
    const Passage passage{"", clock, distance, speed, 2 + gap * random.between(0.5, 1.5), true};
    const auto shapes = partners();
    for (const auto volume : {BoundingVolume::shape, BoundingVolume::sphere}) {
      auto scene = scene_of<Degree>(passage, shapes[seed % 3], volume);
      if constexpr (Degree == 2) scene.bodies[1].motion[0].coefficients[2] = {0.1 * speed * speed / distance, 0, 0};
      // The other has started before, so that motions have to be moved to the common epoch.
      if (random.one_in(2)) scene.bodies[0].motion[0].start -= random.between(0, 1);
      WorldOptions options;
      options.response = random.one_in(2) ? Response::none : Response::elastic;
      options.start_time = clock;
      const auto events = same_in_all_ways(scene, options);
      ++(events.empty() ? passed : touched);
    }
  }
  CHECK(touched > 20);
  CHECK(passed > 20);
}

/// A triangle so thin that its corners are needles, from (-1, 0, 0) to (1, 0, 0): with one sharp corner, or two.
std::shared_ptr<const Mesh> splinter(Random& random, double width) {
  std::vector<Vector3d> corners{{1, 0, 0}, {-1, width, 0}, {-1, -width, 0}};
  if (random.one_in(2)) corners = {{1, 0, 0}, {-1, 0, 0}, {random.between(-0.5, 0.5), width, 0}};
  return std::make_shared<const Mesh>(corners, std::vector<Mesh::Triangle>{{0, 1, 2}});
}

/// Sharp corners that meet tip to tip are nearly in contact along all directions that separate triangles, long before
/// they are near.
TEMPLATE_TEST_CASE_SIG("Splinters touch where they are, and for as long, whatever the broad phase", "[mesh][random]",
                       ((int Degree), Degree), 1, 2) {
  int touched = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    const double width = std::pow(10, random.between(-9, -0.5));
    const double speed = std::pow(10, random.between(-1, 2));
    const auto turn = random.one_in(2) ? Eigen::Quaterniond(random.between(0.1, 1), random.between(-1, 1),
                                                            random.between(-1, 1), random.between(-1, 1))
                                       : Eigen::Quaterniond::Identity();
    Scene<Degree> scene;
    const Vector3d along = turn.normalized() * Vector3d(1, 0, 0);
    const Shape mesh = MeshShape{splinter(random, width), 1};
    const Shape other = seed % 3 == 0 ? Shape(Sphere{1e-4}) : Shape(MeshShape{splinter(random, width), 1});
    const double tip = seed % 3 == 0 ? 1 + 1e-4 : 2;
    const double miss = random.one_in(2) ? 0 : 1e-13 * random.between(0, 1);
    // Head on, or past the tip, across.
    const Vector3d across = turn.normalized() * Vector3d(0, 1, 0);
    const bool head_on = random.one_in(2);
    const Vector3d from =
        head_on ? Vector3d((tip + 3 * speed) * along) : Vector3d((tip + miss) * along + speed * across);
    const Vector3d velocity = head_on ? Vector3d(-speed * along) : Vector3d(-speed * across);
    scene.bodies = {body<Degree>(mesh, motion<Degree>(zero)), body<Degree>(other, motion<Degree>(from, velocity))};
    for (auto& b : scene.bodies) b.orientation = turn.normalized();
    if (random.one_in(4)) scene.bodies[1].volume = BoundingVolume::sphere;
    scene.end_time = 8;
    const auto events = same_in_all_ways(scene, WorldOptions{});
    if (events.empty()) continue;
    ++touched;
    // Head on, the tips are at most 21 gaps apart then (farthest_contact): below 1e-11 of the path.
    if (head_on) CHECK(events[0].time() == Approx(3).epsilon(1e-11));
  }
  CHECK(touched > 40);
}

TEST_CASE("A mesh that comes later makes room in the volumes of those that are there", "[mesh]") {
  for (const auto response : {Response::none, Response::elastic}) {
    std::vector<std::vector<Event>> logs;
    for (const Way& way : ways) {
      if (way.method == BroadPhaseKind::sap) continue;
      WorldOptions options;
      options.response = response;
      options.broad_phase = way.method;
      options.kdop = way.kdop;
      options.start_time = 1e9;
      EventLog<1> log;
      World<1> world(options, &log);
      world.add_body(body<1>(Box{{1, 1, 1}}, motion<1>({0, 2 + 5e-7, 0}, {1, 0, 0}, zero, 1e9)));
      world.add_body(body<1>(Sphere{1}, motion<1>({0, -2 - 5e-7, 0}, {1, 0, 0}, zero, 1e9)));
      world.advance_to(1e9 + 1);
      world.add_body(body<1>(MeshShape{cube(), 1}, motion<1>({10, 0, 0}, zero, zero, 1e9)));
      world.audit();
      world.advance_to(1e9 + 30);
      world.audit();
      logs.push_back(log.events);
      CHECK(log.count(Kind::contact) == (response == Response::none ? 2 : 1));
      CHECK(logs.back() == logs.front());
    }
  }
}

TEST_CASE("Volumes grow on long paths, without steps of their own, and so in a world that was saved", "[mesh]") {
  for (const auto& [kind, method, what] : broad_phases) {
    if (kind == BroadPhaseKind::sap) continue;  // has frames all the way
    INFO(method);
    WorldOptions options;
    options.broad_phase = kind;
    options.report_pairs = true;
    const auto fill = [](World<1>& world) {
      world.add_body(body<1>(MeshShape{cube(), 1}, motion<1>(zero, {1, 0, 0})));
      world.add_body(body<1>(Sphere{1}, motion<1>({0, 4, 0}, {1, 0, 0})));  // moves alike
      world.add_body(body<1>(MeshShape{cube(), 1}, motion<1>({1e8, 2 + 1e-7, 0.5})));
    };
    EventLog<1> log;
    World<1> world(options, &log);
    fill(world);
    CHECK_FALSE(world.step(1e7));  // in ten million radii volumes have been renewed
    CHECK(world.now() == 1e7);
    world.audit();
    const Snapshot snapshot = save(world);
    EventLog<1> log_after;
    World<1> loaded(options, &log_after);
    restore(snapshot, loaded);
    for (World<1>* each : {&world, &loaded}) {
      each->advance_to(2e8);
      each->audit();
    }
    CHECK(log.count(Kind::contact) == 2);
    CHECK(log_after.events == log.events);
  }
}

TEST_CASE("A step without a limit does not run on for the sake of volumes", "[mesh]") {
  for (const auto kind : {BroadPhaseKind::all_pairs, BroadPhaseKind::kinetic_sap}) {
    WorldOptions options;
    options.broad_phase = kind;
    EventLog<1> log;
    World<1> world(options, &log);
    world.add_body(body<1>(MeshShape{cube(), 1}, motion<1>(zero)));
    world.add_body(body<1>(MeshShape{cube(), 1}, motion<1>({10, 0.5, 0.2}, {-1, 0, 0})));
    while (world.step()) {
    }
    CHECK(log.count(Kind::contact) == 1);
    CHECK(log.count(Kind::separation) == 1);
    CHECK(world.now() < 20);
  }
}

TEST_CASE("Where there is no mesh, volumes are those of the bodies", "[mesh]") {
  for (const bool mesh : {false, true}) {
    WorldOptions options;
    options.report_pairs = true;
    EventLog<1> log;
    World<1> world(options, &log);
    world.add_body(box<1>({1, 1, 1}, zero));
    world.add_body(ball<1>(1, {4, 0, 0}, {-1, 0, 0}));
    if (mesh) world.add_body(body<1>(MeshShape{cube(), 1}, motion<1>({0, 100, 0})));
    world.advance_to(10);
    REQUIRE(log.count(Kind::pair_began) == 1);
    const double began = log.of(Kind::pair_began)[0].time();
    CHECK((began < 2) == mesh);
    CHECK(began == Approx(2).epsilon(1e-6));
    CHECK(log.of(Kind::contact)[0].time() == 2);
  }
}

TEST_CASE("A caller's boxes have room for the gap, too", "[mesh]") {
  std::vector<std::vector<Event>> logs;
  for (const Way& way : ways) {
    WorldOptions options;
    options.broad_phase = way.method;
    options.kdop = way.kdop;
    options.start_time = 1e9;
    options.rate = 4;
    EventLog<1> log;
    World<1> world(options, &log);
    world.add_body(body<1>(MeshShape{cube(), 1}, motion<1>(zero, zero, zero, 1e9)));
    auto passing = body<1>(MeshShape{cube(), 1}, motion<1>({10, 2 + 5e-7, 0}, {-1, 0, 0}, zero, 1e9));
    passing.box = [](double t, const certificates::PointMotion<1>& path) {
      auto tight = box_around(path, Vector3d::Constant(-1), Vector3d::Constant(1));
      tight.valid_until = t + 3;
      return tight;
    };
    world.add_body(passing);
    world.advance_to(1e9 + 20);
    logs.push_back(log.events);
    CHECK(log.count(Kind::contact) == 1);
    CHECK(logs.back() == logs.front());
  }
}

}  // namespace
}  // namespace kds::collision::test_mesh_volumes
