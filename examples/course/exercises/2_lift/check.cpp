// Checks exercise 2, the lift.
#include "examples/course/exercises/check.hpp"
#include "examples/list_in_forty_lines.hpp"
#include "kds/simulator.hpp"
#include KDS_ANSWER

#include <limits>

using namespace kds;
using exercises::expect;
using exercises::Lift;

namespace {

/// Exact for the lifts below, at multiples of 1/8.
double height(const Lift& lift, double t) {
  const double since = t - lift.start;
  return lift.height + lift.push * since * since * since;
}

void examine() {
  MovingSet<Lift> lifts;
  for (const Lift& lift : {Lift{0, 1, 0}, Lift{1, 0.5, 0}, Lift{2, 2, 1}, Lift{5, -0.25, 0}, Lift{-3, 1.5, -1},
                           Lift{1, 0.5, 0.5}}) {
    expect(lift.motion()(2) == height(lift, 2), "the height of a lift {", lift.height, ", ", lift.push, ", ",
           lift.start, "} at t = 2 is ", height(lift, 2), ", not ", lift.motion()(2));
    lifts.add(lift, 0);
  }
  expect(!Lift{0, std::numeric_limits<double>::infinity(), 0}.finite(), "an infinite push must not be finite");

  Kinetic<examples::ListRule<Lift>> list(lifts, 0);
  Simulator simulator(0, list);
  for (double t = 0; t <= 4; t += 0.125) {
    simulator.advance_to(t);
    const auto& order = list.rule().order;
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      const double low = height(lifts[order[i]], t), high = height(lifts[order[i + 1]], t);
      expect(low <= high, "at t = ", t, " lift ", order[i], " at ", low, " stands below lift ", order[i + 1], " at ",
             high);
    }
    simulator.audit();
  }
}

}  // namespace

int main() { return exercises::check("the lifts stand in order at all times", examine); }
