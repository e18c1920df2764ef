// A contact that lasts.
#pragma once

#include "collision/world/bodies.hpp"
#include "collision/world/body_keys.hpp"
#include "collision/world/image_tools.hpp"
#include "kds/certificate.hpp"

#include <Eigen/Core>

#include <cmath>
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
  double began = -never;        ///< s
  double left_behind = -never;  ///< s, the epoch of motions whose rounding looks like a new contact

  // In a cluster.
  double gap = 0;         ///< between the two at `since`, in units of length
  double since = -never;  ///< s
  double room = 0;        ///< the gap at which the two are kept, in units of length
  double aim = 0;         ///< the least gap along the normal when the span ends
  bool proven = true;     ///< a plane stays between the two until the span ends

  bool unfinished = false;   ///< not in a cluster: its end has not been found yet, and is sought on at its release
  std::uint32_t listed = 0;  ///< its place in the list of that of the two that is fixed

  // For walks over contacts that lean on each other.
  std::uint64_t seen = 0;   ///< the last walk that has visited it
  std::uint32_t place = 0;  ///< its place in that walk
};

/// All of it but its place in a list, and what walks need.
template <class Archive>
void archive_members(Archive& archive, RestingContact& c) {
  archive(c.a, c.b, c.wall, c.push, c.alive, c.unfinished, c.fresh, c.proven, c.began, c.left_behind, c.solved, c.depth,
          c.gap, c.room, c.since, c.aim, c.ends);
  image::vector(archive, c.normal), image::vector(archive, c.point);
}

/// Calls need(right, what) for each of the numbers that has to be finite, or in some range.
template <class Need>
void check_numbers(const RestingContact& c, double now, const Need& need) {
  /// How far a normal may be from unit length: far above the rounding of a normalisation.
  constexpr double normal_rounding = 0x1p-40;
  need(std::abs(c.normal.norm() - 1) <= normal_rounding, "its normal has no unit length");
  need(std::isfinite(c.push) && std::isfinite(c.solved), "its push or rate is not finite");
  need(image::is_past(c.began, now), "it has not begun");
  need(c.depth >= 0 && std::isfinite(c.depth), "its depth is negative or not finite");
  need(c.point.allFinite(), "its point is not finite");
  need(std::isfinite(c.gap) && c.room >= 0 && std::isfinite(c.room) && std::isfinite(c.aim) &&
           image::is_past(c.since, now),
       "its gap is not finite, or not known yet");
}

/// What of the part that knows what rests happened last by itself, at the end of a contact or of a span: what is told
/// next may follow from that.
struct RestingEvent {
  std::uint64_t count = 0;  ///< of all so far
  double time = -never;     ///< s
  bool is_span = false;     ///< at one time contacts end before spans
  PairKey rank{};           ///< of those of one kind and time the least comes first
};

}  // namespace kds::collision::detail
