// What decides the future of a world, as plain members that can be written down.
#pragma once

#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace kds::collision {

/// A copy of all that decides the events to come. Broad phases are not in it, since they are functions of the motions,
/// nor are times that are. What has been decided with the past in view is: contact times of known pairs, the places
/// where held bodies lean on each other, who passes through whom, the counts of the Zeno policy, reports not yet made.
template <int Degree>
struct World<Degree>::Image {
  struct BodyImage {
    bool alive = false;
    bool entered = false;
    PlacedShape placed;
    std::uint32_t mesh = 0;  ///< number in `meshes`, of a mesh
    Motion motion;
    std::vector<Motion> script;
    double mass = 1, inverse_mass = 1, restitution = 1;
    std::uint32_t category = 1, collides_with = ~0u;
    BoundingVolume volume = BoundingVolume::shape;
    std::uint64_t meetings = 0;
    double burst_start = 0;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
  };
  struct PairImage {
    Pair pair;
    double contact = never;  ///< when it is due in the queues
    double boxes = never;
  };

  double now = 0, clock = 0, horizon = 0;
  bool has_had_meshes = false;
  WorldCounters counters;
  std::vector<std::shared_ptr<const Mesh>> meshes;
  std::vector<BodyImage> bodies;  // by id
  std::vector<BodyId> free_bodies, removed, entering;
  std::vector<PairImage> pairs;
  typename RestingContacts<Degree>::Image resting;
  std::vector<detail::Pending> pending;
  double removed_at = 0;
  EditLimit edits;

  /// Loading, meshes that are among `known` are not built again.
  template <class Archive>
  void archive(Archive& archive, const std::vector<std::shared_ptr<const Mesh>>& known);

  /// Throws std::runtime_error, naming what is wrong, unless it may be an image of a world with these options: then it
  /// can become one. See image_check.cpp.
  void check(const WorldOptions& options) const;

 private:
  /// How far the normal of a hold may be from unit length: far above what normalising rounds.
  static constexpr double normal_rounding = 0x1p-40;

  bool is_alive(BodyId id) const;
  bool is_entered(BodyId id) const;
  void check_bodies() const;
  void check_pairs(const WorldOptions& options) const;
  void check_resting(const WorldOptions& options) const;
  void check_reports() const;
  template <class Archive, class T, class One>
  static void each(Archive& archive, std::vector<T>& values, One&& one) {
    archive.each(values, one);
  }
  template <class Archive>
  static void vector(Archive& archive, Eigen::Vector3d& v) {
    archive(v[0], v[1], v[2]);
  }
  template <class Archive>
  static void mesh(Archive& archive, std::shared_ptr<const Mesh>& mesh,
                   const std::vector<std::shared_ptr<const Mesh>>& known);
  template <class Archive>
  void shape(Archive& archive, BodyImage& body) const;
  template <class Archive>
  void body(Archive& archive, BodyImage& body) const;
};

}  // namespace kds::collision
