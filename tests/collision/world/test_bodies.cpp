// The bodies of a world by themselves: slots, ids and their order, filters, images.
#include "tests/collision/world/parts.hpp"

#include "collision/world/bodies_image.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace kds::collision::test_bodies {
namespace {

using namespace tests;
using certificates::PointMotion;

TEST_CASE("Bodies: the slot of one that is removed is given again, its id is not") {
  Parts<1> parts;
  Bodies<PointMotion<1>>& bodies = parts.bodies;
  const auto one = ball<1>(1, {0, 0, 0});
  CHECK(bodies.id_of(parts.add(one)) == 0);
  CHECK(bodies.id_of(parts.add(one)) == 1);
  bodies.remove(0);
  CHECK_FALSE(bodies.contains(0));
  CHECK(bodies.contains(1));
  CHECK(bodies.id_of(parts.add(one)) == body_id(1, 0));
  CHECK_FALSE(bodies.contains(0));
  CHECK(bodies.slot_of(body_id(1, 0)) == 0);
  CHECK(bodies.size() == 2);
  CHECK(bodies.slots() == 2);
  bodies.remove(1);
  bodies.remove(0);  // the slot that became free last comes first
  CHECK(bodies.id_of(parts.add(one)) == body_id(2, 0));
  CHECK(bodies.id_of(parts.add(one)) == body_id(2, 1));
  CHECK(bodies.id_of(parts.add(one)) == body_id(2, 2));
}

TEST_CASE("Bodies: ids ascend in the order in which bodies are added, and come in that order") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    Parts<1> parts;
    BodyId last = 0;
    std::vector<BodySlot> there;
    for (int i = 0; i < 100; ++i) {
      if (!there.empty() && random.one_in(2)) {
        std::swap(there[random.below(there.size())], there.back());
        parts.bodies.remove(there.back());
        there.pop_back();
        continue;
      }
      there.push_back(parts.add(ball<1>(1, {0, 0, 0})));
      const BodyId id = parts.bodies.id_of(there.back());
      REQUIRE((id > last || id == 0));
      last = id;
      for (const BodySlot other : there) REQUIRE(parts.bodies.before(other, there.back()) == (other != there.back()));
    }
    parts.bodies.image().check(0);
  }
}

TEST_CASE("Bodies: what is thrown says which body it was and whether it was removed") {
  Parts<1> parts;
  parts.add(ball<1>(1, {0, 0, 0}));
  parts.bodies.remove(parts.add(ball<1>(1, {0, 0, 0})));
  CHECK_THROWS_WITH(parts.bodies.slot_of(1), "World: there is no body 1 (generation 0 of slot 1): it was removed");
  CHECK_THROWS_WITH(parts.bodies.slot_of(body_id(1, 1)),
                    "World: there is no body 4294967297 (generation 1 of slot 1): it has never been there");
  CHECK_THROWS_WITH(parts.bodies.slot_of(2),
                    "World: there is no body 2 (generation 0 of slot 2): it has never been there");
  CHECK_THROWS_WITH(parts.bodies.slot_of(body_id(7, 0)),
                    "World: there is no body 30064771072 (generation 7 of slot 0): it has never been there");
}

TEST_CASE("Bodies: when generations are used up, slots below the last one are not given again") {
  Parts<1> parts;
  const auto one = ball<1>(1, {0, 0, 0});
  for (int i = 0; i < 3; ++i) parts.add(one);
  parts.bodies.remove(2), parts.bodies.remove(0);
  auto image = parts.bodies.image();
  image.next_id = body_id(last_generation - 1, 3);
  image.check(0);
  parts.bodies.become(image);
  const BodyId last = body_id(last_generation, 0);
  CHECK_THROWS_WITH(parts.bodies.slot_of(last), Catch::Contains("never been there"));
  REQUIRE(parts.bodies.id_of(parts.add(one)) == last);
  parts.bodies.remove(0);
  CHECK_FALSE(parts.bodies.contains(last));
  CHECK_THROWS_WITH(parts.bodies.slot_of(last), Catch::Contains("was removed"));
  CHECK(parts.bodies.id_of(parts.add(one)) == body_id(last_generation, 3));
  image = parts.bodies.image();
  image.check(0);
  CHECK(image.removed(last));
  parts.bodies.become(image);
  CHECK(parts.bodies.id_of(parts.add(one)) == body_id(last_generation, 4));
}

TEST_CASE("Bodies: an image whose generations or free slots cannot be is refused") {
  Parts<1> parts;
  parts.add(ball<1>(1, {0, 0, 0}));
  parts.bodies.remove(parts.add(ball<1>(1, {0, 0, 0})));
  const auto right = parts.bodies.image();
  right.check(0);
  auto image = right;
  image.generations.resize(3);
  CHECK_THROWS_WITH(image.check(0), Catch::Contains("generations: there are more than there are slots"));
  image = right;
  image.generations = {0, 1};
  CHECK_THROWS_WITH(image.check(0), Catch::Contains("generations[1]: is not before the next one"));
  image = right;
  image.next_id = 1;
  CHECK_THROWS_WITH(image.check(0), Catch::Contains("bodies: the next one has an old id"));
  image = right;
  image.free.clear();
  CHECK_THROWS_WITH(image.check(0), Catch::Contains("bodies[1]: its slot is free, and not listed"));
  image = right;
  image.free.push_back(1);
  CHECK_THROWS_WITH(image.check(0), Catch::Contains("free[1]: is no free slot, or listed twice"));
  image = right;
  image.free.push_back(0);
  CHECK_THROWS_WITH(image.check(0), Catch::Contains("free[1]: is no free slot, or listed twice"));
}

TEST_CASE("Bodies: one that is removed does not enter any more") {
  Parts<1> parts;
  const BodySlot id = parts.bodies.add(ball<1>(1, {0, 0, 0}), nullptr, motion<1>({0, 0, 0}));
  parts.bodies.wait(id);
  CHECK(parts.bodies.waits(id));
  parts.bodies.remove(id);
  CHECK_FALSE(parts.bodies.any_waits());
}

TEST_CASE("Bodies: a jump is what rounding is not") {
  Parts<1> parts;
  const BodySlot id = parts.add(ball<1>(1, {100, 0, 0}, {1, 0, 0}));
  const auto there = [](double x) { return motion<1>({x, 0, 0}, zero, zero, 2); };
  CHECK_FALSE(parts.bodies.is_jump(id, there(102), 2));
  CHECK_FALSE(parts.bodies.is_jump(id, there(102 + 1e-11), 2));
  CHECK(parts.bodies.is_jump(id, there(102 + 1e-9), 2));
}

TEST_CASE("Bodies: two may collide if each one's category is in the other's mask") {
  Parts<1> parts;
  CHECK_FALSE(parts.bodies.filters());
  auto description = ball<1>(1, {0, 0, 0});
  const BodySlot plain = parts.add(description);
  description.category = 2;
  const BodySlot second = parts.add(description);
  description.collides_with = 1;
  const BodySlot choosy = parts.add(description);
  description.collides_with = 0;
  const BodySlot alone = parts.add(description);
  CHECK(parts.bodies.filters());
  CHECK(parts.bodies.may_collide(plain, second));
  CHECK(parts.bodies.may_collide(plain, choosy));
  CHECK_FALSE(parts.bodies.may_collide(second, choosy));
  CHECK_FALSE(parts.bodies.may_collide(plain, alone));
  CHECK(parts.bodies.collides(choosy));
  CHECK_FALSE(parts.bodies.collides(alone));
}

}  // namespace
}  // namespace kds::collision::test_bodies
