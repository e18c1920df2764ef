// Certificates of bodies that turn: sums of polynomials times sines and cosines, and their exact signs.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/enclosure.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/arithmetic/plain_number.hpp"
#include "kds/certificate.hpp"
#include "kds/certificate_hooks.hpp"
#include "kds/turning/exact_zero.hpp"
#include "kds/turning/spin.hpp"
#include "kds/turning/turning_reference.hpp"
#include "kds/turning/turning_sum.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <optional>

namespace kds {

/// A fact about motions that turn: f(t) >= 0 while it holds.
///
/// A certificate names the degree of its polynomials and its two spins, and gives f as a TurningSum about any epoch, in
/// any number type. Order cuts the polynomials off: of order 0 is f at the epoch alone. If its harmonics are more than
/// 1 it names them, too: `static constexpr int harmonics`.
///
/// Semantic laws: those of Certificate, with `turning_sum` in place of `polynomial`: ring operations on finite doubles
/// alone; about all epochs the same function of t, to the order that is asked for.
template <class C>
concept TurningCertificate = requires(const C& certificate, double epoch) {
  { C::degree } -> std::convertible_to<int>;
  { certificate.spins() } -> std::same_as<std::array<Spin, 2>>;
  {
    certificate.template turning_sum<Exact, C::degree>(epoch)
    } -> std::same_as<TurningSum<C::degree, Exact, harmonics_of<C>>>;
  {
    certificate.template turning_sum<Ball<double>, 0>(epoch)
    } -> std::same_as<TurningSum<0, Ball<double>, harmonics_of<C>>>;
  {
    certificate.template turning_sum<Ball<DoubleDouble>, 0>(epoch)
    } -> std::same_as<TurningSum<0, Ball<DoubleDouble>, harmonics_of<C>>>;
};

/// Hook: `Ball<double> quick_value(double t) const`, a ball that holds f(t) times any positive number, got for less
/// than turning_sum<Ball<double>, 0>(t) takes. It spares work and changes no sign. What
/// extended_value() (certificate_hooks.hpp) gives of a turning certificate may be times any positive number, too. A
/// member with one of these names that is not exactly what its concept asks for does not compile, and on a sample of
/// calls the signs of both are compared with that of the formula (hook_checks.hpp).
template <class C>
concept GivesQuickValue = requires {
  static_cast<Ball<double> (C::*)(double) const>(&C::quick_value);
};

/// Hook: `template <class Number> Number value_at_start(double t) const`, f at t times any positive number, as if
/// neither body had turned by then: a sum of products of doubles, in the arithmetic of Number. It is asked for where
/// that is so, as after each contact, when the motions of both begin: there edges are often parallel, and faces lie in
/// one plane.
template <class C>
concept GivesValueAtStart = requires(const C& certificate, double t) {
  { certificate.template value_at_start<Exact>(t) } -> std::same_as<Exact>;
  { certificate.template value_at_start<PlainNumber>(t) } -> std::same_as<PlainNumber>;
};

namespace detail {

KDS_MEMBER_NAMED(NamesQuickValue, quick_value);

/// As RightHooks, which it includes, for turning certificates.
template <class C>
struct RightTurningHooks {
  static_assert(GivesQuickValue<C> || !NamesQuickValue<C>,
                "certificate: `quick_value` must be `Ball<double> quick_value(double t) const`");
  static constexpr bool checked = RightHooks<C>::checked;
};

}  // namespace detail

/// How often the cheaper rungs of the ladder of turning certificates did not decide. One set a thread; reset by
/// assigning {}.
struct TurningSignCounters {
  std::uint64_t extended = 0;  ///< values that asked for double-doubles
  std::uint64_t exact = 0;     ///< values of which the coefficients were tested for zero, exactly
  std::uint64_t zeros = 0;     ///< of these, how many are zero
  std::uint64_t enclosed = 0;  ///< enclosures of growing precision that were computed
};
inline thread_local TurningSignCounters turning_sign_counters;

/// Sign of f, or of its derivative number `derivative`, at t itself; 0 only where it is zero. Exact. Precondition: t is
/// finite, 0 <= derivative.
///
/// The ladder: doubles with an error bound; double-doubles with an error bound; coefficients in doubles, if these are
/// exact and zero (plain_number.hpp); the exact test whether f(t) is zero (exact_zero.hpp); and where it is not,
/// enclosures of twice as many digits each time, which come to an end for that reason.
template <TurningCertificate C>
int sign_at(const C& certificate, double t, int derivative = 0);

/// Sign of f (or its derivative) at t+, the instant after t: that of the first of f(t), f'(t), f''(t) ... that is not
/// zero, and 0 only if f is zero at all times. f is analytic, so unless it is zero throughout, which is decided by its
/// coefficients, one of them is not.
template <TurningCertificate C>
int sign_after(const C& certificate, double t, int derivative = 0);

/// Whether f, or its derivative, is zero at all times. Exact.
template <TurningCertificate C>
bool vanishes(const C& certificate, int derivative = 0);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// The value of f at t, in balls.
template <class Number, class C>
Number turning_value(const C& certificate, double t) {
  const std::array<Spin, 2> spins = certificate.spins();
  return value_at_epoch(certificate.template turning_sum<Number, 0>(t), spins[0].template turn<Number>(t),
                        spins[1].template turn<Number>(t));
}

/// A derivative of f, or f itself, with all its polynomials.
template <class Number, int Degree, int Harmonics>
TurningSum<Degree, Number, Harmonics> derived_sum(const TurningReference<Degree, Harmonics>& certificate, double t,
                                                  int derivative) {
  auto f = certificate.template turning_sum<Number, Degree>(t);
  if (derivative > 0) {
    const std::array<Spin, 2> spins = certificate.spins();
    const Number a = spins[0].template squared_rate<Number>();
    const Number b = spins[1].template squared_rate<Number>();
    for (int k = 0; k < derivative; ++k) f = kds::derivative(f, a, b);
  }
  return f;
}

/// The value of a derivative of f at t, in balls. Precondition: derivative > 0.
template <class Number, int Degree, int Harmonics>
Number turning_derivative(const TurningReference<Degree, Harmonics>& certificate, double t, int derivative) {
  const std::array<Spin, 2> spins = certificate.spins();
  return value_at_epoch(derived_sum<Number>(certificate, t, derivative), spins[0].template turn<Number>(t),
                        spins[1].template turn<Number>(t));
}

/// The sign of f at t by its formula, without counting. For checks of what hooks answer.
template <int Degree, int Harmonics>
int general_turning_sign(const TurningReference<Degree, Harmonics>& certificate, double t);

/// f at t, times any positive number, got the cheapest way.
template <class C>
Ball<double> turning_value_in_doubles(const C& certificate, double t) {
  static_assert(RightTurningHooks<C>::checked);
  if constexpr (GivesQuickValue<C>) {
    const Ball<double> value = certificate.quick_value(t);
    if constexpr (checks_quick_answers) {
      check_sign<C, Hook::quick_value>("quick_value", certain_sign(value), t,
                                       [&] { return general_turning_sign(TurningReference(certificate), t); });
    }
    return value;
  } else {
    return turning_value<Ball<double>>(certificate, t);
  }
}

/// What is referred to tells.
template <int Degree, int Harmonics>
bool plainly_vanishes(const TurningReference<Degree, Harmonics>& certificate) {
  return certificate.plainly_vanishes();
}
template <int Degree, int Harmonics>
Ball<DoubleDouble> extended_turning_value(const TurningReference<Degree, Harmonics>& certificate, double t) {
  return certificate.extended_value(t);
}

/// Whether all coefficients of f are zero and doubles tell so: then it is zero at all times. That is most of what is.
template <class C>
bool plainly_vanishes(const C& certificate) {
  const auto f = certificate.template turning_sum<PlainNumber, C::degree>(certificate.spins()[0].start);
  for (const auto& row : f.p) {
    for (const auto& polynomial : row) {
      if (!is_known_zero(polynomial.c)) return false;
    }
  }
  return true;
}

/// Whether neither body has turned by t.
inline bool at_start(const std::array<Spin, 2>& spins, double t) {
  return std::all_of(spins.begin(), spins.end(), [t](const Spin& spin) { return spin.still() || spin.start == t; });
}

/// The sign of f at t if neither body has turned by then, and the certificate tells it.
template <class C>
std::optional<int> sign_at_start(const C& certificate, double t) {
  if constexpr (GivesValueAtStart<C>) {
    if (at_start(certificate.spins(), t)) return certificate.template value_at_start<Exact>(t).sign();
  }
  return std::nullopt;
}
template <int Degree, int Harmonics>
std::optional<int> sign_at_start(const TurningReference<Degree, Harmonics>& certificate, double t) {
  return certificate.sign_at_start(t);
}

/// f at t in double-doubles, got the cheapest way in which its sign is certain, if there is one; zero without an error
/// where it plainly is.
template <class C>
Ball<DoubleDouble> extended_turning_value(const C& certificate, double t) {
  static_assert(RightTurningHooks<C>::checked);
  if constexpr (GivesExtendedValue<C>) {
    const Ball<DoubleDouble> value = certificate.extended_value(t);
    if constexpr (checks_quick_answers) {
      check_sign<C, Hook::turning_extended_value>("extended_value", certain_sign(value), t, [&] {
        return general_turning_sign(TurningReference(certificate), t);
      });
    }
    if (certain_sign(value) != 0) return value;
  }
  bool is_zero = false;
  if constexpr (GivesValueAtStart<C>) {
    is_zero = at_start(certificate.spins(), t) && certificate.template value_at_start<PlainNumber>(t).is_zero();
  }
  if (is_zero || plainly_vanishes(certificate)) {
    ++turning_sign_counters.exact;
    ++turning_sign_counters.zeros;
    return {};
  }
  return turning_value<Ball<DoubleDouble>>(certificate, t);
}

/// Of a sum that is not zero at its epoch t.
template <int Degree, int Harmonics>
int enclosed_sign(const TurningSum<Degree, Exact, Harmonics>& f, const std::array<Spin, 2>& spins, double t) {
  for (int bits = 160;; bits *= 2) {
    ++turning_sign_counters.enclosed;
    if (const int s =
            certain_sign(value_at_epoch(f, spins[0].enclosed_turn(t, bits), spins[1].enclosed_turn(t, bits)))) {
      return s;
    }
  }
}

/// When the sign of a derivative of f is asked for: at a time, or just after it.
enum class Instant : std::uint8_t { at, after };

template <int Degree, int Harmonics>
int next_turning_sign(const TurningReference<Degree, Harmonics>& certificate, double t, int derivative);
template <int Degree, int Harmonics>
int turning_sign_after_zero(const TurningReference<Degree, Harmonics>& certificate, double t, int derivative);

/// The last rungs. The coefficients about t that tell that f is zero there also tell whether it is so at all times.
template <int Degree, int Harmonics>
int exact_turning_sign(const TurningReference<Degree, Harmonics>& certificate, double t, int derivative,
                       Instant instant) {
  ++turning_sign_counters.exact;
  if (derivative == 0) {
    if (const auto sign = sign_at_start(certificate, t)) {
      turning_sign_counters.zeros += *sign == 0;
      return *sign != 0 || instant == Instant::at ? *sign : turning_sign_after_zero(certificate, t, 0);
    }
  }
  const std::array<Spin, 2> spins = certificate.spins();
  const auto f = derived_sum<Exact>(certificate, t, derivative);
  if (!vanishes_at_epoch(f, relation_at(spins[0], spins[1], t, f.harmonics))) return enclosed_sign(f, spins, t);
  ++turning_sign_counters.zeros;
  if (instant == Instant::at || vanishes_throughout(f, spins[0], spins[1])) return 0;
  return next_turning_sign(certificate, t, derivative);
}

template <int Degree, int Harmonics>
int general_turning_sign(const TurningReference<Degree, Harmonics>& certificate, double t) {
  const TurningSignCounters counters = turning_sign_counters;
  int sign = certain_sign(turning_value<Ball<DoubleDouble>>(certificate, t));
  if (sign == 0) sign = exact_turning_sign(certificate, t, 0, Instant::at);
  turning_sign_counters = counters;
  return sign;
}

template <int Degree, int Harmonics>
bool vanishes(const TurningReference<Degree, Harmonics>& certificate, int derivative) {
  if (derivative == 0 && plainly_vanishes(certificate)) return true;
  const std::array<Spin, 2> spins = certificate.spins();
  return vanishes_throughout(derived_sum<Exact>(certificate, spins[0].start, derivative), spins[0], spins[1]);
}

/// sign_after() where the derivative itself is zero at t. Mostly the next one is not, and doubles or double-doubles
/// tell its sign, for less than it takes to tell whether the first is zero at all times.
template <int Degree, int Harmonics>
int turning_sign_after_zero(const TurningReference<Degree, Harmonics>& certificate, double t, int derivative) {
  const int next = derivative + 1;
  if (const int s = certain_sign(turning_derivative<Ball<double>>(certificate, t, next))) return s;
  if (const int s = certain_sign(turning_derivative<Ball<DoubleDouble>>(certificate, t, next))) return s;
  return vanishes(certificate, derivative) ? 0 : next_turning_sign(certificate, t, derivative);
}

/// sign_at() or sign_after() of f where doubles do not tell, and of its derivatives.
template <int Degree, int Harmonics>
int longer_turning_sign(const TurningReference<Degree, Harmonics>& certificate, double t, int derivative,
                        Instant instant) {
  const auto zero = [&] { return instant == Instant::at ? 0 : turning_sign_after_zero(certificate, t, derivative); };
  if (derivative > 0) {
    const auto value = turning_derivative<Ball<double>>(certificate, t, derivative);
    if (const int s = certain_sign(value)) return s;
    if (value.is_zero()) return zero();
  }
  ++turning_sign_counters.extended;
  const auto value = derivative == 0 ? extended_turning_value(certificate, t)
                                     : turning_derivative<Ball<DoubleDouble>>(certificate, t, derivative);
  if (const int s = certain_sign(value)) return s;
  return value.is_zero() ? zero() : exact_turning_sign(certificate, t, derivative, instant);
}

/// The sign just after t of a derivative that is zero at t, but not at all times: that of the first of the next ones
/// that is not zero there.
template <int Degree, int Harmonics>
int next_turning_sign(const TurningReference<Degree, Harmonics>& certificate, double t, int derivative) {
  for (int k = derivative + 1;; ++k) {
    if (const int s = longer_turning_sign(certificate, t, k, Instant::at)) return s;
  }
}

}  // namespace detail

template <TurningCertificate C>
int sign_at(const C& certificate, double t, int derivative) {
  if (derivative == 0) {
    const Ball<double> value = detail::turning_value_in_doubles(certificate, t);
    if (const int s = certain_sign(value)) return s;
    if (value.is_zero()) return 0;
  }
  return detail::longer_turning_sign(TurningReference(certificate), t, derivative, detail::Instant::at);
}

template <TurningCertificate C>
bool vanishes(const C& certificate, int derivative) {
  return detail::vanishes(TurningReference(certificate), derivative);
}

template <TurningCertificate C>
int sign_after(const C& certificate, double t, int derivative) {
  if (derivative == 0) {
    const Ball<double> value = detail::turning_value_in_doubles(certificate, t);
    if (const int s = certain_sign(value)) return s;
    if (value.is_zero()) return detail::turning_sign_after_zero(TurningReference(certificate), t, derivative);
  }
  return detail::longer_turning_sign(TurningReference(certificate), t, derivative, detail::Instant::after);
}

#define KDS_TURNING_SIGNS(prefix, ...)                                                                \
  prefix int detail::general_turning_sign(const TurningReference<__VA_ARGS__>&, double);              \
  prefix int detail::longer_turning_sign(const TurningReference<__VA_ARGS__>&, double, int, Instant); \
  prefix int detail::turning_sign_after_zero(const TurningReference<__VA_ARGS__>&, double, int);      \
  prefix bool detail::vanishes(const TurningReference<__VA_ARGS__>&, int);
#define KDS_TURNING_SIGNS_ELSEWHERE(...) KDS_TURNING_SIGNS(extern template, __VA_ARGS__)
KDS_FOR_EACH_TURNING_SUM(KDS_TURNING_SIGNS_ELSEWHERE)
#undef KDS_TURNING_SIGNS_ELSEWHERE

}  // namespace kds
