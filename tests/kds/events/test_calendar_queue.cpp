#include "kds/events/calendar_queue.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
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

TEST_CASE("a calendar tells day by day of what comes, and is the same after it", "[events]") {
  std::size_t seen_first = 0, seen_second = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const std::size_t slots = 1 + random.below(300);
    CalendarQueue<> queue, unobserved;
    queue.resize(slots);
    unobserved.resize(slots);
    double now = 0;
    for (int i = 0; i < 600; ++i) {
      const auto slot = static_cast<Slot>(random.below(slots));
      if (random.one_in(3)) {
        REQUIRE(queue.empty() == unobserved.empty());
        if (queue.empty()) continue;
        REQUIRE(queue.top().slot == unobserved.top().slot);
        now = queue.top().time;
        queue.pop();
        unobserved.pop();
      } else {
        const double time = now + std::ldexp(random.unit(), random.integer(-8, 8));
        queue.set(slot, time);
        unobserved.set(slot, time);
      }
      // Of two days the first is over before the second begins, and none is the present one.
      double last_of_first = now, first_of_second = 1e300;
      const double first = queue.empty() ? now : queue.top().time;
      queue.look_ahead(
          [&](Slot each) {
            REQUIRE(queue.time(each) >= first);
            last_of_first = std::max(last_of_first, queue.time(each));
            ++seen_first;
          },
          [&](Slot each) {
            first_of_second = std::min(first_of_second, queue.time(each));
            ++seen_second;
          });
      REQUIRE(last_of_first < first_of_second);
    }
  }
  CHECK(seen_first > 1000);
  CHECK(seen_second > 1000);
}

namespace {

/// Ranks that are kept with events, as they were when these were set.
struct ChangingRank {
  static inline std::uint64_t seed = 0;
  std::uint64_t operator()(Slot slot) const { return (slot + seed) * 0x9e3779b97f4a7c15 >> 60; }
};

/// Two queues have the same events in the same order, though one gives memory back now and then.
template <class Queue>
void check_fit(std::uint64_t seed) {
  Random random(seed);
  Queue kept, fitted;
  const std::size_t slots = 1 + random.below(2000);
  kept.resize(slots), fitted.resize(slots);
  double now = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto slot = static_cast<Slot>(random.below(slots));
    const bool fills = i / 500 % 2 == 0;
    ChangingRank::seed = 0;
    if (random.one_in(fills ? 5 : 2)) {
      kept.clear(slot), fitted.clear(slot);
    } else if (fills || random.one_in(4)) {
      ChangingRank::seed = static_cast<std::uint64_t>(i);
      const double time = now + random.integer(0, 200) / 64.0;
      kept.set(slot, time), fitted.set(slot, time);
    } else if (!kept.empty()) {
      now = std::max(now, kept.top().time);
      kept.pop(), fitted.pop();
    }
    ChangingRank::seed = 1;  // is not asked any more
    if (random.one_in(50)) fitted.fit();
    REQUIRE(kept.size() == fitted.size());
    REQUIRE(kept.operations() == fitted.operations());
    if (kept.empty()) continue;
    REQUIRE(kept.top().time == fitted.top().time);
    REQUIRE(kept.top().slot == fitted.top().slot);
  }
  while (!kept.empty()) {
    REQUIRE(kept.top().slot == fitted.top().slot);
    kept.pop(), fitted.pop();
  }
  REQUIRE(fitted.empty());
  fitted.fit();
  CHECK(fitted.slots() == slots);
}

}  // namespace

TEST_CASE("a calendar that gives memory back has the same events in the same order", "[events]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    check_fit<CalendarQueue<>>(seed);
    check_fit<CalendarQueue<ChangingRank>>(seed);
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
