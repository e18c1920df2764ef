#include "io/scene_file/shape_reader.hpp"

#include "collision/shapes/convex_hull.hpp"
#include "io/number_text.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kds::io {
namespace {

using kds::collision::Shape;
using Meshes = std::vector<SceneMesh>;

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
  return kds::collision::HalfSpace{half_space["normal"].vector(), half_space["offset"].number()};
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
  const double scale = scaled ? node["scale"].positive() : 1.0;
  const std::string problem =
      mesh_size_problem(found->mesh->bounding_radius() * scale, scaled ? "makes the mesh reach " : "reaches ");
  if (!problem.empty()) node[scaled ? "scale" : "mesh"].fail(problem);
  return kds::collision::MeshShape{found->mesh, scale};
}

struct ShapeReader {
  const char* key;
  Shape (*read)(const JsonNode& node, const Meshes& meshes);
};
constexpr const char* one_shape =
    "must have exactly one of \"sphere\", \"box\", \"mesh\", \"capsule\", \"hull\" and \"half_space\"";
constexpr ShapeReader shape_readers[] = {{"sphere", read_sphere},   {"box", read_box},
                                         {"mesh", read_mesh_shape}, {"capsule", read_capsule},
                                         {"hull", read_hull},       {"half_space", read_half_space}};

}  // namespace

std::string mesh_size_problem(double radius, std::string_view reaches) {
  if (radius >= smallest_size && radius <= largest_number) return {};
  const std::string limit =
      radius < smallest_size ? "at least " + number_text(smallest_size) : "at most " + number_text(largest_number);
  return std::string(reaches) + about(radius) + " from its origin; " + limit + " is supported";
}

Shape read_shape(const JsonNode& node, const Meshes& meshes) {
  node.object({"sphere", "box", "mesh", "capsule", "hull", "half_space", "scale"});
  const ShapeReader* found = nullptr;
  for (const ShapeReader& each : shape_readers) {
    if (!node.has(each.key)) continue;
    if (found) node.fail(one_shape);
    found = &each;
  }
  if (!found) node.fail(one_shape);
  if (node.has("scale") && !node.has("mesh")) node["scale"].fail("is for meshes only");
  return found->read(node, meshes);
}

}  // namespace kds::io
