// Numbers as text, in messages and files: the same in every locale.
#pragma once

#include <charconv>
#include <cmath>
#include <string>

namespace kds {

template <class Number>
void append_number(std::string& text, Number value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  text.append(digits, end);
}

/// The shortest that reads back to the same double.
inline std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

/// For numbers that were computed and not given: six digits.
inline std::string rounded_text(double value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 6);
  return {digits, end};
}

/// A power of two, as limits are: "2^-40 (9.1e-13)".
inline std::string power_text(double power) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, power, std::chars_format::scientific, 1);
  std::string decimal(digits, end);
  if (const auto plus = decimal.find('+'); plus != std::string::npos) decimal.erase(plus, 1);
  return "2^" + std::to_string(std::ilogb(power)) + " (" + decimal + ")";
}

}  // namespace kds
