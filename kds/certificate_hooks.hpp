// The optional members of a certificate, by which it saves work: each a concept with its laws.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/double_double.hpp"
#include "kds/member_named.hpp"

#include <concepts>
#include <type_traits>

namespace kds {

// A certificate is complete without any of these: they save work, and change no result. A hook that cannot answer
// returns a NaN, an infinite radius or `false`; so one that is meant for some template arguments only returns that for
// the others, and is not switched off by a requires-clause. A member with one of these names that is not exactly what
// the concept asks for (other parameters, not const, another result, private) does not compile: it would never be
// called, and only a loss of speed would show it. What hooks answer is compared with the formula on a sample of calls
// where KDS_CHECK_QUICK_ANSWERS is defined (hook_checks.hpp).

/// `bool vanishes() const`: cheap, and true only if f is zero throughout. So the exact rung is not needed for things
/// that move together.
template <class C>
concept TellsIfItVanishes = requires {
  static_cast<bool (C::*)() const>(&C::vanishes);
};

/// `Ball<DoubleDouble> extended_value(double t) const`: a ball that contains f(t), computed at less cost than
/// polynomial(t). Used to place a root among the doubles; ignored if its radius is infinite.
template <class C>
concept GivesExtendedValue = requires {
  static_cast<Ball<DoubleDouble> (C::*)(double) const>(&C::extended_value);
};

/// `double quick_failure_time(double now, double horizon) const`: what failure_time() gives, bit for bit, or a NaN
/// where that needs the general methods. It is called first, with now <= horizon.
template <class C>
concept AnswersQuickly = requires {
  static_cast<double (C::*)(double, double) const>(&C::quick_failure_time);
};

/// `double quick_failure_time_after_turn(double now, double horizon) const`: the same where f is known to be positive
/// just after now, as failure_time_after_turn() says.
template <class C>
concept AnswersQuicklyAfterTurn = requires {
  static_cast<double (C::*)(double, double) const>(&C::quick_failure_time_after_turn);
};

/// Failure times in seconds, of the first and of the second of two certificates.
struct TwoTimes {
  double first, second;
};

/// `static TwoTimes quick_failure_times(const C& first, const C& second, double now, double horizon)`: of two
/// certificates together, at less cost than one after the other; each as quick_failure_time() says.
template <class C>
concept AnswersQuicklyForTwo = requires(const C& certificate, double t) {
  { C::quick_failure_times(certificate, certificate, t, t) } -> std::same_as<TwoTimes>;
};

/// `bool is_negative_of(const C& other) const`: cheap, and true only if f is minus the function of the other, at all
/// times. So where the other has just failed, f is known to be positive, and its next failure is found at less cost
/// (failure_time_after_turn()). What certificates refer to is compared by its address.
template <class C>
concept TellsItsNegative = requires {
  static_cast<bool (C::*)(const C&) const>(&C::is_negative_of);
};

namespace detail {

KDS_MEMBER_NAMED(NamesVanishes, vanishes);
KDS_MEMBER_NAMED(NamesExtendedValue, extended_value);
KDS_MEMBER_NAMED(NamesQuickFailureTime, quick_failure_time);
KDS_MEMBER_NAMED(NamesQuickFailureTimeAfterTurn, quick_failure_time_after_turn);
KDS_MEMBER_NAMED(NamesQuickFailureTimes, quick_failure_times);
KDS_MEMBER_NAMED(NamesIsNegativeOf, is_negative_of);

/// To be named wherever a hook is used: compiles only if all hooks that the certificate has are as their concepts ask.
template <class C>
struct RightHooks {
  static_assert(TellsIfItVanishes<C> || !NamesVanishes<C>, "certificate: `vanishes` must be `bool vanishes() const`");
  static_assert(GivesExtendedValue<C> || !NamesExtendedValue<C>,
                "certificate: `extended_value` must be `Ball<DoubleDouble> extended_value(double t) const`");
  static_assert(AnswersQuickly<C> || !NamesQuickFailureTime<C>,
                "certificate: `quick_failure_time` must be "
                "`double quick_failure_time(double now, double horizon) const`");
  static_assert(AnswersQuicklyAfterTurn<C> || !NamesQuickFailureTimeAfterTurn<C>,
                "certificate: `quick_failure_time_after_turn` must be "
                "`double quick_failure_time_after_turn(double now, double horizon) const`");
  static_assert(AnswersQuicklyForTwo<C> || !NamesQuickFailureTimes<C>,
                "certificate: `quick_failure_times` must be "
                "`static TwoTimes quick_failure_times(const C& first, const C& second, double now, double horizon)`");
  static_assert(TellsItsNegative<C> || !NamesIsNegativeOf<C>,
                "certificate: `is_negative_of` must be `bool is_negative_of(const C& other) const`");
  static constexpr bool checked = true;
};

}  // namespace detail

}  // namespace kds
