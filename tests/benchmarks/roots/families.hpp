// The polynomials that solvers are measured on: ordinary ones, and those that bring solvers down.
#pragma once

#include "tests/support/random_numbers.hpp"

#include <span>
#include <vector>

namespace bench_roots {

/// c[0] + c[1] t + c[2] t^2 + ..., constant first. The doubles are the polynomial: whatever was rounded while they were
/// made, the truth is that of the doubles.
using Coefficients = std::vector<double>;

/// A way to draw polynomials. Most are positive just after 0, so that there is something to look for; about one in
/// eight is left as it came, which may be negative at once.
struct Family {
  const char* name;
  const char* what;  ///< half a line for the report
  int least_degree;  ///< of a polynomial that can be of this kind
  bool ordinary;     ///< what a well-behaved scene asks; the others are hostile
  Coefficients (*draw)(kds::tests::Random& random, int degree);
};

/// All families, the ordinary ones first.
std::span<const Family> families();

/// The product of two polynomials, each coefficient rounded as it is summed.
Coefficients product(const Coefficients& a, const Coefficients& b);

}  // namespace bench_roots
