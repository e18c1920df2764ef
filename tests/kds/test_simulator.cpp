// The clock: order of events, windows, counters, audit; with structures that follow a script, and with one that keeps
// real certificates.
#include "kds/audit.hpp"
#include "kds/events/default_event_queue.hpp"
#include "kds/simulator.hpp"
#include "tests/support/exact_failure_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace test_simulator {
namespace {

using namespace kds;
using kds::tests::Random;

struct Event {
  double time;
  char structure;
  std::uint32_t slot;
  friend bool operator==(const Event&, const Event&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Event& e) {
    return out << e.structure << e.slot << " at " << e.time;
  }
};
using Log = std::vector<Event>;

/// Its events are given beforehand, and while others are processed.
struct Script {
  char name;
  Log& log;
  std::set<std::pair<double, std::uint32_t>> events = {};
  double horizon = never;
  int extensions = 0;
  Counters work = {};
  double broken_at = never;
  Script* other = nullptr;  // gets an event of the same time for each of ours, once

  double next_time() const { return events.empty() || events.begin()->first > horizon ? never : events.begin()->first; }
  void process() {
    const auto [time, slot] = *events.begin();
    events.erase(events.begin());
    log.push_back({time, name, slot});
    ++work.events;
    if (other) std::exchange(other, nullptr)->events.insert({time, slot});
  }
  void extend_horizon(double /*now*/, double to) {
    horizon = to;
    ++extensions;
  }
  void audit(double now) const {
    if (now >= broken_at) throw AuditFailure(std::string("Script ") + name + ": broken");
  }
  const Counters& counters() const { return work; }
};

/// Knows the signs of polynomials, by certificates; a slot's event is that its sign turns.
class SignKeeper {
 public:
  SignKeeper(std::vector<Motion<3>> motions, double now, char name, Log& log)
      : motions_(std::move(motions)), name_(name), log_(log) {
    queue_.resize(motions_.size());
    for (const auto& motion : motions_) signs_.push_back(sign_after(PolynomialCertificate<3>{motion}, now));
    for (std::uint32_t i = 0; i < motions_.size(); ++i) certify(i, now);
  }

  double next_time() const { return queue_.empty() ? never : queue_.top().time; }
  void process() {
    const auto [time, slot] = queue_.top();
    signs_[slot] = -signs_[slot];
    log_.push_back({time, name_, slot});
    ++work_.events;
    certify(slot, time);
  }
  void extend_horizon(double now, double horizon) {
    if (horizon == horizon_) return;
    horizon_ = horizon;
    for (std::uint32_t i = 0; i < motions_.size(); ++i) certify(i, now);
  }
  void audit(double now) const {
    for (std::uint32_t i = 0; i < motions_.size(); ++i) {
      if (queue_.time(i) == now) continue;  // about to turn
      if (sign_after(PolynomialCertificate<3>{motions_[i]}, now) != signs_[i]) throw AuditFailure("SignKeeper: sign");
    }
  }
  const Counters& counters() const { return work_; }
  std::size_t scheduled() const { return queue_.size(); }

 private:
  void certify(std::uint32_t slot, double now) {
    ++work_.certificates;
    const PolynomialCertificate<3> f{motions_[slot]};
    queue_.set(slot, signs_[slot] > 0 ? failure_time(f, now, horizon_) : recovery_time(f, now, horizon_));
  }

  std::vector<Motion<3>> motions_;
  std::vector<int> signs_;
  DefaultEventQueue queue_;
  double horizon_ = never;
  Counters work_;
  char name_;
  Log& log_;
};

static_assert(KineticStructure<Script>);
static_assert(KineticStructure<SignKeeper>);
static_assert(!KineticStructure<int>);

std::vector<Motion<3>> random_motions(Random& random, std::size_t n) {
  std::vector<Motion<3>> motions(n);
  for (auto& motion : motions) {
    // Half of them with coarse numbers: their roots coincide.
    const bool coarse = random.one_in(2);
    for (double& c : motion.position.c) c = coarse ? random.integer(-2, 2) : random.between(-1, 1);
    motion.start = random.integer(0, 3);
  }
  return motions;
}

}  // namespace

TEST_CASE("events come in the order of time, then structure, then slot", "[simulator]") {
  Log log;
  Script a{'a', log, {{1.0, 7}, {2.0, 3}, {2.0, 1}, {4.0, 0}}};
  Script b{'b', log, {{0.5, 2}, {2.0, 0}, {3.0, 9}}};
  Simulator simulator(0, a, b);
  CHECK(simulator.next_time() == 0.5);
  simulator.advance_to(10);
  CHECK(log ==
        Log{{0.5, 'b', 2}, {1.0, 'a', 7}, {2.0, 'a', 1}, {2.0, 'a', 3}, {2.0, 'b', 0}, {3.0, 'b', 9}, {4.0, 'a', 0}});
  CHECK(simulator.now() == 10);
  CHECK(simulator.next_time() == never);
}

TEST_CASE("an event that makes one of the same time in an earlier structure is followed by it", "[simulator]") {
  Log log;
  Script a{'a', log, {{5.0, 4}}};
  Script b{'b', log, {{2.0, 1}, {2.0, 6}}};
  b.other = &a;
  Simulator simulator(0, a, b);
  simulator.advance_to(3);
  CHECK(log == Log{{2.0, 'b', 1}, {2.0, 'a', 1}, {2.0, 'b', 6}});
}

TEST_CASE("a step is one event, and none beyond the limit", "[simulator]") {
  Log log;
  Script a{'a', log, {{1.0, 0}, {1.0, 1}, {2.0, 2}}};
  Simulator simulator(0, a);
  CHECK(simulator.step());
  CHECK(log == Log{{1.0, 'a', 0}});
  CHECK(simulator.now() == 1);
  CHECK(simulator.step(1));
  CHECK_FALSE(simulator.step(1));
  CHECK_FALSE(simulator.step(std::nextafter(2.0, 0)));
  CHECK(simulator.now() == 1);  // a step without an event leaves the clock
  CHECK(simulator.step(2));
  CHECK_FALSE(simulator.step());
  CHECK(simulator.now() == 2);
  CHECK(log.size() == 3);
}

TEST_CASE("an event at the very end of an advance belongs to it, one at the clock comes at once", "[simulator]") {
  Log log;
  Script a{'a', log, {{1.0, 0}, {2.0, 1}, {std::nextafter(2.0, 3.0), 2}}};
  Simulator simulator(1.0, a);
  simulator.advance_to(1.0);
  CHECK(log == Log{{1.0, 'a', 0}});
  simulator.advance_to(2.0);
  CHECK(log.size() == 2);
}

TEST_CASE("the clock does not go back, nor to where there is no time", "[simulator]") {
  Log log;
  Script a{'a', log, {{1.0, 0}}};
  Simulator simulator(0.5, a);
  CHECK_THROWS_AS(simulator.advance_to(0.25), std::invalid_argument);
  CHECK_THROWS_AS(simulator.advance_to(std::nan("")), std::invalid_argument);
  CHECK_THROWS_AS(simulator.advance_to(never), std::invalid_argument);
  CHECK_THROWS_AS(simulator.advance_to(-never), std::invalid_argument);
  CHECK(simulator.now() == 0.5);
  CHECK(log.empty());
  simulator.advance_to(0.5);  // where it stands is no way back
  simulator.set_clock(0.75);
  CHECK(simulator.now() == 0.75);
  CHECK_THROWS_AS(simulator.advance_to(0.5), std::invalid_argument);
}

TEST_CASE("a next time that is not a number is refused, whichever structure has it", "[simulator]") {
  Log log;
  Script one{'a', log}, other{'b', log};
  const bool of_first = GENERATE(true, false);
  Simulator simulator(0, one, other);
  one.events = {{1, 0}}, other.events = {{2, 0}};
  simulator.advance_to(1.5);
  Script& wrong = of_first ? one : other;
  wrong.events = {{std::nan(""), 7}};
  const std::string what =
      "Simulator: the clock stands at 1.5, and structure " + std::string(of_first ? "0" : "1") +
      " (in the order of the arguments, from 0) says that its next event is at a time that is not a "
      "number";
  CHECK_THROWS_WITH(simulator.next_time(), what);
  CHECK_THROWS_WITH(simulator.step(), what);
  CHECK_THROWS_WITH(simulator.advance_to(3), what);
  CHECK(log.size() == 1);
  wrong.events.clear();
  simulator.advance_to(3);
  CHECK(log.size() == (of_first ? 2 : 1));
}

TEST_CASE("a window must be longer than nothing", "[simulator]") {
  Log log;
  Script a{'a', log};
  Simulator simulator(0, a);
  CHECK_THROWS_AS(simulator.set_window(0), std::invalid_argument);
  CHECK_THROWS_AS(simulator.set_window(-1), std::invalid_argument);
  CHECK_THROWS_AS(simulator.set_window(std::nan("")), std::invalid_argument);
  CHECK(a.extensions == 1);  // when the simulator was made
  simulator.set_window(2);
  CHECK(simulator.horizon() == 2);
  CHECK(a.horizon == 2);
  simulator.set_window(never);
  CHECK(a.horizon == never);
}

TEST_CASE("with a window the horizon stays near the clock, and an idle stretch costs few extensions", "[simulator]") {
  Log log;
  Script a{'a', log, {{0.5, 0}, {1000.0, 1}}};
  Simulator simulator(0, a);
  simulator.set_window(1);
  simulator.advance_to(0.75);
  CHECK(simulator.horizon() == 1);
  const int before = a.extensions;
  simulator.advance_to(2000);
  CHECK(log == Log{{0.5, 'a', 0}, {1000.0, 'a', 1}});
  CHECK(a.extensions - before < 40);
  CHECK(simulator.horizon() <= 2000);
}

TEST_CASE("a window below the resolution of the clock still moves on", "[simulator]") {
  Log log;
  Script a{'a', log, {{1e9 + 1, 0}}};
  Simulator simulator(1e9, a);
  simulator.set_window(1e-9);
  simulator.advance_to(1e9 + 2);
  CHECK(log.size() == 1);
}

TEST_CASE("an audit asks every structure, at the clock", "[simulator]") {
  Log log;
  Script a{'a', log};
  Script b{'b', log};
  b.broken_at = 2;
  Simulator simulator(1, a, b);
  CHECK_NOTHROW(simulator.audit());
  simulator.advance_to(2);
  CHECK_THROWS_AS(simulator.audit(), AuditFailure);
  CHECK_THROWS_WITH(simulator.audit(), "Script b: broken");
}

TEST_CASE("counters are summed over the structures", "[simulator]") {
  Log log;
  Script a{'a', log, {{1.0, 0}, {2.0, 0}}};
  Script b{'b', log, {{1.5, 0}}};
  a.work.certificates = 10;
  b.work.certificates = 5;
  Simulator simulator(0, a, b);
  CHECK(simulator.counters().certificates == 15);
  simulator.advance_to(1.75);
  CHECK(simulator.counters().events == 2);
  CHECK((Counters{1, 2} + Counters{10, 20}).certificates == 22);
}

TEST_CASE("certificates kept by the clock turn exactly when the signs of their polynomials do", "[simulator]") {
  const std::uint64_t seed = 70;
  CAPTURE(seed);
  Random random(seed);
  const auto motions = random_motions(random, 60);
  Log log;
  SignKeeper keeper(motions, 0, 'k', log);
  Simulator simulator(0, keeper);
  while (simulator.step(6)) simulator.audit();
  REQUIRE(log.size() > 50);
  CHECK(simulator.counters().events == log.size());
  CHECK(simulator.counters().certificates == motions.size() + log.size());
  CHECK(std::is_sorted(log.begin(), log.end(), [](const Event& x, const Event& y) {
    return x.time != y.time ? x.time < y.time : x.slot < y.slot;
  }));
  // Nothing is missing: every motion has turned as often as its isolated roots say.
  for (std::uint32_t i = 0; i < motions.size(); ++i) {
    CAPTURE(i);
    std::vector<double> expected;
    const std::vector<double> c(motions[i].position.c.begin(), motions[i].position.c.end());
    const auto p = oracle::Polynomial::motion(c, motions[i].start);
    int sign = p.sign_after(0);
    for (double t = 0; sign != 0;) {
      t = sign > 0 ? oracle::failure_time(p, t, 6) : oracle::failure_time(oracle::Polynomial() - p, t, 6);
      if (t == never) break;
      expected.push_back(t);
      sign = -sign;
    }
    std::vector<double> found;
    for (const Event& e : log) {
      if (e.slot == i) found.push_back(e.time);
    }
    CHECK(found == expected);
  }
}

TEST_CASE("windows change what is in the queue and nothing else", "[simulator]") {
  const std::uint64_t seed = 71;
  CAPTURE(seed);
  Random random(seed);
  const auto first = random_motions(random, 40);
  const auto second = random_motions(random, 40);
  Log expected;
  {
    SignKeeper a(first, 0, 'a', expected);
    SignKeeper b(second, 0, 'b', expected);
    Simulator simulator(0, a, b);
    simulator.advance_to(8);
  }
  REQUIRE(expected.size() > 50);
  for (const double window : {0.01, 0.3, 1.0, 5.0, 100.0, never}) {
    CAPTURE(window);
    Log log;
    SignKeeper a(first, 0, 'a', log);
    SignKeeper b(second, 0, 'b', log);
    Simulator simulator(0, a, b);
    const std::size_t without = a.scheduled();
    simulator.set_window(window);
    if (window < 1) CHECK(a.scheduled() < without);
    for (double t = 0.7; t < 8; t += random.between(0, 1)) {
      simulator.advance_to(t);
      simulator.audit();
      CHECK(simulator.horizon() >= t);
    }
    simulator.advance_to(8);
    CHECK(log == expected);
  }
}

}  // namespace test_simulator
