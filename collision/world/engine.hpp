// What a world does next: its clock, and the part whose event is due.
#pragma once

#include "collision/profile.hpp"
#include "collision/world/callers_clock.hpp"
#include "collision/world/contact_response.hpp"
#include "collision/world/edits/edits.hpp"
#include "collision/world/guard.hpp"
#include "collision/world/listener_calls.hpp"
#include "collision/world/membership.hpp"
#include "collision/world/motion_updates.hpp"
#include "collision/world/queries.hpp"
#include "collision/world/transfer/transfer.hpp"
#include "collision/world/world_parts.hpp"
#include "collision/world_listener.hpp"
#include "collision/world_options.hpp"

#include <chrono>
#include <cstddef>
#include <optional>

namespace kds::collision {

/// The implementation of a BasicWorld (world.hpp documents the public functions): it runs the clock, and lets the part
/// whose event is next process it. What events and callers change is done by the classes that it is made of.
template <class BodyMotionType>
class Engine {
 public:
  using Motion = BodyMotionType;
  using Listener = BasicWorldListener<Motion>;

  /// `world` is what callbacks are given.
  Engine(BasicWorld<Motion>& world, const WorldOptions& options, Listener* listener);
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// What callers change and ask. Bodies that have been left alone (turning/turning_pieces.cpp) are looked at before
  /// anything is changed. Between two calls they have their present pieces, so to ask changes nothing; within one, by
  /// listeners, they have not.
  Edits<Motion>& edits() { return look_at_all(), edits_; }
  const Queries<Motion>& queries() { return look_within_step(), queries_; }
  WorldCounters counters() { return look_within_step(), parts_.all_counters(); }
  const Motion& motion(BodyId id);
  double now() const { return queries_.now(); }
  Transfer<Motion>& transfer() { return transfer_; }
  const Transfer<Motion>& transfer() const { return transfer_; }
  const WorldParts<Motion>& parts() const { return parts_; }
  const Bodies<Motion>& bodies() const { return parts_.bodies; }

  void advance_to(double t);
  bool step(double limit);
  bool advance_for(double budget_seconds, double t);
  double next_time();
  bool process();
  void extend_horizon(double horizon);
  void audit(double t);

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

 private:
  using WallClock = std::chrono::steady_clock;

  // What follows from the next event of a part, which is due. True if it ends a step (reports do so themselves).
  bool process(Scripts<Motion>&) { return motions_.start_pieces(part_of_work()), true; }
  bool process(Tumbling<Motion>&);
  bool process(BoxTimes<detail::PairRank>&) { return parts_.pairs.process_boxes(), false; }
  bool process(Volumes<Motion>&);
  bool process(Timers&) { return calls_.ring(), true; }
  bool process(WallTimes<Motion>&) { return response_.process_wall(), true; }
  bool process(RestingPart<Motion>&) { return parts_.resting.process(), false; }
  bool process(Pairs<Motion>&) { return response_.process_pair(), true; }
  bool process(SelfContacts<Motion>&) { return response_.process_self_contact(), true; }
  bool process(Unbounded<Motion>&) { return false; }  // It has none.
  bool next_step(double limit);
  /// Bodies that precess and have been left alone get the pieces that they would have otherwise.
  void look_at_all() {
    if constexpr (turns<Motion>) {
      if (parts_.tumbling.any_alone()) [[unlikely]]
        look_at_alone();
    }
  }
  void look_at_alone();
  void look_within_step() {
    if (guard_.stepping()) look_at_all();
  }
  /// Whether an event that is due changes what can be observed.
  bool happens(const auto&) const { return true; }
  bool happens(const Volumes<Motion>& volumes) const { return volumes.from_caller(volumes.next_body()); }
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

  WorldParts<Motion> parts_;
  Clock& clock_;  ///< of the parts; ahead of callers_.now when next_time() has looked ahead
  CallersClock callers_;
  Guard guard_;
  ListenerCalls<Motion> calls_;
  MotionUpdates<Motion> motions_;
  Membership<Motion> membership_;
  ContactResponse<Motion> response_;
  Edits<Motion> edits_;
  Queries<Motion> queries_;
  Transfer<Motion> transfer_;
  /// When advance_for() is to return. Until then work that may be much at one instant is done in small parts.
  std::optional<WallClock::time_point> deadline_;
};

}  // namespace kds::collision
