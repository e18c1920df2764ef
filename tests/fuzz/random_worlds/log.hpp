// What has happened in a run, line by line, to be compared bit for bit.
#pragma once

#include "collision/world.hpp"
#include "tests/fuzz/random_worlds/scenario.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kds::fuzz {

using collision::body_generation;
using collision::body_slot;
using collision::BodyId;
using collision::Contact;

struct Line {
  enum class Kind : std::uint8_t {
    contact,
    separation,
    overlap,
    wall,
    pair_began,
    pair_ended,
    rebound_suppressed,
    rebound_suppressed_at_wall,
    rests,
    rests_at_wall,
    wakes,
    wakes_at_wall,
    passes,
    moved,
    piece,
    timer,
    thrown,  ///< by a call; `text` is what it says
    state,   ///< behind an advance: `text` says the clock, where the bodies are, and who touches and rests
  };
  Kind kind = Kind::state;
  BodyId a = 0;
  BodyId b = 0;  ///< of walls the wall
  Contact contact{};
  std::string text{};
};

inline constexpr std::string_view line_names[] = {"contact",
                                                  "separation",
                                                  "overlap",
                                                  "wall",
                                                  "pair_began",
                                                  "pair_ended",
                                                  "rebound_suppressed",
                                                  "rebound_suppressed_at_wall",
                                                  "rests",
                                                  "rests_at_wall",
                                                  "wakes",
                                                  "wakes_at_wall",
                                                  "passes",
                                                  "moved",
                                                  "piece",
                                                  "timer",
                                                  "thrown",
                                                  "state"};

constexpr bool is_of_a_wall(Line::Kind kind) {
  using enum Line::Kind;
  return kind == wall || kind == rebound_suppressed_at_wall || kind == rests_at_wall || kind == wakes_at_wall;
}

/// Text of a line for a call that must be refused and was not.
inline constexpr std::string_view not_refused = "nothing, where it must be";

/// Whether all is the same, bit for bit.
bool same(const Line& x, const Line& y);
/// For people; numbers in hexadecimal, or rounded.
std::string shown(const Line& line, bool exactly = true);

/// Where two logs differ first.
struct Difference {
  bool any = false;
  std::size_t at = 0;  ///< number of the line
  std::string what;    ///< what kinds of lines stand there: "contact for nothing", say
  std::string text;    ///< both lines
};

/// Lines behind the first `most` are not looked at: a run may be given up there.
Difference compare(const std::vector<Line>& found, const std::vector<Line>& expected, std::size_t most);

}  // namespace kds::fuzz
