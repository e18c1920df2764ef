// A world as lines, for looking at it in a renderer of one's own.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/drawing/outline.hpp"
#include "collision/world.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <functional>
#include <limits>

namespace kds::collision {

/// What a line is of.
enum class Drawn {
  body,      ///< one that contacts move
  fixed,     ///< a fixed body
  sensor,    ///< a sensor
  velocity,  ///< from the centre of a body as far as it moves in DrawOptions::velocity_seconds
  partner,   ///< from the centre of a body to that of one that it touches or rests on
};

/// Called for each line, in space, in units of length.
using DrawLine = std::function<void(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Drawn what)>;

/// What is drawn of a world.
struct DrawOptions {
  int sides = 24;                        ///< lines of a circle
  double velocity_seconds = 0;           ///< s; velocities are drawn if it is > 0
  bool partners = false;                 ///< whether partners are drawn
  std::function<bool(BodyId)> bodies{};  ///< which bodies are drawn; all if empty
};

/// Draws the bodies of a world that have entered as they are at `t` >= now() in s if nothing happens until then, or at
/// now(); in order of their ids. Changes nothing, and may be called in callbacks.
///
/// Cost: O(lines). Outlines are made anew each time: a renderer that keeps models calls outline() once a shape.
template <class Motion>
void draw(const BasicWorld<Motion>& world, const DrawLine& line, const DrawOptions& options = {},
          double t = -std::numeric_limits<double>::infinity()) {
  t = std::max(t, world.now());
  const Eigen::Vector3d everywhere = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  world.visit_overlapping(-everywhere, everywhere, [&](BodyId id) {
    if (options.bodies && !options.bodies(id)) return;
    const Motion& motion = world.motion(id);
    const Eigen::Vector3d centre = path_of(motion).position(t);
    const PlacedShape shape = world.shape(id);
    const auto place = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      if constexpr (turns<Motion>) {
        return centre + motion.rotation(t)(x);
      } else {
        return centre + shape.rotation * x;
      }
    };
    const Drawn what = world.sensor(id) ? Drawn::sensor : world.fixed(id) ? Drawn::fixed : Drawn::body;
    for (const auto& [from, to] : outline(shape.shape, t, options.sides)) line(place(from), place(to), what);
    if (options.velocity_seconds > 0) {
      line(centre, centre + options.velocity_seconds * path_of(motion).velocity(t), Drawn::velocity);
    }
    if (!options.partners) return;
    world.visit_partners(id, [&](BodyId other) {
      if (other < id) return;  // Each pair once.
      line(centre, path_of(world.motion(other)).position(t), Drawn::partner);
    });
  });
}

}  // namespace kds::collision
