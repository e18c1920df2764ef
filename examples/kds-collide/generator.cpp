#include "examples/kds-collide/generator.hpp"

#include "examples/kds-collide/model_meshes.hpp"
#include "examples/kds-collide/placement.hpp"
#include "io/body_table.hpp"
#include "kds/number_text.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kds_collide {

using namespace kds::io;
using kds::append_number;

namespace {

using Eigen::Vector3d;

void append_array(std::string& text, const Vector3d& v) {
  for (int d = 0; d < 3; ++d) {
    text += d == 0 ? '[' : ',';
    append_number(text, v[d]);
  }
  text += ']';
}

void append_rotation(std::string& text, const Eigen::Quaterniond& q) {
  text += '[';
  for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
    append_number(text, part);
    text += ',';
  }
  text.back() = ']';
}

/// Of a box inscribed in the bounding radius, with edges in random proportions.
Vector3d half_extents(double radius, Random& random) {
  Vector3d half;
  for (int d = 0; d < 3; ++d) half[d] = random.uniform(0.5, 1);
  return half * (radius / half.norm());
}

std::string box_shape(const Vector3d& half_extents) {
  std::string text = "{\"box\": {\"half_extents\": ";
  append_array(text, half_extents);
  return text + "}}";
}

/// Of this bounding radius, and what follows the shape: its moment of inertia, unless it is a cube, whose moments are
/// equal. 2/9 m r^2 is the mean of the moments of any box.
std::string spinner_shape(double radius, std::size_t kind) {
  constexpr double slender = 0.125;  // width of a rod, thickness of a plate
  const Vector3d half = std::array{Vector3d(1, 1, 1), Vector3d(slender, slender, 1), Vector3d(1, 1, slender)}[kind % 3];
  std::string text = box_shape(half * (radius / half.norm()));
  if (kind % 3 == 0) return text;
  text += ", \"inertia\": ";
  append_number(text, 2 * radius * radius / 9);
  return text;
}

/// Of this bounding radius, slender, with widths in random proportions: no two moments are equal.
std::string slender_shape(double radius, bool rod, Random& random) {
  const double thickness = random.uniform(0.08, 0.16);
  const double width = rod ? random.uniform(0.08, 0.16) : random.uniform(0.6, 1);
  const Vector3d half(thickness, width, 1);
  return box_shape(half * (radius / half.norm()));
}

/// A rod that is round, as long as one of slender_shape().
std::string capsule_shape(double radius, Random& random) {
  const double thickness = random.uniform(0.08, 0.16) * radius;
  std::string text = "{\"capsule\": {\"radius\": ";
  append_number(text, thickness);
  text += ", \"half_length\": ";
  append_number(text, radius - thickness);
  return text + "}}";
}

std::string sphere_shape(double radius) {
  std::string text = "{\"sphere\": {\"radius\": ";
  append_number(text, radius);
  return text + "}}";
}

std::string mesh_shape(const std::string& mesh, double scale) {
  std::string text = "{\"mesh\": \"" + mesh + "\", \"scale\": ";
  append_number(text, scale);
  return text + '}';
}

double bounding_radius(const MeshData& mesh) {
  double radius = 0;
  for (const Vector3d& v : mesh.vertices) radius = std::max(radius, v.norm());
  return radius;
}

void check(const GeneratorOptions& options) {
  const auto kinds = generator_kinds();
  if (std::find(kinds.begin(), kinds.end(), options.kind) == kinds.end()) {
    throw std::invalid_argument(
        "--generate: there is no \"" + options.kind +
        "\"; use rings, models, spheres, boxes, spinners, spinning-rings, rods, plates, capsules, sheet or crates");
  }
  const bool in_columns = options.kind == "spheres" || options.kind == "boxes" || options.kind == "rings" ||
                          options.kind == "models" || options.kind == "spinning-rings";
  if (!options.table.empty() && !in_columns) {
    throw std::invalid_argument("--table: is for spheres, boxes, rings, models and spinning-rings");
  }
  constexpr std::size_t most_bodies = 10'000'000;  // about 3 GB of text
  if (options.bodies == 0) throw std::invalid_argument("--bodies: must be > 0");
  if (options.bodies > most_bodies) throw std::invalid_argument("--bodies: must be at most 10000000");
  // With most_bodies this is 5.3e18 cells of Placement's, whose numbers are below 2^63.
  constexpr double lowest_density = 1e-12;
  const double density = options.density.value_or(default_density);
  if (!(density >= lowest_density && density <= 0.3)) {
    throw std::invalid_argument("--density: must be from 1e-12 to 0.3");
  }
  if (options.density && !has_density(options.kind)) {
    throw std::invalid_argument("--density: is not for " + options.kind + ", whose bodies have places of their own");
  }
}

Vector3d random_spin(Random& random) {
  const Vector3d axis = random.direction();
  return axis * random.uniform(0, most_turning);
}

struct NamedMesh {
  std::string name;
  double radius;
};

/// A square of 2 n n triangles.
MeshData sheet_mesh(std::uint32_t n, double side) {
  MeshData mesh;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) mesh.vertices.emplace_back(side * i / n, side * j / n, 0);
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

/// A hump between 0 and 1 of the period 1: two parabolas, as sines are not rounded alike everywhere.
double hump(double x) {
  const double part = x - std::floor(x);
  const double from_middle = std::abs(2 * part - 1);
  return from_middle < 0.5 ? 1 - 2 * from_middle * from_middle : 2 * (1 - from_middle) * (1 - from_middle);
}

/// A sheet on which two waves run, and balls that fly to it from above and below and bounce off.
GeneratedScene sheet_scene(const GeneratorOptions& options) {
  const double end_time = options.end_time.value_or(default_end_time);
  constexpr std::uint32_t squares = 24;
  constexpr int steps = 24;  // of the sheet, between keyframes
  constexpr double side = 16, height = 2;
  const MeshData mesh = sheet_mesh(squares, side);
  GeneratedScene scene;
  scene.meshes.push_back({"sheet.obj", to_obj(mesh)});
  std::string& json = scene.json;
  json = "{\n\"scene\": 1,\n\"end_time\": ";
  append_number(json, end_time);
  json += ",\n\"response\": \"elastic\",\n\"meshes\": {\"sheet\": {\"file\": \"sheet.obj\"}},\n\"bodies\": [\n";
  json +=
      "{\"name\": \"sheet\", \"shape\": {\"mesh\": \"sheet\"}, \"fixed\": true,\n \"motion\": [{\"start\": 0, "
      "\"position\": [[0,0,0]]}], \"vertices\": [\n";
  for (int step = 0; step <= steps; ++step) {
    const double part = static_cast<double>(step) / steps;
    json += "{\"time\": ";
    append_number(json, end_time * part);
    json += ", \"positions\": [";
    for (const Vector3d& v : mesh.vertices) {
      append_array(json, {v[0], v[1], height * (hump(v[0] / side - part) + 0.5 * hump(2 * v[1] / side + part))});
      json += ',';
    }
    json.back() = ']';
    json += step < steps ? "},\n" : "}]}";
  }
  Random random(options.seed);
  for (std::size_t i = 0; i < options.bodies; ++i) {
    const double from = i % 2 == 0 ? 6 : -4;
    json += ",\n{\"name\": \"b" + std::to_string(i) + "\", \"shape\": " + sphere_shape(random.uniform(0.2, 0.6));
    json += ", \"motion\": [{\"start\": 0, \"position\": [";
    const double x = random.uniform(1, side - 1), y = random.uniform(1, side - 1);
    append_array(json, {x, y, from});
    json += ',';
    const double way = random.uniform(4, 10) / end_time;
    append_array(json, {0, 0, from > 0 ? -way : way});
    json += "]}]}";
  }
  json += "\n]\n}\n";
  return scene;
}

/// Crates, boards and rods that are thrown into a box without a lid: fixed boxes, which are rough, as walls of the
/// domain are not.
GeneratedScene crates_scene(const GeneratorOptions& options) {
  constexpr std::size_t a_side = 3;  // of a layer of bodies
  constexpr double all_rest = 8;     // s, in which a dozen come to rest
  constexpr double spacing = 1.25, half_width = 2.25, thickness = 0.25, gravity = 9.81;
  const double height = 2 + static_cast<double>(options.bodies / (a_side * a_side));
  GeneratedScene scene;
  std::string& json = scene.json;
  json = "{\n\"scene\": 1,\n\"end_time\": ";
  append_number(json, options.end_time.value_or(all_rest));
  json += ",\n\"response\": \"elastic\", \"restitution\": 0.3, \"friction\": 0.5,\n\"bodies\": [\n";
  const auto add = [&](const std::string& name, const Vector3d& half) {
    json += "{\"name\": \"" + name + "\", \"shape\": {\"box\": {\"half_extents\": ";
    append_array(json, half);
    json += "}}, ";
  };
  const auto add_fixed = [&](const std::string& name, const Vector3d& half, const Vector3d& at) {
    add(name, half);
    json += "\"fixed\": true, \"motion\": [{\"start\": 0, \"position\": [";
    append_array(json, at);
    json += "]}]},\n";
  };
  const double edge = half_width + 2 * thickness, middle = half_width + thickness;
  add_fixed("floor", {edge, edge, thickness}, {0, 0, -thickness});
  add_fixed("left", {thickness, half_width, height / 2}, {-middle, 0, height / 2});
  add_fixed("right", {thickness, half_width, height / 2}, {middle, 0, height / 2});
  add_fixed("front", {half_width, thickness, height / 2}, {0, -middle, height / 2});
  add_fixed("back", {half_width, thickness, height / 2}, {0, middle, height / 2});
  const std::array shapes{Vector3d(0.3, 0.3, 0.3), Vector3d(0.1, 0.125, 0.55), Vector3d(0.4, 0.3, 0.15)};
  Random random(options.seed);
  for (std::size_t i = 0; i < options.bodies; ++i) {
    const Eigen::Quaterniond q = random.rotation();
    const double x = random.uniform(-0.05, 0.05), y = random.uniform(-0.05, 0.05);
    const Vector3d cell(static_cast<double>(i % a_side) - 1, static_cast<double>(i / a_side % a_side) - 1,
                        1 + static_cast<double>(i / (a_side * a_side)));
    add("crate" + std::to_string(i), shapes[i % 3]);
    json += "\"orientation\": ";
    append_rotation(json, q);
    json += ", \"motion\": [{\"start\": 0, \"position\": [";
    append_array(json, spacing * cell + Vector3d(x, y, 0));
    json += ",[0,0,0],";
    append_array(json, Vector3d(0, 0, -gravity / 2));
    json += "], \"angular_velocity\": ";
    const Vector3d axis = random.direction();
    append_array(json, axis * random.uniform(0, 3));
    json += i + 1 < options.bodies ? "}]},\n" : "}]}\n";
  }
  json += "]\n}\n";
  return scene;
}

}  // namespace

std::vector<std::string_view> generator_kinds() {
  return {"rings", "models", "spheres",  "boxes", "spinners", "spinning-rings",
          "rods",  "plates", "capsules", "sheet", "crates"};
}

bool has_density(std::string_view kind) { return kind != "sheet" && kind != "crates"; }

GeneratedScene generate_scene(const GeneratorOptions& options) {
  check(options);
  if (options.kind == "sheet") return sheet_scene(options);
  if (options.kind == "crates") return crates_scene(options);
  GeneratedScene scene;
  std::vector<NamedMesh> meshes;
  const auto add_mesh = [&](const std::string& name, const MeshData& mesh) {
    meshes.push_back({name, bounding_radius(mesh)});
    scene.meshes.push_back({name + ".obj", to_obj(mesh)});
  };
  if (options.kind == "rings" || options.kind == "spinning-rings") add_mesh("ring", ring_mesh());
  if (options.kind == "models") {
    add_mesh("knot", knot_mesh());
    add_mesh("bumpy-torus", bumpy_torus_mesh());
  }

  const bool rods = options.kind == "rods", plates = options.kind == "plates";
  const bool capsules = options.kind == "capsules";
  const bool spins = rods || plates || capsules || options.kind == "spinners" || options.kind == "spinning-rings";

  Random random(options.seed);
  std::vector<double> radii(options.bodies);
  double volume = 0;
  double mean_radius = 0;
  for (double& r : radii) {
    r = random.uniform(0.5, 1.5);
    volume += 4.0 / 3.0 * std::numbers::pi * r * r * r;
    mean_radius += r / static_cast<double>(options.bodies);
  }
  const double largest = *std::max_element(radii.begin(), radii.end());
  // cbrt is not rounded alike everywhere; six digits of it are. One body alone may need more room than its density.
  constexpr double side_grid = 1e-6;
  const double side =
      std::max(std::ceil(std::cbrt(volume / options.density.value_or(default_density)) / side_grid) * side_grid,
               2.125 * largest);

  std::string& json = scene.json;
  json = "{\n\"scene\": 1,\n\"end_time\": ";
  append_number(json, options.end_time.value_or(default_end_time));
  json += ",\n\"response\": \"elastic\",\n\"domain\": {\"min\": [0,0,0], \"max\": ";
  append_array(json, Vector3d::Constant(side));
  json += ", \"walls\": \"reflect\"},\n\"meshes\": {";
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    json += (i == 0 ? "\"" : ", \"") + meshes[i].name + "\": {\"file\": \"" + meshes[i].name + ".obj\"}";
  }
  json += "},\n";
  const std::string prefix = options.kind.substr(0, 1);
  BodyTable table;
  if (options.table.empty()) {
    json += "\"bodies\": [\n";
  } else {
    json += "\"tables\": [{\"file\": \"" + options.table + "\", \"prefix\": \"" + prefix + '"';
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      json += (i == 0 ? ", \"shapes\": [" : ", ") + mesh_shape(meshes[i].name, 1);
    }
    json += meshes.empty() ? "}]\n}\n" : "]}]\n}\n";
  }

  Placement placement(side, largest);
  // A ball of the largest radius finds room in one of about 20 tries at a density of 0.3.
  constexpr int most_tries = 100'000;
  // Walls and neighbours are kept from by a little more than the radius, whose rounding depends on the reader.
  constexpr double margin = 1 + 1e-6;
  for (std::size_t i = 0; i < options.bodies; ++i) {
    const double r = radii[i] * margin;
    Vector3d at;
    int tries = 0;
    do {
      if (++tries > most_tries) {
        throw std::invalid_argument("--density: found no room for body " + std::to_string(i) + "; use a lower density");
      }
      for (int d = 0; d < 3; ++d) at[d] = random.uniform(r, side - r);
    } while (!placement.is_free(at, r));
    placement.add(at, r);
    const Vector3d velocity = random.direction() * (random.uniform(0.5, 1.5) * mean_radius);
    const Eigen::Quaterniond q = random.rotation();

    if (!options.table.empty()) {
      table.position.push_back(at);
      table.velocity.push_back(velocity);
      table.orientation.emplace_back(q.w(), q.x(), q.y(), q.z());
      if (!meshes.empty()) {
        table.shape.push_back(static_cast<std::int64_t>(i % meshes.size()));
        table.scale.push_back(radii[i] / meshes[i % meshes.size()].radius);
      } else if (options.kind == "boxes") {
        table.half_extents.push_back(half_extents(radii[i], random));
      } else {
        table.radius.push_back(radii[i]);
      }
      if (spins) table.angular_velocity.push_back(random_spin(random));
      continue;
    }
    json += "{\"name\": \"" + prefix + std::to_string(i) + "\", \"shape\": ";
    if (!meshes.empty()) {
      const NamedMesh& mesh = meshes[i % meshes.size()];
      json += mesh_shape(mesh.name, radii[i] / mesh.radius);
    } else if (rods || plates) {
      json += slender_shape(radii[i], rods, random);
    } else if (capsules) {
      json += capsule_shape(radii[i], random);
    } else if (spins) {
      json += spinner_shape(radii[i], i);
    } else {
      json += options.kind == "boxes" ? box_shape(half_extents(radii[i], random)) : sphere_shape(radii[i]);
    }
    json += ", \"orientation\": ";
    append_rotation(json, q);
    json += ", \"motion\": [{\"start\": 0, \"position\": [";
    append_array(json, at);
    json += ',';
    append_array(json, velocity);
    json += ']';
    if (spins) {
      json += ", \"angular_velocity\": ";
      append_array(json, random_spin(random));
    }
    json += i + 1 < options.bodies ? "}]},\n" : "}]}\n";
  }
  if (options.table.empty()) {
    json += "]\n}\n";
  } else {
    scene.table = to_hdf5(table);
  }
  return scene;
}

}  // namespace kds_collide
