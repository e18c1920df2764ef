// Which of numbered candidates meet all of their conditions, and what proves it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kds::structures {

/// Candidates that come and go, each with up to `Conditions` conditions, numbered from 0. A candidate is selected if it
/// meets all of them. A selected one has a certificate for each condition, that it is met; any other has one
/// certificate, that one of its conditions is not met. When that fails, another unmet condition takes its place, or the
/// candidate is selected.
///
/// Cost: at most `Conditions` signs a call.
template <std::size_t Conditions>
class Selection {
  static_assert(Conditions < 0xFE);

 public:
  using Candidate = std::uint32_t;

  bool contains(Candidate c) const { return c < unmet_.size() && unmet_[c] == none; }
  /// Whether there is such a candidate, selected or not.
  bool knows(Candidate c) const { return c < unmet_.size() && unmet_[c] != absent; }
  /// What is certified of a condition: 1 that it is met, -1 that it is not, 0 nothing.
  int certified(Candidate c, std::size_t condition) const {
    if (!knows(c)) return 0;
    return contains(c) ? 1 : unmet_[c] == condition ? -1 : 0;
  }

  /// Adds a candidate, or looks at one again: meets(i) says whether it meets condition i.
  template <class Meets>
  void look(Candidate c, const Meets& meets) {
    if (c >= unmet_.size()) unmet_.resize(c + std::size_t{1}, absent);
    unmet_[c] = none;
    for (std::uint8_t i = 0; i < Conditions && unmet_[c] == none; ++i) {
      if (!meets(i)) unmet_[c] = i;
    }
  }
  /// The certificate of this condition has failed. Precondition: there is one.
  template <class Meets>
  void turn(Candidate c, std::size_t condition, const Meets& meets) {
    if (contains(c)) {
      unmet_[c] = static_cast<std::uint8_t>(condition);
    } else {
      look(c, meets);
    }
  }
  void let_go(Candidate c) {
    if (c < unmet_.size()) unmet_[c] = absent;
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(unmet_);
  }

 private:
  static constexpr std::uint8_t none = 0xFF, absent = 0xFE;

  std::vector<std::uint8_t> unmet_;  ///< by candidate: a condition that it does not meet
};

}  // namespace kds::structures
