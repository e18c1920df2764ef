// The walls of the world: when a body reaches one, and what it does then.
#include "certificates/conjunction.hpp"
#include "certificates/wall_separation.hpp"
#include "collision/world.hpp"
#include "collision/world/queue_room.hpp"

#include <algorithm>
#include <array>

namespace kds::collision {

using Eigen::Vector3d;

/// Takes note that a body is at no wall before some time. Precondition: there is room in walls_.
template <int Degree>
inline void World<Degree>::note_wall(BodyId id, double earliest) {
  bodies_[id].wall_estimated = true;
  // An earlier one is a lower bound as well: most are replaced again before they are due.
  if (walls_.contains(id) && walls_.time(id) > now_ && walls_.time(id) <= earliest) return;
  if (earliest <= horizon_) {
    walls_.set(id, std::max(earliest, now_));
  } else {
    walls_.clear(id);
  }
}

template <int Degree>
void World<Degree>::schedule_wall(BodyId id) {
  if (!options_.walls) return;
  make_room(walls_, bodies_.size());
  double earliest = now_;
  if constexpr (Degree == 1) {
    earliest = earliest_wall_time_of_all(movers_[id].motion, bodies_[id].bounding_radius, *options_.walls, now_);
  }
  note_wall(id, earliest);
}

template <int Degree>
void World<Degree>::schedule_walls(std::span<const Entry> bodies) {
  if (!options_.walls) return;
  make_room(walls_, bodies_.size());
  for (std::size_t i = 0; i < bodies.size(); i += 2) {
    const BodyId a = bodies[i].id;
    const BodyId b = bodies[std::min(i + 1, bodies.size() - 1)].id;
    std::array earliest{now_, now_};
    if constexpr (Degree == 1) {
      const Two radii{bodies_[a].bounding_radius, bodies_[b].bounding_radius};
      earliest = earliest_wall_times_of_all({&movers_[a].motion, &movers_[b].motion}, radii, *options_.walls, now_);
    }
    note_wall(a, earliest[0]);
    if (b != a) note_wall(b, earliest[1]);
  }
}

template <int Degree>
void World<Degree>::certify_wall(BodyId id) {
  bodies_[id].wall_estimated = false;
  double first = never;
  for (int wall = 0; wall < 6; ++wall) {
    if (earliest_wall_time(id, wall) > std::min(first, horizon_)) continue;
    first = std::min(first, next_wall_time(id, wall, std::min(first, horizon_)));
  }
  walls_.set(id, first);
}

/// When the ball around a body is outside a wall and still going outward.
template <int Degree>
double World<Degree>::next_wall_time(BodyId id, int wall, double horizon) const {
  const int axis = wall / 2;
  const double out = wall % 2 != 0 ? 1 : -1;
  const Motion& motion = movers_[id].motion;
  using Wall = certificates::WallSeparation<Degree>;
  const auto inside = [&] {
    return Wall{motion.axis(axis), out > 0 ? options_.walls->max[axis] : options_.walls->min[axis],
                bodies_[id].bounding_radius, out};
  };
  if constexpr (Degree == 1) {
    return motion.coefficients[1][axis] * out > 0 ? failure_time(inside(), now_, horizon) : never;
  } else {
    bool moves = false;
    for (std::size_t i = 1; i <= Degree; ++i) moves = moves || motion.coefficients[i][axis] != 0;
    if (!moves) return never;
    const Wall wall_inside = inside();
    const DerivativeCertificate<Wall> leaving{wall_inside};
    return certificates::first_all_broken<Wall, DerivativeCertificate<Wall>>(now_, horizon, {&wall_inside, 1},
                                                                             {&leaving, 1});
  }
}

template <int Degree>
void World<Degree>::process_wall(BodyId id, double t) {
  const Body& body = bodies_[id];
  int wall = 0;
  while (wall < 6 && next_wall_time(id, wall, t) != t) ++wall;
  const int axis = wall / 2;
  const double out = wall % 2 != 0 ? 1 : -1;
  Motion motion = movers_[id].motion.restarted(t);
  const double approach = motion.coefficients[1][axis] * out;
  double pressed = 0;
  if constexpr (Degree >= 2) pressed = 2 * motion.coefficients[2][axis] * out;
  const double rebound = std::min(body.restitution, options_.walls->restitution) * approach;
  WallEvent event{id, wall, {.time = t}};
  event.contact.normal = Vector3d::Zero();  // not a unit vector times -1, whose zeros would be negative
  event.contact.normal[axis] = out;
  event.contact.point = motion.coefficients[0];
  event.contact.point[axis] = out > 0 ? options_.walls->max[axis] : options_.walls->min[axis];
  ++counters_.wall_contacts;
  const double size = motion.coefficients[0].cwiseAbs().maxCoeff() + body.bounding_radius;
  const bool held = stays(rebound, pressed, size, count_meeting(id));
  if (held) {
    ++counters_.held;
    resting_.add({.a = id, .wall = wall, .normal = event.contact.normal});
  } else {
    motion.coefficients[1][axis] = -rebound * out;
    ++counters_.motion_updates;
    set_motion(id, motion, false);
  }
  resting_.disturb(id);
  resting_.settle();
  tell([&](Listener& listener) {
    listener.wall(*this, event);
    if (held) listener.held_at_wall(*this, event);
  });
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
