// The solver through the GSL, where it is there: what it may be asked, and where it must agree with the certified one.
#ifdef KDS_WITH_GSL

#include "kds/roots/gsl_roots.hpp"
#include "tests/kds/roots/check_failure_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace test_gsl_roots {
namespace {

using namespace kds;
using kds::tests::Random;

template <int Degree>
using Value = PolynomialCertificate<Degree>;

double first_negative(std::vector<double> c, double end = never) { return gsl_first_negative(c, end); }

}  // namespace

TEST_CASE("through the GSL: the first crossing downward, at any degree", "[gsl]") {
  CHECK(first_negative({1, -1}) == Approx(1));
  CHECK(first_negative({1, 1}) == never);
  CHECK(first_negative({2, -3, 1}) == Approx(1));
  CHECK(first_negative({-2, 3, -1}) == 0);  // negative already
  CHECK(first_negative({2, 1, -1}) == Approx(2));
  CHECK(first_negative({1, 0, 1}) == never);
  CHECK(first_negative({6, -11, 6, -1}) == Approx(1));  // -(x - 1)(x - 2)(x - 3)
  CHECK(first_negative({-6, 11, -6, 1}) == 0);
  CHECK(first_negative({24, -50, 35, -10, 1}) == Approx(1));
  CHECK(first_negative({0, 0, 1, -1}) == Approx(1));  // zero at the start, and rising
  CHECK(first_negative({0, 0, -1, 1}) == 0);
  CHECK(first_negative({0, 2, -3, 1}) == Approx(1));
}

TEST_CASE("through the GSL: constants, zeros and leading zeros", "[gsl]") {
  CHECK(first_negative({}) == never);
  CHECK(first_negative({0}) == never);
  CHECK(first_negative({1}) == never);
  CHECK(first_negative({-1}) == 0);
  CHECK(first_negative({0, 0, 0, 0, 0}) == never);
  CHECK(first_negative({1, -1, 0, 0, 0, 0}) == Approx(1));
  CHECK(first_negative({1, -1, 0, 0, 0, 1e-320}) == Approx(1));  // dropped with its far root
}

TEST_CASE("through the GSL: nothing beyond the end", "[gsl]") {
  CHECK(first_negative({1, -1}, 0.5) == never);
  CHECK(first_negative({1, -1}, 1.5) == Approx(1));
  CHECK(first_negative({-1, 1}, -1) == never);
  CHECK(gsl_failure_time(Value<1>{{{{1, -1}}, 0}}, 2, 1.5) == never);
  CHECK(gsl_failure_time(Value<1>{{{{1, -1}}, 0}}, 0, 0.5) == never);
}

TEST_CASE("through the GSL: nothing is certified, unless there is nothing to ask", "[gsl]") {
  const Value<1> falling{{{{1, -1}}, 0}};
  const FailureTime found = gsl_estimated_failure_time(falling, 0.5, 2);
  CHECK(found.time == Approx(1));
  CHECK((found.lower == 0.5 && found.upper == 2));
  CHECK(found.status == FailureStatus::estimated);
  const FailureTime none = gsl_estimated_failure_time(falling, 0.25, 0.5);
  CHECK(none.time == never);
  CHECK((none.lower == 0.25 && none.upper == 0.5));
  CHECK(none.status == FailureStatus::estimated);
  CHECK(gsl_estimated_failure_time(falling, 2, 1).status == FailureStatus::holds);
}

TEST_CASE("through the GSL: what is not finite is refused", "[gsl]") {
  CHECK_THROWS_AS(first_negative({1, std::nan("")}), std::invalid_argument);
  CHECK_THROWS_AS(first_negative({1, std::numeric_limits<double>::infinity()}), std::invalid_argument);
  CHECK_THROWS_WITH(first_negative({1, 2, std::nan("")}), Catch::Contains("coefficient 2"));
}

TEMPLATE_TEST_CASE_SIG("through the GSL: the certified failure times, where roots are simple and apart", "[gsl]",
                       FOR_DEGREES_TO_8) {
  const std::uint64_t seed = 60;
  CAPTURE(Degree, seed);
  Random random(seed);
  int found = 0;
  for (int round = 0; round < 300; ++round) {
    // Roots on a grid of width 1, each moved by up to 0.3; the clock starts half way between two of them.
    std::array<double, 12> grid;
    for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = static_cast<double>(i) - 5 + random.between(-0.3, 0.3);
    for (std::size_t i = grid.size(); i-- > 1;) std::swap(grid[i], grid[random.below(i + 1)]);
    Motion<Degree> f;
    f.start = random.integer(-2, 2);
    f.position.c[0] = random.one_in(2) ? 1 : -1;
    for (std::size_t n = 0; n < Degree; ++n) {
      const double root = grid[n] - f.start;
      for (std::size_t i = n + 1; i > 0; --i) f.position.c[i] = f.position.c[i - 1] - root * f.position.c[i];
      f.position.c[0] *= -root;
    }
    const double now = random.integer(-6, 6) + 0.5;
    const double horizon = random.one_in(2) ? never : now + 3.001;
    const double certified = failure_time(Value<Degree>{f}, now, horizon);
    const double compared = gsl_failure_time(Value<Degree>{f}, now, horizon);
    CAPTURE(round, f.position.c, f.start, now, horizon);
    REQUIRE((certified == never) == (compared == never));
    if (certified != never) REQUIRE(compared == Approx(certified).margin(1e-7));
    CHECK(GslSolver{}(Value<Degree>{f}, now, horizon) == compared);
    const FailureTime estimated = gsl_estimated_failure_time(Value<Degree>{f}, now, horizon);
    CHECK(estimated.time == compared);
    CHECK(estimated.status == FailureStatus::estimated);
    CHECK((certified == never || (estimated.lower <= certified && certified <= estimated.upper)));
    found += certified != never && certified != now;
  }
  CHECK(found > 20);
}

TEST_CASE("through the GSL: a double root comes out to half the digits", "[gsl]") {
  // -(x - 1)^2 (x - 2): the touch is no crossing, and is not taken for one.
  CHECK(first_negative({2, -5, 4, -1}) == Approx(2).epsilon(1e-6));
  // -(x - 1)^3 (x + 1): a triple crossing.
  CHECK(first_negative({1, -2, 0, 2, -1}) == Approx(1).epsilon(1e-4));
}

#endif

}  // namespace test_gsl_roots
