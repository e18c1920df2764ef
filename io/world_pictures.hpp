// What recorders of worlds have in common: a record, and pictures of it.
#pragma once

#include "collision/body_id.hpp"
#include "collision/body_motion.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "io/gltf.hpp"
#include "io/replay.hpp"
#include "io/vtk.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace kds::io {

/// A record of a world, and pictures of it: base of WorldRecorder and PeriodicRecorder. A Recorder has two static
/// functions: `visit(world, f)` calls f(id) for each body, `describe(world, id)` is one of them as a SceneBody, without
/// a name and without motion.
template <class Recorder, class World>
class WorldPictures {
 public:
  using BodyId = kds::collision::BodyId;

  /// Records which bodies are there, and their motions.
  void look(const World& world) {
    std::vector<BodyId> gone;
    for (const auto& [id, place] : places_) {
      if (!world.contains(id)) gone.push_back(id);
    }
    for (const BodyId id : gone) see_if_there(world, id);
    Recorder::visit(world, [&](BodyId id) { see(world, id); });
  }

  /// The same of one body, which may have been removed. O(1).
  void look(const World& world, BodyId id) { see_if_there(world, id); }

  /// Forgets what has been recorded, and goes on from now(): for a world that has been restored.
  void start_again(const World& world) {
    scene_.begin_time = world.now();
    scene_.bodies.clear();
    scene_.meshes.clear();
    record_ = {};
    places_.clear();
    look(world);
  }

  /// The page, from the time at which the record began to now(). Throws ReplayError where three.js is not found.
  std::string page(const World& world, const std::string& title,
                   const std::filesystem::path& three_folder = default_three_folder()) {
    return replay_page(to_json(world, title), three_folder);
  }
  /// An animation (gltf.hpp), of the same time.
  std::string gltf(const World& world, const std::string& title, double frames_per_second = 60) {
    end(world);
    return to_gltf(scene_, record_, title, frames_per_second);
  }
  /// Surfaces as files (VtkSeries in vtk.hpp), of the same time.
  void write_vtk(const World& world, const std::string& path, double frames_per_second = 60) {
    end(world);
    VtkSeries series(path);
    series.write(scene_, record_, frames_per_second);
    series.commit();
  }
  /// The data of the page.
  std::string to_json(const World& world, const std::string& title) {
    end(world);
    return record_.to_json(scene_, title);
  }

 protected:
  /// Of a world that begins at a time (s).
  WorldPictures(double begin_time, Response response, bool turning, std::optional<Domain> domain) {
    scene_.begin_time = begin_time;
    scene_.response = response == Response::none ? Response::none : Response::elastic;
    scene_.turning = turning;
    scene_.domain = std::move(domain);
  }

  /// Of bodies that have been removed only what was seen of them before counts.
  void note(const World& world, EventKind kind, BodyId first, BodyId second, const kds::collision::Contact& contact) {
    see_if_there(world, first);
    see_if_there(world, second);
    const auto a = places_.find(first), b = places_.find(second);
    if (a == places_.end() || b == places_.end()) return;
    record_.on_event({contact.time, kind, a->second.place, b->second.place, contact.point, contact.normal, {}, {}});
  }
  void note_wall(const World& world, EventKind kind, BodyId id, int wall, const kds::collision::Contact& contact) {
    see_if_there(world, id);
    const auto body = places_.find(id);
    if (body == places_.end()) return;
    const auto number = static_cast<std::uint32_t>(wall);
    record_.on_event({contact.time, kind, body->second.place, number, contact.point, contact.normal, {}, {}});
  }
  void see_if_there(const World& world, BodyId id) {
    if (world.contains(id)) return see(world, id);
    const auto place = places_.find(id);
    if (place == places_.end()) return;
    record_.on_removal(place->second.place, world.now());
    places_.erase(place);
  }

 private:
  void end(const World& world) {
    look(world);
    scene_.end_time = world.now();
  }
  void see(const World& world, BodyId id) {
    const auto& motion = world.motion(id);
    const auto [found, is_new] =
        places_.try_emplace(id, Known{static_cast<std::uint32_t>(scene_.bodies.size()), motion});
    Known& known = found->second;
    if (is_new) {
      add(world, id);
    } else if (known.motion == motion) {
      return;
    } else {
      known.motion = motion;
      record_.forget_after(known.place, world.now());  // what it was to do then
    }
    // A motion that began earlier counts from now on: what has been recorded until now stays.
    const bool from_start = is_new || path_of(motion).start >= world.now();
    record_.on_motion(known.place,
                      kds::collision::motion_as<RecordedPiece>(from_start ? motion : motion.restarted(world.now())));
  }
  void add(const World& world, BodyId id) {
    SceneBody body = Recorder::describe(world, id);
    body.name = "body " + std::to_string(id);
    body.motion = {kds::collision::motion_as<MotionPiece>(world.motion(id))};
    if (const auto* script = script_of(body.shape)) {
      const auto& form = script->form();
      body.bent = std::make_shared<const kds::collision::Mesh>(form.positions, form.triangles);
      scene_.meshes.push_back({body.name, "", body.bent});
    }
    scene_.bodies.push_back(std::move(body));
  }

  struct Known {
    std::uint32_t place;  ///< in the scene
    typename World::Motion motion;
  };

  Scene scene_;
  Record record_;
  std::unordered_map<BodyId, Known> places_;  ///< of bodies that are there
};

}  // namespace kds::io
