// Names of worlds, and of what they are given and tell, for headers that only refer to them.
#pragma once

#include "collision/body_id.hpp"

#include <cstdint>

namespace kds::certificates {

template <int Degree>
struct PointMotion;
template <int Degree>
struct RigidMotion;

}  // namespace kds::certificates

namespace kds::collision {

template <class BodyMotionType>
class BasicWorld;
template <class Motion>
class BasicWorldListener;
template <class BodyMotionType>
struct BasicBodyDescription;

template <int Degree>
using World = BasicWorld<certificates::PointMotion<Degree>>;
template <int Degree>
using TurningWorld = BasicWorld<certificates::RigidMotion<Degree>>;
template <int Degree>
using WorldListener = BasicWorldListener<certificates::PointMotion<Degree>>;
template <int Degree>
using BodyDescription = BasicBodyDescription<certificates::PointMotion<Degree>>;

using TimerId = std::uint64_t;

struct WorldOptions;
struct WorldCounters;
struct PairEvent;
struct WallEvent;
struct PlacedShape;
struct Contact;
struct Hit;

}  // namespace kds::collision
