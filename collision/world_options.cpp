#include "collision/world_options.hpp"

#include "collision/shapes/shape.hpp"
#include "kds/number_text.hpp"

#include <cmath>
#include <stdexcept>

namespace kds::collision {

void validate(const WorldOptions& options) {
  if (!std::isfinite(options.start_time)) throw std::invalid_argument("WorldOptions.start_time: must be finite");
  if (std::abs(options.start_time) > largest_magnitude) {
    throw std::invalid_argument("WorldOptions.start_time: must not be beyond " + power_text(largest_magnitude));
  }
  if (!(options.window > 0)) throw std::invalid_argument("WorldOptions.window: must be > 0");
  if (!(options.rate >= 0) || !std::isfinite(options.rate)) {
    throw std::invalid_argument("WorldOptions.rate: must be finite and >= 0");
  }
  switch (options.response) {
    case Response::none:
    case Response::elastic:
    case Response::callback:
      break;
    default:
      throw std::invalid_argument("WorldOptions.response: unknown");
  }
  if (options.law && options.response != Response::callback) {
    throw std::invalid_argument("WorldOptions.law: needs response callback");
  }
  if (options.zeno.contacts == 0) throw std::invalid_argument("WorldOptions.zeno.contacts: must be > 0");
  if (!(options.zeno.interval >= 0)) throw std::invalid_argument("WorldOptions.zeno.interval: must be >= 0");
  if (!(options.shortest_flight > 0)) throw std::invalid_argument("WorldOptions.shortest_flight: must be > 0");
  constexpr double least_error = 0x1p-30;
  if (!(options.orientation_error >= least_error && options.orientation_error <= 0.125)) {
    throw std::invalid_argument("WorldOptions.orientation_error: must be from " + power_text(least_error) +
                                " to 0.125 rad");
  }
  if (options.walls) {
    const Walls& walls = *options.walls;
    if (!walls.min.allFinite() || !walls.max.allFinite()) {
      throw std::invalid_argument("WorldOptions.walls: must be finite");
    }
    if (!(walls.min.array() < walls.max.array()).all()) {
      throw std::invalid_argument("WorldOptions.walls: min must be below max");
    }
    if (!(walls.restitution >= 0 && walls.restitution <= 1)) {
      throw std::invalid_argument("WorldOptions.walls.restitution: must be in [0, 1]");
    }
  }
}

}  // namespace kds::collision
