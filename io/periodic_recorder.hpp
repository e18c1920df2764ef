// A replay of a periodic world.
#pragma once

#include "collision/periodic/periodic_world.hpp"
#include "io/world_pictures.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

namespace kds::io {

/// Records what happens in a PeriodicWorld, as WorldRecorder does of a World:
///
///     kds::io::PeriodicRecorder<1> recorder(options, &mine);
///     PeriodicWorld<1> world(options, &recorder);
///
/// Bodies are drawn where the world has them, in the box, and jump from one end of it to the other; their images are
/// not drawn. The box is drawn where no axis of it is open. A periodic world does not tell when bodies come to rest at
/// a wall: look() records that.
template <int Degree>
class PeriodicRecorder final : public kds::collision::PeriodicListener<Degree>,
                               public WorldPictures<PeriodicRecorder<Degree>, kds::collision::PeriodicWorld<Degree>> {
  using Pictures = WorldPictures<PeriodicRecorder<Degree>, kds::collision::PeriodicWorld<Degree>>;
  friend Pictures;

 public:
  using World = kds::collision::PeriodicWorld<Degree>;
  using Listener = kds::collision::PeriodicListener<Degree>;
  using BodyId = kds::collision::BodyId;
  using PeriodicEvent = kds::collision::PeriodicEvent;
  using WallEvent = kds::collision::WallEvent;
  using Offset = kds::collision::Offset;

  /// `options`: those of the world. `listener` must outlive the recorder.
  explicit PeriodicRecorder(const kds::collision::PeriodicOptions& options, Listener* listener = nullptr)
      : Pictures(options.world.start_time, Response::elastic, false, domain_of(options)),
        listener_(listener ? *listener : silent_) {}

 private:
  using Boundary = kds::collision::Boundary;

  static std::optional<Domain> domain_of(const kds::collision::PeriodicOptions& options) {
    const auto has = [&](Boundary kind) {
      return std::count(options.boundaries.begin(), options.boundaries.end(), kind) > 0;
    };
    if (has(Boundary::open)) return {};
    return Domain{options.min, options.max, !has(Boundary::periodic)};
  }
  static void visit(const World& world, const auto& see) {
    const Eigen::Vector3d everywhere = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    world.world().visit_overlapping(-everywhere, everywhere, [&](BodyId in_world) {
      const auto owner = world.owner(in_world);
      if (owner.offset == Offset{}) see(owner.body);
    });
  }
  static SceneBody describe(const World& world, BodyId id) {
    const BodyId in_world = world.in_world(id);
    const kds::collision::PlacedShape placed = world.world().shape(in_world);
    SceneBody body;
    body.shape = placed.shape;
    body.orientation = Eigen::Quaterniond(placed.rotation);
    body.fixed = world.world().fixed(in_world);
    return body;
  }

  void contact(World& world, const PeriodicEvent& event) override {
    relay(world, EventKind::contact, event, &Listener::contact);
  }
  void overlap(World& world, const PeriodicEvent& event) override {
    relay(world, EventKind::overlap, event, &Listener::overlap);
  }
  void passes(World& world, const PeriodicEvent& event) override {
    relay(world, EventKind::pass, event, &Listener::passes);
  }
  void wall(World& world, const WallEvent& event) override {
    this->note_wall(world, EventKind::wall, event.body, event.wall, event.contact);
    listener_.wall(world, event);
    this->see_if_there(world, event.body);
  }
  void wrapped(World& world, BodyId id, const Offset& offset) override {
    listener_.wrapped(world, id, offset);
    this->see_if_there(world, id);
  }

  /// Notes an event, tells the listener, and records what that has changed.
  void relay(World& world, EventKind kind, const PeriodicEvent& event,
             void (Listener::*tell)(World&, const PeriodicEvent&)) {
    this->note(world, kind, event.a, event.b, event.contact);
    (listener_.*tell)(world, event);
    this->see_if_there(world, event.a);
    this->see_if_there(world, event.b);
  }

  Listener silent_;
  Listener& listener_;
};

}  // namespace kds::io
