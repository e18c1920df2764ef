// A kinetic sorted list that writes down its swaps, and what its order ought to be.
#pragma once

#include "structures/sorted_list.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <ostream>
#include <vector>

namespace kds::tests {

struct Swap {
  std::uint32_t left, right;
  double time;
  friend bool operator==(const Swap&, const Swap&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Swap& s) {
    return out << s.left << " < " << s.right << " from " << s.time;
  }
};
using Log = std::vector<Swap>;

/// Ranks fall while ids rise, in steps of three, so that both settle ties.
inline std::uint32_t rank_of(std::uint32_t id) { return 1000 - id / 3; }

/// Ties are broken by ids alone.
struct PlainRecorder : structures::NoSwapListener {
  Log* log;
  explicit PlainRecorder(Log* to) : log(to) {}
  void swapped(std::uint32_t left, std::uint32_t right, double t) { log->push_back({left, right, t}); }
};

struct Recorder : PlainRecorder {
  using PlainRecorder::PlainRecorder;
  static std::uint32_t rank(std::uint32_t id) { return rank_of(id); }
};

template <int Degree>
using List = structures::SortedList<Degree, Recorder>;

template <class L>
std::vector<std::uint32_t> ids(const L& list) {
  std::vector<std::uint32_t> result;
  for (const auto& entry : list.entries()) result.push_back(entry.id);
  return result;
}

template <class L, int Degree>
void require_order(const L& list, const Model<Degree>& model, double t) {
  if (ids(list) != model.order(t, rank_of)) {
    CAPTURE(t);
    REQUIRE(ids(list) == model.order(t, rank_of));
  }
}

}  // namespace kds::tests
