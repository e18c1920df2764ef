// The typical distance between boxes.
#pragma once

#include "collision/broad_phase/swept_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::collision {

/// Distance between neighbours if boxes were spread evenly over the box that contains the middle half of their corners
/// on each axis, at least as wide as most of them; estimated from a sample. Up to a quarter of them may be far out or
/// large without changing the result. Precondition: count > 0. box_of(i), i < count, gives a StaticBox.
///
/// Cost: O(1), and three selections among a few hundred numbers.
template <class BoxOf>
double typical_spacing(std::size_t count, BoxOf&& box_of) {
  constexpr std::size_t sample = 256;
  const std::size_t step = std::max<std::size_t>(count / sample, 1);
  const std::size_t looked_at = (count - 1) / step + 1;
  std::array<std::vector<double>, 4> numbers;  // lower corners by axis, and sizes
  for (auto& some : numbers) some.resize(looked_at);
  auto& [xs, ys, zs, sizes] = numbers;
  for (std::size_t i = 0; i < looked_at; ++i) {
    const StaticBox box = box_of(i * step);
    xs[i] = box.min[0];
    ys[i] = box.min[1];
    zs[i] = box.min[2];
    sizes[i] = box.extent();
  }
  const auto place = [&](std::size_t quarters) { return static_cast<std::ptrdiff_t>(looked_at * quarters / 4); };
  const auto middle = sizes.begin() + place(2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double size = *middle;
  double volume = 1;
  for (auto* some : {&xs, &ys, &zs}) {
    const auto low = some->begin() + place(1);
    const auto high = some->begin() + place(3);
    std::nth_element(some->begin(), high, some->end());
    std::nth_element(some->begin(), low, high);
    volume *= std::max(2 * (*high - *low), size);
  }
  const double spacing = std::cbrt(volume / static_cast<double>(count));
  return std::isfinite(spacing) ? spacing : size;
}

}  // namespace kds::collision
