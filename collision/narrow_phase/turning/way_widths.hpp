// The ways in which two bodies that turn may be apart, and how wide they are.
#pragma once

#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds::collision {

/// A way of being apart (see WaysApart), and how wide the gap is along it.
template <class Way>
struct WayWidth {
  Way way;
  double width;
};

/// Whether the number of ways is the same for all pairs of a type: then it is a constant, else a member.
template <class Pair>
inline constexpr bool has_constant_ways = !std::is_member_object_pointer_v<decltype(&Pair::ways)>;

/// The number of a way of a pair.
template <class Pair>
using WayOf = std::remove_cv_t<decltype(Pair::ways)>;

/// How wide ways are at one time: of all, where their number is a constant, else of those that may be open.
template <class Pair>
class WayWidths {
 public:
  using Way = WayOf<Pair>;

  /// Those that are not closed for certain just after all times of a stretch that begins at the time of a frame.
  /// `error` of the pair: what is narrower than -error then is closed then.
  template <class Frame>
  WayWidths(const Pair& pair, const Frame& frame, [[maybe_unused]] double stretch) {
    if constexpr (has_constant_ways<Pair>) {
      error_ = pair.gaps(frame, widths_);
    } else {
      error_ = pair.error(frame);
      widths_ = pair.near_ways(frame, stretch);
    }
  }

  double error() const { return error_; }

  template <class Which>
  void leave_out(const Which& which) {
    if constexpr (has_constant_ways<Pair>) {
      for (std::size_t way = 0; way < widths_.size(); ++way) {
        if (which(static_cast<Way>(way))) widths_[way] = -never;
      }
    } else {
      std::erase_if(widths_, [&](const WayWidth<Way>& each) { return which(each.way); });
    }
  }

  /// -never if there is none.
  double widest() const {
    if constexpr (has_constant_ways<Pair>) {
      return *std::max_element(widths_.begin(), widths_.end());
    } else {
      const auto widest = std::max_element(widths_.begin(), widths_.end(), comes_after);
      return widest == widths_.end() ? -never : widest->width;
    }
  }

  /// Takes the widest out, of equal ones the first. Where none is left its width is -never.
  WayWidth<Way> take_widest() {
    if constexpr (has_constant_ways<Pair>) {
      const auto widest = std::max_element(widths_.begin(), widths_.end());
      return {static_cast<Way>(widest - widths_.begin()), std::exchange(*widest, -never)};
    } else {
      if (!std::exchange(is_heap_, true)) std::make_heap(widths_.begin(), widths_.end(), comes_after);
      if (widths_.empty()) return {0, -never};
      std::pop_heap(widths_.begin(), widths_.end(), comes_after);
      const WayWidth<Way> widest = widths_.back();
      widths_.pop_back();
      return widest;
    }
  }

 private:
  static bool comes_after(const WayWidth<Way>& x, const WayWidth<Way>& y) {
    return x.width < y.width || (x.width == y.width && x.way > y.way);
  }
  static auto none() {
    if constexpr (has_constant_ways<Pair>) {
      return std::array<double, static_cast<std::size_t>(Pair::ways)>{};
    } else {
      return std::vector<WayWidth<Way>>{};
    }
  }

  double error_ = 0;
  decltype(none()) widths_;
  bool is_heap_ = false;
};

}  // namespace kds::collision
