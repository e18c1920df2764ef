// Values of which samples and a bound on the speed are known.
#include "examples/list_in_forty_lines.hpp"
#include "kds/bounded.hpp"
#include "kds/simulator.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace test_samples {
namespace {

using namespace kds;
using kds::examples::ListRule;
using kds::tests::Random;

}  // namespace

TEST_CASE("sampled values: never out of order for longer than a tick, and resampled only when they may meet",
          "[framework][bounded]") {
  const std::uint64_t seed = 520;
  CAPTURE(seed);
  Random random(seed);
  const Id n = 12;
  std::vector<std::array<double, 3>> swing(n);  // middle, width, frequency: known to the sampler only
  for (auto& s : swing) s = {random.between(-4, 4), random.between(0, 0.6), random.between(0.1, 2)};
  const auto truth = [&](Id id, double t) { return swing[id][0] + swing[id][1] * std::sin(swing[id][2] * t); };
  const double tick = 0.01;
  MovingSet<Bounded> set;
  const auto sample = [&](Id id, double t) { return Bounded{truth(id, t), swing[id][1] * swing[id][2], t}; };
  set.sample_with(sample, tick);
  for (Id id = 0; id < n; ++id) set.insert(id, sample(id, 0), 0);
  Kinetic<ListRule<Bounded>> list(set, 0);
  Simulator simulator(0, list);
  const double end = 10;
  int wrong = 0;
  for (double t = 0.05; t < end; t += 0.05) {
    simulator.advance_to(t);
    list.audit(t);
    const auto& order = list.rule().order;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      // What two values can do to their distance within a tick.
      const double slack = tick * (set[order[i]].speed + set[order[i + 1]].speed) * (1 + 1e-9);
      wrong += truth(order[i], t) > truth(order[i + 1], t) + slack;
    }
  }
  CHECK(wrong == 0);
  CHECK(set.samples() > 2 * n);
  CHECK(set.samples() < 0.3 * n * end / tick);  // Sampling everything every tick takes n end / tick.
  CHECK(list.measures().events > n);
}

TEST_CASE("sampled values need a sampler with a tick", "[framework][bounded]") {
  MovingSet<Bounded> set;
  CHECK_THROWS_AS(set.sample_with([](Id, double) { return Bounded{}; }, 0), std::invalid_argument);
  CHECK_THROWS_AS(set.insert(0, {0, -1, 0}, 0), std::invalid_argument);
  set.insert(0, {0, 1, 0}, 0);
  set.insert(1, {1, 1, 0}, 0);
  Kinetic<ListRule<Bounded>> list(set, 0);
  CHECK(list.next_time() == 0.5);
  CHECK_THROWS_AS(list.process(), std::logic_error);
}

}  // namespace test_samples
