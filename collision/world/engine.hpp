// What a world does: its parts, its clock, and what follows from their events.
#pragma once

#include "collision/body_description.hpp"
#include "collision/body_motion.hpp"
#include "collision/broad_phase/broad_phase.hpp"
#include "collision/free_turning.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/narrow_phase/surface_rate.hpp"
#include "collision/profile.hpp"
#include "collision/response/turning_impulse.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/body_progress.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/edit_limit.hpp"
#include "collision/world/pairs.hpp"
#include "collision/world/reports.hpp"
#include "collision/world/resting_contacts.hpp"
#include "collision/world/scripts.hpp"
#include "collision/world/self_contacts.hpp"
#include "collision/world/timers.hpp"
#include "collision/world/turning/tumbling.hpp"
#include "collision/world/turning/turning_impact.hpp"
#include "collision/world/unbounded.hpp"
#include "collision/world/volumes.hpp"
#include "collision/world/wall_times.hpp"
#include "collision/world/world_part.hpp"
#include "collision/world_counters.hpp"
#include "collision/world_listener.hpp"
#include "collision/world_options.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace kds::collision {

template <class Motion>
struct Parcel;

/// The implementation of a BasicWorld (world.hpp documents the public functions): it owns the parts (docs/design.md),
/// lets the part whose event is next process it, passes the consequences on to the other parts, and calls the listener.
template <class BodyMotionType>
class Engine final : private RestingListener<BodyMotionType> {
 public:
  using Motion = BodyMotionType;
  using Description = BasicBodyDescription<Motion>;
  using Listener = BasicWorldListener<Motion>;

  /// `world` is what callbacks are given.
  Engine(BasicWorld<Motion>& world, const WorldOptions& options, Listener* listener);
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  BodyId add_body(const Description& description);
  void reserve(std::size_t bodies);
  void remove_body(BodyId id);
  void update_motion(BodyId id, std::span<const Motion> pieces);
  void append_motion(BodyId id, std::span<const Motion> pieces);
  void update_vertices(BodyId id, std::vector<MeshScript::Keyframe> keyframes);
  void set_mass(BodyId id, double mass);
  void set_restitution(BodyId id, double restitution);
  void set_filter(BodyId id, std::uint32_t category, std::uint32_t collides_with);
  void set_group(BodyId id, std::uint32_t group);
  void ignore_pair(BodyId a, BodyId b, bool ignored);
  void set_user_data(BodyId id, std::uint64_t user_data);
  TimerId set_timer(double t);
  bool cancel_timer(TimerId timer);

  void advance_to(double t);
  bool step(double limit);
  bool advance_for(double budget_seconds, double t);
  double next_time();
  bool process();
  void extend_horizon(double horizon);
  void audit(double t) const;

  double now() const { return stepping_ ? clock_.now : callers_now_; }
  const Bodies<Motion>& bodies() const { return bodies_; }
  Motion free_motion(BodyId id) const;
  FreeTurning free_turning(BodyId id) const requires(turns<Motion>);
  bool touching(BodyId a, BodyId b) const;
  bool resting(BodyId a, BodyId b) const;
  bool resting_at_wall(BodyId a, int wall) const;
  WorldCounters counters() const;
  std::string_view broad_phase() const { return broad_phase_->name(); }
  const Profile& work_profile() const { return profile_; }

  void visit_partners(BodyId id, BodyVisitor visit) const;
  void visit_overlapping(const Eigen::Vector3d& min, const Eigen::Vector3d& max, BodyVisitor visit) const;
  void visit_swept(const KineticBox<Motion::degree>& box, double until, BodyVisitor visit) const;

  // snapshot.cpp
  struct Image;  // engine_image.hpp
  Image image() const;
  /// The same at t, but for the bodies, which are saved elsewhere; others may have them.
  Image image_without_bodies(double t) const;
  /// Writes an image, or reads and checks one that this can become. Throws as BasicWorld::archive().
  template <class Archive>
  void archive(Archive& archive, Image& image) const;
  void become(const Image& image);
  template <class Archive>
  void archive(Archive& archive);

  // transfer.cpp: bodies that several worlds have, each for a part of the scene (parallel/parallel_world.hpp). A world
  // takes in bodies of another one in the middle of their history, and all that follows is the same, bit for bit: they
  // have the motions, scripts and counts of the other world, their pairs begin as pairs of bodies that move past each
  // other do, and pairs that overlap there overlap here.
  /// Two bodies, by slots, that overlap, and Pair::passes_at.
  struct Overlap {
    BodySlot a, b;
    double passes_at;
  };
  /// Whether descriptions, scripts and progress of bodies, and the pairs that overlap, decide all later events.
  bool is_divisible() const;
  const Scripts<Motion>& scripts() const { return scripts_; }
  const Timers& timers() const { return timers_; }
  /// Takes in bodies of another world with the same options and clock, by their slots there; their numbers ascend.
  /// Those that have not entered there enter with the next step, or when their motion begins. A sensor and the body to
  /// which it is attached come together. `known`: the slots of the bodies that were taken in before, by their numbers.
  /// `ignored`: by numbers. Returns the slots, in the same order.
  std::vector<BodySlot> take_in(const Engine& from, std::span<const BodySlot> slots, std::span<const BodySlot> known,
                                const IgnoredPairs& ignored);
  /// Removes bodies that another world goes on with: nothing is reported.
  void let_go(std::span<const BodySlot> slots);
  /// The overlaps of bodies that have been taken in, by their slots here.
  void go_on_overlapping(std::span<const Overlap> overlaps);
  std::vector<Overlap> overlaps() const;
  BodyProgress<Motion> progress(BodySlot slot) const {
    return {bodies_.motion(slot), bodies_[slot].meetings, bodies_[slot].burst_start, tumbling_.progress(slot)};
  }
  /// A body that belongs to another world continues from its state there. The first, for different bodies, may be
  /// called by several threads at once.
  void go_on_from(BodySlot slot, const BodyProgress<Motion>& progress);
  void note_meeting(BodySlot slot) { resting_.note_meeting(slot); }
  /// Whether it has met a body that is not fixed.
  bool has_met(BodySlot slot) const { return resting_.has_met(slot); }
  /// Bodies of a world that only stores a part of them, as plain data. `meshes`: all meshes of the scene.
  Parcel<Motion> pack(std::span<const BodySlot> slots, std::vector<std::shared_ptr<const Mesh>> meshes) const;
  /// Stores those of a parcel, whose numbers are slots of `whole`; attach() follows. Returns the slots, in order.
  std::vector<BodySlot> store(const Parcel<Motion>& parcel, const Engine& whole);
  void attach(BodySlot sensor, BodySlot owner) { bodies_.attach(sensor, owner); }
  /// Forgets bodies that have been stored.
  void forget(std::span<const BodySlot> slots);
  /// The bodies that have been added get the numbers `first`, `first` + 1, ...
  void number_from(BodySlot first) { bodies_.number_from(first); }
  /// Others store the bodies of this world, and it forgets them until take_back(); then they are put_back() one by one,
  /// and it is whole with go_on(). `bodies`: of so many that have been added elsewhere.
  void lend();
  void lend(std::size_t bodies) { bodies_.lend(bodies); }
  void take_back() { bodies_.take_back(); }
  void put_back(const Parcel<Motion>& parcel);
  /// Other worlds have run to t: bodies have entered, pieces of scripts have begun. Returns the timers that have rung.
  std::vector<Timers::Image::One> note_passed(double t);
  void set_aside();  ///< Forgets all but the bodies, until go_on().
  /// Goes on at t with the bodies as they are then.
  void go_on(double t, std::span<const Overlap> overlaps);

 private:
  using Body = detail::Body<Motion>;
  using Mover = typename Bodies<Motion>::Mover;
  using WallClock = std::chrono::steady_clock;
  using Entry = typename BroadPhase<Motion::degree>::Entry;
  using Resting = RestingPart<Motion>;
  using Begin = typename Pairs<Motion>::Begin;

  // engine.cpp: the clock
  /// The parts, in the order in which their events are processed if they are due at one time (world_part.hpp).
  auto parts() { return list(*this); }
  auto parts() const { return list(*this); }
  template <class Self>
  static auto list(Self& self) {
    return PartList(self.scripts_, self.tumbling_, self.pairs_.box_times(), self.volumes_, self.timers_, self.walls_,
                    self.resting_, self.pairs_, self.self_contacts_, self.unbounded_);
  }
  // What follows from the next event of a part, which is due. True if it ends a step (reports do so themselves).
  bool process(Scripts<Motion>&) { return start_pieces(), true; }
  bool process(Tumbling<Motion>&);
  bool process(BoxTimes<detail::PairRank>&) { return pairs_.process_boxes(), false; }
  bool process(Volumes<Motion>&);
  bool process(Timers&) { return ring(), true; }
  bool process(WallTimes<Motion>&) { return process_wall(), true; }
  bool process(Resting&) { return resting_.process(), false; }
  bool process(Pairs<Motion>&) { return process_meeting(), true; }
  bool process(SelfContacts<Motion>&) { return process_self_contact(), true; }
  bool process(Unbounded<Motion>&) { return false; }  // It has none.
  /// Whether an event that is due changes what can be observed.
  bool happens(const auto&) const { return true; }
  bool happens(const Volumes<Motion>&) const { return volumes_.from_caller(volumes_.next_body()); }
  /// Whether the search for the next event processes it, or stops before it.
  enum class Search { makes, looks };
  bool next_event(double limit, Search search = Search::makes);
  void prefetch_coming() const;
  bool guarded_event(double limit, Search search);
  std::size_t part_of_work() const;
  bool late() const { return deadline_ && WallClock::now() >= *deadline_; }
  /// How far the broad phase has come: to the end, to a pair that it has reported, or until the deadline.
  enum class Ran { all, to_a_pair, until_late };
  Ran run_broad_phase(double until);
  bool work_left() const { return bodies_.any_waits() || !resting_.solved() || !pairs_.tested() || !reports_.empty(); }
  void make_broad_phase();
  void rebuild_broad_phase();
  void set_horizon(double limit);
  void go_back(double t);
  void start_pieces();
  void ring();
  void count_edit(bool of_bodies = true);

  // guards.cpp: what may be called when, and the state after an exception
  [[noreturn]] void refuse(const char* function) const;
  void require_whole(const char* function) const {
    if (failure_) [[unlikely]]
      refuse(function);
  }
  /// For functions that change bodies, which callbacks may call. `body`: the one that is removed, if one is.
  void require_editable(const char* function, BodySlot body = no_body) {
    if (failure_ || volumes_.calling()) [[unlikely]]
      refuse(function);
    if (bounced_ != no_body && bounced_ != body) change_or_fail([&] { take_up_bounce(); });
    if (!stepping_ && clock_.now > callers_now_) [[unlikely]]
      change_or_fail([&] { go_back(callers_now_); });
  }
  /// For functions that run, save or load the world.
  void require_idle(const char* function) const {
    if (failure_ || volumes_.calling() || stepping_) [[unlikely]]
      refuse(function);
  }
  void note_failure();
  /// Makes a change. An exception in the middle of it leaves the world broken.
  template <class Change>
  auto change_or_fail(const Change& change) {
    try {
      return change();
    } catch (...) {
      note_failure();
      throw;
    }
  }
  /// Calls the listener: in a step, when the world is consistent, which it still is if the listener throws.
  template <class Call>
  void tell(const Call& call) {
    telling_ = true;
    call(*listener_);
    telling_ = false;
    require_whole("World::step");  // The listener may have caught the exception of a change that it made.
  }

  // telling.cpp: reports
  void report_next();
  void report_resting(const Reports::Report& event, const PairEvent& pair);

  // edits.cpp: bodies that are added and removed
  BodyId add_attached(const Description& description);
  BodySlot put(const Description& description, std::shared_ptr<const PlacedShape> shape,
               const std::optional<PrincipalInertia>& principal);
  void make_room_for_meshes();
  void enter_new_bodies(std::size_t most);
  void enter(std::span<const BodySlot> entering, Begin begin);
  void expect_new_bodies();
  void take_out(BodySlot slot);
  void update_volume(BodySlot slot, const KineticBox<Motion::degree>& box);

  // motion_edits.cpp: bodies that are moved
  void require_own_motion(BodySlot slot, const char* function) const;
  void wait_to_enter(BodySlot slot);
  void move_attached(BodySlot slot, bool jumped);
  void require_turns_for(BodySlot slot, std::span<const Motion> pieces, const char* name) const;
  void give(BodySlot slot, const Motion& motion);
  void set_motion(BodySlot slot, const Motion& motion, bool jumped);

  // property_edits.cpp: bodies whose properties change
  void move_freely(BodySlot slot, const Motion& motion);
  void give_filter(BodySlot slot, const CollisionFilter& after);
  template <class Change>
  void filter_anew(BodySlot slot, const Change& change);

  // response.cpp: what follows from contacts
  void process_meeting();
  PairEvent event_of(BodySlot a, BodySlot b, const Contact& contact) const {
    return {bodies_.id_of(a), bodies_.id_of(b), contact, bodies_[a].user_data, bodies_[b].user_data};
  }
  void process_self_contact();
  void process_contact(BodySlot a, BodySlot b, const Contact& contact);
  void let_through(BodySlot a, BodySlot b, const Contact& contact);
  std::uint64_t count_meeting(BodySlot a, BodySlot b);
  std::uint64_t count_meeting(BodySlot slot);
  std::uint64_t patience() const { return 10 * std::uint64_t{options_.zeno.contacts}; }

  // bounces.cpp: of bodies that keep their orientation
  /// Rate at which b parts from a along the normal just after the contact.
  double parting(BodySlot a, BodySlot b, const Contact& contact) const requires(!turns<Motion>);
  void process_wall() requires(!turns<Motion>);
  void bounce_off_wall(BodySlot slot, const Motion& motion) requires(!turns<Motion>);
  void take_up_bounce();
  /// Of two bodies that have met others `burst` times at nearly one time. Returns whether the Zeno policy acted.
  bool respond(BodySlot a, BodySlot b, const Contact& contact, std::uint64_t burst) requires(!turns<Motion>);
  bool strike(BodySlot a, BodySlot b, const Contact& contact, double restitution) requires(!turns<Motion>);
  bool bounce_or_rest(BodySlot a, BodySlot b, const Contact& contact, double restitution,
                      std::uint64_t burst) requires(!turns<Motion>);
  void begin_rest(BodySlot a, BodySlot b, const Contact& contact) requires(!turns<Motion>);
  bool stays(double rebound, double pressed, double size, std::uint64_t burst) const;
  bool endless(std::uint64_t burst) const;
  void bounce_off_surface(BodySlot a, BodySlot b, const Contact& contact, std::uint64_t burst) requires(!turns<Motion>);
  // bending_bounces.cpp: of meshes that bend
  bool bends(BodySlot slot) const { return bodies_[slot].shape && collision::bends(bodies_[slot].shape->shape); }
  bool bends(BodySlot a, BodySlot b) const { return bends(a) || bends(b); }
  SurfaceRate surface_rate(BodySlot slot, const Contact& contact, bool is_a) const;
  /// The velocity of the surface of b less that of the surface of a.
  Eigen::Vector3d surface_velocity(BodySlot a, BodySlot b, const Contact& contact) const;
  double rebound_off_surface(BodySlot a, BodySlot b, const Contact& contact, double approach,
                             std::uint64_t burst) const;

  // turning/turning_bounces.cpp: of bodies that turn
  double parting(BodySlot a, BodySlot b, const Contact& contact) const requires(turns<Motion>);
  double rebound(double approach, double pressed, double restitution) const requires(turns<Motion>);
  void process_wall() requires(turns<Motion>);
  bool respond(BodySlot a, BodySlot b, const Contact& contact, std::uint64_t burst) requires(turns<Motion>);
  bool rests_now(BodySlot a, BodySlot b, const Contact& contact) requires(turns<Motion>);
  // turning/turning_pieces.cpp: of bodies that precess
  void turn_on() requires(turns<Motion>);
  double left_alone_until(BodySlot slot) const requires(turns<Motion>);
  void look_at(BodySlot slot) requires(turns<Motion>);
  void look_at_tested() requires(turns<Motion>);
  void turn(BodySlot slot, const Motion& motion) requires(turns<Motion>);
  bool precesses(BodySlot slot) const { return tumbling_.has(slot) && !resting_.carries(slot); }
  Mobility mobility(BodySlot slot) const requires(turns<Motion>);
  Motion met(BodySlot slot, double t) requires(turns<Motion>);
  TurningImpact<Motion> impact(BodySlot a, BodySlot b, const Contact& contact,
                               std::uint64_t burst) requires(turns<Motion>);
  Collapse part_together(BodySlot a, BodySlot b, const Contact& contact, const TurningImpact<Motion>& hit,
                         std::uint64_t burst) requires(turns<Motion>);  // turning/turning_collapse.cpp
  void turn_back(BodySlot a, BodySlot b, Motion& motion_a, Motion& motion_b,
                 const Contact& contact) requires(turns<Motion>);

  /// Changes the motion of a body that takes no part in the event, and reports it.
  void change_motion(BodySlot slot, const Motion& motion);
  // Reports of resting contacts (RestingListener).
  void take_up(BodySlot slot, const Motion& motion) override;
  void changed(BodySlot a, BodySlot b) override { pairs_.changed(a, b); }
  void let_pass(BodySlot a, BodySlot b) override { pairs_.let_pass(a, b); }
  void tell_rebound_suppressed(BodySlot a, BodySlot b) override;
  void tell_resting(bool begins, const detail::RestingContact& contact) override;
  void tell_passes(const detail::RestingContact& contact) override;
  Contact contact_of(const detail::RestingContact& contact) const;

  // transfer.cpp
  bool has_begun(BodySlot slot) const { return bodies_.path(slot).start <= clock_.now; }
  void relate(const Engine& from, std::span<const BodySlot> slots, std::span<const BodySlot> taken,
              std::span<const BodySlot> known, const IgnoredPairs& ignored);
  void resume(const Parcel<Motion>& parcel, std::size_t place, BodySlot slot);

  // near.cpp: queries
  template <class Ask, class Meets>
  void answer(const char* function, const Ask& ask, const Meets& meets, BodyVisitor visit) const;

  Profile* profile() { return options_.profile ? &profile_ : nullptr; }

  BasicWorld<Motion>& world_;
  const WorldOptions options_;
  Listener* listener_;
  Listener silent_;
  Clock clock_;  ///< ahead of callers_now_ when next_time() has looked ahead
  WorldCounters counters_;
  Profile profile_;
  // The parts, each with a state, a queue and laws of its own.
  Bodies<Motion> bodies_;
  Scripts<Motion> scripts_;
  Timers timers_;
  Tumbling<Motion> tumbling_;
  Volumes<Motion> volumes_;
  WallTimes<Motion> walls_;
  Reports reports_;
  Resting resting_;
  Pairs<Motion> pairs_;
  Unbounded<Motion> unbounded_;
  SelfContacts<Motion> self_contacts_;
  std::unique_ptr<BroadPhase<Motion::degree>> broad_phase_;
  EditLimit edits_;
  /// When advance_for() is to return. Until then work that may be much at one instant is done in small parts.
  std::optional<WallClock::time_point> deadline_;
  std::size_t expected_ = 0;         ///< the broad phase has been told of the bodies in slots below this
  BodySlot reserved_ = 0;            ///< it has been asked to make room for those below this
  double callers_now_;               ///< the clock as callers know it
  double looked_for_until_ = never;  ///< the horizon of a simulator: later events need not be found by next_time()
  double idle_until_ = -never;       ///< nothing is due before it; an edit resets it
  bool idle_for_ever_ = false;       ///< no event comes at all; an edit resets it
  double next_time_ = -never;        ///< the result of next_time(); -never if there is none
  /// While a bounce off a wall is reported: the body, which is often removed, so that no part has its new motion yet.
  BodySlot bounced_ = no_body;
  bool stepping_ = false;
  bool telling_ = false;        ///< a listener is being told, or has thrown
  std::exception_ptr failure_;  ///< the exception that has left the world broken
};

}  // namespace kds::collision
