// Messages of one line.
#pragma once

#include <boost/locale/utf.hpp>

#include <iterator>
#include <string>

namespace kds::io {

/// File names, keys and arguments come from outside and may hold anything; a message that names them stays one line of
/// UTF-8, and tells the terminal nothing: control characters and separators of lines become spaces, bytes that are no
/// UTF-8 become U+FFFD.
inline std::string one_line(const std::string& text) {
  using Utf8 = boost::locale::utf::utf_traits<char>;
  std::string line;
  for (auto at = text.begin(); at != text.end();) {
    const auto begin = at;
    auto point = Utf8::decode(at, text.end());
    if (!boost::locale::utf::is_valid_codepoint(point)) {
      at = std::next(begin);
      point = 0xfffd;
    }
    const bool breaks = point < 0x20 || (point >= 0x7f && point < 0xa0) || point == 0x2028 || point == 0x2029;
    Utf8::encode(breaks ? ' ' : point, std::back_inserter(line));
  }
  return line;
}

}  // namespace kds::io
