// Numbers as text: the shortest that reads back to the same double, in every locale.
#pragma once

#include <charconv>
#include <string>

namespace kds::io {

template <class Number>
void append_number(std::string& text, Number value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  text.append(digits, end);
}

inline std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

/// For numbers that were computed and not given: six digits.
inline std::string about(double value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 6);
  return {digits, end};
}

}  // namespace kds::io
