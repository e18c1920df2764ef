#include "tests/fuzz/random_worlds/draw.hpp"

#include "tests/fuzz/random_worlds/meshes.hpp"

#include <algorithm>
#include <array>

namespace kds::fuzz {
namespace {

/// In low ... high, which are multiples of 1/2.
double draw_number(Random& random, Numbers numbers, double low, double high) {
  const bool on_lattice = numbers == Numbers::lattice || (numbers == Numbers::near && !random.one_in(3));
  if (!on_lattice) return random.between(low, high);
  const double number = 0.5 * random.integer(static_cast<int>(2 * low), static_cast<int>(2 * high));
  if (numbers == Numbers::lattice || !random.one_in(4)) return number;
  return number + random.integer(-3, 3) * 0x1p-51;  // some roundings of numbers of the size of 1
}

Vector3d draw_vector(Random& random, Numbers numbers, double size) {
  Vector3d result;
  for (double& x : result) x = draw_number(random, numbers, -size, size);
  return result;
}

double draw_size(Random& random, Numbers numbers) {
  return numbers == Numbers::fine ? random.between(0.2, 1.2) : 0.25 * random.integer(1, 5);
}

ShapeKind draw_shape_kind(Random& random, Shapes shapes) {
  switch (shapes) {
    case Shapes::balls:
      return ShapeKind::ball;
    case Shapes::boxes:
      return ShapeKind::box;
    case Shapes::balls_and_boxes:
      return random.one_in(2) ? ShapeKind::ball : ShapeKind::box;
    case Shapes::meshes:
      return ShapeKind::mesh;
    case Shapes::all:
      break;
  }
  constexpr std::array kinds{ShapeKind::ball, ShapeKind::box, ShapeKind::mesh, ShapeKind::mesh};
  return kinds[random.below(kinds.size())];
}

Eigen::Quaterniond draw_orientation(Random& random) {
  if (random.one_in(2)) return Eigen::Quaterniond::Identity();
  if (random.one_in(3)) return {0.5, 0.5, 0.5, random.one_in(2) ? 0.5 : -0.5};  // turns axes to axes
  if (random.one_in(3)) return {0.6, 0, 0, 0.8};                                // about z alone
  const double w = random.between(0.1, 1);
  const double x = random.between(-1, 1);
  const double y = random.between(-1, 1);
  const double z = random.between(-1, 1);
  return Eigen::Quaterniond(w, x, y, z).normalized();
}

/// Where a path has got to after so many seconds.
Vector3d place_after(const Path& path, double seconds) {
  return path.place + seconds * path.velocity + seconds * seconds * path.half_acceleration;
}

void draw_script(Random& random, const Style& style, std::vector<Path>& pieces) {
  if (random.one_in(4)) {  // it enters later
    pieces.front().start = 0.25 * random.integer(1, 8);
    if (random.one_in(2)) return;
  }
  for (int more = random.integer(1, 3); more > 0; --more) {
    Path next = draw_path(random, style);
    next.start = std::max(0.0, pieces.back().start) + 0.25 * random.integer(1, 6);
    const bool jumps = style.jumps_in_scripts && random.one_in(2);
    if (!jumps) next.place = place_after(pieces.back(), next.start - pieces.back().start);
    pieces.push_back(next);
  }
}

}  // namespace

Style draw_style(Random& random, Response response) {
  constexpr std::array restitutions{1.0, 1.0, 0.5, 0.0, 0x1p-30, 0.999};
  constexpr std::array numbers{Numbers::lattice, Numbers::fine, Numbers::near};
  constexpr std::array shapes{Shapes::balls, Shapes::boxes, Shapes::balls_and_boxes, Shapes::meshes, Shapes::all};
  constexpr std::array reaches{1.5, 2.0, 3.0, 3.0};
  Style style;
  style.numbers = numbers[random.below(numbers.size())];
  style.shapes = shapes[random.below(shapes.size())];
  style.half_side = reaches[random.below(reaches.size())];
  style.restitution = response == Response::none ? 1 : restitutions[random.below(restitutions.size())];
  style.scripts = random.one_in(3);
  style.jumps_in_scripts = random.one_in(2);
  style.masks = random.one_in(4);
  style.fixed_bodies_move = random.one_in(3);
  style.box_functions = random.one_in(8);
  style.sensors = random.one_in(3);
  style.groups = random.one_in(4);
  return style;
}

Path draw_path(Random& random, const Style& style) {
  Path path;
  path.place = draw_vector(random, style.numbers, style.half_side);
  if (!random.one_in(3)) path.velocity = draw_vector(random, style.numbers, 3);
  if (!random.one_in(3)) path.half_acceleration = draw_vector(random, style.numbers, 1);
  if (random.one_in(6)) path.velocity[1] = path.velocity[2] = 0;
  if (random.one_in(6)) path.half_acceleration[0] = path.half_acceleration[1] = 0;
  return path;
}

BodyPlan draw_body(Random& random, const Style& style) {
  BodyPlan body;
  body.shape = draw_shape_kind(random, style.shapes);
  for (double& x : body.size) x = draw_size(random, style.numbers);
  // Some boxes are capsules, hulls or compounds. Which ones is told from what has been drawn, so that all else stays as
  // it is.
  if (body.shape == ShapeKind::box && body.size[1] < std::min(body.size[0], body.size[2])) {
    body.shape = ShapeKind::capsule;
  }
  if (body.shape == ShapeKind::box && body.size[2] < 0.5 * std::min(body.size[0], body.size[1])) {
    body.shape = ShapeKind::hull;
  }
  if (body.shape == ShapeKind::box && body.size[0] < 0.75 * std::min(body.size[1], body.size[2])) {
    body.shape = ShapeKind::compound;
  }
  body.mesh = random.below(sample_meshes().size());
  if (body.shape != ShapeKind::ball || random.one_in(8)) body.orientation = draw_orientation(random);
  body.pieces = {draw_path(random, style)};
  if (random.one_in(8)) body.pieces.front().start = -draw_seconds(random, style);
  body.mass = random.one_in(2) ? 1 : 0.5 * random.integer(1, 8);
  body.fixed = random.one_in(6);
  body.restitution = random.one_in(6) ? 0 : style.restitution;
  if (style.masks && random.one_in(3)) {
    body.category = 1u << random.below(2);
    body.collides_with = static_cast<std::uint32_t>(random.integer(0, 3));
  }
  if (style.groups && random.one_in(2)) body.group = static_cast<std::uint32_t>(random.integer(1, 2));
  if (style.sensors && random.one_in(4)) body.sensor = true;
  if (random.one_in(8)) body.volume = collision::BoundingVolume::sphere;
  if (style.scripts && random.one_in(3)) draw_script(random, style, body.pieces);
  if (body.fixed && !style.fixed_bodies_move) {
    body.pieces.resize(1);
    body.pieces.front().velocity = body.pieces.front().half_acceleration = Vector3d::Zero();
  }
  if (style.box_functions && random.one_in(3)) {
    body.box_function = true;
    body.box_margin = random.one_in(2) ? 0 : 0.25;
    body.box_validity = 0.25 * random.integer(1, 6);
    body.box_edits = random.one_in(4);
  }
  // As above: some of the fixed ones are half-spaces, through their places.
  if (body.fixed && body.mesh % 2 == 0) {
    const int axis = body.size[0] < body.size[1] ? 0 : 2;
    body.shape = ShapeKind::half_space;
    body.size = body.size[2] < body.size[1] ? Vector3d(-Vector3d::Unit(axis)) : Vector3d(Vector3d::Unit(axis));
    body.volume = collision::BoundingVolume::shape;
    body.box_function = false;
  }
  return body;
}

Call draw_call(Random& random, const Style& style, std::size_t bodies) {
  using enum Call::Kind;
  constexpr std::array kinds{remove, move,   move,  turn_back, keep,  follow, away_and_back,
                             filter, filter, group, ignore,    weigh, append, ring};
  Call call;
  call.kind = kinds[random.below(kinds.size())];
  call.body = random.below(bodies);
  call.other = random.below(bodies);
  call.path = draw_path(random, style);
  call.seconds = draw_seconds(random, style);
  call.mass = 0.5 * random.integer(1, 8);
  call.category = static_cast<std::uint32_t>(random.integer(0, 3));
  call.collides_with = random.one_in(2) ? ~0u : static_cast<std::uint32_t>(random.integer(0, 3));
  return call;
}

double draw_seconds(Random& random, const Style& style) {
  return style.numbers == Numbers::fine ? random.between(0, 0.75) : 0.125 * random.integer(0, 6);
}

}  // namespace kds::fuzz
