// What is on the command lines of the jobs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

namespace jobs {

/// Whether one of the arguments asks how the program is called.
inline bool asks_for_help(int argc, char** argv) {
  return std::any_of(argv + 1, argv + argc, [](std::string_view word) { return word == "--help" || word == "-h"; });
}

/// The value of an option. Throws std::invalid_argument, naming the option, for a text that is no finite number.
inline double number(const std::string& option, const std::string& text, const char* kind = "a number") {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
  }
  if (used == 0 || used != text.size() || !std::isfinite(value)) {
    throw std::invalid_argument(option + ": " + text + " is not " + kind);
  }
  return value;
}

/// The same for one that has to be > 0.
inline double positive_number(const std::string& option, const std::string& text) {
  constexpr const char* kind = "a number > 0";
  const double value = number(option, text, kind);
  if (!(value > 0)) throw std::invalid_argument(option + ": " + text + " is not " + kind);
  return value;
}

/// The same for a whole number >= 0.
inline std::uint64_t whole_number(const std::string& option, const std::string& text) {
  constexpr const char* kind = "a whole number >= 0";
  const double value = number(option, text, kind);
  if (!(value >= 0 && value <= 0x1p53 && value == std::floor(value))) {
    throw std::invalid_argument(option + ": " + text + " is not " + kind);
  }
  return static_cast<std::uint64_t>(value);
}

}  // namespace jobs
