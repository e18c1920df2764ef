// You learn: to use your own type of moving element, and motion in pieces.
// How to run: build/dev/examples/04_your_own_motion, then open the page that it names
// What you see: after 8 bounces and 15 swaps the highest ball is c
#include "examples/course/facts.hpp"
#include "examples/list_in_forty_lines.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/pieces.hpp"
#include "kds/simulator.hpp"

#include <cmath>
#include <iostream>
#include <string>

using namespace kds;

/// A ball in the gravity of a planet: two numbers, not three, and the acceleration is a constant.
struct Bouncer {
  static constexpr int degree = 2;  // of its motion as a polynomial
  static constexpr double gravity = 1.6;
  double height = 0;
  double speed = 0;  // upwards
  double start = 0;

  Motion<2> motion() const { return {{{height, speed, -gravity / 2}}, start}; }
  bool finite() const { return is_finite(motion()); }  // checked for every element before it is taken up
};

/// The certificate of a sorted list needs this of an element: upper - lower as a polynomial in (t - epoch), in any
/// number type. It is the whole interface: any element that has it can be sorted.
template <class Number>
Polynomial<2, Number> difference_about(const Bouncer& upper, const Bouncer& lower, double epoch) {
  return difference_about<Number>(upper.motion(), lower.motion(), epoch);
}

using List = examples::ListRule<Bouncer>;

int main(int argc, char** argv) {
  course::Page page(course::View::line, "04 Your own motion",
                    "Bouncing balls: each path is made of pieces, and a plan says when which piece begins. To the "
                    "clock a plan is one more structure, whose events are the seams.", 0, 10);
  page.legend.event = "a swap or a bounce";
  page.legend.marked = "the highest";

  MovingSet<Bouncer> balls;
  Pieces<Bouncer> plan(balls);
  int bounces = 0;
  for (const auto& [height, speed, bounce] : {std::array{4.0, 1.0, 0.8}, {6.5, -0.5, 0.72}, {2.0, 3.2, 0.9}}) {
    Bouncer ball{height, speed, 0};
    const Id id = balls.add(ball, 0);
    page.element(id, std::string(1, static_cast<char>('a' + id)));
    page.moves(id, ball.motion(), 0);
    for (;;) {
      // The plan is made in rounded numbers, so pieces meet up to rounding. The events of the motions as planned are
      // exact.
      const double landing = std::sqrt(ball.speed * ball.speed + 2 * Bouncer::gravity * ball.height);
      const double seam = ball.start + (ball.speed + landing) / Bouncer::gravity;
      if (seam >= 10) break;
      ball = {0, bounce * landing, seam};
      plan.plan(id, seam, ball, 0);
      page.moves(id, ball.motion(), seam);
      ++bounces;
    }
  }

  const auto known = [&](const List& list, double now) {
    return course::State{.text = "From low to high: " + page.names(list.order),
                         .order = list.order,
                         .marked = {list.order.back()},
                         .certificates = course::certificates_of(list, balls.end_id(), balls, now, page)};
  };
  int swaps = 0;
  const auto swapped = [&](const List& list, const KineticEvent& event) {
    const Id up = event.slot, down = list.order[list.place[up] - 1];
    page.event(event.time, page.name(up) + " passes " + page.name(down), {up, down}, known(list, event.time));
    ++swaps;
  };
  Kinetic<List, decltype(swapped)> list(balls, 0, {}, swapped);
  Simulator simulator(0, plan, list);
  page.starts(known(list.rule(), 0));
  // A bounce changes no order, but it changes certificates, which the page is given here.
  std::vector<std::size_t> planned{plan.planned(0), plan.planned(1), plan.planned(2)};
  while (simulator.step(10)) {
    for (Id id = 0; id < 3; ++id) {
      if (plan.planned(id) == planned[id]) continue;
      planned[id] = plan.planned(id);
      page.event(simulator.now(), page.name(id) + " bounces", {id}, known(list.rule(), simulator.now()));
    }
  }
  simulator.advance_to(10);
  simulator.audit();
  std::cout << "after " << bounces << " bounces and " << swaps << " swaps the highest ball is "
            << page.name(list.rule().order.back()) << '\n';
  page.standings = {course::standing::sorted_list(list.measures())};
  page.write(argc, argv, "04_your_own_motion");
}
