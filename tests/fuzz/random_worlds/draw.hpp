// Random paths, shapes and bodies of a scenario.
#pragma once

#include "tests/fuzz/random_worlds/scenario.hpp"
#include "tests/support/random_numbers.hpp"

#include <cstddef>
#include <cstdint>

namespace kds::fuzz {

using kds::tests::Random;

/// How coordinates and speeds are drawn.
enum class Numbers : std::uint8_t {
  lattice,  ///< multiples of 1/2: ties, touches and simultaneous events are frequent
  fine,     ///< of all bits
  near,     ///< a mixture of both, and numbers some roundings from the lattice
};
enum class Shapes : std::uint8_t { balls, boxes, balls_and_boxes, meshes, all };

/// What bodies of a scenario are like.
struct Style {
  Numbers numbers = Numbers::lattice;
  Shapes shapes = Shapes::balls;
  double half_side = 3;  ///< centres start within it, coordinate by coordinate
  double restitution = 1;
  bool scripts = false;
  bool jumps_in_scripts = false;
  bool masks = false;
  bool fixed_bodies_move = false;
  bool sensors = false;
  bool groups = false;
  bool box_functions = false;
};

/// A style from the seed alone, so that callbacks draw bodies like those of the start.
Style draw_style(Random& random, Response response);
Path draw_path(Random& random, const Style& style);
BodyPlan draw_body(Random& random, const Style& style);
/// A call of any kind that changes one of so many bodies.
Call draw_call(Random& random, const Style& style, std::size_t bodies);
/// A span of time to advance by, often none.
double draw_seconds(Random& random, const Style& style);

}  // namespace kds::fuzz
