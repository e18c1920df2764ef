// The types that a rule may return for a slot's certificate: a certificate, perhaps none (std::optional,
// std::monostate), or one of several kinds (std::variant), nested at will.
#pragma once

#include "kds/certificate.hpp"
#include "kds/uncertain.hpp"

#include <concepts>
#include <optional>
#include <type_traits>
#include <variant>

namespace kds::detail {

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};
template <class T>
struct IsVariant : std::false_type {};
template <class... T>
struct IsVariant<std::variant<T...>> : std::true_type {};

/// Whether it has failure times, directly or as a certificate of sampled elements.
template <class C>
concept AnyCertificate = Certificate<C> || UncertainCertificate<C>;

template <class T>
struct IsCertificateChoice : std::bool_constant<AnyCertificate<T> || std::same_as<T, std::monostate>> {};
template <class T>
struct IsCertificateChoice<std::optional<T>> : IsCertificateChoice<T> {};
template <class... T>
struct IsCertificateChoice<std::variant<T...>> : std::bool_constant<(IsCertificateChoice<T>::value && ...)> {};

template <class C>
concept NamesDegree = requires {
  { C::degree } -> std::convertible_to<int>;
};
/// For every type of number, Exact among them.
template <class C>
concept GivesPolynomials = requires(const C& certificate, double epoch) {
  certificate.template polynomial<Exact>(epoch);
  certificate.template polynomial<Ball<double>>(epoch);
  certificate.template polynomial<Ball<DoubleDouble>>(epoch);
};
template <class C>
concept NamesItsDegree = requires(const C& certificate, double epoch) {
  requires decltype(certificate.template polynomial<Exact>(epoch))::degree == C::degree;
};

/// To be named wherever certificates are used: compiles only for certificates and choices of them, and says what is
/// wrong with a class that is none.
template <class C>
struct RightCertificate {
  static constexpr bool right = AnyCertificate<C> || std::same_as<C, std::monostate> || !std::is_class_v<C>;
  static_assert(right || NamesDegree<C>, "certificate: `static constexpr int degree` is missing");
  static_assert(right || GivesPolynomials<C>,
                "certificate: `template <class Number> auto polynomial(double epoch) const` is missing, or does not "
                "take every Number");
  static_assert(right || !NamesDegree<C> || !GivesPolynomials<C> || NamesItsDegree<C>,
                "certificate: `degree` is not the degree of its polynomial");
  static constexpr bool checked = true;
};
template <class T>
struct RightCertificate<std::optional<T>> : RightCertificate<T> {};
template <class... T>
struct RightCertificate<std::variant<T...>> {
  static constexpr bool checked = (RightCertificate<T>::checked && ...);
};

/// Calls f with the certificate, if there is one.
template <class T, class F>
void with_certificate(const T& choice, F&& f) {
  if constexpr (std::same_as<T, std::monostate>) {
  } else if constexpr (IsOptional<T>::value) {
    if (choice) with_certificate(*choice, f);
  } else if constexpr (IsVariant<T>::value) {
    std::visit([&](const auto& alternative) { with_certificate(alternative, f); }, choice);
  } else {
    f(choice);
  }
}

}  // namespace kds::detail
