// Sorting rounded values by buckets, in linear time where they are spread evenly.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kds::structures {

/// A value, and the entry that it belongs to.
struct RoughPlace {
  double value;
  std::uint32_t entry;
};

/// Sorts by value; equal ones come in any order. Precondition: the sum of the magnitudes is finite.
///
/// There are as many buckets as values, and each is sorted by itself. The number of the bucket is monotone in the value
/// even after rounding: a subtraction and a multiplication by a positive number. Cost: O(n) where values are spread
/// evenly, O(n log n) otherwise.
inline void sort_roughly(std::vector<RoughPlace>& places) {
  const auto before = [](const RoughPlace& a, const RoughPlace& b) { return a.value < b.value; };
  constexpr std::size_t few = 64;
  if (places.size() < few) return std::sort(places.begin(), places.end(), before);
  const auto [least, greatest] = std::minmax_element(places.begin(), places.end(), before);
  const double begin = least->value;
  const double buckets_per_unit = static_cast<double>(places.size() - 1) / (greatest->value - begin);
  if (!(buckets_per_unit > 0 && buckets_per_unit < 0x1p1000)) return std::sort(places.begin(), places.end(), before);
  std::vector<std::uint32_t> bucket(places.size());
  std::vector<std::uint32_t> end(places.size() + 1);  // of each bucket, when all are in place
  for (std::size_t i = 0; i < places.size(); ++i) {
    bucket[i] = static_cast<std::uint32_t>((places[i].value - begin) * buckets_per_unit);
    ++end[bucket[i] + 1];
  }
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  std::vector<RoughPlace> sorted(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) sorted[end[bucket[i]]++] = places[i];
  for (std::size_t i = 0, first = 0; first < sorted.size(); first = end[i++]) {
    if (end[i] - first > 1) {
      std::sort(sorted.data() + first, sorted.data() + end[i], before);
    }
  }
  places.swap(sorted);
}

}  // namespace kds::structures
