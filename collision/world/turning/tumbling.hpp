// Bodies that precess: those that turn freely and whose moments of inertia differ.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/response/free_rotation.hpp"
#include "collision/response/rotation_piece.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/turning/no_tumbling.hpp"
#include "collision/world_counters.hpp"
#include "collision/world_options.hpp"
#include "kds/events/dary_queue.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace kds::collision {

namespace detail {

/// A body that precesses.
template <class Motion>
struct Tumbler {
  PrincipalInertia inertia;
  /// Its free rotation: the angular momentum, and the orientation at the last contact or, of bodies that are no tops,
  /// where the present piece begins. That is not the orientation of the motion, which is off by up to the option.
  RotationState state{};
  PathOf<Motion> path{};  ///< as it was given or came out of an impulse: pieces restart it, but do not add up roundings
  double ends = never;    ///< when the present piece does
  Eigen::Quaterniond ahead = Eigen::Quaterniond::Identity();  ///< the orientation of the free rotation then
  bool astray = false;                                        ///< whether the present piece ends elsewhere
};

template <class Archive, class Motion>
void archive_members(Archive& archive, Tumbler<Motion>& body) {
  const auto quaternion = [&archive](Eigen::Quaterniond& q) {
    archive(q.coeffs()[0], q.coeffs()[1], q.coeffs()[2], q.coeffs()[3]);
  };
  image::vector(archive, body.inertia.moments), quaternion(body.inertia.axes), archive(body.inertia.symmetry);
  image::vector(archive, body.state.momentum), quaternion(body.state.orientation), archive(body.state.time);
  archive(body.path, body.ends), quaternion(body.ahead), archive(body.astray);
}

}  // namespace detail

/// The bodies of a world that precess: how they would turn by themselves, and the pieces of constant angular velocity
/// that stand for that.
///
/// A body has an angular momentum, which only contacts and callers change, and an orientation that follows from it by
/// Euler's equations (free_rotation.hpp). Its motion is a sequence of pieces, each of which begins and ends in that
/// orientation, and is off by at most WorldOptions::orientation_error in between (rotation_piece.hpp). Contacts are
/// those of the pieces. What a contact does to the body is calculated with its free rotation, so that energy and
/// momenta are kept; and its next piece begins where it is, but leads back to the free rotation.
///
/// Laws:
/// 1. The angular momentum is the same, to the bit, from one contact to the next.
/// 2. The motion is off the free rotation by at most the option until the first contact, and by at most twice that
///    ever: a body that contacts have not let turn back for so long is taken to be turned as it moves (counted as
///    orientation_resets), which changes its energy by what the difference makes.
/// 3. States and pieces are functions of what contacts and callers have done, and of nothing else.
///
/// Cost: nothing for other bodies; 2 us a piece and O(log n), beside the tests of its pairs.
template <class Motion>
class Tumbling {
 public:
  using Body = detail::Tumbler<Motion>;

  Tumbling(Bodies<Motion>& bodies, const WorldOptions& options, WorldCounters& counters)
      : bodies_(bodies), error_(options.orientation_error), counters_(counters) {}

  /// A body comes that will precess.
  void add(BodySlot slot, const PrincipalInertia& inertia);
  void remove(BodySlot slot);
  bool has(BodySlot slot) const { return slot < of_.size() && of_[slot]; }

  /// A motion is given to a body at t: the piece with which it begins. Its angular momentum follows from the angular
  /// velocity; unless that is the one that the body has already, to the bit, and it does not jump: then the angular
  /// momentum stays as it was. Precondition: the motion has started.
  Motion take_up(BodySlot slot, const Motion& given, double t);
  /// Its centre moves otherwise from now on.
  void set_path(BodySlot slot, const PathOf<Motion>& path) { of_[slot]->path = path; }

  /// When the next piece begins.
  double next_time() const { return ends_.empty() ? never : ends_.top().time; }
  struct Piece {
    BodySlot slot;
    Motion motion;
  };
  /// The piece of the first body of which one begins at next_time(), by slot.
  Piece take_next();

  /// Of a body that has met something at t, being turned as it moves: brings its free rotation up to that time. What
  /// follows concerns this instant: the angular velocity, and the inverse tensor of inertia in the axes of the world.
  void meet(BodySlot slot, const Eigen::Quaterniond& as_it_moves, double t);
  Eigen::Vector3d angular_velocity(BodySlot slot) const;
  Eigen::Matrix3d inverse_inertia(BodySlot slot) const;
  void push(BodySlot slot, const Eigen::Vector3d& angular_impulse) { of_[slot]->state.momentum += angular_impulse; }

  /// The piece that leads a body from where it is back to its free rotation.
  RotationPiece way_back(BodySlot slot, const Eigen::Quaterniond& as_it_moves, double t) const;
  /// It takes that up, or, if it cannot turn back as fast, part of it, for half as long.
  void follow(BodySlot slot, const RotationPiece& piece, bool whole, double t);

  /// Its free rotation at t.
  FreeTurning turning(BodySlot slot, double t) const;

  /// Throws AuditFailure if a motion is off its free rotation by more than it may be, or a piece is over.
  void audit(double t) const;

  /// All of it, as plain data.
  struct Image {
    std::vector<std::optional<Body>> of;

    template <class Archive>
    void archive(Archive& archive) {
      archive(of);
    }
    /// Throws std::runtime_error, naming what is wrong.
    void check(const typename Bodies<Motion>::Image& bodies, double now) const;
  };
  Image image() const { return {of_}; }
  void become(const Image& image);

 private:
  void begin(BodySlot slot, const RotationPiece& piece);
  void set_end(BodySlot slot, double end);
  Motion motion_of(const Body& body, const Eigen::Quaterniond& orientation, const RotationPiece& piece, double t) const;

  Bodies<Motion>& bodies_;  ///< which are told when pieces end
  const double error_;
  WorldCounters& counters_;
  std::vector<std::optional<Body>> of_;  ///< by slot, up to the last that has had one
  DaryQueue<> ends_;                     ///< slots are bodies
};

#ifdef KDS_TURNING
extern template class Tumbling<certificates::RigidMotion<1>>;
extern template class Tumbling<certificates::RigidMotion<2>>;
#endif

}  // namespace kds::collision
