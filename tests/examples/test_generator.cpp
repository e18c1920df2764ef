#include "examples/kds-collide/generator.hpp"
#include "io/mesh_file.hpp"
#include "io/scene_reader.hpp"
#include "tests/io/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

namespace test_generator {

using namespace kds_collide;
using namespace kds::io;
using kds::io::tests::TemporaryFolder;

namespace {

Scene read(const GeneratedScene& generated, const TemporaryFolder& folder) {
  for (const auto& mesh : generated.meshes) folder.write(mesh.name, mesh.text);
  return parse_scene(generated.json, folder / "scene.json");
}

/// FNV-1a.
std::uint64_t hash(const std::string& text) {
  std::uint64_t h = 14695981039346656037u;
  for (const unsigned char c : text) h = (h ^ c) * 1099511628211u;
  return h;
}

}  // namespace

TEST_CASE("generator: one seed gives one scene, here as on every machine") {
  const GeneratorOptions options{.kind = "rings", .bodies = 50, .density = 0.01, .seed = 7};
  const GeneratedScene scene = generate_scene(options);
  CHECK(scene.json == generate_scene(options).json);
  CHECK(hash(scene.json) == 0xb4982a5a283a7789u);
  CHECK(hash(scene.meshes.at(0).text) == 0x309d873ec6b59b95u);
  const GeneratedScene models = generate_scene({.kind = "models", .bodies = 2, .density = 0.01, .seed = 7});
  CHECK(hash(models.meshes.at(0).text) == 0xa9357f6a7985f644u);
  CHECK(hash(models.meshes.at(1).text) == 0x62e8689fee490e95u);
  CHECK(hash(generate_scene({.kind = "spinners", .bodies = 50, .seed = 7}).json) == 0x690ec3731fe4a4e4u);
  GeneratorOptions other = options;
  other.seed = 8;
  CHECK(scene.json != generate_scene(other).json);
}

TEST_CASE("generator: a scene whose bodies are in a table is the same scene") {
  const auto kind = std::string(GENERATE(as<std::string>(), "rings", "models", "spheres", "boxes", "spinning-rings"));
  INFO(kind);
  GeneratorOptions options{.kind = kind, .bodies = 40, .density = 0.1, .seed = 3};
  const TemporaryFolder folder;
  const Scene listed = read(generate_scene(options), folder);
  options.table = "bodies.h5";
  const GeneratedScene generated = generate_scene(options);
  CHECK(generated.table == generate_scene(options).table);
  folder.write(options.table, generated.table);
  const Scene scene = read(generated, folder);
  CHECK(scene.turning == listed.turning);
  REQUIRE(!scene.sources.empty());
  CHECK(scene.sources.back().file == "bodies.h5");
  REQUIRE(scene.bodies.size() == listed.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const SceneBody& a = scene.bodies[i];
    const SceneBody& b = listed.bodies[i];
    CHECK(a.name == b.name);
    REQUIRE(a.shape.index() == b.shape.index());
    if (const auto* mesh = std::get_if<kds::collision::MeshShape>(&a.shape)) {
      CHECK(mesh->scale == std::get<kds::collision::MeshShape>(b.shape).scale);
      CHECK(mesh->mesh->triangles().size() == std::get<kds::collision::MeshShape>(b.shape).mesh->triangles().size());
    }
    const auto placed = [](const SceneBody& body) { return kds::collision::place(body.shape, body.orientation); };
    CHECK(placed(a).low == placed(b).low);
    CHECK(placed(a).high == placed(b).high);
    CHECK(a.motion == b.motion);
  }
}

TEST_CASE("generator: kinds whose bodies do not fit into columns are refused with a table") {
  for (const std::string kind : {"spinners", "rods", "plates", "capsules", "sheet", "crates"}) {
    CHECK_THROWS_WITH(generate_scene({.kind = kind, .bodies = 3, .table = "b.h5"}),
                      "--table: is for spheres, boxes, rings, models and spinning-rings");
  }
}

TEST_CASE("generator: every kind is as the paper's experiment asks") {
  const auto kind = std::string(GENERATE(as<std::string>(), "rings", "models", "spheres", "boxes", "spinners"));
  const double density = GENERATE(0.01, 0.2);
  INFO(kind << " at density " << density);
  const std::size_t bodies = 60;
  const TemporaryFolder folder;
  const Scene scene = read(generate_scene({.kind = kind, .bodies = bodies, .density = density, .seed = 3}), folder);
  REQUIRE(scene.bodies.size() == bodies);
  CHECK(scene.end_time == 1);
  CHECK(scene.response == Response::elastic);
  REQUIRE(scene.domain);
  CHECK(scene.domain->reflects);

  double volume = 0;
  double mean_radius = 0;
  std::vector<double> radii;
  for (const SceneBody& body : scene.bodies) {
    const double r = kds::collision::place(body.shape, body.orientation).bounding_radius;
    CHECK(r > 0.49);
    CHECK(r < 1.51);
    radii.push_back(r);
    volume += 4.0 / 3.0 * std::numbers::pi * r * r * r;
    mean_radius += r / static_cast<double>(bodies);
  }
  CHECK(volume / std::pow(scene.domain->max[0], 3) == Approx(density).epsilon(1e-4));
  for (std::size_t i = 0; i < bodies; ++i) {
    const auto& motion = scene.bodies[i].motion.front().path;
    const double speed = motion.coefficients[1].norm() / mean_radius;
    CHECK(speed > 0.499);
    CHECK(speed < 1.501);
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Vector3d apart = motion.coefficients[0] - scene.bodies[j].motion.front().path.coefficients[0];
      CHECK(apart.norm() > radii[i] + radii[j]);
    }
  }
}

TEST_CASE("generator: spinners are cubes, rods and plates that turn, and only they do") {
  const TemporaryFolder folder;
  const Scene scene = read(generate_scene({.kind = "spinners", .bodies = 30, .seed = 3}), folder);
  CHECK(scene.turning);
  double fastest = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const SceneBody& body = scene.bodies[i];
    const Eigen::Vector3d& half = std::get<kds::collision::Box>(body.shape).half_extents;
    const bool cube = half[0] == half[1] && half[1] == half[2];
    CHECK(cube == (i % 3 == 0));
    CHECK((body.inertia == 0) == cube);
    if (!cube) CHECK(body.inertia == Approx(2 * half.squaredNorm() / 9));
    const double rate = body.motion.front().angular_velocity.norm();
    CHECK(rate < most_turning);
    fastest = std::max(fastest, rate);
  }
  CHECK(fastest > 0.9 * most_turning);
  CHECK_FALSE(read(generate_scene({.kind = "boxes", .bodies = 3}), folder).turning);
}

TEST_CASE("generator: spinning rings, rods, plates and capsules turn, with the inertia of their shapes") {
  const TemporaryFolder folder;
  const auto kind = std::string(GENERATE(as<std::string>(), "spinning-rings", "rods", "plates", "capsules"));
  INFO(kind);
  const Scene scene = read(generate_scene({.kind = kind, .bodies = 30, .seed = 3}), folder);
  CHECK(scene.turning);
  for (const SceneBody& body : scene.bodies) {
    CHECK(body.inertia == 0);
    CHECK_FALSE(body.inertia_tensor);
    CHECK(body.motion.front().angular_velocity.norm() > 0);
    if (kind == "spinning-rings") continue;
    if (kind == "capsules") {
      const auto& capsule = std::get<kds::collision::Capsule>(body.shape);
      CHECK(capsule.radius < 0.2 * capsule.half_length);
      continue;
    }
    const Eigen::Vector3d& half = std::get<kds::collision::Box>(body.shape).half_extents;
    CHECK(half[0] < 0.17 * half[2]);
    CHECK((kind == "rods" ? half[1] < 0.17 * half[2] : half[1] > 0.59 * half[2]));
  }
}

TEST_CASE("generator: crates fall into a box of fixed boxes") {
  const TemporaryFolder folder;
  const std::size_t bodies = 20;
  const Scene scene = read(generate_scene({.kind = "crates", .bodies = bodies, .seed = 3}), folder);
  CHECK(scene.end_time == 8);
  CHECK(read(generate_scene({.kind = "crates", .bodies = bodies, .seed = 3, .end_time = 2.5}), folder).end_time == 2.5);
  CHECK(scene.turning);
  REQUIRE(scene.bodies.size() == bodies + 5);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const SceneBody& body = scene.bodies[i];
    CHECK(body.fixed == (i < 5));
    CHECK(body.restitution == 0.3);
    CHECK(body.friction == 0.5);
    if (body.fixed) continue;
    const double r = kds::collision::place(body.shape, body.orientation).bounding_radius;
    const Eigen::Vector3d at = body.motion.front().path.coefficients[0];
    CHECK(at.head<2>().cwiseAbs().maxCoeff() + r < 2.25);
    for (std::size_t j = 5; j < i; ++j) {
      const double other = kds::collision::place(scene.bodies[j].shape, body.orientation).bounding_radius;
      CHECK((at - scene.bodies[j].motion.front().path.coefficients[0]).norm() > r + other);
    }
  }
}

TEST_CASE("generator: meshes are closed, wound outward and of bounding radius 1") {
  const GeneratedScene rings = generate_scene({.kind = "rings", .bodies = 1});
  const GeneratedScene models = generate_scene({.kind = "models", .bodies = 1});
  auto files = models.meshes;
  files.push_back(rings.meshes.at(0));
  const TemporaryFolder folder;
  for (const auto& file : files) {
    INFO(file.name);
    const MeshData mesh = read_mesh_file(folder.write(file.name, file.text));
    CHECK((file.name == "ring.obj" ? mesh.triangles.size() == 64 : mesh.triangles.size() > 6000));
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double volume = 0;
    double radius = 0;
    for (const auto& t : mesh.triangles) {
      for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
      volume += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6;
    }
    for (const auto& v : mesh.vertices) radius = std::max(radius, v.norm());
    bool closed = true;
    for (const auto& [edge, count] : edges)
      closed = closed && count == 1 && edges.count({edge.second, edge.first}) == 1;
    CHECK(closed);
    CHECK(volume > 0);
    CHECK(radius == Approx(1));
  }
}

TEST_CASE("generator: the sparsest scene can be read") {
  const TemporaryFolder folder;
  CHECK(read(generate_scene({.kind = "spheres", .bodies = 20, .density = 1e-12}), folder).bodies.size() == 20);
}

TEST_CASE("generator: options out of range are refused") {
  const auto error = [](const GeneratorOptions& options) {
    try {
      generate_scene(options);
      return std::string("no error");
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
  };
  CHECK(error({.kind = "cubes"}) ==
        "--generate: there is no \"cubes\"; use rings, models, spheres, boxes, spinners, "
        "spinning-rings, rods, plates, capsules, sheet or crates");
  CHECK(error({.bodies = 0}) == "--bodies: must be > 0");
  for (const double density : {0.0, 1e-100, 0.9, static_cast<double>(NAN)}) {
    CHECK(error({.density = density}) == "--density: must be from 1e-12 to 0.3");
  }
  for (const std::string kind : {"sheet", "crates"}) {
    CHECK(error({.kind = kind, .density = 0.01}) ==
          "--density: is not for " + kind + ", whose bodies have places of their own");
  }
}

}  // namespace test_generator
