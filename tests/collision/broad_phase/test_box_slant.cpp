// Slanted boxes against integers, and in a grid.
#include "collision/broad_phase/box_grid.hpp"
#include "collision/broad_phase/box_slant.hpp"
#include "tests/collision/broad_phase/box_grid_boxes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace kds::collision::test_box_slant {
namespace {

using namespace tests;
using Eigen::Array3d;
using Eigen::Vector3d;

struct WholeBox {
  std::array<std::int64_t, 3> low, high;

  StaticBox scaled(double scale) const {
    StaticBox box;
    for (std::size_t d = 0; d < 3; ++d) {
      box.min[static_cast<int>(d)] = scale * static_cast<double>(low[d]);
      box.max[static_cast<int>(d)] = scale * static_cast<double>(high[d]);
    }
    return box;
  }
};

WholeBox whole_box(Random& random) {
  WholeBox box;
  for (std::size_t d = 0; d < 3; ++d) {
    box.low[d] = random.integer(-12, 12);
    box.high[d] = box.low[d] + random.integer(0, 4);
  }
  return box;
}

enum class Meeting { never, touches, overlaps };

/// Whether box a meets b at some time, moving with a whole velocity: times that are quotients, compared by products.
Meeting meet(const WholeBox& a, const std::array<std::int64_t, 3>& velocity, const WholeBox& b) {
  struct Time {
    std::int64_t over, under;  // under > 0
  };
  const auto later = [](const Time& x, const Time& y) { return x.over * y.under > y.over * x.under; };
  std::optional<Time> from, to;
  bool touches = false;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::int64_t v = velocity[d];
    const std::int64_t first = b.low[d] - a.high[d], last = b.high[d] - a.low[d];  // of v t
    if (v == 0) {
      if (first > 0 || last < 0) return Meeting::never;
      touches = touches || first == 0 || last == 0;
      continue;
    }
    const Time begin = v > 0 ? Time{first, v} : Time{-last, -v};
    const Time end = v > 0 ? Time{last, v} : Time{-first, -v};
    if (!from || later(begin, *from)) from = begin;
    if (!to || later(*to, end)) to = end;
  }
  if (from && later(*from, *to)) return Meeting::never;
  return touches || (from && !later(*to, *from)) ? Meeting::touches : Meeting::overlaps;
}

TEST_CASE("A slanted box is apart from what its prism does not meet", "[box_slant]") {
  Random random(5);
  std::size_t missed = 0, in_vain = 0, apart = 0, touching = 0;
  for (int round = 0; round < 200'000; ++round) {
    const WholeBox a = whole_box(random), b = whole_box(random);
    std::array<std::int64_t, 3> velocity;
    Vector3d v;
    const double scale = std::ldexp(1.0, random.integer(-400, 400));
    const double speed_scale = std::ldexp(1.0, random.integer(-1000, 400));
    for (std::size_t d = 0; d < 3; ++d) {
      velocity[d] = random.integer(-5, 5);
      v[static_cast<int>(d)] = speed_scale * static_cast<double>(velocity[d]);
    }
    if (!BoxSlant::pays(a.scaled(scale), v)) continue;
    const bool told = BoxSlant(a.scaled(scale), v).apart(BoxBounds(b.scaled(scale)));
    const Meeting meeting = meet(a, velocity, b);
    apart += told;
    touching += meeting == Meeting::touches;
    missed += told && meeting != Meeting::never;
    in_vain += !told && meeting == Meeting::never;
  }
  CHECK(missed == 0);
  CHECK(in_vain == 0);
  CHECK(apart > 50'000);
  CHECK(touching > 1000);
}

TEST_CASE("Slants pay for bodies that move along two axes, and not where products underflow", "[box_slant]") {
  const StaticBox box{{1, 1, 1}, {2, 2, 2}};
  CHECK(BoxSlant::pays(box, {1, 1, 0}));
  CHECK(BoxSlant::pays(box, {0, -1, 0.1}));
  CHECK_FALSE(BoxSlant::pays(box, {1, 0, 0}));
  CHECK_FALSE(BoxSlant::pays(box, {0, 0, 0}));
  CHECK_FALSE(BoxSlant::pays({{1, -0x1p-600, 1}, {2, 0x1p-600, 2}}, {1, 1, 1}));
}

/// What the grid is to know: boxes of several kinds, some slanted.
struct Known {
  StaticBox box;
  BoxGrid::Kind kind = 0;
  std::optional<BoxSlant> slant{};

  bool meets(const Known& other, const BoxGrid::Meetings& meetings) const {
    const bool kinds = meetings[kind] >> other.kind & 1;
    return kinds && box.overlaps(other.box) && !(slant && slant->apart(BoxBounds(other.box))) &&
           !(other.slant && other.slant->apart(BoxBounds(box)));
  }
};

BoxGrid::Meetings random_meetings(Random& random, const BoxGrid::Meetings& among) {
  BoxGrid::Meetings meetings = among;
  for (unsigned a = 0; a < BoxGrid::kinds; ++a) {
    for (unsigned b = 0; b <= a; ++b) {
      if (random.one_in(2)) continue;
      meetings[a] &= static_cast<std::uint8_t>(~(1u << b));
      meetings[b] &= static_cast<std::uint8_t>(~(1u << a));
    }
  }
  return meetings;
}

/// `guests_per_slab`: of the tuning; `far`: where the boxes are.
void compare_with_brute_force(std::uint64_t seed, int sizes, std::int64_t guests_per_slab, double far = 0) {
  INFO("seed " << seed << ", sizes over 2^" << sizes << ", guests " << guests_per_slab << ", around " << far);
  constexpr BoxGrid::Id boxes = 60;
  Random random(seed);
  CellTuning tuning;
  tuning.guests_per_slab = guests_per_slab;
  BoxGrid grid(tuning);
  grid.reserve(boxes);
  grid.change_kinds({0xF, 0xF, 0xF, 0xF}, [](BoxGrid::Id) { return BoxGrid::Kind{0}; });
  std::map<BoxGrid::Id, Known> known;
  std::set<std::pair<BoxGrid::Id, BoxGrid::Id>> pairs;
  BoxGrid::Meetings meetings{0xF, 0xF, 0xF, 0xF};
  const auto pairs_now = [&] {
    std::set<std::pair<BoxGrid::Id, BoxGrid::Id>> now;
    for (auto a = known.begin(); a != known.end(); ++a) {
      for (auto b = std::next(a); b != known.end(); ++b) {
        if (a->second.meets(b->second, meetings)) now.emplace(a->first, b->first);
      }
    }
    return now;
  };
  std::size_t seen = 0, slants_that_part = 0, alone_before = 0, told_before = 0;
  for (int round = 0; round < 800; ++round) {
    const auto id = static_cast<BoxGrid::Id>(random.below(boxes));
    const bool alone =
        std::none_of(pairs.begin(), pairs.end(), [&](const auto& p) { return p.first == id || p.second == id; });
    BoxGrid::Changes changes;
    if (round % 400 == 200) {  // fewer kinds meet from now on
      meetings = random_meetings(random, meetings);
      for (auto& [number, one] : known) one.kind = static_cast<BoxGrid::Kind>(random.below(BoxGrid::kinds));
      // Boxes that would begin to overlap by this are not to be there.
      for (const auto& pair : pairs_now()) {
        if (pairs.contains(pair) || !known.contains(pair.first)) continue;
        grid.remove(pair.first, changes);
        known.erase(pair.first);
      }
      grid.change_kinds(meetings, [&](BoxGrid::Id number) { return known.at(number).kind; });
      pairs = pairs_now();
      continue;
    }
    if (known.contains(id) && random.one_in(4)) {
      grid.remove(id, changes, alone);
      known.erase(id);
      REQUIRE(changes.began.empty());
    } else {
      const bool slanted = random.one_in(2);
      const double size = slanted && random.one_in(2) ? 4 : std::ldexp(1.0, -random.integer(0, sizes));
      Known one{random_box(random, size, 2, far)};
      one.kind = known.contains(id) ? known[id].kind : static_cast<BoxGrid::Kind>(random.below(BoxGrid::kinds));
      if (slanted) {
        Vector3d velocity(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
        if (random.one_in(4)) velocity[random.integer(0, 2)] *= 0x1p-4;
        const Array3d middle = 0.5 * (one.box.min + one.box.max);
        const double half = random.one_in(8) ? 0.3 : 0.01;
        one.slant = BoxSlant({middle - half, middle + half}, velocity);
      }
      if (!known.contains(id)) grid.set_kind(id, one.kind);
      // The caller may know what the old box overlaps.
      const bool told = known.contains(id) && !alone && random.one_in(3);
      if (told) std::erase_if(pairs, [&](const auto& p) { return p.first == id || p.second == id; });
      grid.put(id, one.box, changes, 0, known.contains(id) && (alone || told), one.slant ? &*one.slant : nullptr);
      alone_before += alone;
      told_before += told;
      known[id] = one;
    }
    for (const auto other : changes.ended) REQUIRE(pairs.erase(ordered(id, other)) == 1);
    for (const auto other : changes.began) REQUIRE(pairs.insert(ordered(id, other)).second);
    REQUIRE(pairs == pairs_now());
    seen += pairs.size();
    for (const auto& [number, other] : known) {
      const bool here = known.contains(id) && number != id && known.at(id).box.overlaps(other.box);
      slants_that_part += here && !known.at(id).meets(other, {0xF, 0xF, 0xF, 0xF});
    }
  }
  CHECK(seen > 300);
  CHECK(slants_that_part > 10);
  CHECK(alone_before > 20);
  CHECK(told_before > 20);
}

TEST_CASE("A box grid tells of the overlaps of slanted boxes, and of kinds that meet", "[box_slant][box_grid]") {
  constexpr std::int64_t always_followed = 0, never_followed = 1 << 20;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    compare_with_brute_force(seed, 0, CellTuning{}.guests_per_slab);
    for (const std::int64_t guests_per_slab : {always_followed, never_followed}) {
      compare_with_brute_force(seed, 6, guests_per_slab);
      compare_with_brute_force(seed, 3, guests_per_slab, -1e13);  // where cells are a few spacings of the doubles
    }
  }
}

TEST_CASE("Boxes that are announced are whole, whatever boxes of their numbers were before", "[box_slant][box_grid]") {
  const StaticBox long_box{{0, 0, 0}, {8, 8, 8}}, in_its_corner{{0, 7, 0}, {1, 8, 1}};
  BoxGrid grid;
  grid.reserve(2);
  BoxGrid::Changes changes;
  const BoxSlant slant({{0, 0, 0}, {1, 1, 1}}, {1, 1, 1});
  grid.put(0, long_box, changes, 0, false, &slant);
  grid.put(1, in_its_corner, changes);
  CHECK(changes.empty());
  grid.remove(0, changes);
  grid.remove(1, changes);
  grid.announce(0, long_box);
  grid.announce(1, in_its_corner);
  grid.enter(0, changes);
  grid.enter(1, changes);
  CHECK_FALSE(grid.slanted(0));
  CHECK(grid.overlap(0, 1));
  CHECK(changes.began.size() == 1);
}

}  // namespace
}  // namespace kds::collision::test_box_slant
