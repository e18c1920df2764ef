// What libFuzzer calls. An exception that leaves it ends the program, and libFuzzer writes the input down.
#include "tests/fuzz/check.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    kds::fuzz::run({data, size});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failure: %s\n", error.what());
    throw;
  }
  return 0;
}
