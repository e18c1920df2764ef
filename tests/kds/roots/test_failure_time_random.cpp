// Failure times of random polynomials, from plain ones to all that makes roots hard.
#include "tests/kds/roots/check_failure_time.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

namespace test_failure_time_random {
namespace {

using namespace kds;
using namespace kds::tests;

}  // namespace

TEMPLATE_TEST_CASE_SIG("failure times of random polynomials", "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(100, 60, [](Random& random) {
    const auto f = random_motion<Degree>(random);
    const double now = random.between(-2, 2);
    const double t = check(f, now);
    check(f, now, now + random.between(0, 3));
    if (Degree <= 4) {  // once more from the roots, isolated by the chain of Sturm
      const auto p = oracle::Polynomial::motion({f.position.c.begin(), f.position.c.end()}, f.start);
      CHECK(t == oracle::first_double({{p}, [&](const oracle::Rational& x) { return p(x) < 0; }}, now));
    }
  });
}

TEMPLATE_TEST_CASE_SIG("failure times where few bits make roots doubles and signs vanish", "[failure_time]",
                       FOR_DEGREES_TO_8) {
  run<Degree>(200, 60, [](Random& random) {
    Motion<Degree> f;
    if (random.one_in(2)) {
      for (double& c : f.position.c) c = random.coarse();
    } else {
      std::array<double, Degree> roots;
      for (double& root : roots) root = random.integer(-2, 2);
      f = polynomial_from_roots<Degree>(roots, random.one_in(2) ? 1 : -1, 0);
    }
    f.start = random.integer(-2, 2);
    check_around(f, random.integer(-3, 3));
  });
}

TEMPLATE_TEST_CASE_SIG("failure times of clustered roots", "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(300, 60, [](Random& random) {
    const double spread = std::pow(10.0, random.between(-12, -3));
    const double middle = random.one_in(2) ? 1 : random.between(-2, 2);
    std::array<double, Degree> roots;
    for (double& root : roots) root = middle + spread * random.between(-1, 1);
    const double start = random.one_in(2) ? middle : random.between(-2, 2);
    const auto f = polynomial_from_roots<Degree>(roots, random.one_in(2) ? 1 : -1, start);
    check(f, middle - 2 * spread);
    check(f, middle);
    check(f, -4);
  });
}

TEMPLATE_TEST_CASE_SIG("failure times of high degrees, those of extreme coefficients too", "[failure_time]",
                       ((int Degree), Degree), 11, 12, 16, 31) {
  run<Degree>(400, 12, [](Random& random) {
    check(random_motion<Degree>(random), random.between(-2, 2));
    std::array<double, Degree> roots;
    for (double& root : roots) root = random.integer(-2, 2);
    check_around(polynomial_from_roots<Degree>(roots, random.one_in(2) ? 1 : -1, 0), random.integer(-3, 3));
    // Powers of the scale on which these change are out of the range of doubles.
    Motion<Degree> f;
    for (double& c : f.position.c) c = random.scaled(-900, 900);
    f.position.c[0] = std::abs(f.position.c[0]);
    check(f, 0);
    f.position.c.fill(0);
    f.position.c[0] = 0x1p-1000;
    f.position.c[Degree - 1] = random.between(-1, -0.5) * 0x1p912;
    f.position.c[Degree] = random.between(0.5, 1) * 0x1p1023;
    check(f, 0);
  });
}

TEMPLATE_TEST_CASE_SIG("failure times of double, nearly double and triple roots", "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(400, 60, [](Random& random) {
    std::array<double, Degree> roots;
    for (double& root : roots) root = random.integer(-16, 16) / 8.0;
    const std::size_t multiplicity = std::min<std::size_t>(Degree, 2 + random.below(2));
    for (std::size_t i = 1; i < multiplicity; ++i) roots[i] = roots[0];
    auto f = polynomial_from_roots<Degree>(roots, random.one_in(2) ? 1 : -1, random.one_in(2) ? 0 : 0.5);
    if (random.one_in(2)) {
      double& c = f.position.c[random.below(Degree + 1)];
      c = random.one_in(2) ? next_up(c) : next_down(c);
    }
    check(f, -3);
    check(f, roots[0]);
    check(f, next_down(roots[0]));
    check(f, -3, roots[0]);
  });
}

TEMPLATE_TEST_CASE_SIG("failure times where the leading coefficients are nearly zero", "[failure_time]",
                       FOR_DEGREES_TO_8) {
  run<Degree>(500, 40, [](Random& random) {
    auto f = random_motion<Degree>(random);
    const std::size_t vanishing = 1 + random.below(Degree);
    for (std::size_t i = Degree + 1 - vanishing; i <= Degree; ++i) {
      const std::array<double, 6> small{0.0, -0.0, 1e-20, 1e-300, least, 1e-9};
      f.position.c[i] *= small[random.below(small.size())];
    }
    check(f, random.between(-2, 2));
    check(f, 0, 1e10);
  });
}

TEMPLATE_TEST_CASE_SIG("failure times of huge, tiny and mixed numbers", "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(600, 25, [](Random& random) {
    Motion<Degree> f;
    const int scale = random.integer(-900, 900);
    const int spread = random.one_in(2) ? 2 : 90;
    for (double& c : f.position.c) c = random.scaled(scale - spread, scale + spread);
    f.start = random.one_in(2) ? 0 : random.scaled(-60, 60);
    check(f, f.start);
    check(f, random.scaled(-60, 60));
  });
}

TEMPLATE_TEST_CASE_SIG("failure times of numbers from the whole range of doubles", "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(650, Degree < 4 ? 60 : 12, [](Random& random) {
    Motion<Degree> f;
    for (double& c : f.position.c) c = random.scaled(-1000, 1000);
    f.start = random.one_in(2) ? 0 : random.scaled(-1000, 1000);
    const double now = random.one_in(3) ? 0 : random.scaled(-1000, 1000);
    check(f, now);
    check(f, now, std::max(now, std::abs(random.scaled(-1000, 1000))));
  });
}

TEMPLATE_TEST_CASE_SIG("failure times among subnormal numbers", "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(700, 25, [](Random& random) {
    Motion<Degree> f;
    for (double& c : f.position.c) c = random.integer(-40, 40) * least;
    if (random.one_in(2)) f.position.c[Degree] = random.between(-1, 1);
    check(f, 0);
    check(f, random.integer(-40, 40) * least);
    check(f, random.between(-2, 2));
  });
}

TEMPLATE_TEST_CASE_SIG("failure times with the clock at, just before and just after a root", "[failure_time]",
                       FOR_DEGREES_TO_8) {
  run<Degree>(800, 25, [](Random& random) {
    const auto f = random_motion<Degree>(random);
    check_around(f, -2);
    // Also where f rises: those are the failure times of -f.
    check_around(Motion<Degree>{-f.position, f.start}, -2);
  });
}

TEMPLATE_TEST_CASE_SIG("failure times at clock 1e9", "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(900, 30, [](Random& random) {
    auto f = random_motion<Degree>(random);
    f.start = 1e9 + random.between(-1, 1);
    check_around(f, f.start);
    check(f, 1e9 - 2, 1e9 + 2);
  });
}

TEMPLATE_TEST_CASE_SIG("failure times of a motion whose start is far away", "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(1000, 30, [](Random& random) {
    auto f = random_motion<Degree>(random);
    f.start = random.scaled(0, 40);
    check(f, random.between(-2, 2));
    check(f, -2, 2);
  });
}

TEMPLATE_TEST_CASE_SIG("failure times of roots a few steps of the lattice apart", "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(1100, 60, [](Random& random) {
    const double u = 0x1p-52;
    std::array<double, Degree> roots;
    for (double& root : roots) root = 1 + random.integer(-3, 3) * u;
    auto f = polynomial_from_roots<Degree>(roots, random.one_in(2) ? 1 : -1, 1);
    for (std::size_t i = 0; i <= Degree; ++i) f.position.c[i] += random.between(-1, 1) * 0x1p-3 * f.position.c[i];
    check(f, 1 - 5 * u);
    check(f, 1);
    check(f, 0, 1 + 5 * u);
    for (std::size_t i = 0; i <= Degree; ++i) {
      f.position.c[i] = random.between(-1, 1) * std::pow(u, Degree - static_cast<double>(i));
    }
    check(f, 1);
    check(f, 0);
  });
}

}  // namespace test_failure_time_random
