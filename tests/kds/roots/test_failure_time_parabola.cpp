// Lines and parabolas of known coefficients: the quick answer is that of the general method, bit for bit.
#include "kds/roots/enclosed_failure_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace test_failure_time_parabola {
namespace {

using namespace kds;
using kds::tests::Random;

/// A polynomial without quick answers.
struct Careful {
  static constexpr int degree = 2;
  PolynomialCertificate<2> f;

  template <class Number>
  Polynomial<2, Number> polynomial(double epoch) const {
    return f.template polynomial<Number>(epoch);
  }
  Ball<DoubleDouble> extended_value(double t) const { return f.extended_value(t); }
  bool vanishes() const { return f.vanishes(); }
};

/// Coefficients and clocks of many sizes, apart from each other and near.
Motion<2> draw_motion(Random& random) {
  Motion<2> f;
  const int spread = random.one_in(2) ? 2 : random.one_in(2) ? 40 : 500;
  for (double& c : f.position.c) c = random.one_in(12) ? random.coarse() : random.scaled(-spread, spread);
  if (random.one_in(3)) f.position.c[2] = 0;
  f.start = random.one_in(3) ? 0 : random.scaled(-spread, spread);
  return f;
}

}  // namespace

TEST_CASE("quick failure times of lines and parabolas are those of the general method", "[failure_time]") {
  const std::uint64_t seed = 70;
  CAPTURE(seed);
  Random random(seed);
  int asked = 0, undecided = 0, wrong = 0, failures = 0, unenclosed = 0;
  std::string example;
  for (int round = 0; round < 20000; ++round) {
    const PolynomialCertificate<2> f{draw_motion(random)};
    const Careful careful{f};
    const double now = f.value.start + random.one_in(2) * random.scaled(-3, 3);
    const double root = failure_time(careful, now);
    const double edge = root < never ? next_down(root) : now + 1;
    for (const double horizon : {never, root, edge, now + random.unit()}) {
      if (!(now <= horizon)) continue;
      const double expected = failure_time(careful, now, horizon);
      const double quick = f.quick_failure_time(now, horizon);
      const FailureTime enclosed = enclosed_failure_time(f, now, horizon);
      ++asked;
      undecided += std::isnan(quick);
      failures += expected < never;
      unenclosed += expected < never ? !(enclosed.lower <= expected && expected <= next_up(enclosed.upper))
                                     : enclosed.status != FailureStatus::holds;
      if (std::isnan(quick) || quick == expected || wrong++ > 0) continue;
      std::ostringstream text;
      text << std::hexfloat;
      for (const double c : f.value.position.c) text << c << ' ';
      text << "from " << f.value.start << ", now " << now << ", horizon " << horizon << ": " << quick;
      example = text.str();
    }
  }
  CAPTURE(asked, undecided, example);
  CHECK(wrong == 0);
  CHECK(unenclosed == 0);
  CHECK(failures > asked / 5);
  CHECK(undecided < asked / 2);
}

TEST_CASE("ordinary lines and parabolas are decided at once", "[failure_time]") {
  const std::uint64_t seed = 71;
  CAPTURE(seed);
  Random random(seed);
  int undecided = 0;
  for (int round = 0; round < 10000; ++round) {
    PolynomialCertificate<2> f;
    for (double& c : f.value.position.c) c = random.between(-1, 1);
    if (random.one_in(2)) f.value.position.c[2] = 0;
    f.value.start = random.between(-1, 1);
    undecided += std::isnan(f.quick_failure_time(f.value.start + random.unit(), never));
  }
  CHECK(undecided < 30);
}

}  // namespace test_failure_time_parabola
