// Hooks of turning certificates that lie: found on a sample of calls where KDS_CHECK_QUICK_ANSWERS is defined.
#include "kds/turning/turning_certificate.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cstdint>
#include <stdexcept>

namespace test_turning_hook_checks {
namespace {

using namespace kds;

enum class Lie { none, quick_value, extended_value };

/// t - 1, with both hooks, of which one may have the wrong sign.
template <Lie lie>
struct Liar {
  static constexpr int degree = 1;

  std::array<Spin, 2> spins() const { return {}; }
  template <class Number, int Order>
  TurningSum<Order, Number> turning_sum(double epoch) const {
    TurningSum<Order, Number> f;
    f.p[0][0].c[0] = Number(epoch) + Number(-1.0);
    if constexpr (Order > 0) f.p[0][0].c[1] = Number(1.0);
    return f;
  }
  Ball<double> quick_value(double t) const {
    if constexpr (lie == Lie::extended_value) return {0.0, 1.0};  // so that the other hook is asked
    return {lie == Lie::quick_value ? 1 - t : 2 * (t - 1), 0.0};  // times any positive number
  }
  Ball<DoubleDouble> extended_value(double t) const {
    return {DoubleDouble(lie == Lie::extended_value ? 1 - t : 2 * (t - 1)), 0.0};
  }
};

}  // namespace

TEST_CASE("hooks of turning certificates that tell the truth pass the checks, which are not counted", "[hooks]") {
  turning_sign_counters = {};
  CHECK(sign_at(Liar<Lie::none>{}, 3) == 1);
  CHECK(sign_at(Liar<Lie::none>{}, 0) == -1);
  CHECK(sign_at(Liar<Lie::none>{}, 1) == 0);
  CHECK(turning_sign_counters.extended == 0);
  CHECK(turning_sign_counters.exact == 0);
}

#ifdef KDS_CHECK_QUICK_ANSWERS

TEST_CASE("a hook of a turning certificate that lies is found, and the certificate named", "[hooks]") {
  using Catch::Contains;
  CHECK_THROWS_WITH(sign_at(Liar<Lie::quick_value>{}, 3),
                    Contains("Liar<") && Contains("quick_value has the sign -1 at t = 0x1.8p+1, its formula 1"));
  CHECK_THROWS_WITH(sign_at(Liar<Lie::extended_value>{}, 3),
                    Contains("Liar<") && Contains("extended_value has the sign -1 at t = 0x1.8p+1, its formula 1"));
}

TEST_CASE("one answer of 1 024 of a turning certificate is checked", "[hooks]") {
  int refused = 0;
  for (std::uint32_t i = 0; i < 4 * kds::detail::answers_per_check; ++i) {
    try {
      sign_at(Liar<Lie::quick_value>{}, 2);
    } catch (const std::logic_error&) {
      ++refused;
    }
  }
  CHECK(refused == 4);
}

#else

TEST_CASE("without the checks hooks of turning certificates are believed", "[hooks]") {
  CHECK(sign_at(Liar<Lie::quick_value>{}, 3) == -1);
}

#endif

}  // namespace test_turning_hook_checks
