#include "collision/response/mass_properties.hpp"
#include "collision/shapes/mesh.hpp"
#include "io/scene_reader.hpp"

#include "collision/shapes/compound.hpp"
#include "collision/shapes/polytope.hpp"
#include "tests/io/sample_scene.hpp"
#include "tests/io/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <string>

namespace test_scene_reader {

using namespace kds::io;
using kds::io::tests::TemporaryFolder;
using kds::io::tests::tetrahedron;
using kds::io::tests::valid_scene;

TEST_CASE("scene reader: a valid scene is read as it says") {
  const TemporaryFolder folder;
  folder.write("ring.obj", tetrahedron);
  const Scene scene = parse_scene(valid_scene, folder / "scene.json");
  CHECK(scene.begin_time == 0);
  CHECK(scene.end_time == 1);
  CHECK(scene.response == Response::none);
  REQUIRE(scene.domain);
  CHECK(scene.domain->max == Eigen::Vector3d(80, 80, 80));
  CHECK(scene.domain->reflects);
  REQUIRE(scene.bodies.size() == 3);
  CHECK(scene.degree() == 2);

  const SceneBody& a = scene.bodies[0];
  CHECK(a.name == "a");
  CHECK(std::get<kds::collision::Sphere>(a.shape).radius == 1);
  CHECK(a.orientation.coeffs() == Eigen::Quaterniond::Identity().coeffs());
  CHECK(a.mass == 1);
  CHECK_FALSE(a.fixed);
  REQUIRE(a.motion.size() == 1);
  CHECK(a.motion[0].path.coefficients[2] == Eigen::Vector3d(0, 0, -4.9));

  CHECK(std::get<kds::collision::Box>(scene.bodies[1].shape).half_extents == Eigen::Vector3d(1, 2, 3));
  CHECK(scene.bodies[1].mass == 2);
  CHECK(scene.bodies[1].motion[0].path.coefficients[2].isZero(0));

  const SceneBody& c = scene.bodies[2];
  CHECK(std::get<kds::collision::MeshShape>(c.shape).scale == 2);
  CHECK(std::get<kds::collision::MeshShape>(c.shape).mesh->triangles().size() == 4);
  CHECK(c.orientation.w() == Approx(0.6));
  CHECK(c.orientation.x() == Approx(0.8));
  CHECK(c.fixed);
  REQUIRE(c.motion.size() == 2);
  CHECK(c.motion[1].start() == 0.5);
  CHECK_FALSE(scene.turning);
}

TEST_CASE("scene reader: pieces that turn go on with the orientation that the one before has led to") {
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 2, "bodies": [
    {"name": "a", "shape": {"box": {"half_extents": [1,1,1]}}, "orientation": [0,1,0,0], "motion": [
      {"start": 0, "position": [[0,0,0]], "angular_velocity": [0,0,3.141592653589793]},
      {"start": 0.5, "position": [[0,0,0]]},
      {"start": 1, "position": [[0,0,0]]},
      {"start": 1.5, "position": [[0,0,0]], "orientation": [0,0,1,0], "angular_velocity": [1,2,3]}]}]})",
                                  "scene.json");
  CHECK(scene.turning);
  const auto& motion = scene.bodies.at(0).motion;
  REQUIRE(motion.size() == 4);
  CHECK(motion[0].orientation.coeffs() == Eigen::Quaterniond(0, 1, 0, 0).coeffs());
  CHECK(motion[0].angular_velocity == Eigen::Vector3d(0, 0, 3.141592653589793));
  // A quarter turn about z, after the half turn about x.
  const double root = std::sqrt(0.5);
  CHECK((motion[1].orientation.coeffs() - Eigen::Quaterniond(0, root, root, 0).coeffs()).norm() < 1e-15);
  CHECK(motion[1].angular_velocity.isZero(0));
  CHECK(motion[2].orientation.coeffs() == motion[1].orientation.coeffs());
  CHECK(motion[3].orientation.coeffs() == Eigen::Quaterniond(0, 0, 1, 0).coeffs());
  CHECK(motion[3].angular_velocity == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("scene reader: a scene turns if it speaks of turning") {
  const auto turns = [](const std::string& of_body, const std::string& of_piece) {
    return parse_scene(R"({"scene": 1, "end_time": 2, "response": "elastic", "bodies": [{"name": "a", )" + of_body +
                           R"("shape": {"sphere": {"radius": 1}}, "motion": [{)" + of_piece +
                           R"("start": 0, "position": [[0,0,0]]}]}]})",
                       "scene.json");
  };
  CHECK_FALSE(turns("", "").turning);
  CHECK_FALSE(turns(R"("orientation": [0,1,0,0], )", "").turning);
  CHECK(turns("", R"("angular_velocity": [0,0,0], )").turning);
  const Scene scene = turns(R"("inertia": 3, )", "");
  CHECK(scene.turning);
  CHECK(scene.bodies.at(0).inertia == 3);
}

TEST_CASE("scene reader: bodies of any moments turn") {
  const auto read = [](const std::string& response, const std::string& of_body) {
    parse_scene(R"({"scene": 1, "end_time": 2, "response": ")" + response + R"(", "bodies": [{"name": "a", )" +
                    of_body + R"("shape": {"box": {"half_extents": [1,2,3]}}, "motion": [
                      {"start": 0, "position": [[0,0,0]], "angular_velocity": [0,0,1]}]}]})",
                "scene.json");
  };
  CHECK_NOTHROW(read("none", ""));
  CHECK_NOTHROW(read("elastic", R"("sensor": true, )"));
  CHECK_NOTHROW(read("elastic", R"("fixed": true, )"));
  CHECK_NOTHROW(read("elastic", R"("inertia": 1, )"));
  CHECK_NOTHROW(read("elastic", ""));
}

TEST_CASE("scene reader: inertia is one number, three moments or a tensor") {
  const auto read = [](const std::string& inertia) {
    return parse_scene(R"({"scene": 1, "end_time": 2, "response": "elastic", "bodies": [{"name": "a", "inertia": )" +
                           inertia + R"(, "shape": {"box": {"half_extents": [1,2,3]}}, "motion": [
                             {"start": 0, "position": [[0,0,0]]}]}]})",
                       "scene.json");
  };
  CHECK_FALSE(read("1.5").bodies[0].inertia_tensor);
  const Scene moments = read("[1.5, 1.5, 1.5]");
  CHECK(moments.bodies[0].inertia_tensor == Eigen::Matrix3d(1.5 * Eigen::Matrix3d::Identity()));
  const Scene tensor = read("[[1.5, 0, 0], [0, 1.5, 0], [0, 0, 1.5]]");
  CHECK(tensor.bodies[0].inertia_tensor == moments.bodies[0].inertia_tensor);
  const std::string where = "scene.json: bodies[0].inertia: ";
  CHECK(read("[1, 1.25, 1.5]").bodies[0].inertia_tensor == Eigen::Matrix3d(Eigen::Vector3d(1, 1.25, 1.5).asDiagonal()));
  CHECK_THROWS_WITH(read("[1, 1, 1e-13]"), where + "its least moment must be at least 2^-40 (9.1e-13) of the greatest");
  CHECK_THROWS_WITH(read("[1, 1, 3]"), where + "is of no body: its greatest moment exceeds the sum of the two others");
  CHECK_THROWS_WITH(read("[[1,2,0],[2,1,0],[0,0,1]]"), where + "must be positive definite");
  CHECK_THROWS_WITH(read("[[1,0.5,0],[0,1,0],[0,0,1]]"), Catch::StartsWith(where + "must be symmetric"));
}

TEST_CASE("scene reader: a solid that is open has no inertia of its own, and one that precesses needs a fine clock") {
  const TemporaryFolder folder;
  folder.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto read = [&](const std::string& start, const std::string& shape, const std::string& velocity) {
    parse_scene(R"({"scene": 1, "end_time": 2, "response": "elastic", "meshes": {"m": {"file": "sheet.obj"}},
                    "bodies": [{"name": "a", "shape": )" +
                    shape + R"(, "motion": [{"start": )" + start + R"(, "position": [[0,0,0]], "angular_velocity": )" +
                    velocity + "}]}]}",
                folder / "scene.json");
  };
  CHECK_THROWS_WITH(
      read("0", R"({"mesh": "m"})", "[0,0,1]"),
      Catch::EndsWith("scene.json: bodies[0].shape: the mesh is open: edge 0-1 belongs to one triangle, 0"));
  CHECK_THROWS_WITH(
      read("1", R"({"box": {"half_extents": [1,2,3]}})", "[1e20,1e20,0]"),
      Catch::Contains("scene.json: bodies[0].motion[0].angular_velocity: the body precesses, and turns by "
                      "more than a radian between two doubles of the clock"));
}

TEST_CASE("scene reader: a mesh may be a heightfield") {
  const TemporaryFolder folder;
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 2,
      "meshes": {"hill": {"heightfield": {"heights": [[0, 0, 0], [0, 1, 0.5]], "spacing": [2, 3]}}},
      "bodies": [{"name": "a", "shape": {"mesh": "hill", "scale": 2}, "motion": [{"start": 0, "position": [[0,0,0]]}]}]})",
                                  folder / "scene.json");
  REQUIRE(scene.meshes.size() == 1);
  const auto& mesh = *scene.meshes[0].mesh;
  CHECK(scene.meshes[0].file.empty());
  CHECK(mesh.triangles().size() == 4);
  CHECK(mesh.vertices()[0] == Eigen::Vector3d(-2, -1.5, 0));
  CHECK(mesh.vertices()[4] == Eigen::Vector3d(0, 1.5, 1));
  CHECK(std::get<kds::collision::MeshShape>(scene.bodies[0].shape).mesh == scene.meshes[0].mesh);
}

TEST_CASE("scene reader: degenerate triangles of a mesh file are left out, and warned of") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& faces) {
    folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\n" + faces);
    return parse_scene(R"({"scene": 1, "end_time": 2, "meshes": {"m": {"file": "m.obj"}},
                           "bodies": [{"name": "a", "shape": {"mesh": "m"}, "motion": [{"start": 0, "position": [[0,0,0]]}]}]})",
                       folder / "scene.json");
  };
  CHECK(read("f 1 2 3\n").warnings.empty());
  const Scene one = read("f 1 2 3\nf 1 2 4\n");
  CHECK(one.meshes[0].mesh->triangles().size() == 1);
  const std::string where = (folder / "scene.json").string() + ": meshes.m.file: m.obj: ";
  CHECK(one.warnings == std::vector<std::string>{where + "1 of 2 triangles is degenerate and left out, in line 6"});
  CHECK(read("f 1 2 3\nf 1 1 2\nf 2 3 4\nf 1 2 4\n").warnings ==
        std::vector<std::string>{where + "2 of 4 triangles are degenerate and left out, the first is in line 6"});
  CHECK_THROWS_WITH(read("f 1 2 4\n"), where + "no triangle is left: 1 of 1 triangle is degenerate, in line 5");
  CHECK(read("f 2 3 4 1\nf 3 1 2 3 1 2\n").warnings ==
        std::vector<std::string>{where + "a face crosses itself and is cut as a fan, in line 6",
                                 where + "2 of 5 triangles are degenerate and left out, the first is in line 6"});
}

TEST_CASE("scene reader: a shape is placed about its pivot") {
  const auto read = [](const std::string& of_body, const std::string& response) {
    return parse_scene(R"({"scene": 1, "end_time": 2, "response": ")" + response +
                           R"(", "bodies": [{"name": "door", )" + of_body +
                           R"("shape": {"box": {"half_extents": [1,2,3]}}, "motion": [
                             {"start": 0, "position": [[5,0,0]], "pivot": [-1,0.5,0]}]}]})",
                       "scene.json");
  };
  const Scene scene = read(R"("fixed": true, )", "elastic");
  CHECK(scene.turning);
  const auto& hull = *std::get<kds::collision::ConvexHull>(scene.bodies[0].shape).polytope;
  CHECK(hull.points()[0] == Eigen::Vector3d(0, -2.5, -3));
  CHECK(hull.points()[7] == Eigen::Vector3d(2, 1.5, 3));
  CHECK(scene.bodies[0].motion[0].path.coefficients[0] == Eigen::Vector3d(5, 0, 0));
  const auto solid = kds::collision::mass_properties(scene.bodies[0].shape, 1);  // closed, and not inside out
  CHECK((solid.centre - Eigen::Vector3d(1, -0.5, 0)).norm() < 1e-15);
  CHECK_NOTHROW(read("", "none"));
  CHECK_NOTHROW(read(R"("sensor": true, )", "elastic"));
  CHECK_THROWS_WITH(read("", "elastic"),
                    "scene.json: bodies[0].motion[0].pivot: a body that contacts move turns about "
                    "its centre of mass: make it fixed, or a sensor");
}

TEST_CASE("scene reader: hulls, compounds and meshes are placed about their pivots") {
  const auto centre = [](const std::string& shape) {
    const Scene scene = parse_scene(R"({"scene": 1, "end_time": 2, "bodies": [{"name": "a", "shape": )" + shape +
                                        R"(, "motion": [{"start": 0, "position": [[5,0,0]], "pivot": [-1,0.5,0]}]}]})",
                                    "scene.json");
    return kds::collision::mass_properties(scene.bodies[0].shape, 1).centre;
  };
  const std::string tetrahedron = R"({"hull": {"points": [[-1,-1,-1],[3,-1,-1],[-1,3,-1],[-1,-1,3]]}})";
  CHECK((centre(tetrahedron) - Eigen::Vector3d(1, -0.5, 0)).norm() < 1e-15);
  CHECK((centre(R"({"compound": {"parts": [{"shape": )" + tetrahedron + R"(, "position": [1, 0, 0]},
                                 {"shape": {"box": {"half_extents": [1,1,1]}}, "position": [-1, 0, 0]}]}})") -
         Eigen::Vector3d(1 + (32.0 / 3 - 8) / (32.0 / 3 + 8), -0.5, 0))
            .norm() < 1e-14);
}

TEST_CASE("scene reader: friction is the scene's where a body of a scene that turns has none of its own") {
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 2, "friction": 0.5, "tangential_restitution": -0.5,
    "rolling_friction": 0.25, "response": "elastic", "bodies": [
      {"name": "a", "shape": {"sphere": {"radius": 1}}, "friction": 2, "inertia": 1,
       "motion": [{"start": 0, "position": [[0,0,0]]}]},
      {"name": "b", "shape": {"sphere": {"radius": 1}}, "tangential_restitution": 1,
       "rolling_friction": 0, "motion": [{"start": 0, "position": [[9,0,0]]}]}]})",
                                  "scene.json");
  CHECK(scene.bodies[0].friction == 2);
  CHECK(scene.bodies[0].tangential_restitution == -0.5);
  CHECK(scene.bodies[0].rolling_friction == 0.25);
  CHECK(scene.bodies[1].rolling_friction == 0);
  CHECK(scene.bodies[1].friction == 0.5);
  CHECK(scene.bodies[1].tangential_restitution == 1);
}

TEST_CASE("scene reader: capsules turn") {
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 2, "response": "elastic", "bodies": [{"name": "a",
    "shape": {"capsule": {"radius": 1, "half_length": 2}}, "orientation": [0,1,0,0],
    "motion": [{"start": 0, "position": [[0,0,0]], "angular_velocity": [0,0,3]}]}]})",
                                  "scene.json");
  CHECK(scene.turning);
  CHECK(std::get<kds::collision::Capsule>(scene.bodies[0].shape).half_length == 2);
  CHECK(scene.bodies[0].motion[0].angular_velocity == Eigen::Vector3d(0, 0, 3));
}

TEST_CASE("scene reader: a hull of points, some of which are inside") {
  const Scene scene = parse_scene(
      R"({"scene": 1, "end_time": 2, "bodies": [{"name": "a", "shape": {"hull": {"points":
          [[0,0,0],[1,0,0],[0,1,0],[0,0,1],[0.25,0.25,0.25],[0.5,0,0]]}}, "motion": [{"start": 0, "position": [[0,0,0]]}]}]})",
      "scene.json");
  const auto& polytope = *std::get<kds::collision::ConvexHull>(scene.bodies[0].shape).polytope;
  CHECK(polytope.points().size() == 6);
  CHECK(polytope.structure().corners == std::vector<std::uint32_t>{0, 1, 2, 3});
}

TEST_CASE("scene reader: a compound of a box that is turned and a hull") {
  const Scene scene = parse_scene(
      R"({"scene": 1, "end_time": 2, "bodies": [{"name": "a", "shape": {"compound": {"parts": [
          {"shape": {"box": {"half_extents": [1,2,3]}}, "position": [10,0,0], "orientation": [0.5,0.5,0.5,0.5]},
          {"shape": {"hull": {"points": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]]}}}]}},
          "motion": [{"start": 0, "position": [[0,0,0]]}]}]})",
      "scene.json");
  const auto parts = std::get<kds::collision::Compound>(scene.bodies[0].shape).parts->parts();
  REQUIRE(parts.size() == 2);
  const auto placed = kds::collision::place(parts[0], Eigen::Quaterniond::Identity());
  CHECK(placed.low == Eigen::Vector3d(7, -1, -2));  // x is where z was
  CHECK(placed.high == Eigen::Vector3d(13, 1, 2));
  CHECK(std::get<kds::collision::ConvexHull>(parts[1]).polytope->points()[3] == Eigen::Vector3d(0, 0, 1));
}

TEST_CASE("scene reader: a compound about its centre of mass, in a scene that turns") {
  const auto read = [](const std::string& more) {
    return parse_scene(
        R"({"scene": 1, "end_time": 2, "response": "elastic", "bodies": [{"name": "a", "shape": {"compound": {"parts": [
            {"shape": {"box": {"half_extents": [1,1,1]}}},
            {"shape": {"box": {"half_extents": [1,1,1]}}, "position": [4,0,0]}])" +
            more + R"(}}, "motion": [{"start": 0, "position": [[0,0,0]], "angular_velocity": [1,2,3]}]}]})",
        "scene.json");
  };
  const Scene scene = read(R"(, "about_centre_of_mass": true)");
  const auto placed = kds::collision::place(scene.bodies[0].shape, Eigen::Quaterniond::Identity());
  CHECK(placed.low == Eigen::Vector3d(-3, -1, -1));
  CHECK(placed.high == Eigen::Vector3d(3, 1, 1));
  CHECK_THROWS_WITH(read(R"(, "about_centre_of_mass": false)"),
                    Catch::StartsWith("scene.json: bodies[0].inertia: the centre of mass of this compound is at (2,"));
}

TEST_CASE("scene reader: a capsule, and one of no length") {
  const auto read = [](const std::string& numbers) {
    const Scene scene = parse_scene(R"({"scene": 1, "end_time": 2, "bodies": [{"name": "a", "shape": {"capsule": {)" +
                                        numbers + R"(}}, "motion": [{"start": 0, "position": [[0,0,0]]}]}]})",
                                    "scene.json");
    return std::get<kds::collision::Capsule>(scene.bodies[0].shape);
  };
  CHECK(read(R"("radius": 0.5, "half_length": 2)").radius == 0.5);
  CHECK(read(R"("radius": 0.5, "half_length": 2)").half_length == 2);
  CHECK(read(R"("radius": 0.5, "half_length": 0)").half_length == 0);
}

TEST_CASE("scene reader: keys that may be left out") {
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 2, "bodies": []})", "scene.json");
  CHECK(scene.response == Response::none);
  CHECK_FALSE(scene.domain);
  CHECK(scene.bodies.empty());
  CHECK(scene.begin_time == 0);
}

TEST_CASE("scene reader: a half-space may reach through reflecting walls, which it never meets") {
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 2, "response": "elastic",
      "domain": {"min": [-5, -5, -5], "max": [5, 5, 5], "walls": "reflect"},
      "bodies": [{"name": "floor", "shape": {"half_space": {"normal": [0, 0, 1], "offset": 0}},
                  "fixed": true,
                  "motion": [{"start": 0, "position": [[0, 0, 0]]}]}]})",
                                  "scene.json");
  REQUIRE(scene.bodies.size() == 1);
  CHECK(unbounded(scene.bodies[0].shape));
}

TEST_CASE("scene reader: restitution is the scene's where a body or the walls have none of their own") {
  const auto read = [](const std::string& of_scene, const std::string& of_domain, const std::string& of_body) {
    return parse_scene(R"({"scene": 1, "end_time": 2, )" + of_scene +
                           R"("domain": {"walls": "reflect", "min": [-9,-9,-9], "max": [9,9,9])" + of_domain +
                           R"(}, "bodies": [{)" + of_body + R"("name": "a", "shape": {"sphere": {"radius": 1}},
                                        "motion": [{"start": 0, "position": [[0,0,0]]}]}]})",
                       "scene.json");
  };
  const Scene none = read("", "", "");
  CHECK(none.bodies[0].restitution == 1);
  CHECK(none.domain->restitution == 1);
  const Scene whole = read(R"("restitution": 0.5, )", "", "");
  CHECK(whole.bodies[0].restitution == 0.5);
  CHECK(whole.domain->restitution == 0.5);
  const Scene own = read(R"("restitution": 0.5, )", R"(, "restitution": 0)", R"("restitution": 0.75, )");
  CHECK(own.bodies[0].restitution == 0.75);
  CHECK(own.domain->restitution == 0);
}

TEST_CASE("scene reader: the run begins with the earliest motion, and its degree is the highest used") {
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 1000000001, "response": "none", "bodies": [
    {"name": "a", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 1e9, "position": [[0,0,0], [1,0,0], [0,0,0]]}]},
    {"name": "b", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 1000000000.5, "position": [[9,0,0]]}]}]})",
                                  "scene.json");
  CHECK(scene.begin_time == 1e9);
  CHECK(scene.degree() == 1);
}

}  // namespace test_scene_reader
