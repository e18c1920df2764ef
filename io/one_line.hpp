// Messages of one line.
#pragma once

#include <algorithm>
#include <string>

namespace kds::io {

/// File names, keys and arguments come from outside and may hold anything; a message that names them stays one line,
/// and tells the terminal nothing: control characters become spaces.
inline std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

}  // namespace kds::io
