// Contender: the library's failure time.
#pragma once

#include "kds/failure_time.hpp"

namespace bench_roots {

/// The first double at which the polynomial has turned negative, by exact signs.
struct Canonical {
  static constexpr const char* name = "kds";
  static constexpr bool certified = true;
  static constexpr int least_degree = 1;
  static constexpr int greatest_degree = 8;

  template <int Degree>
  static double first_negative(const kds::Polynomial<Degree>& p, double horizon) {
    return kds::failure_time(kds::PolynomialCertificate<Degree>{{p, 0}}, 0, horizon);
  }
};

}  // namespace bench_roots
