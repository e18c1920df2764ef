#include "kds/events/calendar_queue.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <set>
#include <utility>

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

TEST_CASE("few events among many slots are in order, also where slots take over from others", "[events]") {
  const std::uint64_t seed = 21;
  CAPTURE(seed);
  Random random(seed);
  CalendarQueue<> queue;
  queue.resize(1'000'000);
  std::set<std::pair<double, Slot>> expected;
  int wrong = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto slot = static_cast<Slot>(random.below(random.one_in(2) ? 1'000'000 : 100));
    if (queue.contains(slot)) expected.erase({queue.time(slot), slot});
    if (random.one_in(3)) {
      queue.clear(slot);
      wrong += queue.contains(slot) || queue.time(slot) != detail::no_event;
    } else {
      const double time = random.integer(0, 50);  // many at one time
      queue.set(slot, time);
      expected.insert({time, slot});
    }
    while (expected.size() > 100) {
      wrong += queue.top() != QueuedEvent{expected.begin()->first, expected.begin()->second};
      queue.pop();
      expected.erase(expected.begin());
    }
    wrong += queue.size() != expected.size();
  }
  queue.resize(50);  // drops most
  std::erase_if(expected, [](const auto& event) { return event.second >= 50; });
  queue.resize(1'000'000);
  for (const auto& [time, slot] : expected) {
    wrong += queue.top() != QueuedEvent{time, slot};
    queue.pop();
  }
  CHECK(wrong == 0);
  CHECK(queue.empty());
}

}  // namespace test_calendar_queue
