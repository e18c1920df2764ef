// A scenario: what is done to a world, as plain data that can be run in many ways, made smaller and printed.
#pragma once

#include "collision/body_description.hpp"
#include "collision/world_options.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace kds::fuzz {

using collision::Response;
using Eigen::Vector3d;

/// A piece of motion; lengths are in units of the scenario's, `start` is counted from the time of the call.
struct Path {
  double start = 0;
  Vector3d place = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
  Vector3d half_acceleration = Vector3d::Zero();  ///< of no effect in worlds of degree 1
};

enum class ShapeKind : std::uint8_t { ball, box, mesh, capsule, hull, half_space, compound };

struct BodyPlan {
  ShapeKind shape = ShapeKind::ball;
  Vector3d size = Vector3d::Ones();  ///< radius in [0], half extents (of a hull: of the box that it is cut from; of a
                                     ///< compound: of the box around it), scale of the mesh in [0], or radius and half
                                     ///< length, or the normal of a half-space
  std::size_t mesh = 0;              ///< of sample_meshes()
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  std::vector<Path> pieces{Path{}};
  double mass = 1;
  double restitution = 1;
  bool fixed = false;
  std::uint32_t category = 1;
  std::uint32_t collides_with = ~0u;
  std::uint32_t group = 0;
  bool sensor = false;
  collision::BoundingVolume volume = collision::BoundingVolume::shape;
  bool box_function = false;
  double box_margin = 0;    ///< how far its boxes reach beyond the shape
  double box_validity = 1;  ///< s; how long each of them is valid
  bool box_edits = false;   ///< the function tries to change the world, which must be refused
};

/// Something done to the world. Bodies are named by their number in Scenario::bodies, whatever id they have got.
struct Call {
  enum class Kind : std::uint8_t {
    add,            ///< `body`
    remove,         ///< `body`
    move,           ///< `body` gets `path`: as a rule a jump
    turn_back,      ///< `body` reverses its velocity
    keep,           ///< `body` is given the motion that it has
    follow,         ///< `body` is put where `other` is, with its motion
    away_and_back,  ///< `body` jumps to `path` and back at once
    filter,         ///< `body` gets `category` and `collides_with`
    group,          ///< `body` gets the group `category`
    ignore,         ///< `body` and `other` are ignored, or no longer if `collides_with` has all bits
    attach,         ///< `body` is added, as a sensor that is attached to `other`
    weigh,          ///< `body` gets `mass`
    append,         ///< `body` gets `path` as a further piece, `seconds` from now, if its script ends before
    ring,           ///< a timer is set, `seconds` from now
    push_off,       ///< in a callback alone: both bodies leave each other along the normal, `body` in any case
    advance,        ///< up to `seconds` from now; in a callback it must be refused
    save,           ///< in a callback alone: it must be refused
    fail,           ///< in a callback alone: it throws
  };
  Kind kind = Kind::keep;
  std::size_t body = 0;
  std::size_t other = 0;
  Path path{};
  double seconds = 0;
  double mass = 1;
  std::uint32_t category = 1;
  std::uint32_t collides_with = ~0u;
};

inline constexpr std::string_view call_names[] = {
    "add",    "remove", "move",  "turn_back", "keep", "follow",   "away_and_back", "filter", "group",
    "ignore", "attach", "weigh", "append",    "ring", "push_off", "advance",       "save",   "fail"};

/// Which event of a log: the `count`th of its kind and bodies.
struct EventKey {
  std::uint8_t kind = 0;
  std::size_t a = 0;
  std::size_t b = 0;
  std::size_t count = 0;
  friend auto operator<=>(const EventKey&, const EventKey&) = default;
};

/// What a callback does at one event.
struct Reaction {
  EventKey event;
  std::vector<Call> calls;
};

/// Sides and restitution of the walls: a cube about the origin.
struct WallPlan {
  double half_side = 8;
  double restitution = 1;
};

struct Scenario {
  std::uint64_t seed = 0;
  int degree = 1;
  Response response = Response::none;
  bool walls = false;
  WallPlan wall;
  bool report_pairs = false;
  bool report_pieces = false;
  double start_time = 0;
  double unit = 1;  ///< all lengths are multiplied by it
  std::uint32_t zeno_contacts = 100;
  double zeno_interval = 1e-9;
  bool fixed_bodies_move = false;
  std::size_t most_alive = 16;    ///< an `add` beyond is left out
  std::size_t most_events = 120;  ///< a run is given up behind so many
  bool may_be_saved = true;       ///< worlds with box functions may not
  std::vector<BodyPlan> bodies;
  std::vector<Call> calls;

  /// What callbacks do: at random, from the seed and the event, once in `reaction_rate` events (0: never) ...
  std::size_t reaction_rate = 0;
  /// ... or, where a run has been written down, just this.
  bool reactions_are_written_down = false;
  std::vector<Reaction> reactions;
};

}  // namespace kds::fuzz
