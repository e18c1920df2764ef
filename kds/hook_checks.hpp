// Compares a sample of the quick answers of certificates with what their formula gives: for test builds.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/double_double.hpp"
#include "kds/arithmetic/exact.hpp"

#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

// With KDS_CHECK_QUICK_ANSWERS defined, which the preset `dev` does, in all files of a program: of the answers of each
// hook of each kind of certificate (certificate_hooks.hpp, turning/turning_certificate.hpp) the first and then every
// 1024th is computed by the general way too, in each thread. Where they differ std::logic_error names the certificate.
// Neither events nor the counters of signs change. Without the macro nothing of this is compiled.
namespace kds::detail {

#ifdef KDS_CHECK_QUICK_ANSWERS
inline constexpr bool checks_quick_answers = true;
#else
inline constexpr bool checks_quick_answers = false;
#endif

enum class Hook {
  vanishes,
  extended_value,
  quick_failure_time,
  quick_failure_time_after_turn,
  quick_failure_times,
  is_negative_of,
  quick_value,            ///< of turning certificates
  turning_extended_value  ///< of these, of which only the sign counts
};

/// One answer in so many is checked. The general way costs up to a hundred times as much as a quick answer.
inline constexpr std::uint32_t answers_per_check = 1024;

/// Whether this answer is one of those that are checked.
template <class C, Hook>
bool is_to_be_checked() {
  if constexpr (checks_quick_answers) {
    static thread_local std::uint32_t answers = 0;
    return answers++ % answers_per_check == 0;
  }
  return false;
}

/// The type's name as the compiler writes it.
template <class C>
std::string name_of_type() {
  const std::string_view function = __PRETTY_FUNCTION__;  // ... [with C = name; ...] or ... [C = name]
  const std::size_t begin = function.find("C = ") + 4;
  return std::string(function.substr(begin, function.find_first_of(";]", begin) - begin));
}

template <class C>
[[noreturn, gnu::cold]] void refuse_answer(const char* hook, const std::string& what) {
  throw std::logic_error("certificate " + name_of_type<C>() + ": " + hook + ' ' + what);
}

template <class C>
void require_same_time(const char* hook, double quick, double general, double now, double horizon) {
  if (quick == general) return;
  char text[256];
  std::snprintf(text, sizeof(text), "gives %a, its formula %a, for now = %a and horizon = %a", quick, general, now,
                horizon);
  refuse_answer<C>(hook, text);
}

template <class C>
void check_vanishes(const C& certificate) {
  if (!is_to_be_checked<C, Hook::vanishes>()) return;
  for (const Exact& c : certificate.template polynomial<Exact>(0).c) {
    if (c.sign() != 0) refuse_answer<C>("vanishes", "is true, but its formula is not zero");
  }
}

template <class C>
void check_is_negative_of(const C& certificate, const C& other) {
  if (!is_to_be_checked<C, Hook::is_negative_of>()) return;
  const auto f = certificate.template polynomial<Exact>(0), g = other.template polynomial<Exact>(0);
  for (std::size_t i = 0; i < f.c.size(); ++i) {
    if ((f.c[i] + g.c[i]).sign() != 0) {
      refuse_answer<C>("is_negative_of", "is true, but the sum of the two formulas is not zero");
    }
  }
}

/// `sign`: that of the answer, 0 if it does not tell. general(): the sign by the formula.
template <class C, Hook which, class General>
void check_sign(const char* hook, int sign, double t, const General& general) {
  if (!is_to_be_checked<C, which>() || sign == 0) return;
  const int right = general();
  if (sign == right) return;
  char text[128];
  std::snprintf(text, sizeof(text), "has the sign %d at t = %a, its formula %d", sign, t, right);
  refuse_answer<C>(hook, text);
}

template <class C>
void check_extended_value(const C& certificate, double t, const Ball<DoubleDouble>& value) {
  if (!is_to_be_checked<C, Hook::extended_value>()) return;
  const Exact middle = Exact(value.middle.high) + Exact(value.middle.low);
  const Exact error = absolute(certificate.template polynomial<Exact>(t).c[0] - middle);
  if ((error - Exact(value.radius * Ball<DoubleDouble>::slack)).sign() > 0) {
    char text[128];
    std::snprintf(text, sizeof(text), "is off by %g at t = %a, where it claims %g", error.approximate(), t,
                  value.radius);
    refuse_answer<C>("extended_value", text);
  }
}

}  // namespace kds::detail
