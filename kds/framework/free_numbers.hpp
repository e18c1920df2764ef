// Numbers that are given out, given back and given out again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kds {

/// The numbers that are free among those by which a structure knows its slots, edges, triangles: 0 up to an end that
/// only grows. So memory is that of the most that have been in use at a time.
///
///     const Number number = free.take(items.size());
///     if (number == items.size()) items.emplace_back();
///
/// Cost: O(1). The number that was given back last is given out first, so that the same calls give the same numbers.
class FreeNumbers {
 public:
  using Number = std::uint32_t;

  /// A free number, or `end` if none is free: then the caller's numbers end at end + 1.
  Number take(std::size_t end) {
    if (numbers_.empty()) return static_cast<Number>(end);
    const Number number = numbers_.back();
    numbers_.pop_back();
    return number;
  }
  /// Precondition: it is in use.
  void give_back(Number number) { numbers_.push_back(number); }
  /// How many are free.
  std::size_t size() const { return numbers_.size(); }
  std::vector<Number>::const_iterator begin() const { return numbers_.begin(); }
  std::vector<Number>::const_iterator end() const { return numbers_.end(); }

  template <class Archive>
  void archive(Archive& archive) {
    archive(numbers_);
  }

 private:
  std::vector<Number> numbers_;
};

}  // namespace kds
