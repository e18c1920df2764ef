// What must not happen by chance happens here on purpose.
#include "tests/collision/counted_runs.hpp"

#include <catch2/catch.hpp>

#include <utility>
#include <vector>

namespace kds::collision::test_degeneracies {
namespace {

using namespace tests;

/// n^3 bodies of size one on the integers.
template <int Degree>
std::vector<BodyDescription<Degree>> lattice(int n, const Shape& shape, const Vector3d& corner,
                                             const Vector3d& velocity) {
  std::vector<BodyDescription<Degree>> result;
  for (int i = 0; i < n * n * n; ++i) {
    const Vector3d cell(i % n, i / n % n, i / (n * n));
    result.push_back(body<Degree>(shape, motion<Degree>(corner + cell, velocity)));
  }
  return result;
}

TEST_CASE("Many ends at one value: a lattice of touching boxes or balls moves as one", "[degenerate]") {
  for (const Shape& shape : {Shape(Box{{0.5, 0.5, 0.5}}), Shape(Sphere{0.5})}) {
    for (const auto method : all_methods) {
      for (const auto response : {Response::none, Response::elastic}) {
        CHECK(run_audited(lattice<1>(4, shape, {0, 0, 0}, {1, 2, -1}), with(response, method), 10).empty());
      }
    }
  }
}

TEST_CASE("Many ends at one time: two lattices meet face to face", "[degenerate]") {
  for (const Shape& shape : {Shape(Box{{0.5, 0.5, 0.5}}), Shape(Sphere{0.5})}) {
    for (const auto method : all_methods) {
      // Left one at rest with its right faces at 2.5, right one with its left faces at 4.5, closing at 2.
      auto bodies = lattice<1>(3, shape, {0, 0, 0}, {0, 0, 0});
      for (const auto& b : lattice<1>(3, shape, {5, 0, 0}, {-2, 0, 0})) bodies.push_back(b);
      const auto passing = run_audited(bodies, with(Response::none, method), 100);
      const std::vector<Event> contacts = contacts_of(passing);
      REQUIRE(contacts.size() == 9 * 9);  // each of 9 rows: 3 by 3
      // Three fronts of nine: 1, 1.5, 2 ... and nothing between neighbouring rows, which touch all along.
      CHECK(count_at(contacts, 1) == 9);
      CHECK(count_at(contacts, 1.5) == 18);
      CHECK(count_at(contacts, 2) == 27);
      CHECK(count(passing, Kind::separation) == 81);

      // Elastic: each row is a Newton's cradle of three and three.
      const auto bouncing = run_audited(bodies, with(Response::elastic, method), 100);
      const auto hits = count(bouncing, Kind::contact);
      CHECK(hits == 9 * 9);
      for (const Event& e : bouncing) CHECK(e.time() == 1);
    }
  }
}

TEST_CASE("A touch without crossing: a ball grazes another exactly", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const auto response : {Response::none, Response::elastic}) {
      const auto events =
          run_audited<1>({ball<1>(1, {0, 0, 0}), ball<1>(1, {-4, 2, 0}, {1, 0, 0})}, with(response, method), 9);
      for (const Event& e : events) CHECK(is_pair_event(e));
    }
    // An ulp nearer and they meet.
    const auto events = run_audited<1>({ball<1>(1, {0, 0, 0}), ball<1>(1, {-4, next_down(2.0), 0}, {1, 0, 0})},
                                       with(Response::none, method), 9);
    CHECK(count(events, Kind::contact) == 1);
  }
}

TEST_CASE("A touch without crossing: a thrown body reaches another at its turning point", "[degenerate]") {
  const Shape unit_ball = Sphere{1};
  const Shape unit_box = Box{{1, 1, 1}};
  const std::vector<std::pair<Shape, Shape>> shapes{
      {unit_ball, unit_ball}, {unit_box, unit_box}, {unit_box, unit_ball}, {unit_ball, unit_box}};
  for (const auto method : all_methods) {
    for (const auto& [first, second] : shapes) {
      for (const double height : {6.0, next_down(6.0)}) {
        // Rises 4 in two seconds and falls back.
        const auto thrown = body<2>(first, motion<2>({0, 0, 0}, {0, 0, 4}, {0, 0, -1}));
        const auto target = body<2>(second, motion<2>({0, 0, height}));
        const auto events = run_audited<2>({target, thrown}, with(Response::none, method), 9);
        const auto met = count(events, Kind::contact);
        CHECK(met == (height < 6 ? 1 : 0));
      }
    }
  }
}

TEST_CASE("Equal motions: bodies that touch for ever, or overlap for ever", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const double distance : {2.0, 1.0, 0.0}) {
      std::vector<BodyDescription<2>> bodies;
      for (int i = 0; i < 4; ++i) bodies.push_back(box<2>({1, 1, 1}, {i * distance, 0, 0}, {1, 2, 3}, {-1, 0, 1}));
      const auto events = run_audited(bodies, with(Response::none, method), 10);
      const auto overlaps = count(events, Kind::overlap);
      CHECK(overlaps == (distance == 2 ? 0 : distance == 1 ? 3 : 6));
      for (const Event& e : events) CHECK(e.time() == 0);
    }
  }
}

TEST_CASE("A swap at time zero", "[degenerate]") {
  for (const auto method : all_methods) {
    // They touch at the start and close in, or part.
    for (const double speed : {-1.0, 1.0}) {
      const auto events = run_audited<1>({box<1>({1, 1, 1}, {0, 0, 0}), box<1>({1, 1, 1}, {2, 0, 0}, {speed, 0, 0})},
                                         with(Response::none, method), 1);
      REQUIRE(count(events, Kind::overlap) == (speed < 0 ? 1 : 0));
      CHECK(count(events, Kind::contact) == 0);
      CHECK(count_at(events, 0) == events.size());
    }
  }
}

TEST_CASE("Bodies at rest cost no event", "[degenerate]") {
  EventLog<2> log;
  World<2> world(with(Response::none), &log);
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    world.add_body(ball<2>(0.5, {random.between(0, 20), random.between(0, 20), random.between(0, 20)}));
  }
  world.advance_to(0);
  const auto tests = world.counters().pair_tests;
  world.advance_to(1000);
  CHECK(world.counters().pair_tests == tests);
  CHECK(world.counters().broad_phase.swaps == 0);
  for (const Event& e : log.events) CHECK(e.time() == 0);
}

TEST_CASE("Bodies exactly coincident overlap once and part when they part", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const Shape& shape : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}}), Shape(MeshShape{cube(), 1})}) {
      const auto a = body<1>(shape, motion<1>({1, 2, 3}));
      const auto same = run_audited<1>({a, a, a}, with(Response::none, method), 5);
      CHECK(count(same, Kind::overlap) == 3);
      CHECK(count_at(same, 0) == same.size());
      for (const auto response : {Response::none, Response::elastic}) {
        const auto b = body<1>(shape, motion<1>({1, 2, 3}, {1, 0, 0}));
        const auto events = run_audited<1>({a, b}, with(response, method), 5);
        CHECK(count(events, Kind::overlap) == 1);
        const auto parted =
            std::find_if(events.begin(), events.end(), [](const Event& e) { return e.kind == Kind::separation; });
        REQUIRE((parted != events.end()) == (response == Response::none));
        if (parted != events.end()) CHECK(parted->time() == Approx(2).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("Meeting at a corner: boxes corner to corner", "[degenerate]") {
  for (const auto method : all_methods) {
    const auto meet = [&](const Vector3d& velocity) {
      const auto events = run_audited<1>({box<1>({1, 1, 1}, {0, 0, 0}), box<1>({1, 1, 1}, {4, 4, 4}, velocity)},
                                         with(Response::none, method), 3);
      const std::vector<Event> contacts = contacts_of(events);
      return contacts;
    };
    const auto head_on = meet({-1, -1, -1});
    REQUIRE(head_on.size() == 1);
    CHECK(head_on[0].time() == 2);
    CHECK(head_on[0].contact.point == Vector3d(1, 1, 1));
    CHECK(meet({-1, -1, 0}).empty());
    CHECK(meet({-2, -1, -1}).size() == 1);
    CHECK(meet({-2, -1, -1})[0].time() == 2);
  }
}

TEST_CASE("Meeting at a corner: three bodies at one point and time", "[degenerate]") {
  for (const auto method : all_methods) {
    // Three balls meet in a triangle, all at t = 1; exact numbers by a 3-4-5 triangle.
    std::vector<BodyDescription<1>> bodies{ball<1>(1.5, {0, 0, 0}), ball<1>(1.5, {4, 0, 0}, {-1, 0, 0}),
                                           ball<1>(1.5, {0, 4, 0}, {0, -1, 0})};
    const auto passing = run_audited(bodies, with(Response::none, method), 1);
    const std::vector<Event> contacts = contacts_of(passing);
    REQUIRE(contacts.size() == 2);
    CHECK(contacts[0].time() == 1);
    CHECK(contacts[1].time() == 1);
    const auto events = run_audited(bodies, with(Response::elastic, method), 10);
    REQUIRE(events.size() >= 2);
    CHECK(in_order_of_time(events));
    // What is at one time comes by (a, b).
    std::vector<Event> first;
    for (const Event& e : events) {
      if (e.kind == Kind::contact && e.time() == 1) first.push_back(e);
    }
    REQUIRE(first.size() == 2);
    CHECK(first[0].b == 1);
    CHECK(first[1].b == 2);
  }
}

TEST_CASE("Aligned equal cubes face to face, as boxes and as meshes", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const auto response : {Response::none, Response::elastic}) {
      for (int kinds = 0; kinds < 4; ++kinds) {
        const auto shape = [&](int bit) -> Shape {
          if ((kinds & bit) != 0) return MeshShape{cube(), 1};
          return Box{{1, 1, 1}};
        };
        const auto events = run_audited<1>(
            {body<1>(shape(1), motion<1>({0, 0, 0})), body<1>(shape(2), motion<1>({4, 0, 0}, {-1, 0, 0}))},
            with(response, method), 3);
        const std::vector<Event> contacts = contacts_of(events);
        INFO("kinds " << kinds << ", response " << static_cast<int>(response));
        REQUIRE(contacts.size() == 1);
        CHECK(contacts[0].time() <= 2);
        CHECK(contacts[0].time() > 2 - 1e-12);
        CHECK((contacts[0].contact.normal - Vector3d(1, 0, 0)).norm() < 1e-12);
        CHECK(contacts[0].contact.point[0] == Approx(1));
      }
    }
  }
}

TEST_CASE("Newton's cradle: the last ball leaves with the first one's speed", "[degenerate]") {
  for (const auto method : all_methods) {
    for (int in = 1; in <= 3; ++in) {
      WorldOptions options = with(Response::elastic, method);
      EventLog<1> log;
      World<1> world(options, &log);
      constexpr int n = 7;
      for (int i = 0; i < n; ++i) {
        const bool moving = i < in;
        world.add_body(ball<1>(1, {2.0 * i - (moving ? 4 : 0), 0, 0}, {moving ? 2.0 : 0.0, 0, 0}));
      }
      world.advance_to(4);
      world.audit();
      INFO(in << " in");
      for (BodyId i = 0; i < n; ++i) {
        CHECK(world.motion(i).velocity(4)[0] == (i >= n - static_cast<BodyId>(in) ? 2 : 0));
      }
      for (const Event& e : log.of(Kind::contact)) CHECK(e.time() == 2);
      CHECK(log.count(Kind::contact) == static_cast<std::size_t>(in * (n - in)));
      CHECK(log.count(Kind::rebound_suppressed) == 0);
    }
  }
}

TEST_CASE("Sliding in exact touch is no contact", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const auto response : {Response::none, Response::elastic}) {
      const auto floor = fixed_body<1>(Box{{10, 10, 1}}, motion<1>({0, 0, -1}));
      for (const auto& slider : {box<1>({1, 1, 1}, {-5, 0, 1}, {1, 0.5, 0}), ball<1>(1, {-5, 0, 1}, {1, 0.5, 0})}) {
        for (const Event& e : run_audited<1>({floor, slider}, with(response, method), 20)) CHECK(is_pair_event(e));
      }
    }
  }
}

TEST_CASE("Resting on each other in free fall is no contact", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const auto response : {Response::none, Response::elastic}) {
      const auto events = run_audited<2>(
          {box<2>({1, 1, 1}, {0, 0, 0}, {0, 0, 3}, {0, 0, -5}), box<2>({1, 1, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, -5}),
           ball<2>(1, {0, 0, 4}, {0, 0, 3}, {0, 0, -5})},
          with(response, method), 10);
      CHECK(events.empty());
    }
  }
}

}  // namespace
}  // namespace kds::collision::test_degeneracies
