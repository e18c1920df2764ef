// The parameters of clusters, and the bounds that follow for one contact. docs/resting.md gives the reasons.
#pragma once

#include "collision/response/least_constraint.hpp"
#include "collision/world/resting/resting_contact.hpp"

#include <algorithm>
#include <cstddef>

namespace kds::collision::cluster {

/// A span is this part of the time in which a body at rest falls by some half of its size...
inline constexpr double part_of_fall = 0x1p-4;
/// ... and in it bodies slide over each other by no more than this part of their size.
inline constexpr double part_of_slide = 0x1p-5;
/// A span that is cut short lasts at least this part of it.
inline constexpr double shortest_span = 0x1p-6;

/// Contacts are kept while they are nearer than this part of the smaller size.
inline constexpr double kept_gap = 0x1p-7;
/// The gap at which contacts are kept, as a part of the smaller size: room for the errors of sweeps, which with many
/// contacts decrease slowly; for the difference between a path on a curved surface and a parabola; and for the errors
/// where planes have to give way.
inline constexpr double room_of_many = 0x1p-12;
inline constexpr double room_of_curves = 0x1p-17;
inline constexpr double room_of_planes = 0x1p-23;
/// Parts of that room: by how much a gap that is too small grows in a span; the error that sweeps may leave; and by how
/// much an impact elsewhere may reduce a gap before the impact is passed on.
inline constexpr double lift = 0x1p-3;
inline constexpr double tolerated = 0x1p-3;
inline constexpr double absorbed = 0x1p-2;

/// By how much bodies may overlap by rounding, as a part of their size.
inline constexpr double rounding = 0x1p-34;

/// Up to this many contacts are solved exactly if sweeps do not converge.
inline constexpr std::size_t most_active = 64;
inline constexpr std::size_t most_sweeps = 100;

/// A cluster comes to rest when for `calm_time` times sqrt(size / acceleration) its mean kinetic energy has been at
/// most that of `calm_speed` times sqrt(acceleration x size), and none of its bodies has been faster than
/// `fastest_calm` times that.
inline constexpr double calm_time = 4;
inline constexpr double calm_speed = 0.15;
inline constexpr double fastest_calm = 4;

/// By how much a gap may shrink in a span: by its excess over the room. A gap below half of the room has to grow
/// slightly.
inline double closing(const detail::RestingContact& contact, double gap) {
  const double room = contact.room;
  if (gap > room) return gap - room;
  if (gap < room / 2) return -std::min(lift * room, room / 2 - gap);
  return 0;
}

/// The least rate at which the bodies of a contact may part when a span begins: then an acceleration that is allowed
/// cannot bring them nearer than they may come.
inline double least_rate(const detail::RestingContact& contact, double gap, double span) {
  return -0.5 * (gap - 2 * tolerated * contact.room) / span;
}

/// Half the least relative acceleration with which the gap along the normal shrinks by no more than `closing` until the
/// span ends.
inline double least_acceleration(double closing, double rate, double span) {
  return -(rate * span + closing) / (span * span);
}

}  // namespace kds::collision::cluster
