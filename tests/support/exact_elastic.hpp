// Whether a run of bodies that bounce off each other and off walls is right, proved in exact arithmetic.
//
// Nothing is simulated a second time: the log says when the bodies met and how they went on, and between two events
// every path is a given polynomial with coefficients that are doubles. So each claim of the log is a question about
// rational numbers. No broad phase, and no code of the library, has a part in the answers.
#pragma once

#include "tests/support/exact_oracle.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace oracle {

/// A ball, or a box along the axes, on a straight path or a parabola.
struct ElasticBody {
  Shape shape;
  Piece motion;                ///< two coefficients or three
  double bounding_radius = 1;  ///< of the ball that walls keep inside
  double mass = 1;
  bool fixed = false;  ///< no contact changes its motion, but walls do
  double restitution = 1;
};

struct ElasticWalls {
  std::array<double, 3> min, max;
  double restitution = 1;
};

struct ElasticEvent {
  enum class Kind { overlap, contact, wall } kind;
  std::size_t a;
  std::size_t b;  ///< of a wall 0 for -x, 1 for +x, 2 for -y ... 5 for +z
  double time;
  std::array<double, 3> normal;  ///< of a contact: from a to b
  std::vector<Piece> motions;    ///< of all bodies, after it

  friend bool operator==(const ElasticEvent&, const ElasticEvent&) = default;
};

struct ElasticRun {
  std::vector<ElasticBody> bodies;
  std::optional<ElasticWalls> walls;
  double start = 0;
  double end = 1;
  bool cut = false;  ///< whether the log breaks off among the events at `end`
  std::vector<ElasticEvent> events;
};

struct Verdict {
  std::string complaint;   ///< what is wrong first, in words; empty if the run is proved right
  std::size_t grazes = 0;  ///< contacts that the log need not have and has not, or has
};

/// Proves of a run:
///
/// - Each event is the one that comes next. A contact comes at the first double just after which the shapes penetrate
///   and come nearer; a wall at the first just after which the bounding ball is beyond it and going out. At one time
///   walls come first, by body and wall, then contacts by (a, b).
/// - Nothing else happens until then, nor until the end. So no two shapes ever sink into each other, but for pairs that
///   overlapped at the start, which is told once, or are both fixed: they are let pass until there is a double just
///   after which they are apart, and count from then on.
/// - Pairs that part may overlap by what was rounded: for each motion of the two that has begun since they were apart,
///   two spacings of the coordinates and what they go in two spacings of the clock. And pairs that would never be
///   deeper in each other than that with the motions they have, as a box that slides over another and begins above its
///   edge, may meet or not.
/// - A normal is that of a plane that separates the shapes, but for the same amount.
/// - After a contact the rate along the normal is the one before times minus the lower restitution, momentum is the
///   same, speeds change along the normal alone, after a wall along its axis alone; each to a few roundings. Paths are
///   continuous, to a rounding, accelerations stay, and so do the motions of others.
Verdict prove(const ElasticRun& run);

}  // namespace oracle
