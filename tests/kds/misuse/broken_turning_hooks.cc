// Turning certificates with one hook each that is not as it must be: the compiler must name it.
#include "kds/turning/turning_certificate.hpp"

namespace misuse {

using namespace kds;

/// 1, with both hooks as they must be.
struct One {
  static constexpr int degree = 1;
  std::array<Spin, 2> spins() const { return {}; }
  template <class Number, int Order>
  TurningSum<Order, Number> turning_sum(double) const {
    TurningSum<Order, Number> f;
    f.p[0][0].c[0] = Number(1.0);
    return f;
  }
  Ball<double> quick_value(double) const { return {1.0, 0.0}; }
  Ball<DoubleDouble> extended_value(double) const { return {DoubleDouble(1.0), 0.0}; }
};
struct QuickValue : One {
  double quick_value(double) const { return 1; }  // without a bound on the error
};
struct ExtendedValue : One {
  Ball<DoubleDouble> extended_value(double) { return {DoubleDouble(1.0), 0.0}; }  // not const
};

int all() { return sign_after(One{}, 0) + sign_at(QuickValue{}, 0) + sign_at(ExtendedValue{}, 0); }

}  // namespace misuse
