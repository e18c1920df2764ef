// You learn: what a motion is, where it is at a time, and when two of them meet.
// How to run: build/dev/examples/01_moving_points, then open the page that it names
// What you see: a and b meet at t = 0.5 and t = 2
#include "certificates/order.hpp"
#include "examples/course/facts.hpp"
#include "kds/roots/failure_time.hpp"

#include <iostream>
#include <string>

using namespace kds;
using certificates::Order;

int main(int argc, char** argv) {
  // A motion is a polynomial in the time since its own start, here at 0: height, speed, half the acceleration.
  const Motion<2> a{{{1, 5, -2}}, 0};  // 1 + 5 t - 2 t^2: thrown upwards
  const Motion<2> b{{{3, 0, 0}}, 0};   // 3: at rest
  // The same path as a's, written about another start: at t = 1 it is at 4 and has a speed of 1. (Why another start? A
  // clock may stand at a billion; but only the small time since the start is put into the polynomial, never t itself.)
  const Motion<2> same_as_a{{{4, 1, -2}}, 1};
  for (const double t : {0.0, 1.0, 2.0}) {
    std::cout << "t = " << t << ": a at " << a(t) << ", b at " << b(t) << ", a once more " << same_as_a(t) << '\n';
  }

  // They meet where "a is not above b" ceases to hold, and where it comes to hold again. Such a fact is a certificate:
  // a polynomial of time that is >= 0 as long as it is true.
  const Order<2> a_below_b{a, b};
  const double up = failure_time(a_below_b, 0);
  const double down = recovery_time(a_below_b, up);
  std::cout << "a and b meet at t = " << up << " and t = " << down << '\n';

  // The page needs the elements, the state at the beginning, and the events.
  course::Page page(course::View::line, "01 Moving points",
                    "Two motions: polynomials in time. Along this axis a parabola is thrown up past a value at rest. "
                    "Drag the time, or press play.", 0, 3);
  page.legend.event = "they meet";
  page.element(0, "a");
  page.element(1, "b");
  page.moves(0, a, 0);
  page.moves(1, b, 0);
  const auto rising = course::held("a is below b", {0, 1}, a_below_b, up, 0, "b(t) \u2212 a(t)");
  const auto falling = course::held("a is above b", {1, 0}, Order<2>{b, a}, down, 0, "a(t) \u2212 b(t)");
  const std::string below = "a is below b", above = "a is above b";
  page.starts({.text = below, .order = {0, 1}, .certificates = {rising}});
  page.event(up, "a comes up to b and passes", {0, 1},
             {.text = above, .order = {1, 0}, .certificates = {falling}});
  page.event(down, "a falls past b", {0, 1}, {.text = below, .order = {0, 1}, .certificates = {{below, {0, 1}}}});
  page.write(argc, argv, "01_moving_points");
}
