// The kinetic AABB tree over values and points of which only samples are known.
#include "certificates/plane_motion.hpp"
#include "kds/bounded.hpp"
#include "kds/simulator.hpp"
#include "structures/aabb_tree.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>

namespace test_aabb_tree_samples {
namespace {

using namespace kds;
using structures::AabbTreeRule;

constexpr Id elements = 20;

/// Runs for 5 s; counts how often a true position was outside its fat box, and the samples.
template <class Sample, std::size_t Dimension, class At, class Truth>
std::array<std::uint64_t, 2> run(const At& at, const Truth& truth) {
  MovingSet<Sample> set;
  set.sample_with(at, 1e-3);
  for (Id id = 0; id < elements; ++id) set.insert(id, at(id, 0), 0);
  using Rule = AabbTreeRule<Sample, Dimension>;
  Kinetic<Rule> tree(set, 0, Rule({0.05, 0.02}));
  Simulator simulator(0, tree);
  std::uint64_t wrong = 0;
  while (simulator.step(5)) {
    simulator.audit();
    for (Id id = 0; id < elements; ++id) {
      const std::array<double, 2> x = truth(id, simulator.now());
      for (std::size_t d = 0; d < Dimension; ++d) {
        wrong += !(tree.rule().box(id).min[d] <= x[d] && x[d] <= tree.rule().box(id).max[d]);
      }
    }
  }
  return {wrong, set.samples()};
}

}  // namespace

TEST_CASE("Fat boxes hold what is only sampled, and a bound on the acceleration spares samples", "[aabb_tree]") {
  const auto truth = [](Id id, double t) { return std::array{std::cos(t + id), std::sin(t + id)}; };
  const auto [wrong, samples] = run<certificates::BoundedPoint, 2>(
      [&](Id id, double t) {
        return certificates::BoundedPoint{truth(id, t), 1, t};
      },
      truth);
  CHECK(wrong == 0);
  CHECK(samples > 100);
  const auto [wrong_speed, of_speed] = run<Bounded, 1>(
      [&](Id id, double t) {
        return Bounded{truth(id, t)[0], 1, t};
      },
      truth);
  const auto [wrong_acceleration, of_acceleration] = run<BoundedAcceleration, 1>(
      [&](Id id, double t) {
        return BoundedAcceleration{truth(id, t)[0], -truth(id, t)[1], 1, t};
      },
      truth);
  CHECK(wrong_speed == 0);
  CHECK(wrong_acceleration == 0);
  CHECK(of_acceleration < of_speed);
}

}  // namespace test_aabb_tree_samples
