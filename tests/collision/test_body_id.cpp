// The names of bodies.
#include "collision/body_id.hpp"

#include <catch2/catch.hpp>

#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>
#include <unordered_set>

namespace kds::collision {
namespace {

// A slot is no id, nor an id a slot, unless it is written down.
static_assert(!std::is_convertible_v<BodySlot, BodyId> && std::constructible_from<BodyId, BodySlot>);
static_assert(!std::is_convertible_v<BodyId, BodySlot>);
// Ids are made of other numbers, and may be used as the one that they are.
static_assert(std::is_convertible_v<int, BodyId> && std::is_convertible_v<std::uint64_t, BodyId>);
static_assert(std::is_convertible_v<BodyId, std::uint64_t>);
static_assert(std::is_trivially_copyable_v<BodyId> && sizeof(BodyId) == sizeof(std::uint64_t));

TEST_CASE("An id is a slot and a generation in one number", "[body_id]") {
  const BodyId id(3, 7);
  CHECK(id.slot() == 7);
  CHECK(id.generation() == 3);
  CHECK(id == (std::uint64_t{3} << 32) + 7);
  CHECK(std::to_string(id) == "12884901895");
  CHECK(BodyId(std::uint64_t{id}) == id);
  CHECK(BodyId() == 0);
  const BodySlot slot = 7;
  CHECK(BodyId(slot) == 7);
  const BodyId greatest(~0u, ~0u);
  CHECK(greatest == BodyId(-1));
  CHECK(greatest.slot() == no_body);
}

TEST_CASE("Ids are counted through like numbers", "[body_id]") {
  int pairs = 0;
  const std::size_t size = 5;
  for (BodyId a = 0; a < size; ++a) {
    for (BodyId b = a + 1; b < size; ++b) {
      CHECK(b - 1 >= a);
      CHECK(a != b);
      ++pairs;
    }
  }
  CHECK(pairs == 10);
}

TEST_CASE("Ids are ranked by slot, and of one slot by generation", "[body_id]") {
  CHECK(BodyId(0, 1).rank() < BodyId(0, 2).rank());
  CHECK(BodyId(0, 1).rank() < BodyId(1, 1).rank());
  CHECK(BodyId(9, 1).rank() < BodyId(0, 2).rank());
  CHECK(BodyId(0, 2) < BodyId(9, 1));  // as numbers
}

TEST_CASE("Ids are keys of hash tables", "[body_id]") {
  const std::unordered_set<BodyId> ids{0, 1, BodyId(1, 0), 1};
  CHECK(ids.size() == 3);
  CHECK(ids.contains(BodyId(1, 0)));
}

}  // namespace
}  // namespace kds::collision
