// Bodies that precess: those that turn freely and whose moments of inertia differ.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/free_turning.hpp"
#include "collision/narrow_phase/turning/loosely_turning.hpp"
#include "collision/response/free_rotation.hpp"
#include "collision/response/rotation_piece.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/turning/no_tumbling.hpp"
#include "collision/world/world_part.hpp"
#include "collision/world_counters.hpp"
#include "collision/world_options.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/framework/snapshot.hpp"

#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <vector>

namespace kds::collision {

namespace detail {

/// A body that precesses.
template <class Motion>
struct Tumbler {
  PrincipalInertia inertia;
  /// Its free rotation: the angular momentum, and the orientation where the present piece begins or, for symmetric
  /// tops, an earlier one, but not before the last contact. The orientation of the motion differs from it by up to
  /// WorldOptions::orientation_error.
  RotationState state{};
  PathOf<Motion> path{};  ///< as it was given or came out of an impulse: pieces restart it, but do not add up roundings
  double ends = never;    ///< when the present piece does
  /// The orientation of its motion then, if not astray; of tops only where the free rotation is at the start of the
  /// piece.
  Eigen::Quaterniond to = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond ahead = Eigen::Quaterniond::Identity();  ///< that of the free rotation; not of tops
  bool astray = false;                                        ///< whether the present piece leads elsewhere
  std::optional<TopPieces> pieces{};                          ///< what is known of those of a top; no state
};

template <class Archive, class Motion>
void archive_members(Archive& archive, Tumbler<Motion>& body) {
  const auto quaternion = [&archive](Eigen::Quaterniond& q) {
    archive(q.coeffs()[0], q.coeffs()[1], q.coeffs()[2], q.coeffs()[3]);
  };
  image::vector(archive, body.inertia.moments), quaternion(body.inertia.axes), archive(body.inertia.symmetry);
  image::vector(archive, body.state.momentum), quaternion(body.state.orientation), archive(body.state.time);
  archive(body.path, body.ends), quaternion(body.to), quaternion(body.ahead), archive(body.astray);
}

}  // namespace detail

/// The bodies of a world that precess: how they would turn by themselves, and the pieces of constant angular velocity
/// that stand for that.
///
/// A body has an angular momentum, which is changed by contacts and callers only, and an orientation that follows from
/// it by Euler's equations (free_rotation.hpp): its free rotation. Its motion is a sequence of pieces, which
/// differ from the free rotation by at most WorldOptions::orientation_error (rotation_piece.hpp). Contact times are
/// those of the pieces. Impulses are calculated with the free rotation, so that energy and momenta are conserved. The
/// piece after a contact begins with the orientation that the motion has, and leads back to the free rotation.
///
/// Laws:
/// 1. The angular momentum is the same, to the bit, from one contact to the next.
/// 2. The motion differs from the free rotation by at most the option until the first contact, and always by at most
///    twice the option. If a sequence of contacts keeps a body from turning back so that it would differ by more, the
///    free rotation is set to the orientation of the motion, which changes the energy by that difference times the
///    torque of Euler's equations. These resets are counted (orientation_resets).
/// 3. States and pieces depend on contacts and on calls of the user only, not on windows, broad phases or snapshots.
///
/// Where nobody is told of pieces, those of a body that is far from all others need not be taken when they begin: it is
/// left alone for a while, and its pieces are made one after the other when it is looked at again, or when its motion
/// is read or a call ends. They are the same.
///
/// Cost: nothing for other bodies; 1 us a piece and O(log n), beside the tests of its pairs; 0.5 us a piece of a body
/// that is left alone, and of a symmetric top that is 1 us for all of its pieces together.
template <class Motion>
class Tumbling {
 public:
  static constexpr Stage stage = Stage::motions;

  using Body = detail::Tumbler<Motion>;

  Tumbling(Bodies<Motion>& bodies, const WorldOptions& options, WorldCounters& counters)
      : bodies_(bodies), error_(options.orientation_error), counters_(counters), ends_(BodyRank{&bodies.keys()}) {}

  /// Adds a body that will precess.
  void add(BodySlot slot, const PrincipalInertia& inertia);
  void remove(BodySlot slot);
  bool has(BodySlot slot) const { return slot < of_.size() && of_[slot]; }

  /// A body is given a motion at t; returns the first piece. The angular momentum follows from the angular velocity,
  /// except where that is bit for bit the one that the body has already and the body does not jump: then the angular
  /// momentum stays as it is. Precondition: the motion has started.
  Motion take_up(BodySlot slot, const Motion& given, double t);
  /// Its mass has changed by a factor, and its moments of inertia with it: it turns as before.
  void scale(BodySlot slot, double factor);
  /// The path of its centre has changed.
  void set_path(BodySlot slot, const PathOf<Motion>& path) { of_[slot]->path = path; }

  /// When the next piece begins.
  double next_time() const { return ends_.empty() ? never : ends_.top().time; }
  static constexpr bool certify() { return false; }
  static void extend_horizon() {}
  /// The motion that a body has from then on.
  struct Piece {
    BodySlot slot;
    Motion motion;
  };
  BodySlot next_body() const { return ends_.top().slot; }
  /// The piece that next_body() has from next_time() on.
  Piece take_next();

  /// The end of the present call, if nobody is told of the pieces until then, else -never.
  double unheard_until() const { return unheard_until_; }
  void set_unheard_until(double t) { unheard_until_ = t; }
  /// Whether a body whose piece ends now can be left alone until t, and stays so near to the path of that piece that
  /// nothing but rounding is between the two: less than path_rounding of its radius.
  bool can_leave_alone(BodySlot slot, double t) const;
  /// Leaves it alone: next_time() is then, and it keeps the motion that it has. Precondition: nothing needs its motion
  /// until then, except after catch_up() or catch_up_alone().
  void leave_alone(BodySlot slot, double t);
  /// Whether one that is alone stays so at least until its piece would be over, if it is looked at at t; then it is, or
  /// earlier.
  bool goes_on_alone(BodySlot slot, double t);
  bool is_alone(BodySlot slot) const { return alone_ > 0 && has(slot) && of_[slot]->ends != ends_.time(slot); }
  bool any_alone() const { return alone_ > 0; }
  /// What is known of how a body turns from t on, whatever its pieces. Precondition: it is not alone.
  LooselyTurning<Motion::degree> loosely_turning(BodySlot slot, double t) const;
  /// It is alone no longer: the piece that it has just before t.
  Motion catch_up(BodySlot slot, double t);
  /// The piece that it has just before t. It stays alone for as long as it was to be.
  Motion catch_up_alone(BodySlot slot, double t);

  /// A body with this orientation has a contact at t: advances its free rotation to t. The next three functions are
  /// about that time: angular velocity, and inverse tensor of inertia in the axes of the world; an impulse.
  void meet(BodySlot slot, const Eigen::Quaterniond& as_it_moves, double t);
  Eigen::Vector3d angular_velocity(BodySlot slot) const;
  Eigen::Matrix3d inverse_inertia(BodySlot slot) const;
  void push(BodySlot slot, const Eigen::Vector3d& angular_impulse) { of_[slot]->state.momentum += angular_impulse; }

  /// The piece that leads from this orientation back to the free rotation, at the time of meet() or of take_next().
  RotationPiece way_back(BodySlot slot, const Eigen::Quaterniond& as_it_moves) const;
  /// The body moves by that piece from now on; or, if it cannot turn back that fast, makes a part of that turn, in half
  /// the time.
  void follow(BodySlot slot, const RotationPiece& piece, bool whole, double t);

  /// Its free rotation at t.
  FreeTurning turning(BodySlot slot, double t) const;

  /// Throws AuditFailure if a motion is off its free rotation by more than it may be, or a piece is over.
  void audit(double t) const;

  /// The state of a body, from which another world that has the same body goes on; empty for a body that does not
  /// precess.
  class Progress {
   public:
    Progress() = default;
    explicit Progress(const Body& body) : body_(std::make_shared<const Body>(body)) {}
    const Body* body() const { return body_.get(); }

    template <class Archive>
    void archive(Archive& archive) {
      bool precesses = body_ != nullptr;
      archive(precesses);
      if (!precesses) return;
      Body body = body_ ? *body_ : Body{};
      archive(body);
      if constexpr (Archive::loading) body_ = std::make_shared<const Body>(body);
    }
    friend bool same_bits(const Progress& a, const Progress& b) {
      if (!a.body_ || !b.body_) return !a.body_ && !b.body_;
      return bytes_of(*a.body_) == bytes_of(*b.body_);
    }

   private:
    static std::vector<char> bytes_of(Body body) {
      kds::detail::Writer writer;
      writer(body);
      return writer.take();
    }

    std::shared_ptr<const Body> body_;
  };
  Progress progress(BodySlot slot) const { return has(slot) ? Progress(*of_[slot]) : Progress(); }
  /// Adds a body of another world, which goes on from its state there.
  void take_in(BodySlot slot, const Tumbling& from, BodySlot of);
  /// A body continues from its state in another world. May be called for different bodies by several threads at once.
  /// go_on() has to follow before the next piece is asked for.
  void go_on_from(BodySlot slot, const Progress& progress);
  void go_on();

  /// All of it, as plain data.
  struct Image {
    std::vector<std::optional<Body>> of;

    template <class Archive>
    void archive(Archive& archive) {
      archive(of);
    }
    /// Throws std::runtime_error, naming what is wrong.
    void check(const typename Bodies<Motion>::Image& bodies, double now, const WorldOptions& = {}) const;
  };
  Image image() const { return {of_}; }
  void become(const Image& image);

 private:
  static void reach(Body& body, double t);
  Motion next_pieces(BodySlot slot, double t);
  void begin(BodySlot slot, const RotationPiece& piece);
  void set_end(BodySlot slot, double end);
  Motion motion_of(const Body& body, const Eigen::Quaterniond& orientation, const RotationPiece& piece, double t) const;

  Bodies<Motion>& bodies_;  ///< which are told when pieces end
  const double error_;
  WorldCounters& counters_;
  std::vector<std::optional<Body>> of_;  ///< by slot, up to the last that has had one
  DaryQueue<BodyRank> ends_;             ///< slots are bodies; of those that are alone: until when
  std::size_t alone_ = 0;
  double unheard_until_ = -never;
};

#ifdef KDS_TURNING
extern template class Tumbling<certificates::RigidMotion<1>>;
extern template class Tumbling<certificates::RigidMotion<2>>;
#endif

}  // namespace kds::collision
