// The collision detection engine: bodies, broad phase, contacts, response.
#pragma once

#include "collision/body_description.hpp"
#include "collision/broad_phase/broad_phase.hpp"
#include "collision/broad_phase/kdop.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/profile.hpp"
#include "collision/world/earliest_wall_time.hpp"
#include "collision/world/edit_limit.hpp"
#include "collision/world/records.hpp"
#include "collision/world/reports.hpp"
#include "collision/world/resting_contacts.hpp"
#include "collision/world_listener.hpp"
#include "collision/world_options.hpp"
#include "kds/events/calendar_queue.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/statistics.hpp"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace kds::collision {

/// What a world has done so far.
struct WorldCounters {
  BroadPhaseCounters broad_phase;
  std::uint64_t pairs_begun = 0;  ///< pairs handed on by the broad phase
  std::uint64_t pair_tests = 0;   ///< dynamic intersection tests
  std::uint64_t contacts = 0;
  std::uint64_t separations = 0;
  std::uint64_t overlaps = 0;
  std::uint64_t wall_contacts = 0;
  std::uint64_t motion_updates = 0;  ///< by response, walls, scripts and callers
  std::uint64_t held = 0;            ///< times the Zeno policy acted

  friend bool operator==(const WorldCounters&, const WorldCounters&) = default;
  /// As a kinetic structure's: what has happened, and failure times asked for.
  operator Counters() const {
    return {.events = contacts + separations + overlaps + wall_contacts, .certificates = pair_tests};
  }
};

/// Runs bodies through time and reports their contacts at exact times.
///
/// [Paper] Figure 2. Events are, in this order where times are equal: pieces of motion that start, changes of the
/// broad phase, bounding volumes that expire, walls, held pairs let go, contacts and separations by (a, b). Which broad
/// phase finds them makes no difference: WorldListener says in what order they are reported. Dynamic test results are
/// kept until a motion changes; then only the pairs of that body that are active are tested again.
///
/// Adding, removing and moving bodies calls no listener: what follows from it is reported by the next step, at now().
///
/// What a call refuses it refuses before anything is changed, and what a listener throws comes out of the step when its
/// event has been made: the world goes on after both. But where something interrupts a change half-way (a box function
/// that throws, want of memory) the world can no longer be used: it can be looked at and destroyed, and all that would
/// run, change, check or save it throws std::logic_error and says why.
///
/// Degree 1 (straight paths) never pays for degree 2. Lengths and masses are in units of the caller's own, times in
/// seconds. An id that names no body throws std::out_of_range (of held() and touching(), either id).
template <int Degree>
class World final : private PairListener, private RestingContacts<Degree>::Bodies {
  static_assert(Degree == 1 || Degree == 2, "World: bodies move on lines (degree 1) or parabolas (degree 2)");

 public:
  using Motion = certificates::PointMotion<Degree>;
  using Description = BodyDescription<Degree>;
  using Listener = WorldListener<Degree>;

  /// Throws std::invalid_argument, naming the option, for one that is out of range or does not go with the others, and
  /// std::runtime_error where arithmetic is not that of kds/arithmetic/strict.hpp.
  /// The listener, if there is one, must outlive the world.
  explicit World(const WorldOptions& options, Listener* listener = nullptr);
  ~World() override;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Adds a body and returns its id: the next number, from 0 on, or the id of a body that was removed at an earlier
  /// time, so that what is told of an instant never names two bodies by one id. Throws
  /// std::invalid_argument, naming the member that is wrong; then nothing is added. Adding many between two steps costs
  /// least.
  BodyId add_body(const Description& description);

  /// Makes room for this many bodies in all. Never needed, but saves time and memory where many are added. Throws
  /// std::length_error for more than there are ids.
  void reserve(std::size_t bodies);

  /// Removes a body. Its pairs end, and in mode `none` its contacts separate, with reports.
  void remove_body(BodyId id);

  /// Replaces the motion from now() on, and discards the pieces still to come. A body that was to enter later enters
  /// now. In the modes that resolve contacts a body that jumps enters anew: what it meets there is an overlap. In mode
  /// `none` a jump begins and ends contacts. Throws std::invalid_argument for a motion that is not finite or starts
  /// after now().
  void update_motion(BodyId id, const Motion& motion);

  /// Processes everything up to and including t. Throws std::invalid_argument where t is before now() or not finite,
  /// std::logic_error if called from within a callback, and std::runtime_error as WorldOptions::most_edits says.
  void advance_to(double t);

  /// Processes the next event not later than `limit`, if there is one. False if not; then the clock is at `limit`
  /// if that is finite, and else stays at the last event. Throws as advance_to(), but not for the past; `sap`, whose
  /// frames never end, needs a limit.
  bool step(double limit = never);

  /// Processes events up to t until this much time of the wall clock has passed, but at least one; true if t was
  /// reached. Throws as advance_to() does, and std::invalid_argument for a budget that is negative or not a number.
  bool advance_for(double budget_seconds, double t);

  // A world is a KineticStructure: it runs in a Simulator beside others, one clock for all (docs/framework.md). Before
  // it is changed it has to be advanced to that clock, where nothing is due.

  /// When the next event happens, `never` if there is none within the horizon. now(), if bodies have come or changed
  /// there, and it is still to be seen what follows. Nothing that can be observed changes: the search is kept for the
  /// step to come, and made again if the world is changed before that time, at the cost of entry for all bodies. Throws
  /// as step() does.
  double next_time() const;
  /// Processes what is due at next_time(). Throws as step() does.
  void process();
  /// Knows what happens until then. Throws std::logic_error as step() does.
  void extend_horizon(double now, double horizon);
  /// As audit(), at a time from now() on before which nothing is due.
  void audit(double t) const;

  double now() const { return stepping_ ? now_ : clock_; }
  std::size_t size() const { return alive_; }
  bool contains(BodyId id) const { return id < bodies_.size() && bodies_[id].alive; }

  /// Includes what held contacts do to the acceleration; to change a motion, begin with free_motion(). The reference is
  /// valid until bodies are added, removed or moved, or the clock advances.
  const Motion& motion(BodyId id) const { return body(id), movers_[id].motion; }
  /// The motion as it would go on without the contacts that hold it: with the acceleration that the caller gave last.
  Motion free_motion(BodyId id) const;
  PlacedShape shape(BodyId id) const { return body(id), moving(id).shape; }
  double mass(BodyId id) const { return body(id).mass; }
  bool fixed(BodyId id) const { return body(id).inverse_mass == 0; }

  /// Whether a and b are in contact (mode `none`).
  bool touching(BodyId a, BodyId b) const;

  /// Whether a and b are held together (mode `elastic` alone), or a is held at a wall, numbered as in WallEvent (all
  /// modes; std::out_of_range for any other number).
  bool held(BodyId a, BodyId b) const;
  bool held_at_wall(BodyId a, int wall) const;

  WorldCounters counters() const;
  /// The broad phase in use: a name of broad_phase_kind.hpp; "auto" is "grid", or "few-boxes" with few bodies.
  std::string_view broad_phase() const { return broad_phase_->name(); }
  /// All zero unless WorldOptions.profile is set.
  const Profile& work_profile() const { return profile_; }

  /// Checks the broad phase against the motions, exactly, and the pairs against brute force, in O(n^2); throws
  /// AuditFailure. Just after bodies were added or moved, while the next step has work left at now(), only the broad
  /// phase is checked.
  void audit() const { audit(now()); }

  /// Saves or loads all that decides the events to come: see save() and restore() in kds/framework/snapshot.hpp. A
  /// world that is loaded, with the same options (but see docs/framework.md), makes the same contacts at the same
  /// times, bit for bit. Throws std::invalid_argument for a body with a box function, std::logic_error in a callback.
  template <class Archive>
  void archive(Archive& archive);

 private:
  using PairSlot = detail::PairSlot;
  static constexpr PairSlot no_pair = detail::no_pair;
  static constexpr BodyId no_body = detail::no_body;
  // world/records.hpp
  using Mover = detail::Mover<Degree>;
  using Extras = detail::Extras<Degree>;
  using Link = detail::Link;
  using Body = detail::Body<Degree>;
  using Entry = typename BroadPhase<Degree>::Entry;
  using Moving = detail::Moving<Degree>;
  using Resting = RestingContacts<Degree>;
  using Pair = detail::Pair;
  using PairRank = detail::PairRank;

  // world.cpp: the clock
  /// When the next of each kind is due, but for what the broad phase does.
  struct Agenda {
    double piece, boxes, volume, wall, let_go, contact;
    double first() const { return std::min({piece, boxes, volume, wall, let_go, contact}); }
  };
  Agenda agenda() const;
  /// Whether the search for the next event makes it, or stops before it.
  enum class Search { makes, looks };
  bool next_event(double limit, Search search = Search::makes);
  bool guarded_event(double limit, Search search);
  bool work_left() const { return !entering_.empty() || !resting_.settled() || !dirty_.empty() || !reports_.empty(); }
  void make_broad_phase();
  void reach(double limit);
  void go_back(double t);
  void start_pieces();
  bool renew_volume(BodyId id);
  void count_edit();

  // world/guards.cpp: what may be called when, and what is left when something throws
  [[noreturn]] void refuse(const char* function) const;
  void require_whole(const char* function) const {
    if (failure_) [[unlikely]]
      refuse(function);
  }
  /// For what changes bodies. Callbacks may.
  void require_editable(const char* function) {
    if (failure_ || in_box_function_) [[unlikely]]
      refuse(function);
    if (!stepping_ && now_ > clock_) [[unlikely]]
      change_or_fail([&] { go_back(clock_); });
  }
  /// For what runs, saves or loads the world.
  void require_idle(const char* function) const {
    if (failure_ || in_box_function_ || stepping_) [[unlikely]]
      refuse(function);
  }
  void note_failure();
  /// Makes a change. What throws in the middle of it leaves the world in pieces.
  template <class Change>
  auto change_or_fail(const Change& change) {
    try {
      return change();
    } catch (...) {
      note_failure();
      throw;
    }
  }
  /// Calls the listener: in a step, when the world is whole. What it throws leaves it so.
  template <class Call>
  void tell(const Call& call) {
    telling_ = true;
    call(*listener_);
    telling_ = false;
    require_whole("World::step");  // The listener may have caught what interrupted a change that it made.
  }

  void report_next();

  Profile* profile() { return options_.profile ? &profile_ : nullptr; }

  // world/snapshot.cpp: saving and loading; world/image.cpp: what is saved, written and read
  struct Image;
  Image image() const;
  void become(const Image& image);
  void set_shape(BodyId id, PlacedShape placed);
  void load_pairs(const Image& image);
  void rebuild_broad_phase();
  std::vector<std::shared_ptr<const Mesh>> meshes() const;

  // world/entry.cpp: bodies that come
  BodyId put(const Description& description, std::shared_ptr<const PlacedShape> shape);
  BodyId new_body();
  void free_removed();
  void set_extras(BodyId id, std::span<const Motion> script, const typename Description::BoxFunction& box_function);
  void enter_new_bodies();

  // world/bodies.cpp: bodies and pairs
  const Body& body(BodyId id) const;
  Body& body(BodyId id);
  void pairs_to_come(std::size_t pairs) override;
  bool filters() const override { return filters_; }
  /// What collides with nothing the broad phase does not know.
  bool collides(BodyId id) const { return bodies_[id].category != 0 && bodies_[id].collides_with != 0; }
  bool may_collide(BodyId a, BodyId b) const override {
    return (bodies_[a].category & bodies_[b].collides_with) != 0 &&
           (bodies_[b].category & bodies_[a].collides_with) != 0;
  }
  void pair_began(BodyId a, BodyId b, double t) override;
  void pair_ended(BodyId a, BodyId b, double t) override;
  void take_out(BodyId id);
  void give(BodyId id, const Motion& motion);
  PairSlot find_pair(BodyId a, BodyId b) const;
  PairSlot new_pair(BodyId a, BodyId b);
  void unlist(PairSlot slot);
  void release_pair(PairSlot slot);
  void mark_dirty(PairSlot slot);
  void set_motion(BodyId id, const Motion& motion, bool jumped);
  bool is_jump(BodyId id, const Motion& to) const;
  KineticBox<Degree> bounding_box(BodyId id) const;
  KineticBox<Degree> bare_box(BodyId id) const;
  bool caller_makes_box(BodyId id) const { return bodies_[id].extras && bodies_[id].extras->box_function; }
  KineticBox<Degree> renewed_box(BodyId id);
  void note_wall(BodyId id, double earliest);
  void schedule_wall(BodyId id);
  void schedule_walls(std::span<const Entry> bodies);
  void schedule_volume(BodyId id);

  // world/kdops.cpp: bounding volumes in more directions than the axes
  Kdops<Degree> kdops();
  void place_extents(BodyId id);
  KineticSlab<Degree> slab(BodyId id, std::size_t i, double now) const;
  bool volumes_overlap(BodyId a, BodyId b, double t) const;

  // world/clearance.cpp: what volumes reach beyond bodies, for the contact gap of meshes
  void allow_for_meshes();
  void update_volume(BodyId id, const KineticBox<Degree>& box);
  std::array<double, std::size_t{Degree} + 1> growth(BodyId id) const;
  KineticBox<Degree> grown(BodyId id, KineticBox<Degree> box) const;
  double clearance_until(BodyId id) const;

  // world/contacts.cpp: tests, contacts, response
  ContactMode mode() const {
    return options_.response == Response::none ? ContactMode::transparent : ContactMode::resolved;
  }
  void test_dirty_pairs();
  void test(PairSlot slot);
  bool balls_are_quick() const;
  void estimate_dirty_pairs();
  void estimate_balls(std::size_t first, std::size_t last);
  void set_contact(PairSlot slot, double time);
  void remember(PairSlot slot, const FoundTouch& found);
  bool certify_next(bool contact, bool wall);
  void certify_contact(PairSlot slot);
  void certify_wall(BodyId id);
  void test_boxes(PairSlot slot);
  void process_boxes(PairSlot slot, double t);
  Contact contact_of(BodyId a, BodyId b, double t, const FoundTouch& found = {}) const;
  void process_contact(PairSlot slot, double t);
  void process_separation(PairSlot slot, double t);
  void process_wall(BodyId id, double t);
  bool respond(PairSlot slot, const Contact& contact);
  bool stays(double rebound, double pressed, double size, std::uint64_t burst) const;
  double earliest_wall_time(BodyId id, int wall) const {
    return collision::earliest_wall_time(movers_[id].motion, bodies_[id].bounding_radius, *options_.walls, wall, now_);
  }
  double next_wall_time(BodyId id, int wall, double horizon) const;
  std::uint64_t count_meeting(BodyId a, BodyId b);
  std::uint64_t count_meeting(BodyId id);
  std::uint64_t patience() const { return 10 * std::uint64_t{options_.zeno.contacts}; }

  // What resting contacts ask, and tell (RestingContacts::Bodies).
  bool present(BodyId id) const override { return contains(id) && bodies_[id].entered; }
  Moving moving(BodyId id) const override { return Moving(bodies_[id], movers_[id].motion); }
  const Motion& path(BodyId id) const override { return movers_[id].motion; }
  double inverse_mass(BodyId id) const override { return bodies_[id].inverse_mass; }
  Eigen::Vector3d free_acceleration(BodyId id) const override;
  double time() const override { return now_; }
  double horizon() const override { return horizon_; }
  void take_up(BodyId id, const Motion& motion) override;
  void changed(BodyId a, BodyId b) override;
  void let_pass(BodyId a, BodyId b) override;
  void tell_held(BodyId a, BodyId b) override;

  // world/audit.cpp
  void audit_overlapping(double t) const;

  WorldOptions options_;
  Listener* listener_;
  Listener silent_;
  std::unique_ptr<BroadPhase<Degree>> broad_phase_;
  std::vector<Mover> movers_;  // by body
  std::vector<Body> bodies_;
  ListArena<Link> links_;  // pairs of each body
  std::vector<BodyId> free_bodies_;
  std::vector<BodyId> removed_;  ///< at removed_at_: their ids are not given again at that time
  std::vector<BodyId> entering_;
  std::vector<Pair> pairs_;
  std::vector<PairSlot> free_pairs_;
  std::vector<PairSlot> dirty_;
  std::vector<double> estimates_;               // by place in dirty_: see estimate_balls()
  std::vector<FoundTouch> found_;               // by pair, as far as known; of no use once a motion has changed
  std::vector<KdopDirection> directions_;       // beyond the axes
  std::vector<std::array<double, 2>> extents_;  // by body and direction
  Resting resting_;
  Reports reports_;
  // Queues that a scene does not need have no slots.
  DaryQueue<> pieces_;                // slots are bodies
  DaryQueue<> volumes_;               // slots are bodies
  CalendarQueue<> walls_;             // slots are bodies
  CalendarQueue<PairRank> contacts_;  // slots are pairs
  DaryQueue<PairRank> boxes_;         // slots are pairs; used where the broad phase is not exact
  WorldCounters counters_;
  Profile profile_;
  double now_;    ///< of what is being done; ahead of clock_ when next_time() has looked ahead
  double clock_;  ///< as callers know it
  double horizon_;
  double idle_until_ = -never;  ///< before it there is nothing to do; an edit resets it
  double next_time_ = -never;   ///< as next_time() has found it; -never if it has not been asked for
  double removed_at_ = -never;
  std::size_t alive_ = 0;
  std::size_t unlisted_ = 0;    ///< pairs that the broad phase does not list
  bool meshes_ = false;         ///< there is or has been one, so volumes have room for contact gaps
  bool box_functions_ = false;  ///< some body has or had one
  bool filters_ = false;        ///< some body does not collide with all others, or did not
  bool inserting_ = false;
  bool stepping_ = false;
  bool telling_ = false;          ///< a listener is being told, or has thrown
  bool in_box_function_ = false;  ///< a function of the caller's is making a box
  std::exception_ptr failure_;    ///< what has left the world in pieces
  EditLimit edits_;
};

extern template class World<1>;
extern template class World<2>;

}  // namespace kds::collision
