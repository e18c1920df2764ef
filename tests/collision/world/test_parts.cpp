// The parts of a world, each by itself.
#include "tests/collision/world/parts.hpp"

#include "collision/world/scripts.hpp"
#include "collision/world/wall_times.hpp"
#include "kds/audit.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace kds::collision::test_parts {
namespace {

using namespace tests;
using certificates::PointMotion;

constexpr double no_limit = never;

WorldOptions resolved() {
  WorldOptions options;
  options.response = Response::elastic;
  return options;
}

TEST_CASE("Reports: what is told of a body that is gone, and of the next in its slot, are two things") {
  Reports reports;
  const BodyId gone = body_id(0, 1), next = body_id(1, 1);
  reports.add_volumes(false, 0, gone, 1);
  reports.add(Reports::Kind::overlap, 0, gone, {});
  reports.add(Reports::Kind::moved, gone, gone, {});
  reports.forget(gone, 7);
  reports.add_volumes(true, 0, next, 1);  // it does not take back the end of the other pair
  const auto end = reports.take_first();
  CHECK(end.kind == Reports::Kind::pair_ended);
  CHECK(end.b == gone);
  CHECK(end.user_data_b == 7);
  const auto begin = reports.take_first();
  CHECK(begin.kind == Reports::Kind::pair_began);
  CHECK(begin.b == next);
  CHECK(reports.empty());
}

TEST_CASE("Reports: what is dropped with a removed body is neither told nor in a snapshot, wherever it stands") {
  Reports reports;
  reports.add(Reports::Kind::overlap, 1, 2, {});
  reports.add(Reports::Kind::separation, 1, 3, {});
  reports.add(Reports::Kind::overlap, 0, 3, {});
  reports.add(Reports::Kind::moved, 2, 2, {});
  reports.forget(2, 5);
  REQUIRE(reports.image().size() == 2);
  reports.forget(3, 6);
  REQUIRE(reports.image().size() == 1);
  CHECK(reports.image()[0].user_data_b == 6);
  Reports copy;
  copy.become(reports.image());
  CHECK(copy.take_first().user_data_b == 6);
  CHECK(copy.empty());
  CHECK(reports.take_back(Reports::Kind::separation, 1, 3));
  CHECK(reports.empty());  // what was left is of removed bodies
  CHECK(reports.image().empty());
  reports.add(Reports::Kind::overlap, 1, 4, {});
  CHECK(reports.take_first().kind == Reports::Kind::overlap);
  CHECK(reports.empty());
}

TEST_CASE("Scripts: pieces begin in order of time, all of one time at once, by id") {
  Scripts<PointMotion<1>> scripts;
  CHECK(scripts.next_time() == never);
  const auto piece = [](double start) { return motion<1>({start, 0, 0}, zero, zero, start); };
  const std::vector of_5{piece(1), piece(2)};
  const std::vector of_2{piece(2), piece(4)};
  const std::vector of_9{piece(3)};
  scripts.add(5, of_5);
  scripts.add(2, of_2);
  scripts.add(9, of_9);
  REQUIRE(scripts.next_time() == 1);
  auto next = scripts.take_next();
  REQUIRE(next.size() == 1);
  CHECK(next[0].slot == 5);
  CHECK(next[0].motion.start == 1);
  REQUIRE(scripts.next_time() == 2);

  Scripts<PointMotion<1>> copy;
  copy.become(scripts.image());
  for (Scripts<PointMotion<1>>* each : {&scripts, &copy}) {
    next = each->take_next();
    REQUIRE(next.size() == 2);
    CHECK(next[0].slot == 2);
    CHECK(next[1].slot == 5);
    each->clear(9);
    CHECK(each->next_time() == 4);
    each->clear(2);
    each->clear(7);  // has none
    CHECK(each->next_time() == never);
  }
}

TEST_CASE("Wall times: the body that comes next, its exact time and its wall") {
  const std::optional<Walls> walls(Walls{{0, 0, 0}, {10, 10, 10}, 1});
  Parts<2> parts;
  WallTimes<PointMotion<2>> times(parts.bodies, walls, parts.clock);
  const BodySlot to_right = parts.add(ball<2>(1, {5, 5, 5}, {1, 0, 0}));             // at 4
  const BodySlot falls = parts.add(ball<2>(1, {5, 5, 3}, {0, 0, 0}, {0, 0, -0.5}));  // at 2, on wall -z
  const BodySlot rests = parts.add(ball<2>(1, {5, 5, 1}));
  const std::array<BroadPhase<2>::Entry, 3> all{{{to_right, nullptr}, {falls, nullptr}, {rests, nullptr}}};
  times.schedule(all);
  const auto certified = [&] {
    while (times.next_time() < never && times.certify()) {
    }
    return times.next_time();
  };
  REQUIRE(certified() == 2);
  CHECK(times.next_body() == falls);
  parts.clock.now = 2;
  CHECK(times.next_wall() == 4);
  times.remove(falls);
  REQUIRE(certified() == 4);
  CHECK(times.next_body() == to_right);
  parts.clock.now = 4;
  CHECK(times.next_wall() == 1);
  parts.bodies.move(to_right, motion<2>({9, 5, 5}, {-1, 0, 0}, zero, 4));
  times.schedule(to_right);
  CHECK(certified() == 12);
  CHECK(times.next_wall() == 0);
}

TEST_CASE("Wall times: nothing beyond the horizon, until it is extended") {
  const std::optional<Walls> walls(Walls{{0, 0, 0}, {10, 10, 10}, 1});
  Parts<1> parts;
  parts.clock.horizon = 3;
  WallTimes<PointMotion<1>> times(parts.bodies, walls, parts.clock);
  const BodySlot id = parts.add(ball<1>(1, {5, 5, 5}, {1, 0, 0}));
  times.schedule(id);
  CHECK(times.next_time() == never);
  parts.clock.horizon = 5;
  times.extend_horizon();
  CHECK(times.certify());
  CHECK(times.next_time() == 4);
}

template <int Degree>
int first_of_walls_reached_together(const Vector3d& at, const Vector3d& velocity) {
  const std::optional<Walls> walls(Walls{{0, 0, 0}, {10, 1000, 10}, 1});
  Parts<Degree> parts;
  WallTimes<PointMotion<Degree>> times(parts.bodies, walls, parts.clock);
  times.schedule(parts.add(ball<Degree>(1, at, velocity)));
  while (times.certify()) {
  }
  REQUIRE(times.next_time() == 4);
  return times.next_wall();
}

TEST_CASE("Wall times: of walls that are reached at one time it is the one of the lowest number") {
  // The time of the wall at y = 1000 is the least at first, when it is a bound, since its coordinates are rounded most.
  CHECK(first_of_walls_reached_together<1>({5, 995, 5}, {1, 1, 0}) == 1);
  CHECK(first_of_walls_reached_together<1>({5, 995, 5}, {0, 1, -1}) == 3);
  CHECK(first_of_walls_reached_together<1>({5, 995, 5}, {-1, 1, 1}) == 0);
  CHECK(first_of_walls_reached_together<2>({5, 995, 5}, {1, 1, 0}) == 1);
  CHECK(first_of_walls_reached_together<2>({5, 995, 5}, {-1, 1, 1}) == 0);
}

TEST_CASE("Volumes: a caller's box is asked for when it is renewed, and ends when it says") {
  Parts<1> parts;
  int calls = 0;
  auto described = ball<1>(1, {0, 0, 0}, {1, 0, 0});
  described.box = [&](double t, const certificates::PointMotion<1>& path) {
    ++calls;
    const Vector3d at = path.position(t);
    KineticBox<1> box{motion<1>(at - Vector3d(2, 2, 2), zero, zero, t),
                      motion<1>(at + Vector3d(2, 2, 2), zero, zero, t)};
    box.valid_until = t + 1;
    return box;
  };
  const BodySlot plain = parts.add(ball<1>(1, {9, 9, 9}));
  const BodySlot id = parts.add(described);
  CHECK(parts.volumes.from_caller(id));
  CHECK_FALSE(parts.volumes.from_caller(plain));
  parts.volumes.renew(id);
  parts.volumes.schedule(id);
  parts.volumes.schedule(plain);
  CHECK(calls == 1);
  CHECK(parts.volumes.box(id).min.position(0.0) == Vector3d(-2, -2, -2));
  CHECK(parts.volumes.next_time() == 1);
  CHECK(parts.volumes.next_body() == id);
  parts.volumes.remove(id);
  CHECK(parts.volumes.next_time() == never);
}

TEST_CASE("Pairs: contacts of the pairs that are listed, the earliest first, each at its exact time") {
  const auto seed = GENERATE(range(1u, 9u));
  CAPTURE(seed);
  Random random(seed);
  Parts<2> parts(resolved());
  for (int i = 0; i < 8; ++i) {
    const auto place = [&] { return Vector3d(random.between(-9, 9), random.between(-9, 9), random.between(-9, 9)); };
    const Vector3d c0 = place();
    const Shape shape = i % 2 == 0 ? Shape(Sphere{0.5}) : Shape(Box{{0.4, 0.5, 0.6}});
    parts.add(body<2>(shape, motion<2>(c0, -0.5 * c0 + 0.02 * place(), 0.01 * place())));
  }
  std::vector<double> expected;
  for (BodySlot a = 0; a < 8; ++a) {
    for (BodySlot b = a + 1; b < 8; ++b) {
      parts.pairs.pair_began(a, b, 0);
      const double t =
          first_contact(parts.bodies.moving(a), parts.bodies.moving(b), 0, no_limit, ContactMode::resolved);
      if (t < never) expected.push_back(t);
    }
  }
  std::sort(expected.begin(), expected.end());
  REQUIRE(!expected.empty());
  CHECK_FALSE(parts.pairs.tested());
  parts.pairs.test();
  CHECK(parts.pairs.tested());
  CHECK(parts.counters.pair_tests == 28);
  for (const double t : expected) {
    while (parts.pairs.certify()) {
    }
    REQUIRE(parts.pairs.next_time() == t);
    const auto event = parts.pairs.take_next();
    CHECK_FALSE(event.separates);
    CHECK(event.a < event.b);
    CHECK(parts.pairs.contact(event.a, event.b, t, event.found).time == t);
  }
  while (parts.pairs.next_time() < never && parts.pairs.certify()) {
  }
  CHECK(parts.pairs.next_time() == never);
  parts.pairs.audit(0);
}

TEST_CASE("Pairs: what overlaps lives on when the broad phase does not list it, until it has separated") {
  Parts<1> parts;  // mode none
  parts.add(ball<1>(1, {0, 0, 0}));
  parts.add(ball<1>(1, {1, 0, 0}, {1, 0, 0}));
  parts.pairs.set_begin(Pairs<PointMotion<1>>::Begin::entering);
  parts.pairs.pair_began(0, 1, 0);
  parts.pairs.set_begin(Pairs<PointMotion<1>>::Begin::moving);
  parts.pairs.test();
  CHECK(parts.pairs.overlapping(0, 1));
  REQUIRE(parts.reports.take_first().kind == Reports::Kind::overlap);
  parts.pairs.pair_ended(0, 1, 0.5);  // as a broad phase would that knows other boxes
  CHECK_FALSE(parts.pairs.listed(0, 1));
  CHECK(parts.pairs.overlapping(0, 1));
  parts.pairs.test();
  parts.pairs.audit(0.5);
  REQUIRE(parts.pairs.next_time() == 1);
  parts.clock.now = 1;
  CHECK(parts.pairs.take_next().separates);
  CHECK_FALSE(parts.pairs.overlapping(0, 1));
  parts.pairs.test();
  CHECK(parts.pairs.next_time() == never);
  parts.pairs.pair_began(0, 1, 1);  // a pair of its own, with nothing of the old one
  CHECK_FALSE(parts.pairs.overlapping(0, 1));
}

TEST_CASE("Pairs: one that is let pass meets again only after it has separated") {
  Parts<1> parts(resolved());
  parts.add(ball<1>(1, {0, 0, 0}));
  parts.add(ball<1>(1, {4, 0, 0}, {-1, 0, 0}));
  parts.pairs.pair_began(0, 1, 0);
  parts.pairs.test();
  while (parts.pairs.certify()) {
  }
  REQUIRE(parts.pairs.next_time() == 2);
  parts.clock.now = 2;
  CHECK_FALSE(parts.pairs.take_next().separates);
  parts.pairs.let_pass(0, 1);
  parts.pairs.test();
  REQUIRE(parts.pairs.next_time() == 6);
  parts.clock.now = 6;
  CHECK(parts.pairs.take_next().separates);
  parts.pairs.test();
  CHECK(parts.pairs.next_time() == never);
}

TEST_CASE("Pairs: a copy made of the image goes on alike") {
  Parts<2> parts(resolved());
  Parts<2> copy(resolved());
  for (Parts<2>* each : {&parts, &copy}) {
    each->add(ball<2>(1, {0, 0, 0}));
    each->add(ball<2>(1, {5, 0, 0}, {-1, 0, 0}));
    each->add(ball<2>(1, {-9, 0, 0}, {1, 0, 0}, {0.1, 0, 0}));
  }
  parts.pairs.pair_began(0, 1, 0);
  parts.pairs.pair_began(0, 2, 0);
  parts.pairs.test();
  copy.pairs.become(parts.pairs.image());
  for (int i = 0; i < 2; ++i) {
    while (parts.pairs.certify()) {
    }
    while (copy.pairs.certify()) {
    }
    REQUIRE(parts.pairs.next_time() < never);
    CHECK(copy.pairs.next_time() == parts.pairs.next_time());
    const auto event = parts.pairs.take_next();
    const auto same = copy.pairs.take_next();
    CHECK(same.a == event.a);
    CHECK(same.b == event.b);
  }
}

TEST_CASE("Resting contacts: a ball that is pressed on a fixed box stays, and slides off its edge") {
  Parts<2> parts(resolved());
  const BodySlot floor = parts.add(fixed_body<2>(Box{{4, 4, 1}}, motion<2>({0, 0, -1})));
  const BodySlot resting = parts.add(ball<2>(1, {0, 0, 1}, {1, 0, 0}, {0, 0, -5}));
  CHECK(parts.resting.empty());
  parts.resting.add({.a = floor, .b = resting, .normal = Vector3d(0, 0, 1)});
  CHECK_FALSE(parts.resting.empty());
  CHECK(parts.resting.rests(resting));
  parts.resting.disturb(resting);
  CHECK_FALSE(parts.resting.solved());
  parts.resting.solve();
  CHECK(parts.resting.solved());
  REQUIRE(std::find(parts.taken_up.begin(), parts.taken_up.end(), resting) != parts.taken_up.end());
  CHECK(parts.bodies.motion(resting).coefficients[2].isZero(0));
  CHECK(parts.bodies.motion(resting).coefficients[1] == Vector3d(1, 0, 0));
  parts.resting.audit(0);
  const double off = parts.resting.next_time();
  CHECK(off > 4);  // round the edge, until it is a slack away
  CHECK(off < 4.01);
  parts.clock.now = off;
  parts.resting.process();
  CHECK(parts.resting.empty());
  CHECK(parts.bodies.motion(resting).coefficients[2] == Vector3d(0, 0, -5));
  CHECK(parts.resting.next_time() == never);
}

TEST_CASE("Resting contacts: a body that jumps has none any more") {
  Parts<2> parts(resolved());
  const BodySlot floor = parts.add(fixed_body<2>(Box{{4, 4, 1}}, motion<2>({0, 0, -1})));
  const BodySlot resting = parts.add(ball<2>(1, {0, 0, 1}, zero, {0, 0, -5}));
  parts.resting.add({.a = floor, .b = resting, .normal = Vector3d(0, 0, 1)});
  parts.resting.disturb(resting);
  parts.resting.solve();
  parts.resting.audit(0);
  parts.resting.drop_all(resting);
  CHECK(parts.resting.empty());
  CHECK(parts.resting.find(floor, resting) == RestingContacts<PointMotion<2>>::none);
}

}  // namespace
}  // namespace kds::collision::test_parts
