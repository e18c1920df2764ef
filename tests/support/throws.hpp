// Whether a call is refused, and how.
#pragma once

#include <catch2/catch.hpp>

#include <stdexcept>
#include <string>

namespace kds::tests {

/// Checks that f() throws an Error whose message contains `what`.
template <class Error = std::invalid_argument, class F>
void throws(F&& f, const std::string& what) {
  INFO(what);
  try {
    f();
    FAIL("nothing was thrown");
  } catch (const Error& error) {
    INFO(error.what());
    CHECK(std::string(error.what()).find(what) != std::string::npos);
  }
}

}  // namespace kds::tests
