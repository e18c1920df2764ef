// Numbers in messages.
#pragma once

#include <sstream>
#include <string>

namespace kds::collision::detail {

/// With digits enough to know it by.
inline std::string number_text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace kds::collision::detail
