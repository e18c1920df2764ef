// Stretches of contact as a clock of doubles sees them: those of exact arithmetic, and those that the narrow phase
// finds.
#pragma once

#include "collision/narrow_phase/narrow_phase.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/support/exact_algebra.hpp"

#include <catch2/catch.hpp>

#include <ostream>
#include <vector>

namespace kds::collision::tests {

/// One stretch of contact as a clock made of doubles sees it; an end at infinity is none.
struct Stretch {
  double begin;
  double end;
  bool at_start;

  friend bool operator==(const Stretch& x, const Stretch& y) {
    return x.begin == y.begin && x.end == y.end && x.at_start == y.at_start;
  }
  friend std::ostream& operator<<(std::ostream& out, const Stretch& s) {
    return out << lattice_index(s.begin) << " (" << s.begin << ") to " << lattice_index(s.end) << " (" << s.end << ')'
               << (s.at_start ? " from the start" : "");
  }
};

/// Stretches that own no double are never seen, and a gap that owns none is not either.
inline std::vector<Stretch> on_the_clock(const std::vector<oracle::Stretch>& exact_stretches, double limit) {
  std::vector<Stretch> result;
  for (const auto& stretch : exact_stretches) {
    Stretch seen{stretch.begin.ceiling(), stretch.end ? stretch.end->ceiling() : never, stretch.at_start};
    if (seen.end > limit) seen.end = never;
    if (seen.begin > limit || seen.begin == seen.end) continue;
    if (!result.empty() && result.back().end == seen.begin) {
      result.back().end = seen.end;
    } else {
      result.push_back(seen);
    }
  }
  return result;
}

/// What the narrow phase finds by its three questions.
template <int Degree>
std::vector<Stretch> ask(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double start,
                         double limit) {
  std::vector<Stretch> result;
  double t = start;
  bool at_start = in_contact(a, b, start);
  for (;;) {
    t = first_contact(a, b, t, limit, ContactMode::transparent);
    if (t == never) return result;
    REQUIRE(in_contact(a, b, t));
    REQUIRE((t == start || !in_contact(a, b, next_down(t))));
    const double end = first_separation(a, b, t, limit);
    result.push_back({t, end, at_start});
    if (end == never) return result;
    REQUIRE_FALSE(in_contact(a, b, end));
    REQUIRE(end > t);
    at_start = false;
    t = end;
  }
}

}  // namespace kds::collision::tests
