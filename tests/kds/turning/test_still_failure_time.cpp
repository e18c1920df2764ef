// Failure times of sums of two spins that are still, which are found as those of polynomials: they are those that the
// search for sums that turn finds.
#include "kds/arithmetic/lattice.hpp"
#include "kds/turning/turning_failure_time.hpp"
#include "tests/kds/turning/written_sum.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace test_still_failure_time {
namespace {

using namespace kds;
using namespace kds::tests;

/// Polynomials beside all cosines, and beside sines, which are zero. Some have short coefficients, with roots that are
/// doubles or are double, and some are zero but for a constant.
template <int Degree, int Harmonics>
WrittenSum<Degree, Harmonics> random_sum(Random& random) {
  WrittenSum<Degree, Harmonics> f;
  const bool coarse = random.one_in(2), constant = random.one_in(8);
  const auto number = [&] {
    return coarse ? static_cast<double>(random.below(9)) - 4 : random.between(-1, 1) * std::exp2(random.between(-8, 4));
  };
  for (std::size_t i = 0; i < f.size; ++i) {
    for (std::size_t j = 0; j < f.size; ++j) {
      if (i + j > 0 && random.one_in(2)) continue;
      f.p[i][j].start = coarse ? 0 : random.between(-2, 0);
      for (std::size_t k = 0; k <= Degree; ++k) f.p[i][j].position.c[k] = k > 0 && constant ? 0 : number();
    }
  }
  return f;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("sums of spins that are still fail when the search for sums that turn says so",
                       "[turning_failure_time]", ((int Degree, int Harmonics), Degree, Harmonics), (1, 1), (2, 1),
                       (4, 1), (1, 2), (4, 2)) {
  int roots = 0, at_once = 0, none = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const auto f = random_sum<Degree, Harmonics>(random);
    const TurningReference reference(f);
    for (const double now : {0.0, random.between(0, 4)}) {
      for (const double horizon : {now, now + 0.5, 100.0}) {
        const double fails = detail::TurningSearch<Degree, Harmonics>(reference, 1).from_any(now, horizon);
        const double recovers = detail::TurningSearch<Degree, Harmonics>(reference, -1).from_any(now, horizon);
        REQUIRE(failure_time(f, now, horizon) == fails);
        REQUIRE(recovery_time(f, now, horizon) == recovers);
        for (const double t : {fails, recovers}) {
          at_once += t == now, none += t == never;
          if (t == now || t == never) continue;
          ++roots;
          REQUIRE(sign_after(f, t) == (t == fails ? -1 : 1));
          REQUIRE(failure_time(f, now, t) == (t == fails ? t : fails));
          REQUIRE(change_of_sign(f, t == fails ? 1 : -1, now, next_down(t)) == never);
          REQUIRE(change_of_sign(f, t == fails ? 1 : -1, now, t) == t);
        }
      }
    }
  }
  CHECK(roots > 100);
  CHECK(at_once > 500);
  CHECK(none > 500);
}

}  // namespace test_still_failure_time
