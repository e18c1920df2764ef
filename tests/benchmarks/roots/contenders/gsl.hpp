// Contender and reference: the GNU Scientific Library, as the library offers it.
#pragma once

#ifdef KDS_WITH_GSL

#include "kds/roots/gsl_roots.hpp"

#include <limits>
#include <stdexcept>

namespace bench_roots {

/// Degree 1 to 3: the GSL's closed forms; above: eigenvalues of the companion matrix.
struct Gsl {
  static constexpr const char* name = "GSL";
  static constexpr bool certified = false;
  static constexpr int least_degree = 1;
  static constexpr int greatest_degree = 8;

  template <int Degree>
  static double first_negative(const kds::Polynomial<Degree>& p, double horizon) {
    try {
      return kds::gsl_first_negative(p.c, horizon);
    } catch (const std::runtime_error&) {
      return std::numeric_limits<double>::quiet_NaN();  // it says that it has no answer
    }
  }
};

}  // namespace bench_roots

#endif
