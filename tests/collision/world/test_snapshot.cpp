// Worlds saved at random moments, and run again: in place, in others, on another broad phase, through a stream.
#include "kds/framework/snapshot.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace kds::collision::test_snapshot {
namespace {

using namespace tests;

/// Everything but the pairs of bounding volumes, from some place on.
std::vector<Event> contacts_from(const std::vector<Event>& events, std::size_t first) {
  std::vector<Event> result(events.begin() + static_cast<std::ptrdiff_t>(first), events.end());
  std::erase_if(result, is_pair_event);
  return result;
}
std::vector<Event> pairs_from(const std::vector<Event>& events, std::size_t first) {
  std::vector<Event> result(events.begin() + static_cast<std::ptrdiff_t>(first), events.end());
  std::erase_if(result, [](const Event& e) { return !is_pair_event(e); });
  return result;
}

/// What the counters say of events, not of work.
std::array<std::uint64_t, 6> outcome(const WorldCounters& c) {
  return {c.contacts, c.separations, c.overlaps, c.wall_contacts, c.motion_updates, c.rebounds_suppressed};
}

/// Callbacks that edit, as the event alone decides.
template <int Degree>
void meddle(World<Degree>& world, const Event& e) {
  if (e.kind != Kind::contact || !world.contains(e.a) || world.fixed(e.a)) return;
  const double now = world.now();
  if ((e.a + e.b) % 3 == 0) {
    auto motion = world.free_motion(e.a).restarted(now);
    if (motion.coefficients[1].norm() < 0.2) return;  // or it would go on for ever
    motion.coefficients[1] = -0.5 * motion.coefficients[1];
    world.update_motion(e.a, motion);
  } else if ((e.a + e.b) % 5 == 0) {
    auto motion = world.free_motion(e.a).restarted(now);
    motion.coefficients[0] = Vector3d(3, 3, 3) + motion.coefficients[1];
    world.remove_body(e.a);
    world.add_body(body<Degree>(Sphere{0.4}, motion));
  }
}

/// Bounces without loss, for a world that leaves that to its callbacks.
template <int Degree>
void bounce(World<Degree>& world, const Event& e) {
  if (e.kind != Kind::contact) return;
  auto a = world.free_motion(e.a).restarted(world.now());
  auto b = world.free_motion(e.b).restarted(world.now());
  const double approach = e.contact.normal.dot(a.coefficients[1] - b.coefficients[1]);
  const bool both = !world.fixed(e.a) && !world.fixed(e.b);
  a.coefficients[1] -= (both ? 1 : 2) * approach * e.contact.normal;
  b.coefficients[1] += (both ? 1 : 2) * approach * e.contact.normal;
  if (!world.fixed(e.a)) world.update_motion(e.a, a);
  if (!world.fixed(e.b)) world.update_motion(e.b, b);
}

struct Done {
  std::size_t contacts = 0, after = 0, suppressed = 0;
  int wrong = 0;
};

template <int Degree>
void run_again(const Scene<Degree>& scene, WorldOptions options, bool edits, bool compare_pairs, std::uint64_t seed,
               Done& done) {
  Random random(seed);
  EventLog<Degree> log;
  const auto then = options.response == Response::callback ? bounce<Degree> : meddle<Degree>;
  if (edits) log.then = then;
  World<Degree> world(options, &log);
  for (const auto& description : scene.bodies) world.add_body(description);
  const double end = options.start_time + scene.end_time;
  for (int k = random.integer(0, 40); k > 0 && world.step(end);) --k;
  if (random.one_in(2)) world.advance_to(std::max(world.now(), random.between(0, end)));
  const std::size_t first = log.events.size();
  const Snapshot middle = save(world);
  done.wrong += !(save(world) == middle);  // Saving changes nothing.
  const auto at_save = world.counters();
  world.advance_to(end);
  const auto expected = contacts_from(log.events, first);
  const auto expected_pairs = pairs_from(log.events, first);
  const auto counted = outcome(world.counters());
  done.contacts += first;
  done.after += expected.size();
  done.suppressed += world.counters().rebounds_suppressed;

  const auto check = [&](World<Degree>& other, EventLog<Degree>& events) {
    done.wrong += other.size() != world.size() && !edits;
    done.wrong += !(other.counters() == at_save);
    other.audit();
    events.events.clear();
    while (other.step(end)) {
      if (random.one_in(8)) other.audit();
    }
    other.audit();
    done.wrong += contacts_from(events.events, 0) != expected;
    if (compare_pairs) done.wrong += pairs_from(events.events, 0) != expected_pairs;
    done.wrong += outcome(other.counters()) != counted;
  };
  std::stringstream file;
  write(file, middle);
  for (const BroadPhaseKind kind : {options.broad_phase, BroadPhaseKind::kinetic_sap, BroadPhaseKind::all_pairs}) {
    if (options.report_pairs &&
        (kind == BroadPhaseKind::kinetic_sap) != (options.broad_phase == BroadPhaseKind::kinetic_sap))
      continue;
    WorldOptions changed = options;
    changed.broad_phase = kind;
    EventLog<Degree> other_log;
    if (edits) other_log.then = then;
    World<Degree> other(changed, &other_log);
    other.add_body(ball<Degree>(1, zero));  // some past of its own
    other.advance_to(1);
    file.seekg(0);
    restore(read_snapshot(file), other);
    check(other, other_log);
  }
  restore(middle, world);
  check(world, log);
}

template <int Degree, class F>
void for_scenes(const SceneOptions& base, int seeds, const std::vector<Numbers>& all, F&& f) {
  SceneOptions options = base;
  for (const Numbers numbers : all) {
    for (const Shapes shapes : {Shapes::spheres, Shapes::turned_boxes, Shapes::rings, Shapes::mixture}) {
      for (int seed = 1; seed <= seeds; ++seed) {
        INFO("degree " << Degree << ", " << name(shapes) << ", seed " << seed);
        Random random(static_cast<std::uint64_t>(seed) + 40);
        options.shapes = shapes;
        options.numbers = numbers;
        Done done;
        f(SceneMaker(random, options).template scene<Degree>(), static_cast<std::uint64_t>(seed), done);
        CHECK(done.wrong == 0);
      }
    }
  }
}

TEMPLATE_TEST_CASE_SIG("A world that passes through runs again from a snapshot bit for bit", "[world][snapshot]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t after = 0;
  for (const auto kind : {BroadPhaseKind::automatic, BroadPhaseKind::kinetic_sap, BroadPhaseKind::grid}) {
    for_scenes<Degree>({.scripts = true}, 3, {Numbers::fine, Numbers::coarse},
                       [&](const Scene<Degree>& scene, std::uint64_t seed, Done& done) {
                         WorldOptions options;
                         options.broad_phase = kind;
                         options.report_pairs = seed == 2;
                         if (seed == 3) options.window = 0.3;
                         run_again(scene, options, false, false, seed, done);
                         after += done.after;
                       });
  }
  CHECK(after > 500);
}

TEMPLATE_TEST_CASE_SIG("A world with walls and callbacks that edit and contacts that come to rest runs again",
                       "[world][snapshot]", ((int Degree), Degree), 1, 2) {
  std::size_t after = 0, suppressed = 0;
  for (const auto kind : {BroadPhaseKind::automatic, BroadPhaseKind::kinetic_sap}) {
    for (const bool edits : {false, true}) {
      SceneOptions base{.bodies = 20, .heterogeneous = true};
      if (Degree == 2) base.bodies = 10, base.side = 3, base.end_time = 1.5;
      for_scenes<Degree>(base, 3, {Numbers::fine}, [&](Scene<Degree> scene, std::uint64_t seed, Done& done) {
        WorldOptions options;
        options.broad_phase = kind;
        options.response = seed == 3 && edits ? Response::callback : Response::elastic;
        options.walls = Walls{Vector3d::Constant(-2), Vector3d::Constant(8)};
        options.walls->restitution = seed == 2 ? 0 : 0.5;
        for (auto& b : scene.bodies) b.restitution = seed == 2 ? 0 : 0.5;
        options.report_pairs = seed == 1;
        run_again(scene, options, edits, seed == 1, seed, done);
        after += done.after;
        suppressed += done.suppressed;
      });
    }
  }
  CHECK(after > (Degree == 1 ? 500 : 50));
  CHECK(suppressed > 10);
}

TEST_CASE("A heap of balls that has come to rest is still at rest when it is loaded", "[world][snapshot][zeno]") {
  WorldOptions options;
  options.response = Response::elastic;
  options.walls = Walls{Vector3d(-1, -1, 0), Vector3d(1, 1, 9)};
  options.walls->restitution = 0.4;
  EventLog<2> log;
  World<2> world(options, &log);
  for (int i = 0; i < 5; ++i) {
    auto one = ball<2>(0.4, Vector3d(0, 0, 0.5 + i), zero, Vector3d(0, 0, -5));
    one.restitution = 0.4;
    world.add_body(one);
  }
  world.advance_to(4);
  REQUIRE(world.counters().rebounds_suppressed > 3);
  REQUIRE(world.resting_at_wall(0, 4));
  world.audit();
  const Snapshot snapshot = save(world);
  EventLog<2> other_log;
  World<2> other(options, &other_log);
  restore(snapshot, other);
  CHECK(other.resting_at_wall(0, 4));
  CHECK(save(other) == snapshot);
  log.events.clear();
  for (World<2>* each : {&world, &other}) {
    auto push = each->free_motion(4).restarted(each->now());
    push.coefficients[1] = Vector3d(0, 0, 2);
    each->update_motion(4, push);
    each->advance_to(8);
    each->audit();
  }
  CHECK(log.events.size() > 3);
  CHECK(log.events == other_log.events);
  CHECK(outcome(world.counters()) == outcome(other.counters()));
}

TEST_CASE("Worlds refuse snapshots of other worlds, and keep what they have", "[world][snapshot]") {
  WorldOptions options;
  World<1> world(options);
  world.add_body(ball<1>(1, zero, Vector3d(1, 0, 0)));
  world.add_body(body<1>(MeshShape{cube(), 1}, motion<1>(Vector3d(5, 0, 0))));
  World<2> parabolas(options);
  const Snapshot before = save(world);
  CHECK_THROWS_WITH(restore(before, parabolas), Catch::Contains("expected World of degree 2"));
  WorldOptions changed = options;
  changed.response = Response::elastic;
  World<1> elastic(changed);
  elastic.add_body(ball<1>(2, zero));
  const Snapshot other = save(elastic);
  CHECK_THROWS_WITH(restore(other, world), Catch::Contains("other options: response"));
  changed = options;
  changed.zeno.contacts = 7;
  World<1> patient(changed);
  CHECK_THROWS_WITH(restore(before, patient), Catch::Contains("zeno.contacts"));
  changed = options;
  changed.broad_phase = BroadPhaseKind::kinetic_sap;
  changed.kdop = 18;
  World<1> slabs(changed);
  CHECK_NOTHROW(restore(before, slabs));
  changed.report_pairs = true;
  World<1> slabs_told(changed);
  changed.kdop = 6;
  World<1> boxes_told(changed);
  CHECK_THROWS_WITH(restore(save(slabs_told), boxes_told), Catch::Contains("other options: kdop"));
  std::vector<char> cut(before.bytes().begin(), before.bytes().end() - 3);
  CHECK_THROWS_AS(restore(Snapshot(cut), world), std::runtime_error);
  CHECK(save(world) == before);
  const auto* const mesh = std::get<MeshShape>(world.shape(1).shape).mesh.get();
  restore(before, world);
  CHECK(std::get<MeshShape>(world.shape(1).shape).mesh.get() == mesh);  // not built again
  World<1> empty(options);
  restore(before, empty);
  CHECK(std::get<MeshShape>(empty.shape(1).shape).mesh->triangles().size() == mesh->triangles().size());
  auto boxed = ball<1>(1, Vector3d(9, 9, 9));
  boxed.box = [](double, const auto& m) { return box_around(m, Vector3d::Constant(-2), Vector3d::Constant(2)); };
  world.add_body(boxed);
  CHECK_THROWS_WITH(save(world), Catch::Contains("body 2 cannot be saved"));
  EventLog<1> log;
  int refused = 0;
  log.then = [&](World<1>& w, const Event&) {
    try {
      save(w);
    } catch (const std::logic_error&) {
      ++refused;
    }
  };
  World<1> listening(options, &log);
  listening.add_body(ball<1>(1, zero, Vector3d(1, 0, 0)));
  listening.add_body(ball<1>(1, Vector3d(5, 0, 0)));
  listening.advance_to(9);
  CHECK(refused == 2);
}

}  // namespace
}  // namespace kds::collision::test_snapshot
