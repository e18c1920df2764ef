// The bodies of a world as plain data, which can be written down.
#pragma once

#include "collision/world/bodies.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace kds::collision {

/// Numbers of bodies scattered over all of 64 bits: the sums of these tell sets of numbers apart.
inline std::uint64_t number_hash(BodySlot number) {
  std::uint64_t hash = (std::uint64_t{number} + 1) * 0x9e3779b97f4a7c15u;
  hash = (hash ^ hash >> 32) * 0xbf58476d1ce4e5b9u;
  return hash ^ hash >> 29;
}

template <class Motion>
struct Bodies<Motion>::Image {
  /// What is saved of one body.
  struct One {
    bool alive = false;
    bool entered = false;
    bool sensor = false;
    bool self_contacts = false;
    std::uint64_t user_data = 0;
    PlacedShape placed;
    std::uint32_t mesh = 0;  ///< number in `meshes`, of a mesh
    Motion motion;
    double mass = 1, inverse_mass = 1, restitution = 1;
    double inverse_inertia = 0, friction = 0, tangential_restitution = 0,
           rolling_friction = 0;  ///< of bodies that turn
    bool tumbles = false;
    CollisionFilter filter{};
    BoundingVolume volume = BoundingVolume::shape;
    std::uint64_t meetings = 0;
    double burst_start = 0;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Path given{};  ///< of degree 3 and above, in place of the force
  };

  /// Of bodies that are saved elsewhere: how many slots there are, how many bodies in them, and `number_hash` of the
  /// slots of these, added up.
  struct Lent {
    std::uint64_t slots = 0, bodies = 0, numbers = 0;
  };

  std::vector<std::shared_ptr<const Mesh>> meshes;
  Lent elsewhere{};                        ///< then there are none here, and none waits
  std::vector<One> bodies;                 // by slot
  std::vector<std::uint32_t> generations;  ///< as BodyKeys
  BodyId next_id = 0;
  std::vector<BodySlot> free, waiting;
  std::vector<std::pair<BodySlot, BodySlot>> ignored;   ///< lower slot first, in order
  std::vector<std::pair<BodySlot, BodySlot>> attached;  ///< sensor and owner, in order

  bool lent() const { return elsewhere.slots > 0; }
  bool alive(BodySlot slot) const { return slot < bodies.size() && bodies[slot].alive; }
  bool entered(BodySlot slot) const { return alive(slot) && bodies[slot].entered; }
  std::uint32_t generation(BodySlot slot) const { return slot < generations.size() ? generations[slot] : 0; }
  /// Whether a body is there; whether it has entered; whether it was removed.
  BodyId id_of(BodySlot slot) const { return body_id(generation(slot), slot); }
  bool before(BodySlot a, BodySlot b) const { return id_of(a) < id_of(b); }
  bool there(BodyId id) const { return alive(body_slot(id)) && id == id_of(body_slot(id)); }
  bool present(BodyId id) const { return there(id) && entered(body_slot(id)); }
  bool removed(BodyId id) const {
    const BodySlot slot = body_slot(id);
    return slot < bodies.size() && body_generation(id) <= generation(slot) && !there(id);
  }

  BodySlot owner(BodySlot slot) const;
  /// Precondition, here and below: the image has been checked.
  bool may_collide(BodySlot a, BodySlot b) const;

  /// Loading, meshes that are among `known` are not built again.
  template <class Archive>
  void archive(Archive& archive, const std::vector<std::shared_ptr<const Mesh>>& known);

  /// The bodies alone, whose meshes are among `meshes`. Loading gives them the ids 0, 1, ...
  template <class Archive>
  void archive_bodies(Archive& archive);

  /// Throws std::runtime_error, naming what is wrong. Precondition: shapes have been loaded, so that meshes are there.
  void check(double now) const;
  /// The same of a body, in this slot, and one to which it is attached.
  static void check_attached(BodySlot slot, const One& sensor, const One& its_owner);

 private:
  void check_free() const;
  void check_related() const;
  template <class Archive>
  static void mesh(Archive& archive, std::shared_ptr<const Mesh>& mesh,
                   const std::vector<std::shared_ptr<const Mesh>>& known);
  template <class Archive>
  void body(Archive& archive, One& body) const;
};

}  // namespace kds::collision
