// A contact that lasts.
#pragma once

#include "collision/world/bodies.hpp"
#include "kds/certificate.hpp"

#include <Eigen/Core>

#include <cstdint>

namespace kds::collision::detail {

/// Normals with at least this cosine of the angle between them belong to the same place.
inline constexpr double same_normal = 1 - 0x1p-20;

/// Two bodies, or a body (a) and a wall, that stay in touch.
struct RestingContact {
  BodySlot a = 0;
  BodySlot b = no_body;  ///< of a wall
  int wall = -1;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, from a to b or out of the domain
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< where it began, from the centre of a
  double push = 0;                                   ///< half the relative acceleration that it gives
  /// The largest of the velocities that were last solved for with it: the remaining rate along the normal is a rounding
  /// error of that size.
  double solved = 0;
  double depth = 0;  ///< by which the two overlapped when it began, for roundings of the clock; 0 if they did not
  bool alive = false;
  bool fresh = false;           ///< its speed of approach has still to be removed
  double ends = never;          ///< s, when nothing presses the two together from then on; `never` up to degree 2
  double left_behind = -never;  ///< s, the epoch of motions whose rounding looks like a new contact

  // In a cluster.
  double gap = 0;         ///< between the two at `since`, in units of length
  double since = -never;  ///< s
  double room = 0;        ///< the gap at which the two are kept, in units of length
  double aim = 0;         ///< the least gap along the normal when the span ends
  bool proven = true;     ///< a plane stays between the two until the span ends

  // For walks over contacts that lean on each other.
  std::uint64_t seen = 0;   ///< the last walk that has visited it
  std::uint32_t place = 0;  ///< its place in that walk
};

}  // namespace kds::collision::detail
