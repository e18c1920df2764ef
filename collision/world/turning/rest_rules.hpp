// When bodies that turn come to rest: the parameters.
#pragma once

#include <cstddef>

namespace kds::collision::turning_rest {

/// How far two bodies may be from each other, at a place where they have touched, to hold each other there:
/// acceleration times WorldOptions::shortest_flight squared, eight times the height of such a flight (10 um on Earth,
/// at 1 ms), and no more than this part of the bounding radius of the smaller. Bodies at rest may be that far apart.
inline constexpr double largest_holding_distance = 0x1p-6;

/// A body is calm while its fastest point has at most this many times the speed squared that a fall by that way gives:
/// with 4 it is twice acceleration times shortest flight (2 cm/s on Earth). If it is less, a body that rocks on its
/// corners is never calm, since its flights are faster; if it is more, bodies that slide or roll on a level floor stop
/// sooner.
inline constexpr double calm_energy = 4;

/// A body that touches many others is driven by the flights of all: one that touches n others is calm up to that speed
/// times n / calm_neighbours, where that factor is at least 1 and at most most_driven (8 cm/s on Earth).
inline constexpr double calm_neighbours = 2;
inline constexpr double most_driven = 4;
/// A hull that lies on a face with more corners than this is driven by the flights of all of them: with n corners it is
/// calm up to that speed times n / calm_corners, where that factor is at most most_driven_by_corners, and held over the
/// square of it times the distance. A coin of 16 corners that is dropped flat rocks at 2.1 cm/s for ever, one of 32 at
/// 4.9; those of up to 10 mostly get slower than 2 cm/s by themselves.
inline constexpr std::size_t calm_corners = 8;
inline constexpr double most_driven_by_corners = 16;
/// It lies on a face whose normal has at least this cosine with the direction of its weight: a wheel that rolls on its
/// rim does not.
inline constexpr double lying_side = 0.75;

/// Without friction nothing brakes what slides, or turns about the normal: two such bodies come to rest on each other
/// only where that is slower than this part of the speed of a calm body (20 um/s on Earth), or would be if their
/// weights pressed them for calm_flights on all that they touch; else they slide on. So what lies in a corner, and hops
/// off the one side along the other, is held; what nothing holds back is not.
inline constexpr double smooth_slip = 0x1p-10;

/// In shortest flights: for how long bodies have to be calm, so that by then they have touched wherever they can; and
/// how long it takes until bodies that were not in balance are looked at again.
inline constexpr double calm_flights = 8;
/// In shortest flights: after being calm for so long bodies come to rest even if others that they touch still move.
inline constexpr double part_flights = 64;
/// Of a group that is not in balance those bodies are left out first of which at least this part of the worst imbalance
/// is left.
inline constexpr double unheld_part = 0.5;
/// What rests wakes where more than this part of the greatest acceleration is left of it because of what lies on it.
inline constexpr double weak_part = 0x1p-6;
/// In shortest flights: impulses that each are too small to move a body at rest are summed up for so long. So an
/// acceleration below twice that of the weight, divided by this number, has no effect.
inline constexpr double ignored_flights = 256;
/// In shortest flights: for how long it is remembered where bodies touched.
inline constexpr double memory = 64;

/// Two places of a pair are the same if they are nearer than this part of the bounding radius of the smaller body, and
/// their normals have a greater cosine than that of the angle between them.
inline constexpr double same_place = 0x1p-5;
inline constexpr double same_side = 0.9;
/// How many places of a pair are remembered. When there is one more, the one that is nearest to it is forgotten: the
/// others go on to tell on which sides the two touch.
inline constexpr std::size_t most_places = 16;

}  // namespace kds::collision::turning_rest
