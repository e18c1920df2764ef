// Nanoseconds an operation of each event queue, by access pattern and number of slots.
//
// hold:   pop the top, set the same slot a random time later: the classic model of event queues [Jones86].
// list:   a swap in a kinetic list as the queue sees it: the slot at the top and two others are set, to times near now.
// sparse: the same, but every second setting finds no failure and clears the slot instead.
//
// The time ahead is exponential, or 1 / (exponential): the latter has the heavy tail of gap / relative velocity.
// Choices are drawn beforehand, and the loop that only reads them is timed too and taken off.
#include "kds/events/calendar_queue.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/events/pairing_queue.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace {

using kds::Slot;

struct Choice {
  Slot slot[2];
  double ahead[3];
};

enum class Tail { light, heavy };
enum class Access { hold, list, sparse };

std::vector<Choice> draw(std::size_t slots, Access access, Tail tail) {
  std::mt19937_64 random(1);
  const auto unit = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
  std::vector<Choice> choices(1 << 15);
  for (Choice& choice : choices) {
    for (Slot& slot : choice.slot) slot = static_cast<Slot>(random() % slots);
    for (double& ahead : choice.ahead) {
      const double e = -std::log(unit());
      ahead = tail == Tail::light ? e : 1 / e;
      if (access == Access::sparse && random() % 2 == 0) ahead = HUGE_VAL;
    }
    // What the list just swapped does not meet again.
    if (access == Access::sparse) choice.ahead[0] = HUGE_VAL;
  }
  return choices;
}

/// Nothing but the reading of the choices.
struct NoQueue {
  std::size_t n = 0;
  Slot next = 0;
  double last = 0;
  void resize(std::size_t slots) { n = slots; }
  void set(Slot, double t) { last = t; }
  void pop() {}
  bool empty() const { return false; }
  kds::QueuedEvent top() {
    next = next + 1 < n ? next + 1 : 0;
    return {1e-9 * last, next};
  }
};

template <class Queue>
double ns_per_event(std::size_t slots, const std::vector<Choice>& choices, Access access, std::size_t events) {
  Queue queue;
  queue.resize(slots);
  for (Slot s = 0; s < slots; ++s) queue.set(s, choices[s % choices.size()].ahead[1] * (1 + s % 7));
  double checksum = 0;
  const auto run = [&](std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const Choice& choice = choices[i % choices.size()];
      if (queue.empty()) queue.set(choice.slot[0], 1);
      const auto [now, slot] = queue.top();
      checksum += now;
      if (access == Access::hold) {
        queue.pop();
        queue.set(slot, now + choice.ahead[0]);
      } else {
        queue.set(slot, now + choice.ahead[0]);
        queue.set(choice.slot[0], now + choice.ahead[1]);
        queue.set(choice.slot[1], now + choice.ahead[2]);
      }
    }
  };
  run(std::max(2 * slots, events / 4));
  double best = HUGE_VAL;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const auto begin = std::chrono::steady_clock::now();
    run(events);
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
    best = std::min(best, spent.count() / static_cast<double>(events));
  }
  if (checksum == 0.5) std::puts("");  // so that the times are used
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t events = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000;
  const char* const access_names[] = {"hold", "list", "sparse"};
  const int operations[] = {2, 3, 3};  // an event; top() comes on top of them
  std::printf("pattern,tail,slots,pairing_ns_per_op,dary_ns_per_op,calendar_ns_per_op\n");
  for (const Access access : {Access::hold, Access::list, Access::sparse}) {
    for (const Tail tail : {Tail::light, Tail::heavy}) {
      for (const std::size_t slots : {1000, 6000, 10'000, 100'000, 1'000'000}) {
        const auto choices = draw(slots, access, tail);
        const auto a = static_cast<std::size_t>(access);
        const double loop = ns_per_event<NoQueue>(slots, choices, access, events);
        const auto per_op = [&](double event) { return (event - loop) / operations[a]; };
        std::printf("%s,%s,%zu,%.1f,%.1f,%.1f\n", access_names[a], tail == Tail::light ? "light" : "heavy", slots,
                    per_op(ns_per_event<kds::PairingQueue<>>(slots, choices, access, events)),
                    per_op(ns_per_event<kds::DaryQueue<>>(slots, choices, access, events)),
                    per_op(ns_per_event<kds::CalendarQueue<>>(slots, choices, access, events)));
        std::fflush(stdout);
      }
    }
  }
}
