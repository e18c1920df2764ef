// You learn: a certificate of your own in three lines; its sign; the first double at which it has failed.
// How to run: build/dev/examples/02_one_certificate, then open the page that it names
// What you see: fails at t = 1.2679491924311226, the double just after the root
#include "examples/course/facts.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/certificate.hpp"
#include "kds/roots/failure_time.hpp"

#include <iomanip>
#include <iostream>

using namespace kds;

/// A ball stays below a ceiling: f(t) = ceiling - ball(t) >= 0. Nothing else has to be written. The same formula is
/// evaluated in doubles with an error bound and, where that does not decide, exactly.
struct BelowCeiling {
  static constexpr int degree = 2;
  const Motion<2>& ball;
  double ceiling;

  template <class Number>
  auto polynomial(double epoch) const {
    return constant<Number>(ceiling) - about<Number>(ball, epoch);
  }
};

int main(int argc, char** argv) {
  const Motion<2> ball{{{0, 6, -1.5}}, 0};  // thrown upwards, 6 t - 1.5 t^2: up to 6 at t = 2
  const double ceiling = 5.1961524227066311718726;
  const BelowCeiling below{ball, ceiling};

  std::cout << std::setprecision(17);
  for (const double t : {0.0, 1.0, 2.0, 3.0}) {
    std::cout << "sign just after t = " << t << ": " << sign_after(below, t) << '\n';
  }

  // The failure time is a double, though the root is not: it is the first double just after which f is negative. At the
  // double before it f is not negative yet. Both signs are exact, so there is no tolerance to tune.
  const double fails = failure_time(below, 0);
  std::cout << "fails at t = " << fails << ", the double just after the root\n"
            << "sign there " << sign_after(below, fails) << ", one double earlier "
            << sign_after(below, next_down(fails)) << '\n';
  const double holds = recovery_time(below, fails);
  std::cout << "holds again from t = " << holds << " on\n";

  // A ceiling that the ball just touches: f has a double root there, is nowhere negative, and nothing happens.
  std::cout << "ceiling at 6: fails " << (failure_time(BelowCeiling{ball, 6}, 0) == never ? "never" : "?") << '\n';

  // f is a polynomial like any other, so the page can draw it: where it crosses zero the ball meets the ceiling.
  const auto& [height, speed, half_acceleration] = ball.position.c;
  const Motion<2> f{{{ceiling - height, -speed, -half_acceleration}}, 0};

  course::Page page(course::View::line, "02 One certificate",
                    "A certificate is a polynomial f that is not negative as long as a fact holds, here that a ball is "
                    "below a ceiling: f = ceiling - ball. It fails where f comes down through zero.", 0, 4);
  page.legend.event = "the sign of f changes";
  page.element(0, "ball");
  page.element(1, "ceiling");
  page.element(2, "f");
  page.element(3, "0");
  page.moves(0, ball, 0);
  page.moves(1, Motion<0>{{{ceiling}}, 0}, 0);
  page.moves(2, f, 0);
  page.moves(3, Motion<0>{}, 0);
  const std::string fact = "ball \u2264 ceiling", holding = "f \u2265 0: the ball is below the ceiling";
  page.starts({.text = holding, .certificates = {course::held(fact, {0, 1}, below, fails, 0, "f(t)")}});
  page.event(fails, "f fails: the ball is at the ceiling, and goes on", {2}, {.text = "f < 0: the ball is above it"});
  page.event(holds, "f holds again", {2}, {.text = holding, .certificates = {{fact, {0, 1}}}});
  page.write(argc, argv, "02_one_certificate");
}
