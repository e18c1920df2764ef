// One typed test for all event queues: each must agree with an ordered set, operation by operation.
#include "kds/events/calendar_queue.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/events/event_queue.hpp"
#include "kds/events/pairing_queue.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace test_event_queue {
namespace {

using kds::QueuedEvent;
using kds::Slot;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Ranks that a test may change behind the queue's back.
struct TableRank {
  std::shared_ptr<std::vector<std::uint64_t>> table = std::make_shared<std::vector<std::uint64_t>>();
  std::uint64_t operator()(Slot slot) const { return slot < table->size() ? (*table)[slot] : 0; }
};

/// The laws, written down with std::set.
template <class Rank>
class Model {
 public:
  explicit Model(Rank rank = {}) : rank_(rank) {}

  void resize(std::size_t n) {
    for (std::size_t s = n; s < keys_.size(); ++s) clear(static_cast<Slot>(s));
    keys_.resize(n, vacant);
  }
  void set(Slot slot, double time) {
    clear(slot);
    if (time == infinity) return;
    keys_[slot] = {time, rank_(slot), slot};
    order_.insert(keys_[slot]);
  }
  void clear(Slot slot) {
    order_.erase(keys_[slot]);
    keys_[slot] = vacant;
  }
  void pop() { clear(top().slot); }
  QueuedEvent top() const { return {std::get<0>(*order_.begin()), std::get<2>(*order_.begin())}; }
  bool contains(Slot slot) const { return time(slot) != infinity; }
  double time(Slot slot) const { return std::get<0>(keys_[slot]); }
  bool empty() const { return order_.empty(); }
  std::size_t size() const { return order_.size(); }
  std::size_t slots() const { return keys_.size(); }

 private:
  using Key = std::tuple<double, std::uint64_t, Slot>;
  static constexpr Key vacant{infinity, 0, 0};
  std::set<Key> order_;
  std::vector<Key> keys_;
  Rank rank_;
};

template <class Q, class M>
void require_equal(const Q& queue, const M& model) {
  REQUIRE(queue.size() == model.size());
  REQUIRE(queue.empty() == model.empty());
  REQUIRE(queue.slots() == model.slots());
  if (!model.empty()) REQUIRE(queue.top() == model.top());
}

template <class Q, class M>
void require_equal_everywhere(const Q& queue, const M& model) {
  require_equal(queue, model);
  for (Slot s = 0; s < model.slots(); ++s) {
    if (queue.time(s) != model.time(s) || queue.contains(s) != model.contains(s)) {
      CAPTURE(s);
      REQUIRE(queue.time(s) == model.time(s));
      REQUIRE(queue.contains(s) == model.contains(s));
    }
  }
}

template <class Q, class M>
void drain(Q& queue, M& model) {
  while (!model.empty()) {
    require_equal(queue, model);
    queue.pop();
    model.pop();
  }
  require_equal_everywhere(queue, model);
}

/// A way to choose the next time, given that of the last event.
struct Pattern {
  const char* name;
  std::function<double(std::mt19937_64&, double)> next;
};

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

const std::vector<Pattern>& patterns() {
  static const std::vector<Pattern> all{
      {"uniform ahead", [](auto& r, double now) { return now + unit(r); }},
      {"heavy tail", [](auto& r, double now) { return now + 1e-3 / (1 - unit(r)); }},
      {"all at one time", [](auto&, double) { return 7.0; }},
      {"few times", [](auto& r, double now) { return std::floor(now) + static_cast<double>(r() % 4); }},
      {"bursts", [](auto& r, double now) { return r() % 8 == 0 ? std::ceil(now + 1) : now + 1e-3 * unit(r); }},
      {"clusters", [](auto& r, double now) { return std::floor(now) + double(r() % 5) + 1e-9 * unit(r); }},
      {"infinite spread", [](auto& r, double) { return std::ldexp(1 + unit(r), static_cast<int>(r() % 2000) - 1000); }},
      {"both signs", [](auto& r, double) { return std::ldexp(unit(r) - 0.5, static_cast<int>(r() % 2000) - 1000); }},
      {"clock at 1e9", [](auto& r, double now) { return std::max(now, 1e9) + 1e-6 * unit(r); }},
      {"neighbouring doubles", [](auto& r, double) { return 1 + 0x1p-52 * static_cast<double>(r() % 64); }},
      {"denormals", [](auto& r, double) { return 0x1p-1074 * static_cast<double>(r() % 64); }},
      {"backwards", [](auto& r, double now) { return now - unit(r); }},
      {"anywhere", [](auto& r, double) { return 100 * unit(r); }},
      {"the ends of the range",
       [](auto& r, double) { return (r() % 2 ? 1 : -1) * std::numeric_limits<double>::max() * (1 - unit(r) / 2); }},
      {"changing scale",
       [](auto& r, double now) {
         return now + std::ldexp(unit(r), now < 1 ? -20 : now < 2 ? 3 : -5);
       }},
  };
  return all;
}

template <class Q>
void run_pattern(const Pattern& pattern, std::uint64_t seed, std::size_t slots, int steps) {
  CAPTURE(pattern.name, seed, slots);
  std::mt19937_64 random(seed);
  Q queue;
  Model<kds::SlotRank> model;
  queue.resize(slots);
  model.resize(slots);
  double now = 0;
  for (int step = 0; step < steps; ++step) {
    const auto slot = static_cast<Slot>(random() % slots);
    switch (random() % 8) {
      case 0:
      case 1:
        if (!model.empty()) {
          now = model.top().time;
          queue.pop();
          model.pop();
        }
        break;
      case 2:
        queue.clear(slot);
        model.clear(slot);
        break;
      case 3:  // the pattern of a kinetic list: the top and two others change
        if (!model.empty()) {
          now = model.top().time;
          for (const Slot s : {model.top().slot, slot, static_cast<Slot>(random() % slots)}) {
            const double time = random() % 4 == 0 ? infinity : pattern.next(random, now);
            queue.set(s, time);
            model.set(s, time);
          }
        }
        break;
      case 4:  // the same slot again and again
        for (int i = 0; i < 3; ++i) {
          const double time = pattern.next(random, now);
          queue.set(slot, time);
          model.set(slot, time);
        }
        break;
      default: {
        const double time = pattern.next(random, now);
        queue.set(slot, time);
        model.set(slot, time);
      }
    }
    // Not after every step: a top() must also find what several steps have left.
    if (step % 3 != 0) require_equal(queue, model);
  }
  require_equal_everywhere(queue, model);
  drain(queue, model);
}

}  // namespace

TEMPLATE_TEST_CASE("an event queue agrees with an ordered set", "[event_queue]", kds::PairingQueue<>, kds::DaryQueue<>,
                   (kds::DaryQueue<kds::SlotRank, 2>), kds::CalendarQueue<>) {
  for (const Pattern& pattern : patterns()) {
    for (const std::size_t slots : {1, 2, 3, 17, 300, 2000}) {
      run_pattern<TestType>(pattern, 0x9e3779b97f4a7c15u + slots, slots, slots < 100 ? 600 : 8000);
    }
  }
}

TEMPLATE_TEST_CASE("events of one time come by rank, then slot", "[event_queue]", kds::PairingQueue<TableRank>,
                   kds::DaryQueue<TableRank>, kds::CalendarQueue<TableRank>) {
  TableRank rank;
  rank.table->assign(8, 5);
  TestType queue(rank);
  queue.resize(8);
  for (const Slot s : {6, 1, 4}) queue.set(s, 2.0);
  REQUIRE(queue.top() == QueuedEvent{2.0, 1});

  // A rank is read by set and kept: changing it is no operation of the queue's.
  (*rank.table)[4] = 1;
  (*rank.table)[1] = 9;
  REQUIRE(queue.top() == QueuedEvent{2.0, 1});
  queue.set(4, 2.0);
  REQUIRE(queue.top() == QueuedEvent{2.0, 4});
  queue.pop();
  queue.set(1, 2.0);
  REQUIRE(queue.top() == QueuedEvent{2.0, 6});
}

namespace {

/// Gives a slot a time at random, or none, in a queue and its model; after each second step the first event of both is
/// compared and taken.
template <class Queue, class Reference>
void set_and_pop(Queue& queue, Reference& model, std::mt19937_64& random, Slot slot, int step) {
  const double time = random() % 5 == 0 ? infinity : static_cast<double>(step / 500 + static_cast<int>(random() % 3));
  queue.set(slot, time);
  model.set(slot, time);
  if (step % 2 != 0 || model.empty()) return;
  require_equal(queue, model);
  queue.pop();
  model.pop();
}

}  // namespace

TEMPLATE_TEST_CASE("ranks that change between settings leave the queue in order", "[event_queue]",
                   kds::PairingQueue<TableRank>, kds::DaryQueue<TableRank>, kds::CalendarQueue<TableRank>) {
  const std::uint64_t seed = 42;
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  const std::size_t slots = 200;
  TableRank rank;
  rank.table->resize(slots);
  TestType queue(rank);
  Model<TableRank> model(rank);
  queue.resize(slots);
  model.resize(slots);
  for (int step = 0; step < 20000; ++step) {
    (*rank.table)[random() % slots] = random() % 5;
    const auto slot = static_cast<Slot>(random() % slots);
    set_and_pop(queue, model, random, slot, step);
  }
  drain(queue, model);
}

namespace {

/// The same of slots whose rank changes only while they have no event. Counts how often it is asked for.
struct SteadyRank : TableRank {
  static constexpr bool lasts = true;
  std::shared_ptr<std::size_t> asked = std::make_shared<std::size_t>(0);
  std::uint64_t operator()(Slot slot) const { return ++*asked, TableRank::operator()(slot); }
};
static_assert(kds::LastingRank<SteadyRank> && !kds::LastingRank<TableRank> && !kds::LastingRank<kds::SlotRank>);

}  // namespace

TEMPLATE_TEST_CASE("ranks that last, and change only where there is no event", "[event_queue]",
                   kds::PairingQueue<SteadyRank>, kds::DaryQueue<SteadyRank>, kds::CalendarQueue<SteadyRank>) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t slots = 200;
    SteadyRank rank;
    rank.table->resize(slots);
    TestType queue(rank);
    Model<TableRank> model(rank);
    queue.resize(slots);
    model.resize(slots);
    for (int step = 0; step < 10000; ++step) {
      const auto slot = static_cast<Slot>(random() % slots);
      if (!queue.contains(slot)) (*rank.table)[slot] = random() % 5;
      set_and_pop(queue, model, random, slot, step);
    }
    // The ranks may be gone when all is dropped.
    REQUIRE(queue.size() > 1);
    const std::size_t asked = *rank.asked;
    queue.resize(0);
    CHECK(*rank.asked == asked);
    CHECK(queue.empty());
    queue.resize(slots);
    model = Model<TableRank>(rank);
    model.resize(slots);
    for (Slot slot = 0; slot < slots; ++slot) queue.set(slot, slot % 7), model.set(slot, slot % 7);
    drain(queue, model);
  }
}

TEMPLATE_TEST_CASE("resizing keeps what is below and drops what is above", "[event_queue]", kds::PairingQueue<>,
                   kds::DaryQueue<>, kds::CalendarQueue<>) {
  const std::uint64_t seed = 7;
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  TestType queue;
  Model<kds::SlotRank> model;
  for (int round = 0; round < 300; ++round) {
    const std::size_t slots = random() % 3 == 0 ? random() % 5 : random() % 700;
    queue.resize(slots);
    model.resize(slots);
    require_equal_everywhere(queue, model);
    for (int i = 0; i < 200 && slots > 0; ++i) {
      const auto slot = static_cast<Slot>(random() % slots);
      const double time = round + unit(random);
      queue.set(slot, time);
      model.set(slot, time);
      if (random() % 3 == 0) {
        require_equal(queue, model);
        queue.pop();
        model.pop();
      }
    }
  }
  drain(queue, model);
}

TEMPLATE_TEST_CASE("a queue that grows by and by, between events, stays in order", "[event_queue]", kds::PairingQueue<>,
                   kds::DaryQueue<>, kds::CalendarQueue<>) {
  for (std::uint64_t seed = 8; seed < 28; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    TestType queue;
    Model<kds::SlotRank> model;
    double now = 0;
    for (std::size_t slots = 1; slots < 3000; slots += 1 + slots / 3) {
      queue.resize(slots);
      model.resize(slots);
      for (std::size_t i = 0; i < 2 * slots; ++i) {
        const auto slot = static_cast<Slot>(random() % slots);
        const double time = now + unit(random);
        queue.set(slot, time);
        model.set(slot, time);
        if (random() % 4 == 0) {
          require_equal(queue, model);
          now = model.top().time;
          queue.pop();
          model.pop();
        }
      }
    }
    drain(queue, model);
  }
}

TEMPLATE_TEST_CASE("a queue can be moved and begun again", "[event_queue]", kds::PairingQueue<>, kds::DaryQueue<>,
                   kds::CalendarQueue<>) {
  TestType queue;
  queue.resize(4);
  queue.set(3, 1.0);
  queue.set(2, 0.5);
  TestType moved = std::move(queue);
  REQUIRE(moved.top() == QueuedEvent{0.5, 2});
  moved.pop();
  queue = TestType{};
  queue.resize(2);
  queue.set(1, 3.0);
  REQUIRE(queue.top() == QueuedEvent{3.0, 1});
  queue = std::move(moved);
  REQUIRE(queue.top() == QueuedEvent{1.0, 3});
  REQUIRE(queue.size() == 1);
}

TEMPLATE_TEST_CASE("operations are counted where there was something to do", "[event_queue]", kds::PairingQueue<>,
                   kds::DaryQueue<>, kds::CalendarQueue<>) {
  TestType queue;
  queue.resize(3);
  queue.clear(0);
  queue.set(1, infinity);
  REQUIRE(queue.operations() == 0);
  queue.set(1, 1.0);
  queue.set(1, 2.0);
  queue.set(2, 3.0);
  queue.pop();
  queue.clear(2);
  queue.clear(2);
  REQUIRE(queue.operations() == 5);
  REQUIRE(queue.empty());
  queue.set(0, 1.0);
  queue.set(2, 2.0);
  queue.resize(1);  // drops one
  queue.resize(4);
  REQUIRE(queue.operations() == 7);
  REQUIRE(queue.size() == 1);
}

TEMPLATE_TEST_CASE("entries in falling order, a hundred thousand deep, do not exhaust the stack", "[event_queue]",
                   kds::PairingQueue<>, kds::DaryQueue<>, kds::CalendarQueue<>) {
  TestType queue;
  const Slot slots = 100'000;
  queue.resize(slots);
  for (Slot s = 0; s < slots; ++s) queue.set(s, -static_cast<double>(s));
  REQUIRE(queue.top() == QueuedEvent{1.0 - slots, slots - 1});
}

TEST_CASE("a calendar queue refuses slots that it cannot number, and keeps what it has", "[event_queue]") {
  kds::CalendarQueue<> queue;
  queue.resize(2);
  queue.set(1, 3.0);
  REQUIRE_THROWS_WITH(queue.resize(kds::CalendarQueue<>::most_slots + 1), Catch::Contains("at most 134217727"));
  REQUIRE(queue.slots() == 2);
  REQUIRE(queue.top() == QueuedEvent{3.0, 1});
}

}  // namespace test_event_queue
