// Lists in one memory against vectors.
#include "collision/world/pairs/list_arena.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace kds::collision::test_list_arena {
namespace {

TEST_CASE("An arena that is full says so, and keeps what it has", "[list_arena]") {
  constexpr std::uint64_t most = 64;
  ListArena<int, most> arena;
  ListArena<int, most>::List list, other;
  arena.push_back(other, 77);  // takes room for 4
  int count = 0;
  const auto fill = [&] {
    for (;; ++count) arena.push_back(list, count);
  };
  CHECK_THROWS_WITH(fill(), Catch::Contains("ListArena") && Catch::Contains("64"));
  // Rooms for 4 and for 4, 8, 16 and 32 are all there is.
  CHECK(count == 32);
  CHECK_THROWS_AS(arena.push_back(list, 1), std::length_error);
  REQUIRE(arena.items(list).size() == 32);
  for (int i = 0; i < 32; ++i) CHECK(arena.items(list)[static_cast<std::size_t>(i)] == i);
  arena.push_back(other, 78);  // there is room in what it has
  CHECK(arena.items(other)[1] == 78);
  arena.free(list);
  ListArena<int, most>::List again;
  for (int i = 0; i < 32; ++i) arena.push_back(again, i);
  CHECK(again.size == 32);
}

TEST_CASE("Lists in an arena hold what vectors hold", "[list_arena]") {
  constexpr std::uint64_t seed = 1;
  tests::Random random(seed);
  ListArena<int> arena;
  constexpr std::size_t lists = 20;
  std::vector<ListArena<int>::List> list(lists);
  std::vector<std::vector<int>> model(lists);
  std::size_t differences = 0;
  std::size_t longest = 0;
  for (int round = 0; round < 20'000; ++round) {
    const std::size_t i = random.below(lists);
    const auto dice = random.below(1000);
    if (dice == 0 && round % 7 == 0) {
      arena.clear();
      std::fill(list.begin(), list.end(), ListArena<int>::List{});
      for (auto& values : model) values.clear();
    } else if (dice < 5) {
      arena.free(list[i]);
      model[i].clear();
    } else if (dice < 450 && !model[i].empty()) {
      arena.pop_back(list[i]);
      model[i].pop_back();
    } else {
      arena.push_back(list[i], round, static_cast<std::uint32_t>(1 + random.below(9)));
      model[i].push_back(round);
    }
    longest = std::max(longest, model[i].size());
    for (std::size_t k = 0; k < lists; ++k) {
      const auto items = arena.items(list[k]);
      differences += !std::equal(items.begin(), items.end(), model[k].begin(), model[k].end());
      differences += list[k].empty() != model[k].empty();
    }
  }
  INFO("seed " << seed);
  CHECK(differences == 0);
  CHECK(longest > 32);
}

TEST_CASE("Room that was given back is used again", "[list_arena]") {
  ListArena<int> arena;
  ListArena<int>::List first;
  arena.push_back(first, 1, 3);
  const auto* const place = arena.items(first).data();
  CHECK(first.room == 4);
  arena.free(first);
  CHECK(first.room == 0);
  ListArena<int>::List second, third;
  arena.push_back(second, 2);
  arena.push_back(third, 3);
  CHECK(arena.items(second).data() == place);
  CHECK(arena.items(third).data() != place);
}

TEST_CASE("Lists stay where they are while there is reserved room", "[list_arena]") {
  ListArena<int> arena;
  ListArena<int>::List first, other;
  arena.push_back(first, 1);
  arena.reserve(400);
  const auto* const place = arena.items(first).data();
  for (int i = 0; i < 100; ++i) {
    other = {};
    arena.push_back(other, i);
  }
  CHECK(arena.items(first).data() == place);
  CHECK(arena.items(first)[0] == 1);
  CHECK(arena.items(other)[0] == 99);
  arena.clear();
  first = {};
  arena.push_back(first, 2);
  CHECK(arena.items(first)[0] == 2);
}

}  // namespace
}  // namespace kds::collision::test_list_arena
