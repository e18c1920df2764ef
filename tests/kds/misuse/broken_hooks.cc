// Certificates with one hook each that is not as it must be: the compiler must name it.
#include "kds/events/schedule.hpp"

namespace misuse {

using namespace kds;
using Whole = PolynomialCertificate<1>;  // has all that are for one certificate, as they must be

struct Vanishes : Whole {
  bool vanishes() { return false; }  // not const
};
struct ExtendedValue : Whole {
  DoubleDouble extended_value(double) const { return {}; }  // without a bound on the error
};
struct QuickFailureTime : Whole {
  double quick_failure_time(double) const { return never; }  // without a horizon
};
struct QuickFailureTimeAfterTurn : Whole {
 private:
  double quick_failure_time_after_turn(double, double) const { return never; }
};
struct QuickFailureTimes : Whole {
  static double quick_failure_times(const Whole&, const Whole&, double, double) { return never; }
};
struct IsNegativeOf : Whole {
  bool is_negative_of(const Whole&) const { return false; }  // of a certificate of another type
};

template <class C>
double ask(const C& certificate) {
  return failure_time(certificate, 0) + sign_after(certificate, 0);
}
double all() {
  return ask(Whole{}) + ask(Vanishes{}) + ask(ExtendedValue{}) + ask(QuickFailureTime{}) +
         ask(QuickFailureTimeAfterTurn{}) + ask(QuickFailureTimes{}) + ask(IsNegativeOf{});
}

}  // namespace misuse
