// What the tests of bodies of several parts share: scenes, and what happens according to their parts.
#pragma once

#include "collision/narrow_phase/part_pairs.hpp"
#include "tests/collision/sample_compounds.hpp"
#include "tests/collision/world/resting_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace kds::collision::tests {

/// What happens between two bodies, without its place.
using Told = std::tuple<double, BodyId, BodyId, Kind>;

inline std::vector<Told> told(const std::vector<Event>& events) {
  std::vector<Told> result;
  for (const Event& e : events) result.emplace_back(e.time(), e.a, e.b, e.kind);
  std::sort(result.begin(), result.end());
  return result;
}

/// What a world reports of two bodies on one piece of motion each, as their parts have it, each pair by itself: the
/// contacts of the two begin when one begins and no other lasts, and end when none lasts.
template <int Degree>
void tell_parts(const Scene<Degree>& scene, BodyId a, BodyId b, std::vector<Told>& result) {
  const PlacedShape shape_a = place(scene.bodies[a].shape, scene.bodies[a].orientation);
  const PlacedShape shape_b = place(scene.bodies[b].shape, scene.bodies[b].orientation);
  std::map<double, int> changes;  // of how many pairs of parts are in contact
  for (const PlacedShape& part_a : parts_of(shape_a)) {
    for (const PlacedShape& part_b : parts_of(shape_b)) {
      const TranslatingShape<Degree> x{part_a, scene.bodies[a].motion[0]}, y{part_b, scene.bodies[b].motion[0]};
      double t = 0;
      while (t <= scene.end_time) {
        const double begin = first_contact(x, y, t, scene.end_time, ContactMode::transparent);
        if (begin == never) break;
        t = first_separation(x, y, begin, scene.end_time);
        ++changes[begin];
        if (t != never) --changes[t];
      }
    }
  }
  int before = 0;
  for (const auto& [time, change] : changes) {
    const int after = before + change;
    if (before == 0 && after > 0) result.emplace_back(time, a, b, time == 0 ? Kind::overlap : Kind::contact);
    if (before > 0 && after == 0) result.emplace_back(time, a, b, Kind::separation);
    before = after;
  }
}

template <int Degree>
std::vector<Told> told_by_parts(const Scene<Degree>& scene) {
  std::vector<Told> result;
  for (BodyId a = 0; a < scene.bodies.size(); ++a) {
    for (BodyId b = a + 1; b < scene.bodies.size(); ++b) tell_parts(scene, a, b, result);
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Contacts and separations of each pair take turns.
inline void check_turns(const std::vector<Event>& events) {
  std::map<std::pair<BodyId, BodyId>, bool> together;
  for (const Event& e : events) {
    const bool begins = e.kind == Kind::contact || e.kind == Kind::overlap;
    if (!begins && e.kind != Kind::separation) continue;
    bool& now = together[{e.a, e.b}];
    CHECK(now != begins);
    now = begins;
  }
}

template <int Degree>
Scene<Degree> mixed_scene(std::uint64_t seed, bool scripts) {
  Random random(seed);
  SceneOptions options;
  options.shapes = seed % 2 == 0 ? Shapes::mixture : Shapes::turned_boxes;
  options.numbers = seed % 3 == 0 ? Numbers::coarse : Numbers::fine;
  options.scripts = scripts;
  options.bodies = 12;
  return compound_scene<Degree>(random, options, seed % 2 == 0 ? Parts::all : Parts::solids);
}

inline WorldOptions with_method(BroadPhaseKind method, Response response = Response::none) {
  WorldOptions options;
  options.broad_phase = method;
  options.response = response;
  options.rate = 16;
  return options;
}

/// Whether two bodies overlap by more than roundings: as one body may touch another in several places, it is moved out
/// of one after the other.
inline bool deep(const World<2>& world, BodyId a, BodyId b) {
  constexpr double roundings = 1e-9;
  const PlacedShape shape_a = world.shape(a), shape_b = world.shape(b);
  const auto path = world.motion(a);
  auto moved = world.motion(b);
  for (int i = 0; i < 6; ++i) {
    const TranslatingShape<2> x{shape_a, path}, y{shape_b, moved};
    if (!in_contact(x, y, world.now())) return false;
    moved.coefficients[0] += roundings * contact_at(x, y, world.now()).normal;
  }
  return true;
}

/// Bodies on a lattice, every other one a compound, that fly about and do not overlap at the start.
inline Scene<2> gas(std::uint64_t seed, Parts kinds, bool falls = false) {
  Random random(seed);
  Scene<2> scene;
  for (int i = 0; i < 18; ++i) {
    Vector3d at(3.5 * (i % 3), 3.5 * (i / 3 % 3), 3.5 * (i / 9)), velocity;
    for (int d = 0; d < 3; ++d) velocity[d] = random.between(-2, 2) - 0.4 * (at[d] - 3);
    const Shape shape = i % 2 == 0 ? Shape(random_compound(random, kinds, 3, 0.6))
                                   : i % 3 == 0 ? Shape(Sphere{0.7}) : i % 3 == 1 ? Shape(Box{{0.5, 0.8, 0.6}})
                                                                                  : Shape(Capsule{0.4, 0.5});
    auto b = body<2>(shape, motion<2>(at, velocity, falls ? weight : zero), random.between(0.5, 2));
    b.orientation = unit_quaternion(random.between(0.1, 1), 0.5, 0.25, -0.5);
    scene.bodies.push_back(b);
  }
  return scene;
}

}  // namespace kds::collision::tests
