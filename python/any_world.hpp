// A world of any type of motion, behind one interface: so the bindings are compiled once.
#pragma once

#include "collision/body_description.hpp"
#include "collision/free_turning.hpp"
#include "collision/profile.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/hit.hpp"
#include "collision/queries/near_pairs.hpp"
#include "collision/queries/nearest.hpp"
#include "collision/shapes/mesh_keyframe.hpp"
#include "collision/world_counters.hpp"
#include "collision/world_listener.hpp"
#include "collision/world_options.hpp"
#include "io/scene.hpp"
#include "kds/framework/snapshot.hpp"
#include "python/rows.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kds_python {

using kds::collision::BodyId;
using kds::collision::ContactMode;

/// Category, and what it collides with.
using BodyMasks = std::array<std::uint32_t, 3>;

/// The orientation of the first piece is that of a body which keeps it, and no box function counts.
using Description = kds::collision::BasicBodyDescription<Motion>;

/// What worlds of all types have. Members are those of kds::collision::BasicWorld, and throw what those throw. Motions
/// that the type of the world cannot hold are refused with std::invalid_argument.
class AnyBodies {
 public:
  virtual ~AnyBodies() = default;

  virtual BodyId add_body(const Description& body) = 0;
  virtual void reserve(std::size_t bodies) = 0;
  virtual void remove_body(BodyId id) = 0;
  /// As many pieces for each body, one body after the other; the first of each has started, and those after it are
  /// named `then` in errors. All or none: throws before anything is changed.
  virtual void update_motions(const std::vector<BodyId>& ids, const std::vector<Motion>& pieces) = 0;
  /// All or none, too: a value for each body.
  virtual void set_restitutions(const std::vector<BodyId>& ids, const double* restitutions) = 0;

  virtual bool step(double limit) = 0;
  virtual bool advance_for(double budget_seconds, double t) = 0;

  virtual double now() const = 0;
  virtual std::size_t size() const = 0;
  virtual bool contains(BodyId id) const = 0;
  virtual Motion motion_now(BodyId id) const = 0;  ///< restarted at now()
  virtual Motion free_motion_now(BodyId id) const = 0;
  virtual void audit() const = 0;
  virtual kds::Snapshot save() = 0;
  /// What is recorded begins again.
  virtual void restore(const kds::Snapshot& snapshot) = 0;

  /// Pictures of what has been recorded (recording.hpp); of other worlds they throw std::logic_error.
  virtual void write_replay(const std::string& file, const std::string& title) = 0;
  virtual void write_gltf(const std::string& file, const std::string& title, double frames_per_second) = 0;
  virtual void write_vtk(const std::string& file, double frames_per_second) = 0;
};

/// A BasicWorld of some type of motion, or a BasicParallelWorld; queries are those of queries/.
class AnyWorld : public AnyBodies {
 public:
  using Listener = std::function<void(const EventRow&)>;
  using Filter = kds::collision::BodyFilter;

  using AnyBodies::add_body;
  virtual BodyId add_body(const kds::io::SceneBody& body) = 0;
  virtual void append_motion(BodyId id, const std::vector<Motion>& pieces) = 0;
  virtual void update_vertices(BodyId id, std::vector<kds::collision::MeshKeyframe> keyframes) = 0;
  // All or none: a value for each body.
  virtual void set_masses(const std::vector<BodyId>& ids, const double* masses) = 0;
  virtual void ignore_pair(BodyId a, BodyId b, bool ignored) = 0;
  virtual bool ignores_pair(BodyId a, BodyId b) const = 0;
  virtual void set_filters(const std::vector<BodyId>& ids, const BodyMasks* masks) = 0;
  virtual void set_user_data(const std::vector<BodyId>& ids, const std::uint64_t* user_data) = 0;
  virtual kds::collision::TimerId set_timer(double t) = 0;
  virtual bool cancel_timer(kds::collision::TimerId timer) = 0;

  virtual double next_time() const = 0;

  virtual kds::collision::Shape shape(BodyId id) const = 0;
  /// Of a mesh that bends, at now(); std::invalid_argument for other bodies.
  virtual std::vector<Eigen::Vector3d> vertices(BodyId id) const = 0;
  /// std::invalid_argument where bodies do not turn, too.
  virtual kds::collision::FreeTurning free_turning(BodyId id) const = 0;
  virtual double mass(BodyId id) const = 0;
  virtual bool fixed(BodyId id) const = 0;
  virtual bool sensor(BodyId id) const = 0;
  virtual std::optional<BodyId> attached_to(BodyId id) const = 0;
  virtual double restitution(BodyId id) const = 0;
  virtual BodyMasks masks(BodyId id) const = 0;
  virtual std::uint64_t user_data(BodyId id) const = 0;
  virtual std::vector<BodyId> partners(BodyId id) const = 0;
  virtual bool touching(BodyId a, BodyId b) const = 0;
  virtual bool resting(BodyId a, BodyId b) const = 0;
  virtual bool resting_at_wall(BodyId a, int wall) const = 0;
  virtual kds::collision::WorldCounters counters() const = 0;
  virtual std::string_view broad_phase() const = 0;
  virtual kds::collision::Profile profile() const = 0;

  /// All, in order of their ids.
  virtual std::vector<BodyId> bodies() const = 0;
  virtual std::vector<BodyId> in_box(const Eigen::Vector3d& min, const Eigen::Vector3d& max) const = 0;
  /// `motion`: of the corner `min`, with which the other one moves.
  virtual std::vector<BodyId> in_moving_box(const Motion& motion, const Eigen::Vector3d& extent,
                                            double until) const = 0;
  /// A ray where there is no shape.
  virtual std::vector<kds::collision::Hit> cast(const std::optional<kds::collision::PlacedShape>& shape,
                                                const Eigen::Vector3d& from, const Eigen::Vector3d& to, bool all,
                                                const Filter& filter) const = 0;
  virtual std::vector<BodyId> overlapping(const kds::collision::PlacedShape& shape, const Eigen::Vector3d& at,
                                          const Filter& filter) const = 0;
  /// To a point where there is no shape.
  virtual std::vector<kds::collision::NearBody> nearest(const std::optional<kds::collision::PlacedShape>& shape,
                                                        const Eigen::Vector3d& to, std::size_t count,
                                                        const Filter& filter) const = 0;
  virtual kds::collision::ShapeDistance distance_between(BodyId a, BodyId b) const = 0;
  virtual std::optional<kds::collision::Hit> next_contact(const kds::collision::Shape& shape, const Motion& motion,
                                                          double until, const Filter& filter) const = 0;
  virtual std::vector<kds::collision::Hit> next_contacts(const kds::collision::Shape& shape, const Motion& motion,
                                                         double until, const Filter& filter) const = 0;
  virtual std::optional<kds::collision::Hit> next_contact_of(BodyId body, double until, const Filter& filter,
                                                             ContactMode mode) const = 0;
  virtual std::vector<kds::collision::Hit> next_contacts_of(BodyId body, double until, const Filter& filter,
                                                            ContactMode mode) const = 0;
  virtual std::optional<kds::collision::Contact> next_contact_between(BodyId a, BodyId b, double until,
                                                                      ContactMode mode) const = 0;
  virtual kds::collision::Approach closest_approach(BodyId a, BodyId b, double until) const = 0;
  virtual std::vector<kds::collision::BodyPair> contact_pairs() const = 0;
  virtual std::vector<kds::collision::NearPair> pairs_nearer_than(double distance, double until,
                                                                  const Filter& filter) const = 0;
};

/// Which type of world.
struct WorldType {
  int degree = 1;           ///< from 1 to 5; 1 or 2 of bodies that turn
  bool turning = false;     ///< whether bodies turn, or keep their orientation
  std::size_t domains = 1;  ///< of a ParallelWorld, as in ParallelOptions; 1: a World
  bool record = false;      ///< whether it can be asked for pictures

  bool divided() const { return domains != 1; }
};

/// Throws std::invalid_argument for a type that is not there, and what the world throws for its options. A divided
/// world is told of events, and runs, but has no step(); its listener must not call it.
std::unique_ptr<AnyWorld> make_world(const WorldType& type, const kds::collision::WorldOptions& options,
                                     AnyWorld::Listener listener);

}  // namespace kds_python
