// Checks exercise 3, the lowest of moving values.
#include "examples/course/exercises/check.hpp"
#include "kds/simulator.hpp"
#include KDS_ANSWER

#include <cstdint>

using namespace kds;
using exercises::expect;
using exercises::LowestRule;

namespace {

/// Compares the answer with all values, by exact signs at t+.
void compare(const LowestRule& rule, const MovingSet<Motion<2>>& values, double t) {
  for (const Id id : values.ids()) {
    const int sign = sign_after(certificates::Order<2>{values[rule.lowest], values[id]}, t);
    expect(sign >= 0, "at t = ", t, " value ", id, " is below value ", rule.lowest, ", the lowest by your rule");
  }
}

void run(std::size_t count, std::uint32_t dice) {
  const auto some = [&dice](double low, double high) {
    dice = dice * 1664525u + 1013904223u;
    return low + (high - low) * (dice * 0x1p-32);
  };
  const auto motion = [&](double start) { return Motion<2>{{{some(0, 9), some(-4, 1), some(0, 0.8)}}, start}; };
  MovingSet<Motion<2>> values;
  for (std::size_t i = 0; i < count; ++i) values.add(motion(0), 0);
  Kinetic<LowestRule> structure(values, 0);
  Simulator simulator(0, structure);
  std::uint64_t events = 0, changes = 0;
  Id before = structure.rule().lowest;
  for (double t = 0; t <= 8; t += 0.25) {
    while (simulator.step(t)) {
      expect(++events < 10000, "there is no end of events at t = ", simulator.now());
      changes += structure.rule().lowest != before;
      before = structure.rule().lowest;
      if (simulator.next_time() > simulator.now()) compare(structure.rule(), values, simulator.now());
    }
    compare(structure.rule(), values, t);
    simulator.audit();
  }
  const std::uint64_t external = structure.measures().external;
  expect(external == changes, "the answer has changed ", changes, " times, but your repairs say ", external);
  while (values.size() > 1) {
    values.remove(structure.rule().lowest, 8);
    compare(structure.rule(), values, 8);
  }
}

void examine() {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) run(2 + seed, seed);
}

}  // namespace

int main() { return exercises::check("the lowest value is known at all times", examine); }
