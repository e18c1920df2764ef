// Structures on solvers that are wrong: what exact signs put right, and that no run loops.
#include "kds/simulator.hpp"
#include "structures/tournament.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/recorded_list.hpp"
#include "tests/structures/rule_list.hpp"

#ifdef KDS_WITH_GSL
#include "kds/roots/gsl_roots.hpp"
#endif

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace kds::tests::test_uncertified_solvers {
namespace {

using structures::Tournament;

/// Says half way to the root: early by much.
struct HalfWay {
  static constexpr bool certified = false;
  template <Certificate C>
  double operator()(const C& f, double now, double horizon) const {
    const double t = failure_time(f, now, horizon);
    return t == never ? never : now + 0.5 * (t - now);
  }
};

/// Says "now" to everything that will ever fail, and to what will not.
struct AlwaysNow {
  static constexpr bool certified = false;
  template <Certificate C>
  double operator()(const C&, double now, double) const {
    return now;
  }
};

struct Nonsense {
  static constexpr bool certified = false;
  template <Certificate C>
  double operator()(const C&, double, double) const {
    return std::numeric_limits<double>::quiet_NaN();
  }
};

/// Long before the clock.
struct Past {
  static constexpr bool certified = false;
  template <Certificate C>
  double operator()(const C&, double, double) const {
    return -1e300;
  }
};

/// Late by up to a tenth of a second, and differently for each pair.
struct Late {
  static constexpr bool certified = false;
  template <Certificate C>
  double operator()(const C& f, double now, double horizon) const {
    const double t = failure_time(f, now, horizon);
    return t == never ? never : t + 0.1 * (t * 7.13 - std::floor(t * 7.13));
  }
};

template <int Degree>
std::vector<Motion<Degree>> random_motions(std::uint64_t seed, Kind kind, std::size_t n) {
  Random random(seed);
  std::vector<Motion<Degree>> motions;
  for (std::size_t i = 0; i < n; ++i) motions.push_back(random_motion<Degree>(random, kind, 0));
  return motions;
}

struct Outcome {
  std::vector<Swap> log;
  std::vector<std::uint32_t> order;
  Counters counters;
};

/// Runs a list made of a rule to `end`; checks nothing on the way but that it ends.
template <int Degree, class Solver>
Outcome run(const std::vector<Motion<Degree>>& motions, double end) {
  Outcome outcome;
  RuleList<Degree, PlainRecorder, DefaultEventQueue, Solver> list(PlainRecorder{&outcome.log});
  for (std::uint32_t id = 0; id < motions.size(); ++id) list.insert(id, motions[id], 0);
  Simulator simulator(0, list);
  std::size_t steps = 0;
  // An event that is processed, or put off; a pair has Degree crossings at most, and each certificate is put off once.
  const std::size_t most = 100 * Degree * motions.size() * motions.size();
  while (simulator.step(end)) REQUIRE(++steps < most);
  simulator.advance_to(end);
  for (const auto& entry : list.entries()) outcome.order.push_back(entry.id);
  outcome.counters = list.counters();
  return outcome;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a solver that is early, or talks nonsense, changes no event of a list",
                       "[sorted_list][uncertified]", ((int Degree), Degree), 1, 2, 3) {
  for (const Kind kind : {Kind::generic, Kind::lattice, Kind::mixed, Kind::resting, Kind::scales}) {
    for (std::uint64_t seed = 700; seed < 704; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const auto motions = random_motions<Degree>(seed, kind, 24);
      const Outcome right = run<Degree, CertifiedSolver>(motions, 2);
      CHECK(right.counters.rescheduled == 0);
      CHECK(right.counters.repaired == 0);
      const Outcome half = run<Degree, HalfWay>(motions, 2);
      const Outcome at_once = run<Degree, AlwaysNow>(motions, 2);
      const Outcome nonsense = run<Degree, Nonsense>(motions, 2);
      const Outcome past = run<Degree, Past>(motions, 2);
      for (const Outcome* other : {&half, &at_once, &nonsense, &past}) {
        CHECK(other->log == right.log);
        CHECK(other->order == right.order);
        CHECK(other->counters.events == right.counters.events);
        CHECK(other->counters.repaired == 0);
      }
      if (right.log.size() > 5) CHECK(half.counters.rescheduled > 0);
      CHECK(at_once.counters.rescheduled > 0);
    }
  }
}

TEST_CASE("a solver that is late leaves a list that is repaired late, and counts it", "[sorted_list][uncertified]") {
  std::uint64_t repaired = 0;
  for (std::uint64_t seed = 710; seed < 720; ++seed) {
    CAPTURE(seed);
    const auto motions = random_motions<1>(seed, Kind::generic, 30);
    // By then every pair of lines has crossed that ever will, and the last event is past.
    const double end = 1e9;
    const Outcome right = run<1, CertifiedSolver>(motions, end);
    const Outcome late = run<1, Late>(motions, end);
    CHECK(late.order == right.order);
    CHECK(late.log.size() == right.log.size());  // one swap for each crossing, whatever their order
    repaired += late.counters.repaired;
  }
  CHECK(repaired > 0);
}

TEST_CASE("a tournament on a solver that is early has the right winner at all times", "[tournament][uncertified]") {
  for (std::uint64_t seed = 730; seed < 736; ++seed) {
    CAPTURE(seed);
    const auto motions = random_motions<2>(seed, Kind::lattice, 20);
    Tournament<2> right;
    Tournament<2, DefaultEventQueue, HalfWay> early;
    for (std::uint32_t id = 0; id < motions.size(); ++id) {
      right.insert(id, motions[id], 0);
      early.insert(id, motions[id], 0);
    }
    Simulator one(0, right);
    Simulator other(0, early);
    bool same = true;
    for (int k = 1; k <= 200; ++k) {
      one.advance_to(k / 100.0);
      other.advance_to(k / 100.0);
      same = same && right.winner() == early.winner();
    }
    CHECK(same);
    CHECK(early.counters().events == right.counters().events);
    CHECK(early.counters().rescheduled > 0);
  }
}

#ifdef KDS_WITH_GSL
TEST_CASE("a list on the GSL's roots makes the swaps of a certified one, in their order or late",
          "[sorted_list][uncertified]") {
  std::uint64_t corrected = 0;
  for (std::uint64_t seed = 740; seed < 750; ++seed) {
    CAPTURE(seed);
    const auto motions = random_motions<2>(seed, Kind::generic, 24);
    const Outcome right = run<2, CertifiedSolver>(motions, 1);
    const Outcome gsl = run<2, GslSolver>(motions, 1);
    CHECK(gsl.order == right.order);
    CHECK(gsl.log.size() == right.log.size());
    corrected += gsl.counters.rescheduled + gsl.counters.repaired;
  }
  CHECK(corrected > 0);  // about half of its roots are rounded down
}
#endif

}  // namespace kds::tests::test_uncertified_solvers
