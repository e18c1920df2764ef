// The numbers by which clusters are advanced, and what follows for one contact. docs/resting.md says why.
#pragma once

#include "collision/response/least_constraint.hpp"
#include "collision/world/resting_contact.hpp"

#include <algorithm>
#include <cstddef>

namespace kds::collision::cluster {

/// A span is this part of the time in which a body at rest falls by some half of its size...
inline constexpr double part_of_fall = 0x1p-4;
/// ... and in it bodies slide over each other by no more than this part of their size.
inline constexpr double part_of_slide = 0x1p-5;
/// One is cut short to no less than this part of it.
inline constexpr double shortest_span = 0x1p-6;

/// Contacts are kept while they are nearer than this part of the smaller size.
inline constexpr double kept_gap = 0x1p-7;
/// The gap that contacts are kept at, as a part of the smaller size: room for what sweeps leave, which with many
/// contacts would take long to be little; for what a path on a curved surface differs from a parabola; and for what is
/// left where planes have to give way.
inline constexpr double room_of_many = 0x1p-12;
inline constexpr double room_of_curves = 0x1p-17;
inline constexpr double room_of_planes = 0x1p-23;
/// Parts of that room: what a gap that is too small grows by in a span, what sweeps may leave, and what an impact
/// elsewhere may take before it is passed on.
inline constexpr double lift = 0x1p-3;
inline constexpr double tolerated = 0x1p-3;
inline constexpr double absorbed = 0x1p-2;

/// As a part of their size, what bodies may overlap by rounding.
inline constexpr double rounding = 0x1p-34;

/// Up to so many contacts are solved exactly where sweeps do not get there.
inline constexpr std::size_t most_active = 64;
inline constexpr std::size_t most_sweeps = 100;

/// A cluster comes to rest when for so many times sqrt(size / acceleration) its mean kinetic energy has been that of
/// this part of sqrt(acceleration x size), and none of its bodies has been faster than so many times that.
inline constexpr double calm_time = 4;
inline constexpr double calm_speed = 0.15;
inline constexpr double fastest_calm = 4;

/// By how much a gap may shrink in a span: what is more than the room. Below half of that it grows, by little.
inline double closing(const detail::RestingContact& contact, double gap) {
  const double room = contact.room;
  if (gap > room) return gap - room;
  if (gap < room / 2) return -std::min(lift * room, room / 2 - gap);
  return 0;
}

/// The least rate at which the bodies of a contact may part when a span begins: an acceleration that does not turn
/// outward can take them no nearer than they may come.
inline double least_rate(const detail::RestingContact& contact, double gap, double span) {
  return -0.5 * (gap - 2 * tolerated * contact.room) / span;
}

/// Half the least relative acceleration: for which the gap along the normal has shrunk by no more than `closing` when
/// the span ends.
inline double least_acceleration(double closing, double rate, double span) {
  return -(rate * span + closing) / (span * span);
}

}  // namespace kds::collision::cluster
