#include "kds/events/calendar_queue.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <set>

namespace test_calendar_queue {

using namespace kds;
using kds::tests::Random;

TEST_CASE("a calendar tells of all events up to a time, and rearranges nothing", "[events]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    CalendarQueue<> queue;
    std::size_t slots = 1 + random.below(300);
    queue.resize(slots);
    double now = 0;
    std::size_t visited = 0;
    for (int i = 0; i < 600; ++i) {
      const auto slot = static_cast<Slot>(random.below(slots));
      const double ahead = random.one_in(5) ? 0 : std::ldexp(random.unit(), random.integer(-8, 8));
      switch (random.below(6)) {
        case 0:
          queue.clear(slot);
          break;
        case 1:
          if (!queue.empty()) now = std::max(now, queue.top().time), queue.pop();
          break;
        case 2:
          if (random.one_in(40)) queue.resize(slots += random.below(60));
          break;
        default:
          queue.set(slot, random.one_in(10) ? now - ahead : now + ahead);
      }
      const double until = now + (random.one_in(10) ? 1e300 : std::ldexp(random.unit(), random.integer(-8, 9)));
      std::multiset<Slot> found, expected;
      queue.visit_until(until, [&](Slot each) { found.insert(each); });
      for (Slot each = 0; each < queue.slots(); ++each) {
        if (queue.contains(each) && queue.time(each) <= until) expected.insert(each);
      }
      REQUIRE(found == expected);
      visited += found.size();
    }
    CHECK(visited > 0);
  }
}

}  // namespace test_calendar_queue
