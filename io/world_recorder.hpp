// A replay of a world of the caller's own.
#pragma once

#include "collision/shapes/mesh_script.hpp"
#include "collision/world.hpp"
#include "io/gltf.hpp"
#include "io/replay.hpp"
#include "io/scene_world.hpp"
#include "io/vtk.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

namespace kds::io {

/// Records what happens in a world, from where it is first seen on. It is a listener, and tells another, if there is
/// one, of all that it is told:
///
///     kds::io::WorldRecorder<World<2>::Motion> recorder(options, &mine);
///     World<2> world(options, &recorder);
///     ...                                              // add bodies,
///     recorder.look(world);                            // advance, change, look,
///     out << recorder.page(world, "my world");         // an HTML file that plays it
///
/// Motions that events change are recorded at their times. What the caller does between events - to add, remove or move
/// bodies - is recorded by look(), which page() calls, too: call it after such changes, else they count from the next
/// event of the body, or the next look, on. A mesh that bends is shown with the keyframes that it has when it is first
/// seen.
///
/// Cost: O(1) an event; look() O(n log n) for n bodies.
template <class BodyMotionType>
class WorldRecorder final : public kds::collision::BasicWorldListener<BodyMotionType> {
 public:
  using Motion = BodyMotionType;
  static_assert(Motion::degree <= 2, "WorldRecorder: a replay has paths of degree 1 and 2");
  using World = kds::collision::BasicWorld<Motion>;
  using Listener = kds::collision::BasicWorldListener<Motion>;
  using BodyId = kds::collision::BodyId;
  using PairEvent = kds::collision::PairEvent;
  using WallEvent = kds::collision::WallEvent;

  /// `options`: those of the world. `listener` must outlive the recorder.
  explicit WorldRecorder(const kds::collision::WorldOptions& options, Listener* listener = nullptr)
      : listener_(listener ? *listener : silent_) {
    scene_.begin_time = options.start_time;
    scene_.response = options.response == Response::none ? Response::none : Response::elastic;
    scene_.turning = kds::collision::turns<Motion>;
    if (options.walls) {
      scene_.domain = Domain{options.walls->min, options.walls->max, Walls::reflect, options.walls->restitution};
    }
  }

  /// Records which bodies are there, and their motions.
  void look(const World& world) {
    std::vector<BodyId> gone;
    for (const auto& [id, place] : places_) {
      if (!world.contains(id)) gone.push_back(id);
    }
    for (const BodyId id : gone) see_if_there(world, id);
    const Eigen::Vector3d everywhere = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    world.visit_overlapping(-everywhere, everywhere, [&](BodyId id) { see(world, id); });
  }

  /// The page, from the time at which the world began to now(). Throws ReplayError where three.js is not found.
  std::string page(const World& world, const std::string& title,
                   const std::filesystem::path& three_folder = default_three_folder()) {
    return replay_page(to_json(world, title), three_folder);
  }
  /// An animation (gltf.hpp), of the same time.
  std::string gltf(const World& world, const std::string& title, double frames_per_second = 60) {
    look(world);
    scene_.end_time = world.now();
    return to_gltf(scene_, record_, title, frames_per_second);
  }
  /// Surfaces as files (VtkSeries in vtk.hpp), of the same time.
  void write_vtk(const World& world, const std::string& path, double frames_per_second = 60) {
    look(world);
    scene_.end_time = world.now();
    VtkSeries series(path);
    series.write(scene_, record_, frames_per_second);
    series.commit();
  }
  /// The data of the page.
  std::string to_json(const World& world, const std::string& title) {
    look(world);
    scene_.end_time = world.now();
    return record_.to_json(scene_, title);
  }

 private:
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
  void moved(World& world, BodyId id) override {
    listener_.moved(world, id);
    see_if_there(world, id);
  }
  void piece(World& world, BodyId id) override {
    listener_.piece(world, id);
    see_if_there(world, id);
  }
  void timer(World& world, kds::collision::TimerId timer) override {
    listener_.timer(world, timer);
    look(world);  // What it is for is to change something.
  }
  void rebound_suppressed(World& world, const PairEvent& event) override { listener_.rebound_suppressed(world, event); }
  void rebound_suppressed_at_wall(World& world, const WallEvent& event) override {
    listener_.rebound_suppressed_at_wall(world, event);
  }
  void pair_began(World& world, BodyId a, BodyId b, double t) override { listener_.pair_began(world, a, b, t); }
  void pair_ended(World& world, BodyId a, BodyId b, double t) override { listener_.pair_ended(world, a, b, t); }

  /// Notes an event, tells the listener, and records what that has changed.
  template <class AnyEvent>
  void relay(World& world, EventKind kind, const AnyEvent& event, void (Listener::*tell)(World&, const AnyEvent&)) {
    note(world, kind, event);
    (listener_.*tell)(world, event);
    see_bodies(world, event);
  }

  /// Of bodies that have been removed only what was seen of them before counts.
  void note(const World& world, EventKind kind, const PairEvent& event) {
    see_bodies(world, event);
    const auto a = places_.find(event.a), b = places_.find(event.b);
    if (a == places_.end() || b == places_.end()) return;
    record_.on_event(
        {event.contact.time, kind, a->second, b->second, event.contact.point, event.contact.normal, {}, {}});
  }
  void note(const World& world, EventKind kind, const WallEvent& event) {
    see_if_there(world, event.body);
    const auto body = places_.find(event.body);
    if (body == places_.end()) return;
    const kds::collision::Contact& c = event.contact;
    const auto wall = static_cast<std::uint32_t>(event.wall);
    record_.on_event({c.time, kind, body->second, wall, c.point, c.normal, {}, {}});
  }

  void see_bodies(const World& world, const PairEvent& event) {
    see_if_there(world, event.a);
    see_if_there(world, event.b);
  }
  void see_bodies(const World& world, const WallEvent& event) { see_if_there(world, event.body); }
  void see_if_there(const World& world, BodyId id) {
    if (world.contains(id)) return see(world, id);
    const auto place = places_.find(id);
    if (place == places_.end()) return;
    record_.on_removal(place->second, world.now());
    places_.erase(place);
  }
  void see(const World& world, BodyId id) {
    const auto [place, is_new] = places_.try_emplace(id, static_cast<std::uint32_t>(scene_.bodies.size()));
    if (is_new) add(world, id);
    record_.on_motion(place->second, kds::collision::motion_as<MotionPiece>(world.motion(id)));
  }
  void add(const World& world, BodyId id) {
    const kds::collision::PlacedShape placed = world.shape(id);
    SceneBody body;
    body.name = "body " + std::to_string(id);
    body.shape = placed.shape;
    if (const auto* bending = std::get_if<kds::collision::BendingMesh>(&placed.shape)) {
      const auto& form = bending->script->form();
      body.bent = std::make_shared<const kds::collision::Mesh>(form.positions, form.triangles);
      scene_.meshes.push_back({body.name, "", body.bent});
    }
    body.orientation = Eigen::Quaterniond(placed.rotation);
    if constexpr (kds::collision::turns<Motion>) body.orientation = world.motion(id).orientation.normalized();
    body.fixed = world.fixed(id);
    scene_.bodies.push_back(std::move(body));
  }

  Listener silent_;
  Listener& listener_;
  Scene scene_;
  Record record_;
  std::unordered_map<BodyId, std::uint32_t> places_;  ///< in the scene, of bodies that are there
};

}  // namespace kds::io
