// How far apart boxes are.
#pragma once

#include "collision/broad_phase/swept_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::collision {

/// Distance between neighbours if boxes are spread evenly over the box that holds the middle half of their corners on
/// each axis, at least as wide as most of them are; told from some of them. What is far out or large, up to a quarter
/// of them, makes no difference. Precondition: count > 0. box_of(i), i < count, gives a StaticBox.
///
/// Cost: O(1), and three selections among a few hundred numbers.
template <class BoxOf>
double typical_spacing(std::size_t count, BoxOf&& box_of) {
  constexpr std::size_t sample = 256;
  const std::size_t step = std::max<std::size_t>(count / sample, 1);
  std::array<std::vector<double>, 3> places;
  std::vector<double> sizes;
  for (std::vector<double>* numbers : {&places[0], &places[1], &places[2], &sizes}) numbers->reserve(count / step + 1);
  for (std::size_t i = 0; i < count; i += step) {
    const StaticBox box = box_of(i);
    sizes.push_back(box.extent());
    for (std::size_t d = 0; d < 3; ++d) places[d].push_back(box.min[static_cast<Eigen::Index>(d)]);
  }
  const auto part = [](std::vector<double>& numbers, std::size_t quarters) {
    const auto at = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() * quarters / 4);
    std::nth_element(numbers.begin(), at, numbers.end());
    return *at;
  };
  const double size = part(sizes, 2);
  double volume = 1;
  for (auto& place : places) volume *= std::max(2 * (part(place, 3) - part(place, 1)), size);
  const double spacing = std::cbrt(volume / static_cast<double>(count));
  return std::isfinite(spacing) ? spacing : size;
}

}  // namespace kds::collision
