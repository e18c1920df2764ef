// Sorting by buckets against std::sort, spread evenly and not.
#include "structures/rough_sort.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace test_rough_sort {
namespace {

using kds::structures::RoughPlace;
using kds::structures::sort_roughly;
using kds::tests::Random;

/// Whether the result is the values in order, each with its entry, all once.
bool sorts(const std::vector<double>& values) {
  std::vector<RoughPlace> places;
  for (std::uint32_t i = 0; i < values.size(); ++i) places.push_back({values[i], i});
  sort_roughly(places);
  std::vector<double> expected = values;
  std::sort(expected.begin(), expected.end());
  std::vector<bool> seen(values.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [value, entry] = places[i];
    if (value != expected[i] || value != values[entry] || seen[entry]) return false;
    seen[entry] = true;
  }
  return places.size() == values.size();
}

TEST_CASE("buckets sort values however they are spread", "[sorted_list]") {
  const std::uint64_t seed = 77;
  CAPTURE(seed);
  Random random(seed);
  for (const std::size_t size : {0, 1, 2, 63, 64, 65, 200, 1000}) {
    CAPTURE(size);
    for (int spread = 0; spread < 6; ++spread) {
      CAPTURE(spread);
      std::vector<double> values(size);
      for (double& x : values) {
        switch (spread) {
          case 0:  // evenly
            x = random.between(-10, 10);
            break;
          case 1:  // a cluster and one far away
            x = random.one_in(50) ? 1e300 : random.unit();
            break;
          case 2:  // few different ones
            x = static_cast<double>(random.below(5));
            break;
          case 3:  // all sizes and signs
            x = random.scaled(-900, 900) * (random.one_in(2) ? -1 : 1);
            break;
          case 4:  // all equal
            x = 3;
            break;
          default:  // so small that a unit has more buckets than doubles have numbers
            x = std::numeric_limits<double>::denorm_min() * random.integer(-20, 20);
        }
      }
      CHECK(sorts(values));
    }
  }
  // A span that overflows.
  std::vector<double> ends(100, 0.0);
  ends[7] = std::numeric_limits<double>::max();
  ends[70] = -std::numeric_limits<double>::max();
  CHECK(sorts(ends));
}

}  // namespace

}  // namespace test_rough_sort
