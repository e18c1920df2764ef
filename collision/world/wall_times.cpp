#include "collision/world/wall_times.hpp"

#include "certificates/conjunction.hpp"
#include "certificates/wall_separation.hpp"
#include "collision/motions.hpp"
#include "collision/world/earliest_wall_time.hpp"
#include "collision/world/queue_room.hpp"
#include "kds/audit.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace kds::collision {

template <class Motion>
inline void WallTimes<Motion>::make_room(std::size_t slots) {
  collision::make_room(times_, slots);
  if (wall_.size() < times_.slots()) wall_.resize(times_.slots());
}

/// Notes that a body meets no wall before a time. Precondition: there is room for it.
template <class Motion>
inline void WallTimes<Motion>::note(BodySlot slot, double earliest) {
  if (bodies_[slot].sensor || bodies_.unbounded(slot)) return;
  wall_[slot] = none_yet;
  // An earlier one is a lower bound as well: most are replaced again before they are due.
  if (times_.contains(slot) && times_.time(slot) > clock_.now && times_.time(slot) <= earliest) return;
  if (earliest <= clock_.horizon) {
    times_.set(slot, std::max(earliest, clock_.now));
  } else {
    times_.clear(slot);
  }
}

template <class Motion>
void WallTimes<Motion>::schedule(BodySlot slot) {
  if (!walls_) return;
  make_room(bodies_.slots());
  note(slot, earliest_wall_time_of_all(bodies_.path(slot), bodies_[slot].bounding_radius, *walls_, clock_.now));
}

template <class Motion>
void WallTimes<Motion>::schedule(std::span<const Entry> entries) {
  if (!walls_) return;
  make_room(bodies_.slots());
  for (std::size_t i = 0; i < entries.size(); i += 2) {
    const BodySlot a = entries[i].slot;
    const BodySlot b = entries[std::min(i + 1, entries.size() - 1)].slot;
    if constexpr (Motion::degree == 1) {
      const Two radii{bodies_[a].bounding_radius, bodies_[b].bounding_radius};
      const auto earliest =
          earliest_wall_times_of_all({&bodies_.path(a), &bodies_.path(b)}, radii, *walls_, clock_.now);
      note(a, earliest[0]);
      if (b != a) note(b, earliest[1]);
    } else {
      schedule(a);
      if (b != a) schedule(b);
    }
  }
}

template <class Motion>
void WallTimes<Motion>::remove(BodySlot slot) {
  clear(times_, slot);
}

template <class Motion>
void WallTimes<Motion>::reserve(std::size_t bodies) {
  if (!walls_ || times_.slots() >= bodies) return;
  times_.resize(bodies);
  make_room(bodies);
}

template <class Motion>
void WallTimes<Motion>::extend_horizon() {
  if (!walls_) return;
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
    if (bodies_[slot].entered) schedule(slot);
  }
}

template <class Motion>
void WallTimes<Motion>::audit(double t) const {
  if (!walls_) return;
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
    if (!bodies_[slot].entered || bodies_[slot].sensor || bodies_.unbounded(slot)) continue;
    const double known = slot < times_.slots() ? times_.time(slot) : never;
    const auto fail = [&](int wall, const char* what) {
      throw AuditFailure("World: body " + std::to_string(bodies_.id_of(slot)) + " and wall " + std::to_string(wall) +
                         ": " + what);
    };
    if (known < t && wall_[slot] != none_yet) fail(wall_[slot], "it should have been reached");
    if (bodies_.left_alone(slot)) continue;  // Its time is of a piece that has passed.
    for (int wall = 0; wall < 6; ++wall) {
      const double time = exact_time(slot, wall, clock_.horizon);
      if (time < never && time < known) fail(wall, "it is reached before the body's time");
    }
  }
}

template <class Motion>
void WallTimes<Motion>::become(const Image&) {
  forget_all();
  extend_horizon();
}

template <class Motion>
bool WallTimes<Motion>::certify() {
  const BodySlot slot = times_.top().slot;
  if (wall_[slot] != none_yet) return false;
  std::array<double, 6> bounds;
  for (int wall = 0; wall < 6; ++wall) {
    bounds[static_cast<std::size_t>(wall)] =
        earliest_wall_time(bodies_.path(slot), bodies_[slot].bounding_radius, *walls_, wall, clock_.now);
  }
  // The wall that is probably met first is tested first: the bounds of the other walls are mostly later than its time.
  const int probable = static_cast<int>(std::min_element(bounds.begin(), bounds.end()) - bounds.begin());
  double first = never;
  wall_[slot] = 0;
  const auto consider = [&](int wall) {
    const double horizon = std::min(first, clock_.horizon);
    if (bounds[static_cast<std::size_t>(wall)] > horizon) return;
    const double time = exact_time(slot, wall, horizon);
    if (time > first || time == never || (time == first && wall > wall_[slot])) return;
    first = time;
    wall_[slot] = static_cast<signed char>(wall);
  };
  consider(probable);
  for (int wall = 0; wall < 6; ++wall) {
    if (wall != probable) consider(wall);
  }
  times_.set(slot, first);
  return true;
}

/// When the ball around a body is outside a wall and still going outward.
template <class Motion>
double WallTimes<Motion>::exact_time(BodySlot slot, int wall, double horizon) const {
  const int axis = wall / 2;
  const double out = wall % 2 != 0 ? 1 : -1;
  const auto& path = bodies_.path(slot);
  using Wall = certificates::WallSeparation<Motion::degree>;
  const auto inside = [&] {
    return Wall{path.axis(axis), out > 0 ? walls_->max[axis] : walls_->min[axis], bodies_[slot].bounding_radius, out};
  };
  if constexpr (Motion::degree == 1) {
    return path.coefficients[1][axis] * out > 0 ? failure_time(inside(), clock_.now, horizon) : never;
  } else {
    bool moves = false;
    for (std::size_t i = 1; i <= Motion::degree; ++i) moves = moves || path.coefficients[i][axis] != 0;
    if (!moves) return never;
    const Wall wall_inside = inside();
    const DerivativeCertificate<Wall> leaving{wall_inside};
    return certificates::first_all_broken<Wall, DerivativeCertificate<Wall>>(clock_.now, horizon, {&wall_inside, 1},
                                                                             {&leaving, 1});
  }
}

#define KDS_INSTANTIATE(motion) template class WallTimes<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
