// The collision detection engine: bodies, broad phase, contacts, response.
#pragma once

#include "collision/broad_phase.hpp"
#include "collision/contact.hpp"
#include "collision/narrow_phase.hpp"
#include "collision/profile.hpp"
#include "collision/shape.hpp"
#include "kds/dary_queue.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace kds::collision {

/// What the engine does about contacts.
enum class Response {
  none,      ///< reports contacts and separations; bodies pass through each other
  elastic,   ///< frictionless impulses with restitution 1, no spin; motions change at each contact
  callback,  ///< as elastic, but the listener changes the motions; a pair it leaves approaching passes through
};

/// How a broad phase is chosen.
enum class BroadPhaseKind {
  kinetic_sap,  ///< kinetic sweep and prune: event-driven, exact
  sap,          ///< sweep and prune over arrays with swept boxes, frame by frame
  all_pairs,    ///< no pruning: every pair tested once and its result kept
};

/// Bounces that pile up in time. Two bodies that have both met others more than `contacts` times within `interval`
/// (fixed bodies and walls do not count), or that meet without speed and are pressed together, are *held*: the relative
/// normal velocity and acceleration are taken out (momentum is kept, energy is not) and, should rounding leave a rest of
/// them, the pair is let pass until it has separated. After twice as many, which happens where a body is crushed, pairs
/// are let pass at once. Holds are counted and reported, and a run always ends.
///
/// Differs: meetings are counted for bodies, not for pairs. A pair is forgotten when its bounding volumes part, which
/// boxes do at each bounce, and when that is depends on the broad phase.
struct ZenoPolicy {
  std::uint32_t contacts = 100;  ///< more makes longer cascades exact and collapses slower
  double interval = 1e-9;        ///< s
};

/// Reflecting walls: a ball around each body stays inside the box [min, max].
struct Walls {
  Eigen::Vector3d min;
  Eigen::Vector3d max;
};

struct WorldOptions {
  double start_time = 0;                ///< s; keep it near 0: events are as fine as doubles near the clock
  double window = never;                ///< s; how far ahead events are predicted at a time
  Response response = Response::none;
  BroadPhaseKind broad_phase = BroadPhaseKind::kinetic_sap;
  double rate = 0;                      ///< Hz; frames of the swept boxes, needed by `sap` alone
  std::optional<Walls> walls;
  bool report_pairs = false;            ///< tell the listener of bounding volumes that begin and cease to overlap
  bool profile = false;                 ///< measure where the time goes
  ZenoPolicy zeno;
};

/// The volume that the broad phase sees.
enum class BoundingVolume {
  shape,   ///< the tightest box around the shape in its orientation
  sphere,  ///< the box around the bounding sphere: right for a shape in any orientation
};

/// A body to add.
template <int Degree>
struct BodyDescription {
  using Motion = certificates::PointMotion<Degree>;
  /// Gives a box that holds the body from time t until its valid_until, which must be later than t.
  using BoxFunction = std::function<KineticBox<Degree>(double t, const Motion& motion)>;

  Shape shape;
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// One or more pieces sorted by start. The first may lie in the past; in the future, the body enters then.
  std::vector<Motion> motion;
  double mass = 1;     ///< > 0
  bool fixed = false;  ///< infinite mass
  std::uint32_t category = 1;          ///< bits
  std::uint32_t collides_with = ~0u;   ///< a pair is tested if each one's category is in the other's mask
  BoundingVolume volume = BoundingVolume::shape;
  BoxFunction box;     ///< instead of `volume`: caller-given conservative boxes
};

/// Something of two bodies: contact, overlap or separation.
struct PairEvent {
  BodyId a;
  BodyId b;
  Contact contact;
};

/// A body's bounding sphere meets a wall: 0 is -x, 1 is +x, 2 is -y ... 5 is +z.
struct WallEvent {
  BodyId body;
  int wall;
  Contact contact;  ///< normal points out of the domain
};

template <int Degree>
class World;

/// Told of events in order of time. Every callback may change motions, add and remove bodies, the ones concerned
/// included; the world is consistent when it is called.
template <int Degree>
class WorldListener {
 public:
  virtual ~WorldListener() = default;
  virtual void contact(World<Degree>&, const PairEvent&) {}     ///< penetration begins; motions are as after response
  virtual void separation(World<Degree>&, const PairEvent&) {}  ///< `none` alone: penetration ends
  virtual void overlap(World<Degree>&, const PairEvent&) {}     ///< in contact when entering the world or after a jump
  virtual void wall(World<Degree>&, const WallEvent&) {}
  virtual void pair_began(World<Degree>&, BodyId, BodyId, double) {}
  virtual void pair_ended(World<Degree>&, BodyId, BodyId, double) {}
  virtual void held(World<Degree>&, const PairEvent&) {}        ///< the Zeno policy has acted on a pair
};

struct WorldCounters {
  BroadPhaseCounters broad_phase;
  std::uint64_t pairs_begun = 0;     ///< pairs handed on by the broad phase
  std::uint64_t pair_tests = 0;      ///< dynamic intersection tests
  std::uint64_t contacts = 0;
  std::uint64_t separations = 0;
  std::uint64_t overlaps = 0;
  std::uint64_t wall_contacts = 0;
  std::uint64_t motion_updates = 0;  ///< by response, walls, scripts and callers
  std::uint64_t held = 0;            ///< times the Zeno policy acted
};

/// Runs bodies through time and reports their contacts at exact times.
///
/// [Paper] Figure 2. Events are, in this order where times are equal: pieces of motion that start, changes of the
/// broad phase, bounding volumes that expire, walls, contacts by (a, b). Dynamic test results are kept until a motion
/// changes; then only the pairs of that body that are active are tested again.
///
/// Degree 1 (straight paths) never pays for degree 2.
template <int Degree>
class World final : private PairListener {
 public:
  using Motion = certificates::PointMotion<Degree>;
  using Description = BodyDescription<Degree>;
  using Listener = WorldListener<Degree>;

  /// Throws std::invalid_argument for options that contradict each other.
  explicit World(const WorldOptions& options, Listener* listener = nullptr);
  ~World() override;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Adds a body and returns its id: the number of bodies so far, or the id of one that was removed. Throws
  /// std::invalid_argument naming the member that is wrong. Adding many before time moves costs least.
  BodyId add_body(const Description& description);

  /// Removes a body. Its pairs end, and in mode `none` its contacts separate, with reports.
  void remove_body(BodyId id);

  /// From now on the body moves so, whatever pieces it still had. A jump counts as entering anew.
  void update_motion(BodyId id, const Motion& motion);

  /// Processes everything up to and including t.
  void advance_to(double t);

  /// Processes the next event not later than `limit`, if there is one. False if not; then the clock is at `limit`
  /// if that is finite.
  bool step(double limit = never);

  /// Processes events up to t for as long as the wall-clock budget lasts; true if t was reached.
  bool advance_for(double budget_seconds, double t);

  double now() const { return now_; }
  std::size_t size() const { return alive_; }
  bool contains(BodyId id) const { return id < bodies_.size() && bodies_[id].alive; }

  const Motion& motion(BodyId id) const { return body(id).motion; }
  const PlacedShape& shape(BodyId id) const { return body(id).shape; }
  double mass(BodyId id) const { return body(id).mass; }
  bool fixed(BodyId id) const { return body(id).inverse_mass == 0; }

  /// Whether a and b are in contact (mode `none`).
  bool touching(BodyId a, BodyId b) const;

  WorldCounters counters() const;
  /// All zero but for `other` unless WorldOptions.profile is set.
  const Profile& work_profile() const { return profile_; }

  /// Checks the broad phase against the motions, exactly, and the pairs against brute force; throws AuditFailure.
  void audit() const;

 private:
  using PairSlot = std::uint32_t;
  static constexpr PairSlot no_pair = ~PairSlot{0};

  struct Body {
    PlacedShape shape;
    Motion motion;
    KineticBox<Degree> box;
    std::vector<Motion> script;  ///< pieces to come, last first
    std::vector<PairSlot> pairs;
    typename Description::BoxFunction box_function;
    double mass = 1;
    double inverse_mass = 1;
    std::uint32_t category = 1;
    std::uint32_t collides_with = ~0u;
    BoundingVolume volume = BoundingVolume::shape;
    bool alive = false;
    bool entered = false;  ///< is in the broad phase
    std::uint64_t meetings = 0;  ///< contacts since burst_start (Zeno)
    double burst_start = -never;
  };

  struct Pair {
    BodyId a = 0, b = 0;
    std::uint32_t place_in_a = 0, place_in_b = 0;
    bool alive = false;
    bool dirty = false;
    bool fresh = false;       ///< one of the bodies has entered or jumped at this instant
    bool touching = false;    ///< mode none: in contact
    bool ignored = false;     ///< resolved: overlaps and passes through until separated
    bool boxes_overlap = false;
  };

  struct PairRank {
    const std::vector<Pair>* pairs = nullptr;
    std::uint64_t operator()(std::uint32_t slot) const {
      return std::uint64_t{(*pairs)[slot].a} << 32 | (*pairs)[slot].b;
    }
  };

  struct Pending {
    enum class Kind { overlap, separation, pair_began, pair_ended } kind;
    BodyId a, b;
    Contact contact;
  };

  // world.cpp: the clock
  void reach(double limit);
  void enter_new_bodies();
  void start_pieces();
  void renew_volume(BodyId id);
  void emit_pending();

  Profile* profile() { return options_.profile ? &profile_ : nullptr; }

  // world_bodies.cpp: bodies and pairs
  const Body& body(BodyId id) const;
  Body& body(BodyId id);
  void pair_began(BodyId a, BodyId b, double t) override;
  void pair_ended(BodyId a, BodyId b, double t) override;
  PairSlot find_pair(BodyId a, BodyId b) const;
  bool take_back(typename Pending::Kind kind, BodyId a, BodyId b, double t);
  void release_pair(PairSlot slot);
  void mark_dirty(PairSlot slot);
  void set_motion(BodyId id, const Motion& motion, bool jumped);
  KineticBox<Degree> bounding_box(const Body& body) const;
  void schedule_wall(BodyId id);
  void schedule_volume(BodyId id);
  MovingShape<Degree> moving(BodyId id) const { return {bodies_[id].shape, bodies_[id].motion}; }

  // world_contacts.cpp: tests, contacts, response
  ContactMode mode() const { return options_.response == Response::none ? ContactMode::transparent : ContactMode::resolved; }
  void test_dirty_pairs();
  void test(PairSlot slot);
  void test_boxes(PairSlot slot);
  void process_boxes(PairSlot slot, double t);
  void process_contact(PairSlot slot, double t);
  void process_wall(BodyId id, double t);
  bool respond(PairSlot slot, const Contact& contact);
  void hold(const Contact& contact, BodyId a, BodyId b);
  double next_wall_time(const Body& body, int wall) const;
  std::uint64_t count_meeting(Body& body, double t) const;

  WorldOptions options_;
  Listener* listener_;
  Listener silent_;
  std::unique_ptr<BroadPhase<Degree>> broad_phase_;
  std::vector<Body> bodies_;
  std::vector<BodyId> free_bodies_;
  std::vector<BodyId> entering_;
  std::vector<Pair> pairs_;
  std::vector<PairSlot> free_pairs_;
  std::vector<PairSlot> dirty_;
  std::deque<Pending> pending_;
  DaryQueue<> pieces_;    // slots are bodies
  DaryQueue<> volumes_;   // slots are bodies
  DaryQueue<> walls_;     // slots are bodies
  DaryQueue<PairRank> contacts_;  // slots are pairs
  DaryQueue<PairRank> boxes_;     // slots are pairs; used where the broad phase is not exact
  WorldCounters counters_;
  Profile profile_;
  double now_;
  double horizon_;
  std::size_t alive_ = 0;
  bool inserting_ = false;
};

extern template class World<1>;
extern template class World<2>;

}  // namespace kds::collision
