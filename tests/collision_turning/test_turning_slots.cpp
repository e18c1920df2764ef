// Bodies that turn: what they do does not depend on which slots they have, but only on the order in which they are
// added.
#include "collision/world.hpp"
#include "tests/collision/world/slot_histories.hpp"
#include "tests/collision_turning/rest_scenes.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace test_turning_slots {
namespace {

using namespace kds::collision;
using namespace kds::tests::rest;

using kds::tests::first_difference;
using kds::tests::Random;
using Motion = kds::certificates::RigidMotion<2>;
using Scene = kds::tests::ComingAndGoing<Motion>;
using History = kds::tests::SlotHistory<Motion>;

/// Equal heaps that fall at one time: boxes and balls in layers, some of them above the gaps of the layer below.
Scene heaps(Random& random) {
  Scene scene;
  const auto heap = [&](std::vector<Body>& bodies, double x, double y, double start) {
    const auto add = [&](const Shape& shape, const Vector3d& at) {
      bodies.push_back(body(shape, at));
      bodies.back().motion[0].path.start = start;
    };
    const Shape block = Box{Vector3d(0.5, 0.5, 0.5)}, ball = Sphere{0.5};
    const bool round = random.one_in(3);
    for (const double side : {-0.5, 0.5}) add(round ? ball : block, {x + 1.01 * side, y, 0.51});
    add(random.one_in(2) ? ball : block, {x, y, 1.55});
  };
  for (const double x : {-6.0, 6.0}) heap(scene.first, x, 0, 0);
  for (std::size_t i = scene.first.size(); i > 1; --i) {
    std::swap(scene.first[i - 1], scene.first[random.below(i)]);
  }
  scene.gone = {random.below(scene.first.size())};
  scene.first.push_back(ground());
  scene.middle = 0.75, scene.end = 1.5;
  for (const double y : {-6.0, 6.0}) heap(scene.later, 0, y, scene.middle);
  return scene;
}

}  // namespace

TEST_CASE("heaps of bodies that turn come to rest in the same way, whichever slots they have", "[turning][slots]") {
  std::size_t contacts = 0, rested = 0, out_of_order = 0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const Scene scene = heaps(random);
    const History plain(scene, options(), nullptr), other(scene, options(), &random);
    REQUIRE(first_difference(plain.told.lines, other.told.lines) == "");
    contacts += plain.told.counts.contains("contact") ? plain.told.counts.at("contact") : 0;
    rested += plain.told.counts.contains("rests") ? plain.told.counts.at("rests") : 0;
    out_of_order += other.out_of_order();
  }
  CHECK(contacts > 100);
  CHECK(rested > 4);
  CHECK(out_of_order > 4);
}

}  // namespace test_turning_slots
