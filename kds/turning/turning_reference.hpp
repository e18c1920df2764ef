// A reference to a turning certificate of any type: what is long is compiled once for a kind of sum.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/double_double.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/turning/spin.hpp"
#include "kds/turning/turning_sum.hpp"

#include <array>
#include <optional>
#include <type_traits>

namespace kds {

/// How many multiples of each angle are in the sum of a certificate: 1 unless it says otherwise.
template <class C>
inline constexpr int harmonics_of = 1;
template <class C>
requires requires { C::harmonics; }
inline constexpr int harmonics_of<C> = C::harmonics;

namespace detail {

template <class C>
Ball<double> turning_value_in_doubles(const C& certificate, double t);
template <class C>
Ball<DoubleDouble> extended_turning_value(const C& certificate, double t);
template <class C>
bool plainly_vanishes(const C& certificate);
template <class C>
std::optional<int> sign_at_start(const C& certificate, double t);

}  // namespace detail

/// A turning certificate that is another one, of whatever type, of the same degree and harmonics: pointers to its
/// functions stand for its type, as in CertificateReference. The other one must outlive it. So signs beyond doubles and
/// failure times are compiled for six kinds of sums, not for each of some thirty certificates. An indirect call is
/// little beside what is called here.
template <int Degree, int Harmonics>
class TurningReference {
 public:
  static constexpr int degree = Degree;
  static constexpr int harmonics = Harmonics;

  template <class C>
  requires(C::degree == Degree && harmonics_of<C> == Harmonics &&
           !std::is_same_v<C, TurningReference>) explicit TurningReference(const C& certificate)
      : certificate_(&certificate), functions_(&functions_of<C>), spins_(certificate.spins()) {}

  std::array<Spin, 2> spins() const { return spins_; }

  template <class Number, int Order>
  TurningSum<Order, Number, Harmonics> turning_sum(double epoch) const {
    static_assert(Order == Degree || (Order == 0 && !std::is_same_v<Number, Exact>));
    if constexpr (std::is_same_v<Number, Exact>) {
      return functions_->exact(certificate_, epoch);
    } else if constexpr (std::is_same_v<Number, Ball<double>>) {
      if constexpr (Order == 0) return functions_->in_doubles_at_epoch(certificate_, epoch);
      if constexpr (Order != 0) return functions_->in_doubles(certificate_, epoch);
    } else {
      static_assert(std::is_same_v<Number, Ball<DoubleDouble>>);
      if constexpr (Order == 0) return functions_->in_double_doubles_at_epoch(certificate_, epoch);
      if constexpr (Order != 0) return functions_->in_double_doubles(certificate_, epoch);
    }
  }
  Ball<double> quick_value(double t) const { return functions_->quick_value(certificate_, t); }
  Ball<DoubleDouble> extended_value(double t) const { return functions_->extended_value(certificate_, t); }
  bool plainly_vanishes() const { return functions_->plainly_vanishes(certificate_); }
  std::optional<int> sign_at_start(double t) const { return functions_->sign_at_start(certificate_, t); }

 private:
  template <class Number, int Order>
  using SumFunction = TurningSum<Order, Number, Harmonics> (*)(const void*, double epoch);
  struct Functions {
    SumFunction<Ball<double>, 0> in_doubles_at_epoch;
    SumFunction<Ball<double>, Degree> in_doubles;
    SumFunction<Ball<DoubleDouble>, 0> in_double_doubles_at_epoch;
    SumFunction<Ball<DoubleDouble>, Degree> in_double_doubles;
    SumFunction<Exact, Degree> exact;
    Ball<double> (*quick_value)(const void*, double t);
    Ball<DoubleDouble> (*extended_value)(const void*, double t);
    bool (*plainly_vanishes)(const void*);
    std::optional<int> (*sign_at_start)(const void*, double t);
  };

  template <class C, class Number, int Order>
  static TurningSum<Order, Number, Harmonics> sum_of(const void* certificate, double epoch) {
    return static_cast<const C*>(certificate)->template turning_sum<Number, Order>(epoch);
  }
  template <class C>
  static Ball<double> quick_value_of(const void* certificate, double t) {
    return detail::turning_value_in_doubles(*static_cast<const C*>(certificate), t);
  }
  template <class C>
  static Ball<DoubleDouble> extended_value_of(const void* certificate, double t) {
    return detail::extended_turning_value(*static_cast<const C*>(certificate), t);
  }
  template <class C>
  static bool plainly_vanishes_of(const void* certificate) {
    return detail::plainly_vanishes(*static_cast<const C*>(certificate));
  }

  template <class C>
  static std::optional<int> sign_at_start_of(const void* certificate, double t) {
    return detail::sign_at_start(*static_cast<const C*>(certificate), t);
  }

  template <class C>
  static constexpr Functions functions_of = {sum_of<C, Ball<double>, 0>,
                                             sum_of<C, Ball<double>, Degree>,
                                             sum_of<C, Ball<DoubleDouble>, 0>,
                                             sum_of<C, Ball<DoubleDouble>, Degree>,
                                             sum_of<C, Exact, Degree>,
                                             quick_value_of<C>,
                                             extended_value_of<C>,
                                             plainly_vanishes_of<C>,
                                             sign_at_start_of<C>};

  const void* certificate_;
  const Functions* functions_;
  std::array<Spin, 2> spins_;
};

template <class C>
TurningReference(const C&) -> TurningReference<C::degree, harmonics_of<C>>;

/// In namespace kds: `KDS_FOR_EACH_TURNING_SUM(WHAT)` says WHAT(degree, harmonics) of the sums that occur, of
/// bodies on paths of degree 1 and 2.
#define KDS_FOR_EACH_TURNING_SUM(what) what(1, 1) what(2, 1) what(4, 1) what(1, 2) what(2, 2) what(4, 2)

}  // namespace kds
