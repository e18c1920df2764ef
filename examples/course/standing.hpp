// How the structures of the course stand in the four measures of kinetic data structures.
#pragma once

#include "kds/framework/measures.hpp"

#include <cstdint>
#include <string>
#include <utility>

namespace kds::course {

/// A structure in the four measures, in words: each completes "it is responsive (efficient, local, compact): ...".
struct Standing {
  std::string structure, responsive, efficient, local, compact;

  friend bool operator==(const Standing&, const Standing&) = default;
};

/// The costs that the headers of the structures state, for n elements. Each function adds what a run has counted,
/// except where the structure does not count.
namespace standing {

inline Standing counted(Standing stated, const Measures& run) {
  const auto number = [](std::uint64_t count) { return std::to_string(count); };
  stated.responsive += " (here at most " + number(run.most_touched) + ")";
  stated.efficient +=
      " (here " + number(run.external) + " of " + number(run.events + run.followed) + " events change the answer)";
  stated.local += " (at the end at most " + number(run.most_per_element) + ")";
  stated.compact += " (here at most " + number(run.most_held) + ")";
  return stated;
}

/// examples/list_in_forty_lines.hpp
inline Standing sorted_list(const Measures& run) {
  return counted({"Sorted list", "3 certificates an event", "every event changes the order",
                  "2 certificates an element", "n \u2212 1 certificates"},
                 run);
}

/// structures/heap.hpp
inline Standing heap(const Measures& run) {
  return counted({"Heap", "5 certificates an event at most",
                  "on lines O(n log n) events, of which at most n \u2212 1 change the top",
                  "3 certificates an element at most", "n \u2212 1 certificates"},
                 run);
}

/// structures/tournament.hpp
inline Standing tournament(const Measures& run) {
  return counted({"Tournament", "O(log n) certificates an event", "an event may change a match, and not the winner",
                  "log\u2082 n certificates an element at most", "n \u2212 1 certificates"},
                 run);
}

/// structures/convex_hull.hpp
inline Standing convex_hull(const Measures& run) {
  return counted({"Convex hull", "O(1) certificates an event, which is a flip",
                  "not in general: most events change the proof, not the hull",
                  "not in the worst case: a point is in as many as it has neighbours",
                  "2 n + (points of the hull) certificates at most"},
                 run);
}

/// structures/delaunay.hpp
inline Standing delaunay(const Measures& run) {
  return counted(
      {"Delaunay triangulation", "20 certificates an event at most, which is a flip",
       "every event changes the triangulation, but where an edge of the hull changes its heading",
       "some 3 certificates for each neighbour of a point, of which it has 6 on average, and n \u2212 1 at worst",
       "5 n certificates at most"},
      run);
}

/// structures/spatial_triangulation.hpp
inline Standing delaunay_in_space(const Measures& run) {
  return counted({"Delaunay triangulation in space", "21 certificates an event, which is a flip",
                  "every event changes the triangulation, but where a facet or edge of the hull turns",
                  "some 100 certificates a point among many, more in the worst case", "some 20 n certificates"},
                 run);
}

/// examples/smallest_gap.hpp, on structures/champion.hpp
inline Standing smallest_gap(const Measures& run) {
  return counted({"Smallest gap", "O(log n) certificates an event, of its own or of the list",
                  "an event may change the list or a match, and not the answer",
                  "a value is in two gaps, and each of these in O(log n) certificates", "O(n) certificates"},
                 run);
}

/// examples/11_your_own_structure.cpp
inline Standing band(const Measures& run) {
  return counted({"Band", "1 certificate an event", "every event changes who is in the band", "2 certificates a value",
                  "2 n certificates"},
                 run);
}

/// The ends in the lists of collision/broad_phase/kinetic_sweep_and_prune.hpp, each as structures/sorted_list.hpp: with
/// the swaps of a run, and how many of them changed a pair.
inline Standing sweep_and_prune(std::uint64_t swaps, std::uint64_t changes) {
  return {"Lists of ends", "3 certificates a swap",
          "only a swap of a left with a right end can change a pair (here " + std::to_string(changes) + " of " +
              std::to_string(swaps) + " do, on three axes)",
          "2 certificates an end, so 4 a box on each axis", "2 n \u2212 1 certificates on each axis"};
}

}  // namespace standing

}  // namespace kds::course
