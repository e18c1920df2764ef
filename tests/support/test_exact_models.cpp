// The brute-force models of structures against cases worked out by hand.
#include "tests/support/exact_models.hpp"

#include <catch2/catch.hpp>

#include <vector>

namespace test_exact_models {

using namespace oracle;

TEST_CASE("order just after a time", "[oracle]") {
  // At t = 1 all are at 1; then -t falls behind, the constant follows, the parabola that touches it, the line.
  const std::vector<Value> values{{{0, 1}, 0}, {{1}, 7}, {{1, 0, 1}, 1}, {{1, -1}, 1}, {{1}, 0}};
  CHECK(order_after(values, 1) == std::vector<std::size_t>{3, 1, 4, 2, 0});
  CHECK(greatest_after(values, 1) == 0);
  CHECK(order_after(values, 0) == std::vector<std::size_t>{0, 1, 4, 2, 3});
  CHECK(greatest_after(std::vector<Value>{{{1}, 0}, {{1}, 5}}, 3) == 0);
  CHECK(compare_after(values[1], values[4], 2) == 0);
  CHECK(compare_after(values[2], values[1], 1) == 1);
  CHECK(compare_after(values[3], values[1], 1) == -1);
  CHECK(first_below(values[1], values[0], 0)->compare(1) == 0);
  CHECK_FALSE(first_below(values[2], values[1], 0));
  CHECK_FALSE(first_below(values[1], values[0], 0, 0.5));
}

TEST_CASE("order of cubics about different starts", "[oracle]") {
  const std::vector<Value> values{{{0, 0, 0, 1}, 1e9}, {{0, 0, 0, 1}, 1e9 + 0x1p-20}, {{0, 0, 0, 0, 1}, 1e9}};
  CHECK(order_after(values, 1e9) == std::vector<std::size_t>{1, 2, 0});
  CHECK(order_after(values, 1e9 + 2) == std::vector<std::size_t>{1, 0, 2});
}

TEST_CASE("boxes overlap while all their intervals do", "[oracle]") {
  const auto still = [](double x) { return Value{{x}, 0}; };
  const MovingBox a{{still(0), still(0), still(0)}, {still(1), still(1), still(1)}};
  MovingBox b = a;
  b.low[0] = {{3, -1}, 0};
  b.high[0] = {{4, -1}, 0};
  const auto found = overlaps(a, b, 0);
  REQUIRE(found.size() == 1);
  CHECK(found[0].begin.compare(2) == 0);
  CHECK(found[0].end->compare(4) == 0);
  CHECK_FALSE(found[0].at_start);
  CHECK(overlaps(a, b, 3).at(0).at_start);
  CHECK(overlap_after(a, b, 2));
  CHECK_FALSE(overlap_after(a, b, 4));
  // Touching for ever along another axis: apart.
  b.low[1] = still(1);
  b.high[1] = still(2);
  CHECK(overlaps(a, b, 0).empty());
  CHECK_FALSE(overlap_after(a, b, 3));
  // A box that grows towards one at rest, and stops to count at the end of the time.
  MovingBox c = a;
  c.low[0] = {{3, 0, -0.5}, 0};
  c.high[0] = {{4, 0, 0.5}, 0};
  const auto growing = overlaps(a, c, 0, 5);
  REQUIRE(growing.size() == 1);
  CHECK(growing[0].begin.compare(2) == 0);
  CHECK_FALSE(growing[0].end);
}

}  // namespace test_exact_models
