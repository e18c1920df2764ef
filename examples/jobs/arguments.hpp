// Numbers on the command lines of the jobs.
#pragma once

#include <cmath>
#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>

namespace jobs {

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

}  // namespace jobs
