// Contenders: the library's failure times.
#pragma once

#include "kds/roots/enclosed_failure_time.hpp"
#include "kds/roots/failure_time.hpp"
#include "tests/benchmarks/roots/contenders.hpp"

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
  template <int Degree>
  static Enclosure enclosure(const kds::Polynomial<Degree>& p, double horizon) {
    const auto found = kds::certified_failure_time(kds::PolynomialCertificate<Degree>{{p, 0}}, 0, horizon);
    return {found.lower, found.upper};
  }
};

/// The exact decision, with a time that is near the root; above degree 2 the library gives the canonical double here
/// too.
struct Enclosed {
  static constexpr const char* name = "kds enclosed";
  static constexpr bool certified = true;
  static constexpr int least_degree = 1;
  static constexpr int greatest_degree = 2;

  template <int Degree>
  static double first_negative(const kds::Polynomial<Degree>& p, double horizon) {
    return kds::enclosed_failure_time(kds::PolynomialCertificate<Degree>{{p, 0}}, 0, horizon).time;
  }
  template <int Degree>
  static Enclosure enclosure(const kds::Polynomial<Degree>& p, double horizon) {
    const auto found = kds::enclosed_failure_time(kds::PolynomialCertificate<Degree>{{p, 0}}, 0, horizon);
    return {found.lower, found.upper};
  }
};

}  // namespace bench_roots
