#include "io/scene_file/shape_reader.hpp"

#include "collision/response/mass_properties.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "io/scene_file/body_checks.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kds::io {
namespace {

using kds::collision::Shape;
using Meshes = std::vector<SceneMesh>;

/// A kind of shape in scenes.
struct ShapeReader {
  const char* key;
  Shape (*read)(const JsonNode& node, const Meshes& meshes);
  bool part;  ///< whether it may be a part of a compound
};
std::span<const ShapeReader> shape_readers();

Shape read_sphere(const JsonNode& node, const Meshes&) {
  return kds::collision::Sphere{node["sphere"].object({"radius"})["radius"].positive()};
}

Shape read_box(const JsonNode& node, const Meshes&) {
  const JsonNode half = node["box"].object({"half_extents"})["half_extents"];
  const std::vector<JsonNode> parts = half.tuple(3);
  return kds::collision::Box{{parts[0].positive(), parts[1].positive(), parts[2].positive()}};
}

Shape read_capsule(const JsonNode& node, const Meshes&) {
  const JsonNode capsule = node["capsule"];
  capsule.object({"radius", "half_length"});
  return kds::collision::Capsule{capsule["radius"].positive(), capsule["half_length"].length()};
}

Shape read_half_space(const JsonNode& node, const Meshes&) {
  const JsonNode half_space = node["half_space"];
  half_space.object({"normal", "offset"});
  const kds::collision::HalfSpace shape{half_space["normal"].vector(), half_space["offset"].number()};
  try {
    kds::collision::place(shape, Eigen::Quaterniond::Identity());
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();  // "normal: ..."
    const std::size_t colon = what.find(": ");
    half_space[what.substr(0, colon)].fail(what.substr(colon + 2));
  }
  return shape;
}

Shape read_hull(const JsonNode& node, const Meshes&) {
  const JsonNode points = node["hull"].object({"points"})["points"];
  const std::vector<JsonNode> places = points.elements();
  std::vector<Eigen::Vector3d> corners;
  for (const JsonNode& place : places) corners.push_back(place.vector());
  try {
    const Shape hull = kds::collision::convex_hull(std::move(corners));
    kds::collision::place(hull, Eigen::Quaterniond::Identity());
    return hull;
  } catch (const kds::collision::InvalidHull& error) {
    if (error.point()) {
      const std::string what = error.what();  // "point 4: ..."
      places[*error.point()].fail(what.substr(what.find(": ") + 2));
    }
    points.fail(error.what());
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();  // "hull: ..."
    points.fail(what.substr(what.find(": ") + 2));
  }
}

Shape read_mesh_shape(const JsonNode& node, const Meshes& meshes) {
  const std::string name = node["mesh"].string();
  const auto found = std::find_if(meshes.begin(), meshes.end(), [&](const SceneMesh& m) { return m.name == name; });
  if (found == meshes.end()) node["mesh"].fail("there is no mesh \"" + name + "\" in \"meshes\"");
  const bool scaled = node.has("scale");
  const kds::collision::MeshShape shape{found->mesh, scaled ? node["scale"].positive() : 1.0};
  const std::string problem = mesh_size_problem(shape, scaled);
  if (!problem.empty()) node[scaled ? "scale" : "mesh"].fail(problem);
  return shape;
}

kds::collision::CompoundPart read_part(const JsonNode& node, const Meshes& meshes) {
  node.object({"shape", "position", "orientation"});
  const JsonNode shape = node["shape"];
  for (const ShapeReader& each : shape_readers()) {
    if (each.part || !shape.has(each.key)) continue;
    shape[each.key].fail("cannot be a part of a compound: boxes, hulls and meshes can");
  }
  kds::collision::CompoundPart part{read_shape(shape, meshes)};
  if (node.has("position")) part.position = node["position"].vector();
  if (node.has("orientation")) part.orientation = read_orientation(node["orientation"]);
  return part;
}

Shape read_compound(const JsonNode& node, const Meshes& meshes) {
  const JsonNode compound = node["compound"];
  const JsonNode parts = compound.object({"parts", "about_centre_of_mass"})["parts"];
  const std::vector<JsonNode> nodes = parts.elements();
  if (nodes.empty()) parts.fail("must have at least one part");
  std::vector<kds::collision::CompoundPart> read;
  for (const JsonNode& each : nodes) read.push_back(read_part(each, meshes));
  const bool moved = compound.has("about_centre_of_mass") && compound["about_centre_of_mass"].boolean();
  try {
    return kds::collision::compound(moved ? kds::collision::about_centre_of_mass(read) : read);
  } catch (const kds::collision::InvalidCompound& error) {
    const std::string what = error.what();  // "compound: part 3: ..."
    const std::size_t name = what.find(": ") + 2;
    nodes[error.part().value()].fail(what.substr(what.find(": ", name) + 2));
  }
}

std::span<const ShapeReader> shape_readers() {
  static constexpr ShapeReader readers[] = {
      {"sphere", read_sphere, false},     {"box", read_box, true},   {"mesh", read_mesh_shape, true},
      {"capsule", read_capsule, false},   {"hull", read_hull, true}, {"half_space", read_half_space, false},
      {"compound", read_compound, false},
  };
  return readers;
}

/// The reader of the only kind of which a node has the key.
const ShapeReader& reader_of(const JsonNode& node) {
  const auto readers = shape_readers();
  const auto has = [&](const ShapeReader& each) { return node.has(each.key); };
  const auto found = std::ranges::find_if(readers, has);
  if (found != readers.end() && std::none_of(found + 1, readers.end(), has)) return *found;
  std::string names;
  for (const ShapeReader& each : readers) {
    names += &each == &readers.front() ? "" : &each == &readers.back() ? " and " : ", ";
    names += '"' + std::string(each.key) + '"';
  }
  node.fail("must have exactly one of " + names);
}

}  // namespace

Eigen::Quaterniond read_orientation(const JsonNode& node) {
  const std::vector<JsonNode> parts = node.tuple(4);
  const Eigen::Quaterniond q(parts[0].number(), parts[1].number(), parts[2].number(), parts[3].number());
  return unit_quaternion(q, [&](const std::string& what) { node.fail(what); });
}

std::string mesh_size_problem(const kds::collision::MeshShape& shape, bool scaled) {
  const double radius = shape.mesh->bounding_radius() * shape.scale;
  if (!(radius >= smallest_size && radius <= largest_number)) {
    const std::string limit =
        radius < smallest_size ? "at least " + number_text(smallest_size) : "at most " + number_text(largest_number);
    return (scaled ? "makes the mesh reach " : "reaches ") + rounded_text(radius) + " from its origin; " + limit +
           " is supported";
  }
  const double edge = shape.mesh->shortest_edge() * shape.scale;
  if (edge >= kds::collision::shortest_edge) return {};
  return (scaled ? "makes an edge of the mesh " : "has an edge that is ") + rounded_text(edge) + " long; at least " +
         rounded_text(kds::collision::shortest_edge) + " is supported";
}

Shape read_shape(const JsonNode& node, const Meshes& meshes) {
  static const std::vector<std::string_view> keys = [] {
    std::vector<std::string_view> all{"scale"};
    for (const ShapeReader& each : shape_readers()) all.push_back(each.key);
    return all;
  }();
  node.object(keys);
  const ShapeReader& reader = reader_of(node);
  if (node.has("scale") && !node.has("mesh")) node["scale"].fail("is for meshes only");
  return reader.read(node, meshes);
}

}  // namespace kds::io
