// Powers of two, subnormal ones and those that are no doubles included.
#include "kds/arithmetic/power_of_two.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

namespace test_power_of_two {

TEST_CASE("powers of two are what ldexp gives", "[power_of_two]") {
  for (int exponent = -1100; exponent <= 1100; ++exponent) {
    CAPTURE(exponent);
    CHECK(kds::power_of_two(exponent) == std::ldexp(1.0, exponent));
  }
  CHECK(kds::power_of_two(-1074) == std::numeric_limits<double>::denorm_min());
  CHECK(kds::power_of_two(-1075) == 0);
  CHECK(kds::power_of_two(1024) == std::numeric_limits<double>::infinity());
}

}  // namespace test_power_of_two
