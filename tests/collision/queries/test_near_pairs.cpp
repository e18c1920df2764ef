// Who enters a place, which pairs are in contact and which come near: against all pairs, one by one.
#include "collision/queries/near_pairs.hpp"

#include "collision/queries/future.hpp"
#include "collision/shapes/half_space.hpp"
#include "tests/collision/queries/sample_bodies.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace kds::collision::test_near_pairs {
namespace {

using Eigen::Vector3d;
using samples::Random;

constexpr BroadPhaseKind methods[] = {BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap, BroadPhaseKind::all_pairs,
                                      BroadPhaseKind::automatic};

/// A hull whose centre is far outside of it.
Shape hull_elsewhere(Random& random) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 6; ++i) points.push_back(Vector3d(2, 1, 0) + random.vector(0.3));
  return convex_hull(points);
}

BodyDescription<1> floor_at(double height) {
  auto description = samples::body(HalfSpace{Vector3d(0, 0, 1), height}, Vector3d::Zero());
  description.fixed = true;
  return description;
}

/// Bodies of all kinds, some of which enter at time 3.
std::vector<BodyId> fill(World<1>& world, Random& random, std::size_t count) {
  std::vector<BodyId> ids;
  const auto ring = samples::torus(8, 4);
  for (std::size_t i = 0; i < count; ++i) {
    const Shape shape = i % 7 == 3 ? hull_elsewhere(random) : samples::random_shape(random, ring);
    auto description = samples::body(shape, random.vector(4), random.vector(1));
    if (i % 11 == 5) description.motion[0].start = 3;
    if (i % 5 == 1) description.collides_with = 0;
    ids.push_back(world.add_body(description));
  }
  return ids;
}

}  // namespace

TEST_CASE("all pairs that come nearer than a distance are those that one finds pair by pair, the same doubles") {
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    Random random(seed);
    World<1> world({.broad_phase = methods[seed % 4]});
    auto ids = fill(world, random, 30);
    world.add_body(floor_at(-20));
    if (seed % 2 == 0) world.advance_to(1);
    world.remove_body(ids[4]);
    std::erase(ids, ids[4]);
    const double distance = random.uniform(0.2, 2), until = world.now() + random.uniform(0, 3);
    INFO("seed " << seed << ", distance " << distance << ", until " << until);
    const auto near = pairs_nearer_than(world, distance, until, [&](BodyId id) { return id != 2; });
    std::size_t expected = 0;
    for (const BodyId a : ids) {
      for (const BodyId b : ids) {
        if (a >= b || a == 2 || b == 2) continue;
        if (world.motion(a).start > world.now() || world.motion(b).start > world.now()) continue;
        const Approach approach = closest_approach(world, a, b, until);
        if (!(approach.distance < distance)) continue;
        ++expected;
        CHECK(std::any_of(near.begin(), near.end(), [&](const NearPair& one) {
          return one.pair == BodyPair{a, b} && one.approach.time == approach.time &&
                 one.approach.distance == approach.distance;
        }));
      }
    }
    CHECK(near.size() == expected);
    CHECK(std::is_sorted(near.begin(), near.end(),
                         [](const NearPair& x, const NearPair& y) { return x.approach.time < y.approach.time; }));
    found += expected;
  }
  CHECK(found > 100);
}

TEST_CASE("the pairs in contact are those that touch or rest, each once") {
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    World<1> world({.broad_phase = methods[seed % 4]});
    const auto ids = fill(world, random, 60);
    world.advance_to(random.uniform(0, 4));
    std::vector<BodyPair> expected;
    for (const BodyId a : ids) {
      for (const BodyId b : ids) {
        if (a < b && world.touching(a, b)) expected.push_back({a, b});
      }
    }
    CHECK(contact_pairs(world) == expected);
    found += expected.size();
  }
  CHECK(found > 20);
}

TEST_CASE("balls that lie on each other are in contact, and what flies is not") {
  World<2> world({.response = Response::elastic});
  const auto ball = [&](double z, bool fixed) {
    BodyDescription<2> description{.shape = Sphere{1}, .fixed = fixed, .restitution = 0};
    const Vector3d pull(0, 0, fixed ? 0 : -5);
    description.motion = {certificates::PointMotion<2>::parabola(Vector3d(0, 0, z), Vector3d::Zero(), pull)};
    return world.add_body(description);
  };
  const BodyId ground = ball(0, true), lying = ball(2.001, false), flying = ball(1000, false);
  CHECK(contact_pairs(world).empty());
  world.advance_to(1);
  CHECK(contact_pairs(world) == std::vector{BodyPair{ground, lying}});
  CHECK(world.contains(flying));
}

TEST_CASE("all bodies are visited by id, those that enter later and those that have no box included") {
  World<1> world({});
  std::vector<BodyId> expected;
  for (int i = 0; i < 5; ++i) {
    auto description = samples::body(Sphere{0.5}, Vector3d(3. * i, 0, 0));
    description.motion[0].start = i < 3 ? 0 : 100;
    expected.push_back(world.add_body(description));
  }
  expected.push_back(world.add_body(floor_at(-9)));
  const auto all = [&] {
    std::vector<BodyId> ids;
    world.visit_bodies([&](BodyId id) { ids.push_back(id); });
    return ids;
  };
  CHECK(all() == expected);
  world.advance_to(1);
  world.remove_body(expected[1]);
  expected.erase(expected.begin() + 1);
  expected.push_back(world.add_body(samples::body(Sphere{0.5}, Vector3d(0, 9, 0))));
  CHECK(expected.back() == body_id(1, 1));
  CHECK(all() == expected);
  world.visit_bodies([&](BodyId id) { world.remove_body(id); });
  CHECK(world.size() == 0);
}

TEST_CASE("all who enter a place are met when they would be one by one, by time") {
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    World<1> world({.broad_phase = methods[seed % 4]});
    const auto ids = fill(world, random, 30);
    world.advance_to(0.5);
    const PlacedShape place_kept = place(Box{Vector3d(1, 2, 1)}, Eigen::Quaterniond::Identity());
    const certificates::PointMotion<1> still{{Vector3d(0, 0, 0), random.vector(seed % 2)}};
    const auto hits = next_contacts(world, place_kept, still, 4);
    CHECK(std::is_sorted(hits.begin(), hits.end(), detail::sooner));
    std::size_t expected = 0;
    for (const BodyId id : ids) {
      const auto one = next_contact(world, place_kept, still, 4, [&](BodyId other) { return other == id; });
      const auto same = [&](const Hit& hit) { return hit.body == id && hit.contact.time == one->contact.time; };
      if (one) CHECK(std::any_of(hits.begin(), hits.end(), same));
      expected += one.has_value();
    }
    CHECK(hits.size() == expected);
    if (!hits.empty()) CHECK(next_contact(world, place_kept, still, 4)->body == hits[0].body);
    found += expected;
    const auto of_body = next_contacts_of(world, ids[0], 4);
    const auto first = next_contact_of(world, ids[0], 4);
    REQUIRE(first.has_value() == !of_body.empty());
    if (first) CHECK(first->body == of_body[0].body);
    for (const Hit& hit : of_body) CHECK(next_contact_between(world, ids[0], hit.body, 4)->time == hit.contact.time);
  }
  CHECK(found > 60);
}

TEST_CASE("pairs that come near are refused for distances and times that are none") {
  World<1> world({.start_time = 2});
  world.add_body(samples::body(Sphere{1}, {0, 0, 0}));
  CHECK(pairs_nearer_than(world, 1, 2).empty());
  for (const double distance : {0.0, -1.0, std::nan(""), never}) {
    CHECK_THROWS_AS(pairs_nearer_than(world, distance, 3), std::invalid_argument);
  }
  for (const double until : {1.0, never, std::nan("")}) {
    CHECK_THROWS_AS(pairs_nearer_than(world, 1, until), std::invalid_argument);
  }
  CHECK_THROWS_AS(next_contacts_of(world, 0, 1), std::invalid_argument);
}

}  // namespace kds::collision::test_near_pairs
