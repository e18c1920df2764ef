// What the checks of the exercises have in common.
#pragma once

#include <exception>
#include <iostream>
#include <sstream>
#include <stdexcept>

namespace kds::exercises {

/// Throws std::runtime_error with the text of the other arguments unless `holds`.
template <class... Text>
void expect(bool holds, const Text&... text) {
  if (holds) return;
  std::ostringstream all;
  (all << ... << text);
  throw std::runtime_error(all.str());
}

/// Prints "right: ", or "not yet: " and what an answer lacks, and gives what main() is to return. An audit of the
/// library that fails counts as an answer that is not right yet.
inline int check(const char* right, void (*examine)()) {
  try {
    examine();
  } catch (const std::exception& error) {
    std::cout << "not yet: " << error.what() << '\n';
    return 1;
  }
  std::cout << "right: " << right << '\n';
  return 0;
}

}  // namespace kds::exercises
