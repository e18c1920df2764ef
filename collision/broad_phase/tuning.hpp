// The tuning of the broad phases: numbers that were found by measuring.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kds::collision {

// Tuning changes the cost of a run, never its contacts or their times (tests/collision/broad_phase/test_tuning.cpp).
// Constructors throw std::invalid_argument, naming the member, for a number that is out of range.
//
// Most minima are flat. Brackets say how flat: by how much half the value and double the value change the number of
// instructions of a whole run; for factors, half and double their distance from 1. Runs are of balls of equal size in a
// box, at degree 1, unless stated otherwise: for a grid 1 000 balls that fill a twentieth of the box, then 1 000 that
// fill a quarter; for few boxes 48 balls of the same two densities.

/// Cells of a box grid.
struct CellTuning {
  /// Cells are at least this much larger than the boxes in them, >= 1. With larger ones a search visits fewer cells,
  /// with more boxes in each.
  /// [+0.2, -1.3 %; +0.3, -1.7 %; degree 2, sizes spread over a factor of 8: -1.8, +10.0 %]
  double roominess = 1.4;
  /// Side of the smallest cells over the spacing of boxes, > 0. Larger cells contain more boxes, of smaller ones more
  /// are visited.
  /// [+29.2, +1.7 %; +0.2, +0.9 %]
  double cell_per_spacing = 2;
  /// If a search visits more chained buckets for each cell than this, smaller cells would be better, >= 0: boxes have
  /// gathered.
  /// [no difference where bodies are spread evenly]
  std::int64_t crowded_chain = 4;
  /// Where kinds of boxes have cells of their own, these suit the sparsest kind of those that at least one box in so
  /// many has, >= 4.
  /// [no difference where bodies are of one kind; 1 500 bullets and 500 targets: +6.7 % with cells for the spacing of
  /// all]
  std::size_t share_for_cells = 8;
  /// A prism is followed through finer cells, slab by slab, if boxes of these are more than so many for each slab,
  /// >= 0; else it is compared with all in a large cell.
  /// [0.0, 0.0 % where one ball in ten, in twenty or in a hundred is 60 to 2 000 times as fast as the others, also
  /// beside balls 30 times as large; no prism is followed at all: -0.1, 0.0 %]
  std::int64_t guests_per_slab = 16;
  /// So many boxes are compared in the time in which the cell of one is changed, > 0: what this says decides whether
  /// the smaller boxes are guests of the cells of larger ones.
  /// [no difference where boxes are of one size; guests on all levels: +12.3 % where radii are spread over a factor of
  /// 1 000, 2.5 times the time where 25 600 balls bounce on a box]
  std::size_t scanned_per_change = 16;
  /// After so many excess buckets, for each box, rebuilding with smaller cells pays, > 0.
  /// [no difference where bodies are spread evenly]
  std::int64_t patience = 16;
};

/// The fat boxes of a kinetic grid.
struct GridTuning {
  CellTuning cells{};

  // How far a body may move in its fat box: its travel.

  /// The travel of a new body, over the spacing of bodies, > 0.
  /// [+6.6, -4.9 %; +4.2, +3.5 %]
  double first_travel = 0.25;
  /// The least travel, over the body's size, > 0: with less it would be renewed very often among bodies that touch it
  /// anyway.
  /// [0.0, 0.0 %; +0.1, 0.0 %]
  double least_travel = 0.125;
  /// A fat box costs about as much as two pairs. If it has lasted its time, the next travel is multiplied by one of
  /// these: if no pair began in it, if one did, from three on, and from `many` on. The first two are >= 1, the others
  /// in (0, 1].
  /// [the first two +0.9, 0.0 % and +0.9, -0.7 %; +0.1, +0.4 % and +0.1, -0.1 %]
  /// [the third -0.5, +1.9 %; -0.3, +1.2 %; the fourth 0.0, 0.0 % both; `many` +1.1, 0.0 %; +1.0, -0.1 %]
  double grow_after_none = 1.4;
  double grow_after_one = 1.15;
  double shrink_after_some = 0.8;
  double shrink_after_many = 0.5;
  std::uint32_t many = 8;
  /// The factor of the travel, in (0, 1], if a change of motion made the body leave its box before half the time was
  /// over.
  /// [-0.7, +2.4 %; -0.1, +1.9 %]
  double shrink_after_turn = 0.8;
  /// This many pairs found whose bodies may not collide count as one that begins, > 0.
  /// [two kinds of balls that ignore each other: -0.1, -0.1 %; +0.5, -0.1 %; one kind, three in four, that ignores
  /// itself: +0.5, -0.1 %; +1.2, -0.4 %]
  std::uint32_t found_per_pair = 4;
  /// A body whose travel is more than so many times its size uses a small part of its fat box, and pairs are sought in
  /// that only, > 0.
  /// [one ball in ten is a tenth as large and 60 times as fast: +0.1, -0.1 %; 0.0, -0.4 %; one in twenty is twice as
  /// large and 60 times as fast, at the lesser density: +6.2, 0.0 %]
  double slanted_at = 4;
  /// Bodies that ignore each other get cells of their own if more than so many of them are found in a fat box of one of
  /// them. These cells are a further search for all others.
  /// [two kinds of balls that ignore each other: 0.0, 0.0 %; 0.0, 0.0 %; one kind, three in four, that ignores itself:
  /// -3.4, 0.0 %; -7.4, 0.0 %]
  std::uint64_t in_vain_per_box = 2;
  /// After a change of motion the old fat box is kept if it lasts this share of a new one's lifetime, in (0, 1]: on
  /// straight paths, and on others.
  /// [+0.4, +1.3 %; +0.2, +0.3 %; the second, at degree 2: +0.9, +1.4 %; +1.3, +2.0 %]
  double kept_share_straight = 0.15;
  double kept_share_curved = 0.25;
  /// A coarser level of cells is begun just for the travel of bodies if at least one body in so many wants it, > 0.
  /// [0.0, 0.0 % for equal sizes; degree 2, sizes spread over a factor of 8: -3.0, +4.5 %]
  std::uint64_t share_for_level = 8;

  // Bodies whose motion changes in most of their boxes are *jostled*: their boxes have a margin on all sides.

  /// The number of boxes in which it has changed, minus twice those in which it has not, from which on a body is
  /// jostled, > 0; and the greatest such number.
  /// [-0.3, -0.1 % and +0.1, 0.0 %; -1.3, +3.7 % and +0.3, 0.0 %]
  int jostled_at = 3;
  int jostled_most = 6;
  /// A pair that begins costs as much as this many tests of one, > 0.
  /// [0.0, 0.0 %; +0.7, +0.1 %]
  std::uint32_t tests_per_pair = 8;
  /// The cost of pairs and their tests within a box, in tests, below which the travel grows, and above which it
  /// shrinks.
  /// [0.0, 0.0 % each; +0.1, +0.7 % and +0.2, +0.2 %]
  std::uint32_t little_spent = 40;
  std::uint32_t much_spent = 60;
  /// The factors by which it grows and shrinks.
  /// [+0.1, +0.2 % and 0.0, 0.0 %; 0.0, +0.2 % and +0.2, -0.2 %]
  double grow_jostled = 1.1;
  double shrink_jostled = 0.9;
  /// The share of the margin that is moved from behind the body to ahead of it, in [0, 1): it continues its motion
  /// until it is struck, and a little after that.
  /// [at the greater density half +1.3 %, one and a half times +0.4 %]
  double lead = 0.6;
};

/// The most bodies of FewBoxes, where the partners of a body are the bits of one number.
inline constexpr std::size_t most_few_boxes = 64;

/// The spans of time of few boxes.
struct FewBoxesTuning {
  /// How far bodies move in the first span, over their size, > 0.
  /// [-1.7, +2.6 %; -1.0, +2.9 %]
  double first_travel = 2;
  /// A pair with its test costs as much as this many comparisons of boxes, > 0; and so does a new box.
  /// [+5.2, +3.7 % and +0.2, +3.7 %; -2.9, +11.3 % and +3.2, -0.9 %]
  std::uint64_t comparisons_per_pair = 16;
  std::uint64_t comparisons_per_box = 12;
  /// The cost of pairs in a span over that of new boxes for all: below `little` the next span is longer, above `much`
  /// it is shorter. Some pairs exist however short the span is, so `much` is more than 1. Above `far_too_much` the span
  /// ends at once: its length was found for other motions. little <= much <= far_too_much.
  /// [-1.4, +0.1 %, +1.0, -0.2 % and 0.0, -0.7 %; +1.2, -1.3 %, +6.4, -2.7 % and +1.4, -0.3 %]
  std::uint64_t little = 1;
  std::uint64_t much = 3;
  std::uint64_t far_too_much = 12;
  /// The factors of the span then, the first two >= 1, the last in (0, 1]; `grow_where_idle` if `idle_part` times the
  /// cost of pairs is still less than that of new boxes.
  /// [-1.0, +1.5 %, 0.0, 0.0 % and -0.3, +0.5 %; +0.6, +0.6 %; `idle_part` +3.2, 0.0 %]
  double grow = 1.5;
  double grow_where_idle = 4;
  double shrink = 0.75;
  std::uint64_t idle_part = 8;
};

/// When the default changes between its two methods.
struct AdaptiveTuning {
  FewBoxesTuning few{};
  GridTuning grid{};
  /// Up to this many bodies are compared each with all others, at most most_few_boxes; more are in the grid, until
  /// there are no more than half as many. A smaller number is better for dense bodies, and worse for sparse ones.
  /// [half, for 48 balls: +19.3 %; -13.8 %]
  std::size_t most_for_few = most_few_boxes;
};

/// How many of the three axes, or of the directions of k-DOPs, have a sorted list.
enum class ListedAxes { automatic, one, all };

/// The lists of kinetic sweep and prune.
struct SweepTuning {
  ListedAxes listed = ListedAxes::automatic;
  /// If `listed` is automatic, fewer boxes than this, not k-DOPs, have three lists: times of pairs are then found by
  /// swaps only.
  /// [Not flat: which is cheaper depends on the density. Half, for 48 bodies of the two densities: -28.3 %; +48.3 %;
  /// double, for 100: +74.3 %; -15.5 %]
  std::size_t few_bodies = 64;
  /// Lists are given up for others whose expected cost is less than this part of theirs, in (0, 1].
  /// [no difference where bodies are spread evenly]
  double change_below = 2.0 / 3;
};

/// Throw std::invalid_argument, naming the member, for what is out of range.
void check(const CellTuning& tuning);
void check(const GridTuning& tuning);
void check(const FewBoxesTuning& tuning);
void check(const AdaptiveTuning& tuning);
void check(const SweepTuning& tuning);

}  // namespace kds::collision
