// Parts of a world that have little to do, each by itself; and what the audits of parts find.
#include "collision/world/bodies_image.hpp"
#include "collision/world/scripts.hpp"
#include "collision/world/self_contacts.hpp"
#include "collision/world/timers.hpp"
#include "collision/world/unbounded.hpp"
#include "collision/world/wall_times.hpp"
#include "kds/audit.hpp"
#include "tests/collision/deforming/folded_strip.hpp"
#include "tests/collision/world/parts.hpp"
#include "tests/collision/world/through_bytes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace kds::collision::test_small_parts {
namespace {

using namespace tests;
using Catch::Contains;
using certificates::PointMotion;
using Path = PointMotion<1>;

std::vector<TimerId> all_of(Timers& timers) {
  std::vector<TimerId> rung;
  while (timers.next_time() < never) rung.push_back(timers.take_next());
  return rung;
}

BodyDescription<1> plane(double height, const Vector3d& normal = {0, 0, 1}) {
  return fixed_body<1>(HalfSpace{normal, height}, motion<1>({0, 0, 0}));
}

/// A strip that meets itself, and asks for that or not.
BodyDescription<1> strip(bool self_contacts = true) {
  auto described = fixed_body<1>(Fold().shape(), motion<1>({1, 2, 3}));
  described.self_contacts = self_contacts;
  return described;
}

}  // namespace

TEST_CASE("Timers: by time, and by the order in which they were set") {
  Timers timers;
  CHECK(timers.next_time() == never);
  const TimerId late = timers.set(3), early = timers.set(1), tie = timers.set(3), gone = timers.set(2);
  CHECK(timers.next_time() == 1);
  CHECK(timers.cancel(gone));
  CHECK_FALSE(timers.cancel(gone));
  CHECK_FALSE(timers.cancel(99));
  CHECK(all_of(timers) == std::vector{early, late, tie});
  CHECK_FALSE(timers.cancel(late));
  CHECK(timers.set(0) > gone);  // no number is given twice
}

TEST_CASE("Timers: a copy rings alike, and goes on counting") {
  Timers timers;
  timers.set(2), timers.set(5), timers.set(2);
  CHECK(timers.take_next() == 0);
  Timers copy;
  copy.set(1);  // which it forgets
  copy.become(through_bytes(timers.image()));
  copy.audit(2);
  CHECK(copy.set(5) == timers.set(5));
  CHECK(all_of(copy) == all_of(timers));
}

TEST_CASE("Timers: the audit finds one that should have rung, and images that cannot be are refused") {
  Timers timers;
  timers.set(2), timers.set(5);
  CHECK_NOTHROW(timers.audit(2));
  CHECK_THROWS_WITH(timers.audit(2.5), Contains("a timer should have rung"));

  const auto right = timers.image();
  const auto check = [](const Timers::Image& image) { image.check(0, 1, {}); };
  CHECK_NOTHROW(check(right));
  auto image = right;
  image.timers[0].time = 0.5;
  CHECK_THROWS_WITH(check(image), Contains("timers[0]: is of no time to come"));
  image = right;
  std::swap(image.timers[0], image.timers[1]);
  CHECK_THROWS_WITH(check(image), Contains("timers[1]: is out of order"));
  image = right;
  image.next = 1;
  CHECK_THROWS_WITH(check(image), Contains("timers[1]: has a number that has not been given"));
  image = right;
  image.timers[1].timer = 0;
  CHECK_THROWS_WITH(check(image), Contains("timers[1]: is there twice"));
}

TEST_CASE("Unbounded: a half-space has a pair with each bounded body with which it may collide") {
  Parts<1> parts;
  Unbounded<Path> unbounded(parts.bodies, parts.clock, parts.pairs);
  CHECK(unbounded.empty());
  const BodySlot a = parts.add(ball<1>(1, {0, 0, 5}));
  auto alone = ball<1>(1, {0, 9, 5});
  alone.collides_with = 0;
  const BodySlot ghost = parts.add(alone);
  const BodySlot floor = parts.add(plane(0));
  const BodySlot roof = parts.add(plane(-20, {0, 0, -1}));
  const BodySlot b = parts.add(ball<1>(1, {5, 0, 5}));
  for (const BodySlot slot : {floor, roof}) unbounded.add(slot, Pairs<Path>::Begin::entering);
  unbounded.audit(0);
  for (const BodySlot each : {a, b}) {
    for (const BodySlot slot : {floor, roof}) CHECK(parts.pairs.listed(std::min(each, slot), std::max(each, slot)));
  }
  CHECK_FALSE(parts.pairs.listed(floor, roof));
  CHECK_FALSE(parts.pairs.listed(ghost, floor));
  CHECK_FALSE(parts.pairs.listed(a, b));
  CHECK(unbounded.next_time() == never);

  std::vector<std::pair<BodySlot, BodySlot>> pairs;
  unbounded.every_pair([&](BodySlot x, BodySlot y) { pairs.emplace_back(x, y); });
  CHECK(pairs == std::vector<std::pair<BodySlot, BodySlot>>{{a, floor}, {floor, b}, {a, roof}, {roof, b}});

  unbounded.remove(a);
  parts.bodies.remove(a);
  CHECK_FALSE(parts.pairs.listed(a, floor));
  CHECK(parts.pairs.listed(floor, b));
  unbounded.audit(0);
  unbounded.remove(floor);
  parts.bodies.remove(floor);
  CHECK_FALSE(parts.pairs.listed(floor, b));
  CHECK(parts.pairs.listed(roof, b));
  unbounded.audit(0);
  REQUIRE(unbounded.bodies().size() == 1);
  CHECK(unbounded.bodies()[0] == roof);
}

TEST_CASE("Unbounded: the audit finds a pair that is not listed, and a body that is not known") {
  Parts<1> parts;
  Unbounded<Path> unbounded(parts.bodies, parts.clock, parts.pairs);
  const BodySlot a = parts.add(ball<1>(1, {0, 0, 5}));
  const BodySlot floor = parts.add(plane(0));
  CHECK_THROWS_WITH(unbounded.audit(0), Contains("body 1: whether it is unbounded is not known"));
  unbounded.add(floor, Pairs<Path>::Begin::entering);
  CHECK_NOTHROW(unbounded.audit(0));
  const BodySlot b = parts.add(ball<1>(1, {5, 0, 5}));
  CHECK_THROWS_WITH(unbounded.audit(0), Contains("bodies 1 and 2: one is unbounded, and the pair is not active"));
  unbounded.begin_pairs(b);
  CHECK_NOTHROW(unbounded.audit(0));
  parts.pairs.pair_ended(a, floor, 0);
  CHECK_THROWS_AS(unbounded.audit(0), AuditFailure);
  unbounded.begin_pairs(a);

  Unbounded<Path> copy(parts.bodies, parts.clock, parts.pairs);
  copy.become(through_bytes(unbounded.image()));
  CHECK_NOTHROW(copy.audit(0));
  parts.bodies[floor].entered = false;
  CHECK_THROWS_WITH(copy.audit(0), Contains("body 1: whether it is unbounded is not known"));
}

TEST_CASE("Self-contacts: when a body begins and ceases to touch itself, of one time by slot") {
  Parts<1> parts;
  parts.clock.horizon = 1;
  SelfContacts<Path> contacts(parts.bodies, parts.clock);
  const BodySlot one = parts.add(strip()), silent = parts.add(strip(false)), two = parts.add(strip());
  for (const BodySlot slot : {one, silent, two}) CHECK_FALSE(contacts.enter(slot));
  CHECK(contacts.next_time() == never);  // not up to the horizon
  parts.clock.horizon = 10;
  contacts.extend_horizon();
  const double met = contacts.next_time();
  CHECK(met == Approx(2.5).margin(1e-3));
  contacts.audit(2);
  parts.clock.now = met;
  for (const BodySlot slot : {one, two}) {
    REQUIRE(contacts.next_time() == met);
    const auto event = contacts.take_next();
    CHECK(event.slot == slot);
    CHECK_FALSE(event.separates);
    CHECK(contacts.touching(slot));
  }
  CHECK_FALSE(contacts.touching(silent));
  contacts.audit(met);

  SelfContacts<Path> copy(parts.bodies, parts.clock);
  const auto image = through_bytes(contacts.image());
  CHECK_NOTHROW(image.check(parts.bodies.image(), met, parts.options));
  copy.become(image);
  const double parted = contacts.next_time();
  CHECK(parted == Approx(2.625).margin(1e-3));  // all through itself
  contacts.audit(2.5625);
  for (SelfContacts<Path>* each : {&contacts, &copy}) {
    parts.clock.now = met;
    REQUIRE(each->next_time() == parted);
    each->remove(one);
    REQUIRE(each->next_time() == parted);
    parts.clock.now = parted;
    const auto event = each->take_next();
    CHECK(event.slot == two);
    CHECK(event.separates);
    each->audit(parted);
    CHECK(each->next_time() == Approx(3.375).margin(1e-3));  // on the way back
  }
}

TEST_CASE("Self-contacts: the audit finds a body that touches itself and is not known to") {
  Parts<1> parts;
  SelfContacts<Path> contacts(parts.bodies, parts.clock);
  const BodySlot slot = parts.add(strip()), silent = parts.add(strip(false));
  const double now = 2.5625;
  parts.clock.now = now;
  CHECK(contacts.enter(slot));
  CHECK_NOTHROW(contacts.audit(now));
  CHECK_THROWS_WITH(contacts.audit(2), Contains("body 0: whether it touches itself is not known"));  // not yet then
  auto image = contacts.image();
  image.touching.assign(2, 0);
  image.touching[silent] = true;
  CHECK_THROWS_WITH(image.check(parts.bodies.image(), now, parts.options), Contains("is of no body that meets itself"));
}

TEST_CASE("Scripts: the audit finds a piece that should have begun") {
  Scripts<Path> scripts;
  const std::vector pieces{motion<1>({1, 0, 0}, zero, zero, 1), motion<1>({2, 0, 0}, zero, zero, 2)};
  scripts.add(3, pieces);
  CHECK_NOTHROW(scripts.audit(0));
  CHECK_NOTHROW(scripts.audit(1));
  CHECK_THROWS_WITH(scripts.audit(1.5), Contains("slot 3: a piece should have begun"));
  scripts.take_next();
  CHECK_NOTHROW(scripts.audit(1.5));
  auto image = scripts.image();
  image.of[3].insert(image.of[3].begin(), motion<1>({0, 0, 0}, zero, zero, 1.75));
  scripts.become(image);
  CHECK_THROWS_WITH(scripts.audit(1.5), Contains("its pieces are out of order"));
}

TEST_CASE("Wall times: the audit finds a body that reaches a wall before its time") {
  const std::optional<Walls> walls(Walls{{0, 0, 0}, {10, 10, 10}, 1});
  Parts<1> parts;
  WallTimes<Path> times(parts.bodies, walls, parts.clock);
  const BodySlot slot = parts.add(ball<1>(1, {5, 5, 5}, {1, 0, 0}));
  CHECK_THROWS_WITH(times.audit(0), Contains("body 0 and wall 1: it is reached before the body's time"));
  times.schedule(slot);
  CHECK_NOTHROW(times.audit(0));
  while (times.certify()) {
  }
  CHECK_NOTHROW(times.audit(4));
  CHECK_THROWS_WITH(times.audit(4.5), Contains("body 0 and wall 1: it should have been reached"));
  parts.bodies.move(slot, motion<1>({5, 5, 5}, {0, 0, -2}));
  CHECK_THROWS_WITH(times.audit(0), Contains("body 0 and wall 4: it is reached before the body's time"));
  times.become(through_bytes(times.image()));
  CHECK_NOTHROW(times.audit(0));
  while (times.certify()) {
  }
  CHECK(times.next_time() == 2);
}

TEST_CASE("Volumes: the audit finds one that will not be renewed in time") {
  Parts<1> parts;
  auto described = ball<1>(1, {0, 0, 0}, {1, 0, 0});
  described.box = [](double t, const Path& path) {
    const Vector3d at = path.position(t);
    KineticBox<1> box{motion<1>(at - Vector3d(2, 2, 2), zero, zero, t),
                      motion<1>(at + Vector3d(2, 2, 2), zero, zero, t)};
    box.valid_until = t + 1;
    return box;
  };
  const BodySlot slot = parts.add(described);
  parts.volumes.renew(slot);
  CHECK_THROWS_WITH(parts.volumes.audit(0), Contains("body 0: the end of its bounding volume is not in the queue"));
  parts.volumes.schedule(slot);
  CHECK_NOTHROW(parts.volumes.audit(1));
  CHECK_THROWS_WITH(parts.volumes.audit(1.5), Contains("a bounding volume should have been renewed"));
  CHECK_THROWS_WITH(parts.volumes.image(), Contains("body 0 cannot be saved: it has a box function"));
}

TEST_CASE("Box times: the audit finds boxes that should have met") {
  BoxTimes<SlotRank> times;
  times.resize(2);
  times.audit(9);
  times.set(1, 2);
  CHECK(times.next_time() == 2);
  CHECK_NOTHROW(times.audit(2));
  CHECK_THROWS_AS(times.audit(3), AuditFailure);
}

}  // namespace kds::collision::test_small_parts
