// What was edited at one instant, and the same looked up in plain lists.
#include "collision/world/pairs/instant_edits.hpp"

#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace kds::collision::test_instant_edits {
namespace {

constexpr CollisionFilter all{};
constexpr CollisionFilter of_group{1, ~0u, 7};
constexpr CollisionFilter only_second{1, 2, 0};

TEST_CASE("Instant edits: what was done at another time is forgotten") {
  InstantEdits edits;
  CHECK_FALSE(edits.has_jumped(3, -never));
  edits.add_jump(3, 1);
  edits.add_filter(4, only_second, 1);
  edits.add_ignored(5, 6, 1);
  CHECK(edits.has_jumped(3, 1));
  CHECK_FALSE(edits.has_jumped(3, 2));
  CHECK_FALSE(edits.has_jumped(4, 1));
  CHECK(edits.has_let_collide(4, all, 9, all, 1));
  CHECK(edits.has_let_collide(9, all, 4, all, 1));
  CHECK_FALSE(edits.has_let_collide(4, all, 9, all, 2));
  CHECK_FALSE(edits.has_let_collide(4, all, 9, {2, ~0u, 0}, 1));
  CHECK(edits.has_let_collide(6, all, 5, all, 1));
  edits.add_jump(8, 2);
  CHECK_FALSE(edits.has_jumped(3, 2));
  CHECK(edits.image(2).jumped == std::vector<BodySlot>{8});
  CHECK(edits.image(2).filtered.empty());
  CHECK(edits.image(2).ignored.empty());
  CHECK(edits.image(1).jumped.empty());
}

TEST_CASE("Instant edits: filters that two bodies have had are compared with each other, too") {
  InstantEdits edits;
  edits.add_filter(1, of_group, 0);
  CHECK_FALSE(edits.has_let_collide(1, all, 2, all, 0));
  edits.add_filter(2, of_group, 0);
  CHECK(edits.has_let_collide(1, all, 2, all, 0));
  edits.forget(1);
  CHECK_FALSE(edits.has_let_collide(1, all, 2, all, 0));
}

/// The same, by looking through everything that was done.
struct Plain {
  double at = -never;
  std::vector<BodySlot> jumped;
  std::vector<std::pair<BodySlot, CollisionFilter>> had;
  std::vector<std::pair<BodySlot, BodySlot>> ignored;

  void begin(double now) {
    if (at != now) *this = Plain{now, {}, {}, {}};
  }
  std::vector<CollisionFilter> filters(BodySlot body, const CollisionFilter& present) const {
    std::vector<CollisionFilter> all{present};
    for (const auto& [of, filter] : had) {
      if (of == body) all.push_back(filter);
    }
    return all;
  }
  bool has_let_collide(BodySlot a, const CollisionFilter& of_a, BodySlot b, const CollisionFilter& of_b,
                       double now) const {
    if (at != now) return false;
    for (const auto& pair : ignored) {
      if (pair == IgnoredPairs::pair(a, b)) return true;
    }
    for (const CollisionFilter& x : filters(a, of_a)) {
      for (const CollisionFilter& y : filters(b, of_b)) {
        if (!x.meets(y)) return true;
      }
    }
    return false;
  }
};

TEST_CASE("Instant edits agree with lists that are looked through") {
  const auto seed = GENERATE(range(0u, 60u));
  CAPTURE(seed);
  tests::Random random(seed);
  const auto below = [&](std::size_t n) { return random.below(n); };
  InstantEdits edits;
  Plain plain;
  double now = 0;
  const std::vector<CollisionFilter> some{all, of_group, only_second, {2, ~0u, 0}, {3, 1, 7}};
  for (int step = 0; step < 300; ++step) {
    if (below(40) == 0) now += 1;
    const auto a = static_cast<BodySlot>(below(8)), b = static_cast<BodySlot>((a + 1 + below(7)) % 8);
    switch (below(5)) {
      case 0:
        edits.add_jump(a, now), plain.begin(now), plain.jumped.push_back(a);
        break;
      case 1: {
        const CollisionFilter& before = some[below(5)];
        edits.add_filter(a, before, now), plain.begin(now), plain.had.emplace_back(a, before);
        break;
      }
      case 2:
        edits.add_ignored(a, b, now), plain.begin(now), plain.ignored.push_back(IgnoredPairs::pair(a, b));
        break;
      case 3:
        if (below(4) != 0) break;
        edits.forget(a);
        std::erase(plain.jumped, a);
        std::erase_if(plain.had, [&](const auto& one) { return one.first == a; });
        std::erase_if(plain.ignored, [&](const auto& one) { return one.first == a || one.second == a; });
        break;
      default: {  // A snapshot is made and gone on from.
        const InstantEdits::Image image = edits.image(now);
        CHECK(std::is_sorted(image.jumped.begin(), image.jumped.end()));
        CHECK(std::is_sorted(image.ignored.begin(), image.ignored.end()));
        edits.become(image, now);
      }
    }
    for (BodySlot x = 0; x < 8; ++x) {
      const bool jumped =
          plain.at == now && std::find(plain.jumped.begin(), plain.jumped.end(), x) != plain.jumped.end();
      REQUIRE(edits.has_jumped(x, now) == jumped);
      const auto y = static_cast<BodySlot>((x + 1 + below(7)) % 8);
      const CollisionFilter &of_x = some[below(5)], &of_y = some[below(5)];
      // Asked of pairs only that may collide.
      if (!of_x.meets(of_y)) continue;
      REQUIRE(edits.has_let_collide(x, of_x, y, of_y, now) == plain.has_let_collide(x, of_x, y, of_y, now));
    }
  }
}

}  // namespace
}  // namespace kds::collision::test_instant_edits
