#include "collision/narrow_phase/equal_parts.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>

namespace test_equal_parts {

using kds::next_down;
using kds::next_up;
using kds::collision::EqualParts;

TEST_CASE("equal parts follow on each other, and each time is in one") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  kds::collision::samples::Random random(seed);
  const auto number = [&] { return random.vector(1)[0]; };
  for (int i = 0; i < 200; ++i) {
    const double begin = number() * std::ldexp(1.0, i % 40), end = begin + (number() + 1.001) * std::ldexp(1.0, i % 7);
    const double longest = (number() + 1.001) * std::ldexp(1.0, -(i % 9));
    const EqualParts parts(begin, end, longest);
    CAPTURE(i, begin, end, longest, parts.count());
    REQUIRE(parts.bound(0) == begin);
    REQUIRE(parts.bound(parts.count()) == end);
    CHECK((parts.count() & (parts.count() - 1)) == 0);
    for (std::uint64_t k = 0; k < parts.count(); k += 1 + parts.count() / 32) {
      const double from = parts.bound(k), to = parts.bound(k + 1);
      CHECK(from < to);
      CHECK(to - from <= longest * (1 + 1e-9) + 16 * (next_up(std::abs(end)) - std::abs(end)) +
                             16 * (next_up(std::abs(begin)) - std::abs(begin)));
      CHECK(parts.at(from) == k);
      CHECK(parts.at(next_down(to)) == k);
      CHECK(parts.at(0.5 * from + 0.5 * to) == k);
    }
    CHECK(parts.at(begin - 1) == 0);
    CHECK(parts.at(end + 1) == parts.count() - 1);
  }
}

TEST_CASE("equal parts end where doubles are too sparse") {
  const double begin = 0x1p52;
  const EqualParts parts(begin, begin + 64, 1e-9);
  CHECK(parts.count() == 16);  // four doubles each
  for (std::uint64_t k = 0; k < parts.count(); ++k) CHECK(parts.bound(k + 1) - parts.bound(k) == 4);
}

}  // namespace test_equal_parts
