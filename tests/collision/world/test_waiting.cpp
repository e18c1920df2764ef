// Bodies that are about to enter.
#include "collision/world/bodies_image.hpp"
#include "tests/collision/world/parts.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

namespace kds::collision::test_waiting {
namespace {

using namespace tests;

TEST_CASE("Bodies: those that wait are taken in their order, whichever were removed and came into their slots") {
  Parts<1> parts;
  std::vector<BodySlot> expected;
  std::mt19937_64 random(7);
  const auto add = [&] {
    const BodySlot slot = parts.bodies.add(ball<1>(1, {0, 0, 0}), nullptr, motion<1>({0, 0, 0}));
    parts.bodies.wait(slot);
    expected.push_back(slot);
  };
  std::size_t reused = 0;
  for (int round = 0; round < 200; ++round) {
    for (auto count = random() % 8; count > 0; --count) {
      const std::size_t slots = parts.bodies.slots();
      add();
      reused += parts.bodies.slots() == slots;
    }
    for (auto count = std::min<std::size_t>(random() % 5, expected.size()); count > 0; --count) {
      const auto place = expected.begin() + static_cast<std::ptrdiff_t>(random() % expected.size());
      parts.bodies.remove(*place);
      expected.erase(place);
    }
    REQUIRE(parts.bodies.waits() == expected.size());
    REQUIRE(parts.bodies.image().waiting == expected);
    const auto taken = parts.bodies.take_waiting(random() % 5);
    REQUIRE(taken == std::vector(expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(taken.size())));
    for (const BodySlot slot : taken) REQUIRE_FALSE(parts.bodies.waits(slot));
    expected.erase(expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(taken.size()));
  }
  CHECK(reused > 100);
  CHECK(parts.bodies.take_waiting(expected.size()) == expected);
  CHECK_FALSE(parts.bodies.any_waits());
}

}  // namespace
}  // namespace kds::collision::test_waiting
