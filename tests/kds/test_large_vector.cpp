#include "kds/large_vector.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <utility>

namespace test_large_vector {
namespace {

using kds::LargeAllocator;
using kds::LargeVector;
using kds::detail::large_page;
using kds::detail::much_memory;

bool at_large_page(const void* memory) { return reinterpret_cast<std::uintptr_t>(memory) % large_page == 0; }

struct alignas(64) Line {
  std::size_t value;
};

}  // namespace

TEST_CASE("what a large vector holds stays as it grows into large pages, and is copied and moved", "[large_vector]") {
  constexpr std::size_t most = 3 * much_memory / sizeof(Line) + 1;
  LargeVector<Line> lines;
  for (std::size_t i = 0; i < most; ++i) lines.push_back({i});
  LargeVector<Line> copy = lines;
  const Line* const before = lines.data();
  const LargeVector<Line> moved = std::move(lines);
  CHECK(moved.data() == before);
  copy.resize(2);
  copy.shrink_to_fit();
  for (std::size_t i = 0; i < most; ++i) {
    if (moved[i].value != i) FAIL("line " << i << " is " << moved[i].value);
  }
  CHECK((copy[0].value == 0 && copy[1].value == 1));
}

TEST_CASE("much memory begins at a large page, and little where its elements may", "[large_vector]") {
  const std::size_t enough = much_memory / sizeof(Line);
  CHECK(at_large_page(LargeVector<Line>(enough).data()));
  CHECK(at_large_page(LargeVector<Line>(enough + 1).data()));
  CHECK(at_large_page(LargeVector<char>(much_memory).data()));
  const LargeVector<Line> little(enough - 1);
  CHECK(reinterpret_cast<std::uintptr_t>(little.data()) % alignof(Line) == 0);
}

TEST_CASE("more than can be counted in bytes is refused", "[large_vector]") {
  LargeAllocator<Line> allocator;
  const std::size_t most = std::numeric_limits<std::size_t>::max() / sizeof(Line);
  CHECK_THROWS_AS(allocator.allocate(most + 1), std::bad_array_new_length);
  CHECK(allocator == LargeAllocator<Line>(LargeAllocator<char>()));
}

}  // namespace test_large_vector
