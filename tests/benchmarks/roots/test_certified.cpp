// Solvers that certify their answers must not be wrong: in any family, at any degree, at any horizon.
#include "tests/benchmarks/roots/measure.hpp"

#include <catch2/catch.hpp>

#include <string>
#include <utility>

namespace test_certified {
namespace {

using namespace bench_roots;

template <int Degree>
void check_families(std::string& complaints, std::size_t& crossings, const Options& options) {
  for (const Family& family : families()) {
    if (Degree < family.least_degree) continue;
    for (const Cell& cell : measure<Degree>(family, options)) {
      if (!cell.certified) continue;
      crossings += cell.tally.crossings;
      if (cell.tally.wrong() + cell.tally.unenclosed == 0) continue;
      complaints += cell.solver + ", degree " + std::to_string(Degree) + ", " + family.name + ", horizon " +
                    horizon_names[static_cast<std::size_t>(cell.horizon)] + '\n';
    }
  }
}

template <int Degree>
void check(std::string& complaints, const kds::Polynomial<Degree>& p) {
  const Truth truth = exact_truth(p.c);
  for (const Entry<Degree>& entry : entries<Degree>()) {
    if (!entry.certified) continue;
    const Judgement judgement = judge(truth, never, entry.answer(p, never));
    if (judgement.verdict != Verdict::right || judgement.ulps > 1) {
      complaints += std::string(entry.name) + ", degree " + std::to_string(Degree) + '\n';
    }
  }
}

}  // namespace

TEST_CASE("certified solvers are never wrong in any family", "[roots]") {
  Options options;
  options.polynomials = 8;
  options.rounds = 0;
  options.seed = 17;
  CAPTURE(options.seed);
  std::string complaints;
  std::size_t crossings = 0;
  [&]<int... Less>(std::integer_sequence<int, Less...>) {
    (check_families<Less + 1>(complaints, crossings, options), ...);
  }
  (std::make_integer_sequence<int, greatest_degree>{});
  CHECK(complaints == "");
  CHECK(crossings > 1000);
}

TEST_CASE("certified solvers: three roots at 1e-39, where most coefficients look like zero from a unit scale",
          "[roots]") {
  std::string complaints;
  check<3>(complaints, {{0x1.9a0950b0fca58p+0, -0x1.dc3636dd5a8bcp+134, 0x1.6186670ee4487p+266, -0x1p+396}});
  check<5>(complaints, {{0x1.3f3cb54372369p+2, -0x1.7aea9220f3698p+131, -0x1.9bb717ee4673cp+259, 0x1.c73838a6182cap+386,
                         0x1.fc8ce4323ee32p+517, -0x1p+645}});
  check<6>(complaints, {{0x1.c1ae04e461a51p+7, -0x1.8a131eccc68c8p+132, 0x1.cc2850a73cbaep+255, -0x1.01045df200c22p+377,
                         -0x1.2bc74d358b276p+500, 0x1.06d13a9dc1377p+623, -0x1p+744}});
  CHECK(complaints == "");
}

}  // namespace test_certified
