#include "collision/parallel/slots_by_number.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <map>

namespace kds::collision::test_slots_by_number {

TEST_CASE("Slots by number: what is added is found until it is removed", "[parallel]") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    kds::tests::Random random(seed);
    INFO("seed " << seed);
    // Close together, far apart, or multiples: neighbours in the table are then of many places.
    const BodySlot step = random.one_in(3) ? 1u << 20 : 1;
    const std::uint64_t numbers = 1 + random.below(2000);
    SlotsByNumber slots;
    std::map<BodySlot, BodySlot> right;
    CHECK(slots.find(0) == no_body);
    for (int i = 0; i < 5000; ++i) {
      const auto number = static_cast<BodySlot>(random.below(numbers)) * step;
      if (right.contains(number)) {
        slots.remove(number);
        right.erase(number);
      } else {
        right[number] = static_cast<BodySlot>(random.below(1u << 30));
        slots.add(number, right[number]);
      }
      REQUIRE(slots.size() == right.size());
      if (i % 100 > 0) continue;
      for (std::uint64_t n = 0; n < numbers; ++n) {
        const auto asked = static_cast<BodySlot>(n) * step;
        const auto found = right.find(asked);
        REQUIRE(slots.find(asked) == (found == right.end() ? no_body : found->second));
      }
    }
  }
}

}  // namespace kds::collision::test_slots_by_number
