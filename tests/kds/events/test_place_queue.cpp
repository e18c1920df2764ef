// The queue of places against a plain array, looked through from end to end.
#include "kds/events/place_queue.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <limits>
#include <vector>

namespace test_place_queue {
namespace {

using kds::PlaceQueue;
using kds::QueuedEvent;
using kds::Slot;
using kds::tests::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Row {
  std::vector<double> times;
  std::vector<std::uint32_t> ranks;

  QueuedEvent first() const {
    QueuedEvent first;
    for (Slot i = 0; i < times.size(); ++i) {
      if (times[i] < first.time || (times[i] == first.time && times[i] < infinity && ranks[i] < ranks[first.slot])) {
        first = {times[i], i};
      }
    }
    return first;
  }
};

/// One in three is among few values, so that many are equal; some are negative, tiny or huge.
double random_time(Random& random) {
  switch (random.below(6)) {
    case 0:
    case 1:
      return static_cast<double>(random.below(4));
    case 2:
      return random.one_in(2) ? -random.between(0, 1e300) : 0x1p-1060 * random.between(1, 2);
    case 3:
      return random.one_in(3) ? std::numeric_limits<double>::max() : infinity;
    default:
      return random.between(-10, 10);
  }
}

/// Whether the queue says what the row says.
bool agree(const PlaceQueue& queue, const Row& row) {
  if (queue.slots() != row.times.size()) return false;
  std::size_t events = 0;
  for (Slot i = 0; i < row.times.size(); ++i) {
    if (queue.time(i) != row.times[i] || queue.contains(i) != (row.times[i] < infinity)) return false;
    events += row.times[i] < infinity;
  }
  if (queue.size() != events || queue.empty() != (events == 0)) return false;
  return events == 0 || queue.top() == row.first();
}

std::uint64_t change(Random& random, PlaceQueue& queue, Row& row) {
  const auto size = static_cast<std::uint32_t>(row.times.size());
  const auto what = random.below(40);
  const auto place = static_cast<Slot>(random.below(size + 1));
  const auto at = static_cast<std::ptrdiff_t>(place);
  if (what == 0 || size == 0) {
    queue.insert_slot(place);
    row.times.insert(row.times.begin() + at, infinity);
    row.ranks.insert(row.ranks.begin() + at, static_cast<std::uint32_t>(random.below(1000000)));
  } else if (place == size) {
    return 0;
  } else if (what == 1) {
    queue.erase_slot(place);
    row.times.erase(row.times.begin() + at);
    row.ranks.erase(row.ranks.begin() + at);
  } else if (what == 2) {
    const auto to = static_cast<Slot>(random.below(size));
    queue.move_slot(place, to);
    const double time = row.times[place];
    const std::uint32_t rank = row.ranks[place];
    row.times.erase(row.times.begin() + at);
    row.ranks.erase(row.ranks.begin() + at);
    row.times.insert(row.times.begin() + static_cast<std::ptrdiff_t>(to), time);
    row.ranks.insert(row.ranks.begin() + static_cast<std::ptrdiff_t>(to), rank);
  } else if (what < 12 && place > 0 && place + 1 < size) {
    for (Slot i = place - 1; i <= place + 1; ++i) row.times[i] = random_time(random);
    queue.set_three(place, row.times[place - 1], row.times[place], row.times[place + 1]);
  } else {  // neighbours
    for (Slot i = place; i < std::min(size, place + 3); ++i) {
      row.times[i] = random_time(random);
      if (row.times[i] < infinity || random.one_in(2)) {
        queue.set(i, row.times[i]);
      } else {
        queue.clear(i);
      }
    }
  }
  return 1;
}

TEST_CASE("a queue of places agrees with a plain row", "[place_queue]") {
  std::uint64_t changes = 0;
  for (const std::size_t size : {0, 1, 7, 8, 9, 63, 64, 65, 200, 513, 600}) {
    const std::uint64_t seed = 400 + size;
    CAPTURE(size, seed);
    Random random(seed);
    PlaceQueue queue;
    Row row;
    queue.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      row.times.push_back(infinity);
      row.ranks.push_back(static_cast<std::uint32_t>(random.below(1000000)));
    }
    bool right = true;
    for (int step = 0; step < 1500 && right; ++step) {
      for (std::uint64_t i = random.below(3); i > 0; --i) changes += change(random, queue, row);
      queue.settle([&](Slot place) { return row.ranks[place]; });
      right = agree(queue, row);
    }
    CHECK(right);
  }
  CHECK(changes > 10000);
}

TEST_CASE("events of one time come by rank, at every distance", "[place_queue]") {
  for (const Slot other : {1u, 7u, 8u, 63u, 64u, 511u, 512u, 999u}) {
    for (const bool first : {true, false}) {
      PlaceQueue queue;
      queue.resize(1000);
      queue.set(0, 2.5);
      queue.set(other, 2.5);
      queue.settle([&](Slot place) { return (place == 0) == first ? 3 : 5; });
      CHECK(queue.top() == QueuedEvent{2.5, first ? 0 : other});
    }
  }
}

TEST_CASE("a queue of places grows and shrinks with its events", "[place_queue]") {
  const auto by_place = [](Slot place) { return place; };
  PlaceQueue queue;
  CHECK(queue.empty());
  queue.resize(3);
  queue.set(2, 1);
  queue.resize(5000);
  queue.set(4999, 0.5);
  queue.settle(by_place);
  CHECK(queue.top() == QueuedEvent{0.5, 4999});
  queue.resize(100);
  queue.settle(by_place);
  CHECK(queue.top() == QueuedEvent{1, 2});
  queue.resize(0);
  queue.settle(by_place);
  CHECK(queue.empty());
  queue.resize(9);
  queue.settle(by_place);
  CHECK(queue.empty());
}

}  // namespace

}  // namespace test_place_queue
