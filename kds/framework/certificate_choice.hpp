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
