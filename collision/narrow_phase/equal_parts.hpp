// A stretch of time in equal parts.
#pragma once

#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace kds::collision {

/// [begin, end] in 2^k parts, each no longer than a given time: a function of the three alone. Where doubles are too
/// sparse for that the parts are longer, several doubles each.
class EqualParts {
 public:
  /// Precondition: begin < end, longest > 0.
  EqualParts(double begin, double end, double longest) : begin_(begin), end_(end) {
    constexpr int most = 40;  // doublings
    const double length = end - begin;
    const double spacing =
        4 * (next_up(std::max(std::abs(begin), std::abs(end))) - std::max(std::abs(begin), std::abs(end)));
    for (int k = 0; k < most && length > std::max(longest, spacing) * static_cast<double>(count_); ++k) count_ *= 2;
  }

  std::uint64_t count() const { return count_; }
  /// Where part i begins, and the one before ends.
  double bound(std::uint64_t i) const {
    return i >= count_ ? end_ : begin_ + (end_ - begin_) * (static_cast<double>(i) / static_cast<double>(count_));
  }
  /// The part that holds t, with its begin; the first or the last for times outside.
  std::uint64_t at(double t) const {
    const double part = std::floor((t - begin_) / (end_ - begin_) * static_cast<double>(count_));
    auto i = static_cast<std::uint64_t>(std::clamp(part, 0.0, static_cast<double>(count_ - 1)));
    while (i + 1 < count_ && bound(i + 1) <= t) ++i;
    while (i > 0 && bound(i) > t) --i;
    return i;
  }

 private:
  double begin_, end_;
  std::uint64_t count_ = 1;
};

}  // namespace kds::collision
