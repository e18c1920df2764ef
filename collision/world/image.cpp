// The image of a world, written and read.
#include "collision/world/image.hpp"

#include "collision/shapes/mesh.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace kds::collision {
namespace {

bool equal(std::span<const Eigen::Vector3d> a, const std::vector<Eigen::Vector3d>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

template <int Degree>
template <class Archive>
void World<Degree>::Image::mesh(Archive& archive, std::shared_ptr<const Mesh>& mesh,
                                const std::vector<std::shared_ptr<const Mesh>>& known) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
  if (mesh) {
    vertices.assign(mesh->vertices().begin(), mesh->vertices().end());
    triangles.assign(mesh->triangles().begin(), mesh->triangles().end());
  }
  each(archive, vertices, [&](Eigen::Vector3d& v) { vector(archive, v); });
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

template <int Degree>
template <class Archive>
void World<Degree>::Image::shape(Archive& archive, BodyImage& body) const {
  PlacedShape& placed = body.placed;
  std::uint32_t kind = static_cast<std::uint32_t>(placed.shape.index());
  archive(kind);
  if constexpr (Archive::loading) {
    if (kind > 2) throw std::runtime_error("snapshot: a shape is of an unknown kind");
    if (kind == 0) placed.shape = Sphere{0};
    if (kind == 1) placed.shape = Box{Eigen::Vector3d::Zero()};
    if (kind == 2) placed.shape = MeshShape{};
  }
  if (auto* const sphere = std::get_if<Sphere>(&placed.shape)) archive(sphere->radius);
  if (auto* const box = std::get_if<Box>(&placed.shape)) {
    vector(archive, box->half_extents);
    for (Eigen::Vector3d& half : placed.half_axes) vector(archive, half);
  }
  if (auto* const mesh = std::get_if<MeshShape>(&placed.shape)) {
    archive(body.mesh, mesh->scale);
    if (body.mesh >= meshes.size()) {
      throw std::runtime_error("snapshot: a body has mesh " + std::to_string(body.mesh) + ", and there are " +
                               std::to_string(meshes.size()));
    }
    mesh->mesh = meshes[body.mesh];
  }
  for (double& entry : placed.rotation.reshaped()) archive(entry);
  vector(archive, placed.low), vector(archive, placed.high);
  archive(placed.bounding_radius);
}

template <int Degree>
template <class Archive>
void World<Degree>::Image::body(Archive& archive, BodyImage& body) const {
  archive(body.alive);
  if (!body.alive) return;
  shape(archive, body);
  archive(body.entered, body.motion, body.script, body.mass, body.inverse_mass, body.restitution, body.category,
          body.collides_with, body.volume, body.meetings, body.burst_start);
  vector(archive, body.force);
}

template <int Degree>
template <class Archive>
void World<Degree>::Image::archive(Archive& archive, const std::vector<std::shared_ptr<const Mesh>>& known) {
  archive(now, clock, horizon, has_had_meshes, counters, edits);
  each(archive, meshes, [&](auto& one) { mesh(archive, one, known); });
  each(archive, bodies, [&](BodyImage& one) { body(archive, one); });
  archive(free_bodies, removed, removed_at, entering);
  each(archive, pairs, [&](PairImage& image) {
    Pair& p = image.pair;
    archive(p.a, p.b, p.listed, p.dirty, p.fresh, p.overlapping, p.boxes_overlap, p.estimated, p.passes_at,
            image.contact, image.boxes);
  });
  archive(resting.free, resting.disturbed, resting.releases);
  each(archive, resting.of, [&](auto& slots) { archive(slots); });
  each(archive, resting.contacts, [&](auto& h) {
    archive(h.a, h.b, h.wall, h.push, h.alive, h.fresh, h.left_behind);
    vector(archive, h.normal);
  });
  each(archive, pending, [&](auto& p) {
    archive(p.kind, p.a, p.b, p.removed, p.contact.time);
    for (Feature* f : {&p.contact.feature_a, &p.contact.feature_b}) archive(f->kind, f->first, f->second);
    vector(archive, p.contact.point), vector(archive, p.contact.normal);
  });
}

template void World<1>::Image::archive(kds::detail::Writer&, const std::vector<std::shared_ptr<const Mesh>>&);
template void World<1>::Image::archive(kds::detail::Reader&, const std::vector<std::shared_ptr<const Mesh>>&);
template void World<2>::Image::archive(kds::detail::Writer&, const std::vector<std::shared_ptr<const Mesh>>&);
template void World<2>::Image::archive(kds::detail::Reader&, const std::vector<std::shared_ptr<const Mesh>>&);

}  // namespace kds::collision
