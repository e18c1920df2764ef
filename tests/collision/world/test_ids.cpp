// Ids of bodies that were removed: stale for good, whatever comes into their slot, and whatever is loaded.
#include "collision/queries/future.hpp"
#include "collision/queries/nearest.hpp"
#include "collision/world.hpp"
#include "kds/framework/history.hpp"
#include "kds/framework/snapshot.hpp"
#include "kds/simulator.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision::test_ids {
namespace {

using namespace tests;

using kds::tests::Random;

WorldOptions with(Response response, BroadPhaseKind method) {
  WorldOptions options = with_response(response);
  options.broad_phase = method;
  options.rate = method == BroadPhaseKind::sap ? 16 : 0;  // frames a second
  return options;
}

template <int Degree>
void require_stale(World<Degree>& world, BodyId gone, BodyId there) {
  CAPTURE(gone, there);
  REQUIRE(world.contains(there));
  CHECK_FALSE(world.contains(gone));
  const std::string what = "there is no body " + std::to_string(gone) + " (generation " +
                           std::to_string(body_generation(gone)) + " of slot " + std::to_string(body_slot(gone)) +
                           "): it was removed";
  const auto throws = [&](const auto& call) {
    CHECK_THROWS_AS(call(), std::out_of_range);
    CHECK_THROWS_WITH(call(), Catch::Contains(what));
  };
  throws([&] { world.motion(gone); });
  throws([&] { world.free_motion(gone); });
  throws([&] { world.shape(gone); });
  throws([&] { world.mass(gone); });
  throws([&] { world.sensor(gone); });
  throws([&] { world.fixed(gone); });
  throws([&] { world.touching(gone, there); });
  throws([&] { world.touching(there, gone); });
  throws([&] { world.resting(gone, there); });
  throws([&] { world.resting(there, gone); });
  throws([&] { world.resting_at_wall(gone, 0); });
  throws([&] { world.restitution(gone); });
  throws([&] { world.category(gone); });
  throws([&] { world.collides_with(gone); });
  throws([&] { world.group(gone); });
  throws([&] { world.user_data(gone); });
  throws([&] { world.attached_to(gone); });
  throws([&] { world.ignores_pair(there, gone); });
  throws([&] { world.visit_partners(gone, [](BodyId) {}); });
  const double until = world.now() + 1;
  throws([&] { next_contact_of(world, gone, until); });
  throws([&] { next_contacts_of(world, gone, until); });
  throws([&] { next_contact_between(world, gone, there, until); });
  throws([&] { next_contact_between(world, there, gone, until); });
  throws([&] { closest_approach(world, there, gone, until); });
  throws([&] { distance_between(world, gone, there); });
  const auto still = motion<Degree>({7, 7, 7}, zero, zero, world.now());
  const auto later = motion<Degree>({7, 7, 7}, zero, zero, until);
  throws([&] { world.update_motion(gone, still); });
  throws([&] { world.update_motion(gone, std::span(&still, 1)); });
  throws([&] { world.append_motion(gone, std::span(&later, 1)); });
  throws([&] { world.update_vertices(gone, {}); });
  throws([&] { world.set_mass(gone, 2); });
  throws([&] { world.set_restitution(gone, 0.5); });
  throws([&] { world.set_filter(gone, 2, 2); });
  throws([&] { world.set_group(gone, 2); });
  throws([&] { world.ignore_pair(gone, there); });
  throws([&] { world.ignore_pair(there, gone); });
  throws([&] { world.set_user_data(gone, 2); });
  throws([&] {
    auto attached = body<Degree>(Sphere{1}, still);
    attached.motion.clear();
    attached.sensor = true;
    attached.attached_to = gone;
    world.add_body(attached);
  });
  throws([&] { world.remove_body(gone); });
  CHECK(world.contains(there));
}

TEMPLATE_TEST_CASE_SIG("Ids: one that was removed is refused by all that can be asked and done", "[world][ids]",
                       ((int Degree), Degree), 1, 2) {
  World<Degree> world({});
  const BodyId other = world.add_body(ball<Degree>(1, {9, 0, 0}));
  const BodyId first = world.add_body(ball<Degree>(1, {0, 0, 0}));
  const auto second_description = body<Degree>(Sphere{1}, motion<Degree>({0, 0, 0}), 5);
  SECTION("with an empty slot") {
    world.remove_body(first);
    require_stale(world, first, other);
    world.advance_to(1);
    require_stale(world, first, other);
  }
  SECTION("with another body in its slot, which is left alone") {
    if (GENERATE(false, true)) world.advance_to(1);
    world.remove_body(first);
    const BodyId second = world.add_body(second_description);
    REQUIRE(body_slot(second) == body_slot(first));
    REQUIRE(body_generation(second) == 1);
    require_stale(world, first, other);
    require_stale(world, first, second);
    CHECK(world.mass(second) == 5);
    world.advance_to(2);
    require_stale(world, first, second);
    CHECK(world.motion(second).position(2) == zero);
    world.remove_body(second);
    require_stale(world, first, other);
    require_stale(world, second, other);
  }
  CHECK_THROWS_WITH(world.motion(body_id(5, 0)), Catch::Contains("it has never been there"));
  CHECK_THROWS_WITH(world.motion(77), Catch::Contains("no body 77 (generation 0 of slot 77): it has never been there"));
  world.audit();
}

TEST_CASE("Ids: a body that a callback puts into a slot is not taken for the one that was in it", "[world][ids]") {
  // 0 and 1 meet at 1. Then 1 goes, and a ball that overlaps 0 and goes on into it comes into its slot.
  for (const auto response : {Response::none, Response::elastic, Response::callback}) {
    std::optional<std::vector<Event>> first;
    for (const auto method : all_methods) {
      CAPTURE(static_cast<int>(response), static_cast<int>(method));
      EventLog<1> log;
      log.then = [&](World<1>& world, const Event& e) {
        if (e.kind != Kind::contact || e.b != 1) return;
        world.remove_body(e.b);
        const BodyId next = world.add_body(body<1>(Sphere{1}, motion<1>({1.5, 0, 0}, {-0.5, 0, 0}, zero, world.now())));
        CHECK(next == body_id(1, 1));
        CHECK_FALSE(world.contains(e.b));
      };
      World<1> world(with(response, method), &log);
      world.add_body(fixed_body<1>(Sphere{1}, motion<1>(zero)));
      world.add_body(ball<1>(1, {3, 0, 0}, {-1, 0, 0}));
      world.advance_to(1);
      const auto overlaps = log.of(Kind::overlap);
      REQUIRE(overlaps.size() == 1);
      CHECK(overlaps[0].a == 0);
      CHECK(overlaps[0].b == body_id(1, 1));
      CHECK(overlaps[0].time() == 1);
      const auto separations = log.of(Kind::separation);
      REQUIRE(separations.size() == (response == Response::none ? 1 : 0));
      if (response == Response::none) CHECK(separations[0].b == 1);
      CHECK(world.touching(0, body_id(1, 1)) == (response == Response::none));
      world.advance_to(20);  // through it, to the other side
      world.audit();
      CHECK(log.count(Kind::contact) == 1);
      if (!first) first = log.events;
      CHECK(log.events == *first);
    }
  }
}

TEST_CASE("Ids: bodies are named in the order in which they were added", "[world][ids]") {
  EventLog<1> log;
  World<1> world({}, &log);
  for (int i = 0; i < 3; ++i) world.add_body(ball<1>(1, {0.5 * i, 0, 0}));
  world.remove_body(0);
  const BodyId again = world.add_body(ball<1>(1, {0.25, 0, 0}));
  REQUIRE(again == body_id(1, 0));
  std::vector<BodyId> named;
  world.visit_overlapping(zero, zero, [&](BodyId id) { named.push_back(id); });
  CHECK(named == std::vector<BodyId>{1, 2, again});
  world.advance_to(1);
  std::vector<std::pair<BodyId, BodyId>> pairs;
  for (const Event& e : log.of(Kind::overlap)) pairs.emplace_back(e.a, e.b);
  CHECK(pairs == std::vector<std::pair<BodyId, BodyId>>{{1, 2}, {1, again}, {2, again}});
}

TEST_CASE("Ids: a world that is loaded knows which were removed, and goes on alike", "[world][ids][snapshot]") {
  World<2> world({});
  for (int i = 0; i < 4; ++i) world.add_body(ball<2>(1, {9.0 * i, 0, 0}));
  world.remove_body(3), world.remove_body(1);
  const BodyId second = world.add_body(ball<2>(1, {9, 0, 0}));
  REQUIRE(second == body_id(1, 1));
  world.advance_to(1);
  const Snapshot saved = save(world);

  World<2> other({});
  restore(saved, other);
  world.remove_body(second);  // all that comes now is undone
  world.remove_body(0);
  for (int i = 0; i < 9; ++i) world.add_body(ball<2>(1, {9.0 * i, 20, 0}));
  restore(saved, world);
  for (World<2>* each : {&world, &other}) {
    CHECK(save(*each) == saved);
    CHECK(each->size() == 3);
    CHECK(each->contains(0));
    CHECK(each->contains(2));
    require_stale(*each, 1, second);
    require_stale(*each, 3, second);
    CHECK(each->add_body(ball<2>(1, {0, 9, 0})) == body_id(1, 3));
    CHECK(each->add_body(ball<2>(1, {0, 18, 0})) == body_id(1, 4));
    each->remove_body(second);
    CHECK(each->add_body(ball<2>(1, {9, 0, 0})) == body_id(2, 1));
  }
}

TEST_CASE("Ids: a roll-back brings back those that were there, and the same come again", "[world][ids][history]") {
  EventLog<1> log;
  World<1> world({}, &log);
  BodyId next = 0;
  log.then = [&](World<1>& w, const Event& e) {
    if (e.kind != Kind::contact) return;
    w.remove_body(e.b);
    next = w.add_body(ball<1>(1, {50, 0, 0}));
  };
  for (int i = 0; i < 4; ++i) world.add_body(ball<1>(1, {5.0 * i, 0, 0}, {i == 0 ? 1.0 : 0.0, 0, 0}));
  Simulator simulator(0, world);
  History history(1, simulator);
  history.advance_to(5);
  REQUIRE(world.contains(body_id(1, 1)));
  CHECK_FALSE(world.contains(1));
  const BodyId came = next;
  const auto events = log.events;
  history.roll_back(1);
  CHECK(world.contains(1));
  CHECK_FALSE(world.contains(body_id(1, 1)));
  log.events.clear();
  history.advance_to(5);
  CHECK(next == came);
  CHECK(log.events == events);
}

/// What a world must say of ids, by a map.
template <int Degree>
class Model {
 public:
  Model(std::uint64_t seed, BroadPhaseKind method) : random_(seed), world_(with(Response::elastic, method), &log_) {
    log_.then = [this](World<Degree>&, const Event&) {
      if (random_.one_in(2)) edit();
    };
  }

  void run() {
    for (int i = 0; i < 150; ++i) {
      edit();
      if (random_.one_in(3)) world_.advance_to(world_.now() + random_.between(0, 0.5));
      if (random_.one_in(20)) kept_.emplace(Kept{save(world_), alive_, ever_});
      if (kept_ && random_.one_in(20)) {
        restore(kept_->world, world_);
        alive_ = kept_->alive;
        ever_ = kept_->ever;  // what has come since has never been there
      }
      check();
    }
    world_.audit();
  }
  std::size_t reused() const { return reused_; }

 private:
  void edit() {
    if (alive_.size() < 4 || random_.one_in(2)) {
      const double mass = 1 + ++bodies_ / 64.0;
      const auto coordinate = [&] { return random_.between(-4, 4); };
      const Vector3d at(coordinate(), coordinate(), coordinate());
      const Vector3d velocity(coordinate(), coordinate(), coordinate());
      const auto path = motion<Degree>(at, velocity, zero, world_.now());
      const BodyId id = world_.add_body(body<Degree>(Sphere{0.5}, path, mass));
      CHECK(ever_.emplace(id, mass).second);
      alive_[id] = mass;
      reused_ += body_generation(id) > 0;
    } else {
      const auto which = std::next(alive_.begin(), static_cast<std::ptrdiff_t>(random_.below(alive_.size())));
      world_.remove_body(which->first);
      alive_.erase(which);
    }
  }
  void check() const {
    CHECK(world_.size() == alive_.size());
    for (const auto& [id, mass] : ever_) {
      if (alive_.contains(id)) {
        CHECK(world_.mass(id) == mass);
      } else {
        CHECK_FALSE(world_.contains(id));
        CHECK_THROWS_AS(world_.mass(id), std::out_of_range);
      }
    }
  }

  using Masses = std::map<BodyId, double>;
  struct Kept {
    Snapshot world;
    Masses alive, ever;
  };

  Random random_;
  EventLog<Degree> log_;
  World<Degree> world_;
  Masses alive_, ever_;
  std::optional<Kept> kept_;
  std::size_t bodies_ = 0, reused_ = 0;
};

TEST_CASE("Ids: bodies that come and go at random, also in callbacks, are those of a map", "[world][ids]") {
  for (const auto method : all_methods) {
    if (method == BroadPhaseKind::sap) continue;  // its world is that of all-pairs, and slower
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      CAPTURE(seed, static_cast<int>(method));
      Model<1> model(seed, method);
      model.run();
      CHECK(model.reused() > 20);
    }
  }
}

}  // namespace
}  // namespace kds::collision::test_ids
