// A result: one contender on one family at one degree.
#pragma once

#include "tests/benchmarks/roots/families.hpp"
#include "tests/benchmarks/roots/judge.hpp"

#include <array>
#include <string>

namespace bench_roots {

/// Where the horizon is: nowhere; at some time of the polynomial's scale; at the first double not before the crossing
/// or one of its neighbours, so that the last bit of a root decides between an answer and none.
enum class Horizon { infinite, finite, edge };
inline constexpr std::array horizon_names{"infinite", "finite", "edge"};

/// One contender on one family with one kind of horizon.
struct Cell {
  int degree;
  const Family* family;
  Horizon horizon;
  std::string solver;
  bool certified;
  Tally tally;
  double nanoseconds = 0;  ///< a call; not measured at the edge
};

}  // namespace bench_roots
