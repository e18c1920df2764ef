// A replay of a world of the caller's own.
#pragma once

#include "collision/world.hpp"
#include "io/world_pictures.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>

namespace kds::io {

/// Records what happens in a world of any degree, from where it is first seen on. It is a listener, and tells another,
/// if there is one, of all that it is told:
///
///     kds::io::WorldRecorder<World<2>::Motion> recorder(options, &mine);
///     World<2> world(options, &recorder);
///     ...                                              // add bodies,
///     recorder.look(world);                            // advance, change, look,
///     out << recorder.page(world, "my world");         // an HTML file that plays it
///
/// Motions that events change are recorded at their times; so are the pieces of motions that are given in pieces, if
/// the world has WorldOptions::report_pieces. What the caller does between events - to add, remove or move bodies - is
/// recorded by look(), which page() calls, too: call it after such changes, else they count from the next event of the
/// body, or the next look, on. A mesh that bends is shown with the keyframes that it has when it is first seen, and a
/// body that enters later from then on.
///
/// Cost: O(1) an event; look() O(n log n) for n bodies.
template <class BodyMotionType>
class WorldRecorder final
    : public kds::collision::BasicWorldListener<BodyMotionType>,
      public WorldPictures<WorldRecorder<BodyMotionType>, kds::collision::BasicWorld<BodyMotionType>> {
  using Pictures = WorldPictures<WorldRecorder<BodyMotionType>, kds::collision::BasicWorld<BodyMotionType>>;
  friend Pictures;

 public:
  using Motion = BodyMotionType;
  using World = kds::collision::BasicWorld<Motion>;
  using Listener = kds::collision::BasicWorldListener<Motion>;
  using BodyId = kds::collision::BodyId;
  using PairEvent = kds::collision::PairEvent;
  using WallEvent = kds::collision::WallEvent;

  /// `options`: those of the world. `listener` must outlive the recorder.
  explicit WorldRecorder(const kds::collision::WorldOptions& options, Listener* listener = nullptr)
      : Pictures(options.start_time, options.response, kds::collision::turns<Motion>, domain_of(options)),
        listener_(listener ? *listener : silent_) {}

 private:
  static std::optional<Domain> domain_of(const kds::collision::WorldOptions& options) {
    if (!options.walls) return {};
    return Domain{options.walls->min, options.walls->max, true, options.walls->restitution};
  }
  static void visit(const World& world, const auto& see) { world.visit_bodies(see); }
  static SceneBody describe(const World& world, BodyId id) {
    const kds::collision::PlacedShape placed = world.shape(id);
    SceneBody body;
    body.shape = placed.shape;
    body.orientation = Eigen::Quaterniond(placed.rotation);
    if constexpr (kds::collision::turns<Motion>) body.orientation = world.motion(id).orientation.normalized();
    body.fixed = world.fixed(id);
    body.sensor = world.sensor(id);
    return body;
  }

  void contact(World& world, const PairEvent& event) override {
    relay(world, EventKind::contact, event, &Listener::contact);
  }
  void separation(World& world, const PairEvent& event) override {
    relay(world, EventKind::separation, event, &Listener::separation);
  }
  void overlap(World& world, const PairEvent& event) override {
    relay(world, EventKind::overlap, event, &Listener::overlap);
  }
  void rests(World& world, const PairEvent& event) override { relay(world, EventKind::rest, event, &Listener::rests); }
  void wakes(World& world, const PairEvent& event) override { relay(world, EventKind::wake, event, &Listener::wakes); }
  void passes(World& world, const PairEvent& event) override {
    relay(world, EventKind::pass, event, &Listener::passes);
  }
  void wall(World& world, const WallEvent& event) override { relay(world, EventKind::wall, event, &Listener::wall); }
  void rests_at_wall(World& world, const WallEvent& event) override {
    relay(world, EventKind::rest_at_wall, event, &Listener::rests_at_wall);
  }
  void wakes_at_wall(World& world, const WallEvent& event) override {
    relay(world, EventKind::wake_at_wall, event, &Listener::wakes_at_wall);
  }
  bool hears_pieces() const override { return true; }  // A replay shows each piece.
  void moved(World& world, BodyId id) override {
    listener_.moved(world, id);
    this->see_if_there(world, id);
  }
  void piece(World& world, BodyId id) override {
    listener_.piece(world, id);
    this->see_if_there(world, id);
  }
  void timer(World& world, kds::collision::TimerId timer) override {
    listener_.timer(world, timer);
    this->look(world);  // What it is for is to change something.
  }
  void rebound_suppressed(World& world, const PairEvent& event) override { listener_.rebound_suppressed(world, event); }
  void rebound_suppressed_at_wall(World& world, const WallEvent& event) override {
    listener_.rebound_suppressed_at_wall(world, event);
  }
  void pair_began(World& world, BodyId a, BodyId b, double t) override { listener_.pair_began(world, a, b, t); }
  void pair_ended(World& world, BodyId a, BodyId b, double t) override { listener_.pair_ended(world, a, b, t); }

  /// Notes an event, tells the listener, and records what that has changed.
  void relay(World& world, EventKind kind, const PairEvent& event, void (Listener::*tell)(World&, const PairEvent&)) {
    this->note(world, kind, event.a, event.b, event.contact);
    (listener_.*tell)(world, event);
    this->see_if_there(world, event.a);
    this->see_if_there(world, event.b);
  }
  void relay(World& world, EventKind kind, const WallEvent& event, void (Listener::*tell)(World&, const WallEvent&)) {
    this->note_wall(world, kind, event.body, event.wall, event.contact);
    (listener_.*tell)(world, event);
    this->see_if_there(world, event.body);
  }

  Listener silent_;
  Listener& listener_;
};

}  // namespace kds::io
