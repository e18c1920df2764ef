// What rests of one body that turns, or is about to, on its way from one world to another.
#pragma once

#include "collision/body_id.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/resting/kept_progress.hpp"
#include "collision/world/turning/carrier.hpp"
#include "kds/certificate.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace kds::collision {

namespace detail {

/// Where two bodies have touched: the same point in the coordinates of each.
struct TouchedPlace {
  Eigen::Vector3d on_a, on_b;
  Eigen::Vector3d normal;  ///< unit, from a to b, in the world
  double time;             ///< s
};

/// Two bodies that lie on each other, or hop on each other so gently that they may soon.
struct LyingPair {
  bool rests = false;
  std::vector<TouchedPlace> places;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< of the contact with which they came to rest, from a's centre
};

template <class Archive>
void archive_members(Archive& archive, LyingPair& pair) {
  archive(pair.rests);
  image::vector(archive, pair.normal), image::vector(archive, pair.point);
  archive.each(pair.places, [&](TouchedPlace& place) {
    image::vector(archive, place.on_a), image::vector(archive, place.on_b), image::vector(archive, place.normal);
    archive(place.time);
  });
}

/// Calls need(right, what) for each of the numbers of a pair that has to be finite, or in some range.
template <class Need>
void check_numbers(const LyingPair& pair, double now, const Need& need) {
  constexpr double unit_rounding = 0x1p-40;  // far above that of a normalisation
  need(pair.normal.allFinite() && pair.point.allFinite(), "its contact is not finite");
  for (const TouchedPlace& place : pair.places) {
    need(place.on_a.allFinite() && place.on_b.allFinite(), "a place is not finite");
    need(std::abs(place.normal.norm() - 1) <= unit_rounding, "a normal has no unit length");
    need(image::is_past(place.time, now), "they have not touched yet");
  }
}

}  // namespace detail

namespace turning_rest {

/// How impulses that were too small to wake a body at rest would make it move if it lay on nothing.
struct Ignored {
  double since = -never;  ///< s
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();

  template <class Archive>
  void archive(Archive& archive) {
    archive(since);
    image::vector(archive, velocity), image::vector(archive, angular_velocity);
  }
};

}  // namespace turning_rest

/// With which others a body lies, or is about to lie, and what else decides when it comes to rest and wakes: another
/// world that has the same bodies can go on from it. That of all bodies that lie with each other is complete, since
/// what they do follows from these alone. A pair of two bodies that are not fixed is in the progress of both. What
/// decides nothing any more is left out, so that two worlds in which the same will happen have the same bits.
class TurningRestProgress {
 public:
  /// With another body: where the two have touched.
  struct Link {
    BodySlot other = 0;  ///< by its number
    detail::LyingPair pair{};
  };
  /// Of a body with links, or that is calm.
  struct State {
    std::vector<Link> links{};  ///< in the order of the others
    double since = never;       ///< s; since when it is calm
    double looked = -never;     ///< s; if it is calm: when its group was last found not to be at rest
    bool rests = false;
    turning_rest::Ignored ignored{};  ///< if it rests
    turning_rest::Carrier carrier{};  ///< if there are links

    bool is_none() const { return links.empty() && since == never; }
    const State& compared() const { return *this; }
    template <class Archive>
    void archive(Archive& archive) {
      archive(since, looked, rests, ignored, carrier);
      archive.each(links, [&](Link& link) { archive(link.other, link.pair); });
    }
  };

  TurningRestProgress() = default;
  explicit TurningRestProgress(State state) : state_(std::move(state)) {}

  /// Null if nothing rests or is about to.
  const State* state() const { return state_.get(); }
  bool is_none() const { return !state(); }
  /// Calls take(number) for each body with which this one lies, or is about to.
  template <class Take>
  void each_other(BodySlot, const Take& take) const {
    if (!state()) return;
    for (const Link& link : state()->links) take(link.other);
  }
  /// As RestingProgress.
  template <class Take>
  void each_contact(BodySlot, const Take& take) const {
    if (!state()) return;
    for (const Link& link : state()->links) take(link.other, std::uint64_t{link.pair.rests});
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(state_);
  }

  friend bool same_bits(const TurningRestProgress& a, const TurningRestProgress& b) {
    return same_bits(a.state_, b.state_);
  }

 private:
  RestingState<State> state_;
};

}  // namespace kds::collision
