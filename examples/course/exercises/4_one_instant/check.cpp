// Checks exercise 4, the degenerate case.
#include "examples/course/exercises/check.hpp"
#include "examples/list_in_forty_lines.hpp"
#include "kds/simulator.hpp"
#include KDS_ANSWER

#include <string>

using namespace kds;
using exercises::expect;
using List = examples::ListRule<Motion<2>>;

namespace {

constexpr double end = 8;

/// Whether two motions meet in a double root before the end: the discriminant of their difference is zero, exactly.
bool touch(const Motion<2>& a, const Motion<2>& b) {
  const auto difference = difference_about<Exact>(b, a, 0);
  const auto& [d0, d1, d2] = difference.c;
  if (d2.sign() == 0 || (d1 * d1 - d0 * d2 * 4.0).sign() != 0) return false;
  const double root = -d1.approximate() / (2 * d2.approximate());
  return 0 < root && root < end;
}

std::string name(Id id) { return std::string(1, static_cast<char>('a' + id)); }

void examine() {
  const auto motions = exercises::motions();
  MovingSet<Motion<2>> values;
  for (const Motion<2>& motion : motions) {
    expect(motion.start == 0, "all motions are to be about time 0");
    values.add(motion, 0);
  }
  double first = never;
  int events = 0;
  const auto swapped = [&](const List& list, const KineticEvent& event) {
    const Id up = event.slot, down = list.order[list.place[up] - 1];
    if (first == never) first = event.time;
    expect(up >= 2 && down >= 2, name(up), " passes ", name(down), " at t = ", event.time);
    expect(event.time == first, "there are events at t = ", first, " and at t = ", event.time);
    ++events;
  };
  Kinetic<List, decltype(swapped)> list(values, 0, {}, swapped);
  Simulator simulator(0, list);
  simulator.advance_to(end);
  simulator.audit();
  expect(events == 3, "there are ", events, " events, not 3");
  expect(touch(motions[0], motions[1]), "a and b do not touch between t = 0 and t = ", end);
}

}  // namespace

int main() { return exercises::check("three events at one time, and a touch that is none", examine); }
