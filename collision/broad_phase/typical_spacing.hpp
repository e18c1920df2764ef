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
/// each axis; told from some of them. What is far out, up to a quarter on each side, makes no difference.
/// Precondition: count > 0. box_of(i), i < count, gives a StaticBox.
template <class BoxOf>
double typical_spacing(std::size_t count, BoxOf&& box_of) {
  constexpr std::size_t sample = 256;
  const std::size_t step = std::max<std::size_t>(count / sample, 1);
  std::array<std::vector<double>, 3> places;
  double size = 0;
  for (auto& place : places) place.reserve(count / step + 1);
  for (std::size_t i = 0; i < count; i += step) {
    const StaticBox box = box_of(i);
    size += box.extent();
    for (std::size_t d = 0; d < 3; ++d) places[d].push_back(box.min[static_cast<Eigen::Index>(d)]);
  }
  size /= static_cast<double>(places[0].size());
  double volume = 1;
  for (auto& place : places) {
    const auto quarter = place.begin() + static_cast<std::ptrdiff_t>(place.size() / 4);
    const auto three_quarters = place.begin() + static_cast<std::ptrdiff_t>(place.size() * 3 / 4);
    std::nth_element(place.begin(), quarter, place.end());
    const double low = *quarter;
    std::nth_element(quarter, three_quarters, place.end());
    volume *= std::max(2 * (*three_quarters - low), size);
  }
  const double spacing = std::cbrt(volume / static_cast<double>(count));
  return std::isfinite(spacing) ? spacing : size;
}

}  // namespace kds::collision
