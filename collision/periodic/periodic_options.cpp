#include "collision/periodic/periodic_options.hpp"

#include "collision/shapes/shape.hpp"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

[[noreturn]] void fail(const std::string& what) { throw std::invalid_argument("PeriodicOptions." + what); }

void validate_axis(const PeriodicOptions& options, int axis) {
  const std::string name{"xyz"[axis]};
  const Boundary boundary = options.boundaries[static_cast<std::size_t>(axis)];
  switch (boundary) {
    case Boundary::periodic:
    case Boundary::walls:
      break;
    case Boundary::open:
      return;
    default:
      fail("boundaries: that of " + name + " is unknown");
  }
  for (const double end : {options.min[axis], options.max[axis]}) {
    if (!(std::abs(end) <= largest_magnitude)) fail("min, max: " + name + " must be finite, and not beyond 2^205");
  }
  if (!(options.min[axis] < options.max[axis])) fail("min, max: " + name + " of min must be below that of max");
}

}  // namespace

void validate(const PeriodicOptions& options) {
  for (int axis = 0; axis < 3; ++axis) validate_axis(options, axis);
  if (!std::isfinite(options.shear_rate)) fail("shear_rate: must be finite");
  const auto periodic = [&](std::size_t axis) { return options.boundaries[axis] == Boundary::periodic; };
  if (options.shear_rate != 0 && !(periodic(0) && periodic(1))) fail("shear_rate: needs periodic x and y");
  if (!(options.wall_restitution >= 0 && options.wall_restitution <= 1)) fail("wall_restitution: must be in [0, 1]");
  for (std::size_t wall = 0; wall < 6; ++wall) {
    const double temperature = options.wall_temperatures[wall];
    const std::string name = "wall_temperatures[" + std::to_string(wall) + "]";
    if (!(temperature >= 0 && temperature <= largest_magnitude)) fail(name + ": must be in [0, 2^205]");
    if (temperature > 0 && options.boundaries[wall / 2] != Boundary::walls) fail(name + ": there is no wall");
  }
  if (!(options.elastic_within >= 0 && std::isfinite(options.elastic_within))) {
    fail("elastic_within: must be finite and >= 0");
  }
  if (options.world.response != Response::none) fail("world.response: must not be given");
  if (options.world.law) fail("world.law: must not be given");
  if (options.world.walls) fail("world.walls: must not be given; see boundaries");
  if (options.world.report_pairs || options.world.report_pieces) {
    fail("world: pairs of bounding volumes and pieces of motion are not reported");
  }
}

}  // namespace kds::collision
