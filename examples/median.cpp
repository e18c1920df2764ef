// You learn: to maintain a median of moving values, to ask for another percentile, and to rank by a rule of your own.
// How to run: build/dev/examples/median
// What you see: at 8 s the median is c, the upper quartile d, and the greatest three are d g h
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/kth_smallest.hpp"
#include "structures/least.hpp"

#include <iostream>

using namespace kds;
using Value = Motion<2>;
using Median = structures::KthSmallestRule<Value>;

/// The greatest first. A ranking makes the certificate that one element does not come after another.
struct Downward {
  using Element = Value;
  certificates::InOrder<Value> in_order(const Value& first, const Value& second) const { return {second, first}; }
};
using Greatest = structures::LeastRule<Downward>;

char name(Id id) { return static_cast<char>('a' + id); }

int main() {
  MovingSet<Value> values;
  for (int i = 0; i < 11; ++i) {
    const double height = i * 7 % 11 + 0.03 * i, speed = (i * i * 5 % 13 - 6) / 2.0;
    values.add(Value{{{height, speed, -speed / 16}}, 0}, 0);
  }
  const auto tell = [](const Median& median, const KineticEvent& event) {
    if (event.effect == Effect::external) {
      std::cout << "from " << event.time << " s on it is " << name(median.kth()) << "\n";
    }
  };
  Kinetic<Median, decltype(tell)> median(values, 0, Median(5), tell);
  Kinetic<Greatest> greatest(values, 0, Greatest(3));
  Simulator simulator(0, median, greatest);
  std::cout << "the median of eleven values is " << name(median.rule().kth()) << "\n";
  simulator.advance_to(8);

  std::cout << "at 8 s the median is " << name(median.rule().kth());
  median.edit([](Median& rule, auto& repair) { rule.set_rank(8, repair); }, 8);
  std::cout << ", the upper quartile " << name(median.rule().kth()) << ", and the greatest three are";
  for (const Id id : values.ids()) {
    if (greatest.rule().contains(id)) std::cout << " " << name(id);
  }
  std::cout << "\n";
}
