// The image of a world's bodies, written, read and checked.
#include "collision/world/bodies_image.hpp"

#include "collision/motions.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape_archive.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/saved_motion.hpp"
#include "kds/framework/snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace kds::collision {
namespace {

bool equal(std::span<const Eigen::Vector3d> a, const std::vector<Eigen::Vector3d>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

/// Whether a shape is one that place() makes of some orientation.
void check_shape(const PlacedShape& placed, std::size_t slot) {
  try {
    image::require(is_placed(placed), "bodies", slot, "its bounds are not those of its shape");
  } catch (const std::invalid_argument& error) {
    image::require(false, "bodies", slot, error.what());
  }
}

}  // namespace

template <class Motion>
template <class Archive>
void Bodies<Motion>::Image::mesh(Archive& archive, std::shared_ptr<const Mesh>& mesh,
                                 const std::vector<std::shared_ptr<const Mesh>>& known) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
  if (mesh) {
    vertices.assign(mesh->vertices().begin(), mesh->vertices().end());
    triangles.assign(mesh->triangles().begin(), mesh->triangles().end());
  }
  archive.each(vertices, [&](Eigen::Vector3d& v) { image::vector(archive, v); });
  archive(triangles);
  if constexpr (Archive::loading) {
    const auto same = std::find_if(known.begin(), known.end(), [&](const auto& other) {
      return equal(other->vertices(), vertices) &&
             std::equal(triangles.begin(), triangles.end(), other->triangles().begin(), other->triangles().end());
    });
    try {
      mesh = same != known.end() ? *same : std::make_shared<const Mesh>(std::move(vertices), std::move(triangles));
    } catch (const InvalidMesh& error) {
      throw std::runtime_error(std::string("snapshot: a mesh: ") + error.what());
    }
  }
}

template <class Motion>
template <class Archive>
void Bodies<Motion>::Image::body(Archive& archive, One& body) const {
  archive(body.alive);
  if (!body.alive) return;
  archive_shape(archive, body.placed, body.mesh, meshes);
  archive(body.entered, body.sensor, body.self_contacts, body.user_data, body.motion, body.mass, body.inverse_mass,
          body.restitution, body.filter.category, body.filter.collides_with, body.filter.group, body.volume,
          body.meetings, body.burst_start);
  image::vector(archive, body.force);
  if constexpr (turns<Motion>) {
    archive(body.inverse_inertia, body.friction, body.tangential_restitution, body.rolling_friction, body.tumbles);
  }
  if constexpr (Motion::degree >= 3) archive(body.given);
}

template <class Motion>
template <class Archive>
void Bodies<Motion>::Image::archive(Archive& archive, const std::vector<std::shared_ptr<const Mesh>>& known) {
  archive.each(meshes, [&](auto& one) { mesh(archive, one, known); });
  archive(elsewhere.slots, elsewhere.bodies, elsewhere.numbers);
  archive_bodies(archive);
  archive(generations, next_id, free, waiting);
  archive.each(ignored, [&](auto& pair) { archive(pair.first, pair.second); });
  archive.each(attached, [&](auto& pair) { archive(pair.first, pair.second); });
}

template <class Motion>
template <class Archive>
void Bodies<Motion>::Image::archive_bodies(Archive& archive) {
  archive.each(bodies, [&](One& one) { body(archive, one); });
  if constexpr (Archive::loading) next_id = bodies.size();
}

template <class Motion>
BodySlot Bodies<Motion>::Image::owner(BodySlot slot) const {
  const auto found = std::lower_bound(attached.begin(), attached.end(), std::pair(slot, BodySlot{0}));
  return found == attached.end() || found->first != slot ? no_body : found->second;
}

template <class Motion>
bool Bodies<Motion>::Image::may_collide(BodySlot a, BodySlot b) const {
  const BodySlot of_a = owner(a), of_b = owner(b);
  const bool together = (of_a == no_body ? a : of_a) == (of_b == no_body ? b : of_b);
  return bodies[a].filter.meets(bodies[b].filter) && !together &&
         !std::binary_search(ignored.begin(), ignored.end(), IgnoredPairs::pair(a, b));
}

/// Checks free slots and ids.
template <class Motion>
void Bodies<Motion>::Image::check_free() const {
  const std::size_t slots = lent() ? elsewhere.slots : bodies.size();
  if (slots > no_body) image::fail("bodies: there are more than there are slots");
  if (generations.size() > slots) image::fail("generations: there are more than there are slots");
  std::set<BodySlot> listed;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const BodySlot slot = free[i];
    image::require(slot < slots && !alive(slot) && listed.insert(slot).second, "free", i,
                   "is no free slot, or listed twice");
  }
  for (BodySlot slot = 0; slot < bodies.size(); ++slot) {
    image::require(bodies[slot].alive || listed.contains(slot), "bodies", slot, "its slot is free, and not listed");
  }
  for (BodySlot slot = 0; slot < generations.size(); ++slot) {
    image::require(id_of(slot) < next_id, "generations", slot, "is not before the next one");
  }
  if (slots > 0 && id_of(static_cast<BodySlot>(slots - 1)) >= next_id)
    image::fail("bodies: the next one has an old id");
  if (!lent()) return;
  if (elsewhere.bodies != slots - free.size()) image::fail("bodies: not as many are elsewhere as have slots");
  if (!bodies.empty() || !waiting.empty()) image::fail("bodies: they are elsewhere, and here");
}

/// Checks ignored and attached pairs; those of bodies that are stored elsewhere only as far as is possible here.
template <class Motion>
void Bodies<Motion>::Image::check_related() const {
  const auto known = [this](BodySlot slot) { return lent() ? slot < elsewhere.slots : alive(slot); };
  for (std::size_t i = 0; i < ignored.size(); ++i) {
    const auto [a, b] = ignored[i];
    image::require(a < b && known(a) && known(b), "ignored", i, "is not of two bodies");
    image::require(i == 0 || ignored[i - 1] < ignored[i], "ignored", i, "is out of order, or there twice");
  }
  for (std::size_t i = 0; i < attached.size(); ++i) {
    const auto [sensor, its_owner] = attached[i];
    image::require(known(sensor) && known(its_owner), "attached", i, "is not of two bodies");
    image::require(i == 0 || attached[i - 1].first < sensor, "attached", i, "is out of order, or there twice");
  }
  for (std::size_t i = 0; i < attached.size(); ++i) {
    image::require(owner(attached[i].second) == no_body, "attached", i, "is of a body that is attached itself");
    if (!lent()) check_attached(attached[i].first, bodies[attached[i].first], bodies[attached[i].second]);
  }
}

template <class Motion>
void Bodies<Motion>::Image::check_attached(BodySlot slot, const One& sensor, const One& its_owner) {
  image::require(sensor.sensor, "bodies", slot, "is attached, and no sensor");
  image::require(!sensor.entered || its_owner.entered, "bodies", slot,
                 "has entered before that to which it is attached");
}

template <class Motion>
void Bodies<Motion>::Image::check(double now) const {
  check_free();
  for (std::size_t i = 0; i < waiting.size(); ++i) {
    image::require(alive(waiting[i]) && !bodies[waiting[i]].entered, "waiting", i, "is no body that waits to enter");
    image::require(path_of(bodies[waiting[i]].motion).start <= now, "waiting", i, "its motion begins after now");
  }
  check_related();
  for (std::size_t slot = 0; slot < bodies.size(); ++slot) {
    const One& body = bodies[slot];
    const auto need = [slot](bool right, const char* what) { image::require(right, "bodies", slot, what); };
    if (!body.alive) continue;
    check_shape(body.placed, slot);
    need(!body.self_contacts || collision::bends(body.placed.shape), "meets itself, and does not bend");
    need(body.motion.finite(), "its motion is not finite");
    need(image::can_have_come_about(path_of(body.motion)), "its motion is out of range");
    if constexpr (turns<Motion>) {
      need(image::can_have_come_about(body.motion.angular_velocity), "its angular velocity is beyond 2^450");
    }
    need(!body.entered || path_of(body.motion).start <= now, "its motion begins after now");
    const bool has_mass =
        body.mass >= smallest_size && body.mass <= largest_magnitude && body.inverse_mass == 1 / body.mass;
    need(has_mass || body.inverse_mass == 0, "its mass is not in [2^-205, 2^205], or not that of its inverse");
    need(body.restitution >= 0 && body.restitution <= 1, "its restitution is not in [0, 1]");
    need(body.volume == BoundingVolume::shape || body.volume == BoundingVolume::sphere, "its volume is unknown");
    need(body.meetings <= std::numeric_limits<std::uint32_t>::max(), "it has met too many others");
    need(image::is_past(body.burst_start, now), "its meetings are counted from a time after now");
    need(body.force.allFinite() && body.force.cwiseAbs().maxCoeff() <= 2 * largest_magnitude,
         "its acceleration is not finite, or out of range");
    need(body.inverse_inertia == 0 || image::is_moment(body.inverse_inertia),
         "its inertia is not > 0, or out of range");
    need(body.friction >= 0 && body.friction <= largest_magnitude, "its friction is not in [0, 2^205]");
    need(std::abs(body.tangential_restitution) <= 1, "its tangential restitution is not in [-1, 1]");
    need(body.rolling_friction >= 0 && body.rolling_friction <= largest_magnitude,
         "its rolling friction is not in [0, 2^205]");
    if constexpr (Motion::degree >= 3) need(body.given.finite(), "the motion that it was given is not finite");
  }
}

#define KDS_INSTANTIATE(motion)                                                                                        \
  KDS_TEMPLATE_PART struct Bodies<motion>::Image;                                                                      \
  template void Bodies<motion>::Image::archive(kds::detail::Writer&, const std::vector<std::shared_ptr<const Mesh>>&); \
  template void Bodies<motion>::Image::archive(kds::detail::Reader&, const std::vector<std::shared_ptr<const Mesh>>&); \
  template void Bodies<motion>::Image::archive_bodies(kds::detail::Writer&);                                           \
  template void Bodies<motion>::Image::archive_bodies(kds::detail::Reader&);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
