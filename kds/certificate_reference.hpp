// A reference to a certificate of any type: what is long is compiled once for a degree, not once for a certificate.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/double_double.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/certificate_hooks.hpp"
#include "kds/polynomial.hpp"

#include <type_traits>

namespace kds {

namespace detail {

template <class C>
bool known_to_vanish(const C& certificate);
template <class C>
Ball<DoubleDouble> extended_value(const C& certificate, double t);

}  // namespace detail

/// A certificate that is another one, of whatever type, of the same degree: five pointers to its functions stand for
/// its type. The other one must outlive it. It costs an indirect call each time, so only the longer rungs of the ladder
/// take certificates in this form; failure_time.hpp says what that costs.
template <int Degree>
class CertificateReference {
 public:
  static constexpr int degree = Degree;

  template <class C>
  requires(C::degree == Degree &&
           !std::is_same_v<C, CertificateReference>) explicit CertificateReference(const C& certificate)
      : certificate_(&certificate), functions_(&functions_of<C>) {}

  template <class Number>
  Polynomial<Degree, Number> polynomial(double epoch) const {
    if constexpr (std::is_same_v<Number, Ball<double>>) {
      return functions_->in_doubles(certificate_, epoch);
    } else if constexpr (std::is_same_v<Number, Ball<DoubleDouble>>) {
      return functions_->in_double_doubles(certificate_, epoch);
    } else {
      static_assert(std::is_same_v<Number, Exact>);
      return functions_->exactly(certificate_, epoch);
    }
  }
  Ball<DoubleDouble> extended_value(double t) const { return functions_->extended_value(certificate_, t); }
  bool vanishes() const { return functions_->vanishes(certificate_); }

 private:
  struct Functions {
    Polynomial<Degree, Ball<double>> (*in_doubles)(const void*, double epoch);
    Polynomial<Degree, Ball<DoubleDouble>> (*in_double_doubles)(const void*, double epoch);
    Polynomial<Degree, Exact> (*exactly)(const void*, double epoch);
    Ball<DoubleDouble> (*extended_value)(const void*, double t);
    bool (*vanishes)(const void*);
  };

  template <class C, class Number>
  static Polynomial<Degree, Number> polynomial_of(const void* certificate, double epoch) {
    return static_cast<const C*>(certificate)->template polynomial<Number>(epoch);
  }
  template <class C>
  static Ball<DoubleDouble> extended_value_of(const void* certificate, double t) {
    return detail::extended_value(*static_cast<const C*>(certificate), t);
  }
  template <class C>
  static bool vanishes_of(const void* certificate) {
    return detail::known_to_vanish(*static_cast<const C*>(certificate));
  }

  template <class C>
  static constexpr Functions functions_of = {polynomial_of<C, Ball<double>>, polynomial_of<C, Ball<DoubleDouble>>,
                                             polynomial_of<C, Exact>, extended_value_of<C>, vanishes_of<C>};

  const void* certificate_;
  const Functions* functions_;
};

template <class C>
CertificateReference(const C&) -> CertificateReference<C::degree>;

}  // namespace kds
