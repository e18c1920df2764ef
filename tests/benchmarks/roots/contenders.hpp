// The solvers that are measured, behind pointers: who uses them need not compile them.
#pragma once

#include "kds/polynomial.hpp"

#include <vector>

namespace bench_roots {

/// lower <= root <= upper, guaranteed; infinite where there is none.
struct Enclosure {
  double lower, upper;
};

/// A solver at one degree. The question: when, in [0, horizon], is the polynomial first negative just after? Infinity
/// where it is not; `horizon` may be infinite.
template <int Degree>
struct Entry {
  const char* name;
  bool certified;
  double (*answer)(const kds::Polynomial<Degree>&, double horizon);
  /// Sum of the finite answers, so that none can be left out. The solver is inlined into the loop.
  double (*sum)(const std::vector<kds::Polynomial<Degree>>&, const std::vector<double>& horizons);
  /// The enclosure of the answer, from those that give one; others have none.
  Enclosure (*enclosure)(const kds::Polynomial<Degree>&, double horizon);
};

inline constexpr int greatest_degree = 8;

/// All that solve this degree, 1 to greatest_degree; the GSL, if it is there, first. The list is in contenders.cpp.
template <int Degree>
std::vector<Entry<Degree>> entries();

}  // namespace bench_roots
