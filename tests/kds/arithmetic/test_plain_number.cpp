// Numbers that know whether they are exact, against exact ones.
#include "kds/arithmetic/plain_number.hpp"

#include "kds/arithmetic/exact.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace test_plain_number {

using namespace kds;
using kds::tests::Random;

TEST_CASE("a plain number is known to be zero only where that is exact", "[arithmetic]") {
  CHECK(PlainNumber().is_zero());
  CHECK((PlainNumber(0.1) - PlainNumber(0.1)).is_zero());
  CHECK((PlainNumber(3) * PlainNumber(0.5) - PlainNumber(1.5)).is_zero());
  CHECK_FALSE(PlainNumber(1).is_zero());
  // 0.1 x 0.1 is rounded, so that nothing is known of what it is part of, but that it times zero is zero.
  const PlainNumber rounded = PlainNumber(0.1) * PlainNumber(0.1);
  CHECK_FALSE((rounded - rounded).is_zero());
  CHECK_FALSE((rounded - PlainNumber(0.1 * 0.1)).is_zero());
  CHECK((rounded * PlainNumber(0.0)).is_zero());
  CHECK((-PlainNumber() * rounded).is_zero());
  // 1 + 2^-60 - 1
  CHECK_FALSE((PlainNumber(1) + PlainNumber(0x1p-60) - PlainNumber(1)).is_zero());
  // Underflow and overflow.
  CHECK_FALSE((PlainNumber(0x1p-600) * PlainNumber(0x1p-600)).is_zero());
  const double most = std::numeric_limits<double>::max();
  CHECK_FALSE((PlainNumber(most) + PlainNumber(most) - PlainNumber(most)).is_zero());
  CHECK_FALSE((PlainNumber(most) * PlainNumber(4) - PlainNumber(most) * PlainNumber(4)).is_zero());
  CHECK((difference<PlainNumber>(0.7, 0.7)).is_zero());
  // The same two factors, unless one of them is rounded.
  const PlainNumber x(0.1), y(0.7);
  CHECK(difference_of_products(x, y, x, y).is_zero());
  CHECK(difference_of_products(x, y, y, x).is_zero());
  CHECK_FALSE(difference_of_products(x, y, y, y).is_zero());
  CHECK_FALSE(difference_of_products(x, y, -x, y).is_zero());
  CHECK_FALSE(difference_of_products(rounded, y, rounded, y).is_zero());
}

TEST_CASE("what a plain number knows to be zero is, after operations at random", "[arithmetic]") {
  int zeros = 0, exact_zeros = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    std::vector<std::pair<PlainNumber, Exact>> numbers;
    const bool coarse = random.one_in(2);
    const auto one_of = [&]() -> std::pair<PlainNumber, Exact> {
      return numbers[static_cast<std::size_t>(random.between(0, 1) * 0.999 * static_cast<double>(numbers.size()))];
    };
    for (int i = 0; i < 4; ++i) {
      const double x = random.between(-2, 2);
      const double value = coarse ? std::round(4 * x) / 4 : x;
      numbers.emplace_back(PlainNumber(value), Exact(value));
    }
    for (int i = 0; i < 12; ++i) {
      const auto a = one_of(), b = one_of();
      switch (i % 3) {
        case 0:
          numbers.emplace_back(a.first + b.first, a.second + b.second);
          break;
        case 1:
          numbers.emplace_back(a.first * b.first, a.second * b.second);
          break;
        default:
          numbers.emplace_back(a.first - b.first, a.second - b.second);
      }
      const auto& [plain, exact] = numbers.back();
      exact_zeros += exact.is_zero();
      zeros += plain.is_zero();
      if (plain.is_zero()) CHECK(exact.is_zero());
      if (coarse && i < 6) CHECK(plain.is_zero() == exact.is_zero());  // nothing is rounded yet
    }
  }
  CHECK(zeros > 500);
  CHECK(exact_zeros > zeros);
}

}  // namespace test_plain_number
