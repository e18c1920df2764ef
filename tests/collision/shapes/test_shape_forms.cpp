// What shapes are made of, whatever kind they are.
#include "collision/shapes/shape_forms.hpp"

#include "collision/shapes/shape_kinds.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace test_shape_forms {
namespace {

using namespace kds::collision;
using Eigen::Vector3d;

ConvexHull tetrahedron() {
  return convex_hull({Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)});
}

Eigen::Quaterniond turned() { return Eigen::Quaterniond(1, 2, 3, 4).normalized(); }

/// One of each kind, in the order of Shape.
std::vector<Shape> one_of_each() {
  const auto mesh = samples::cuboid();
  std::vector<Mesh::Triangle> triangles(mesh->triangles().begin(), mesh->triangles().end());
  std::vector<Vector3d> vertices(mesh->vertices().begin(), mesh->vertices().end());
  const std::vector<CompoundPart> parts{{tetrahedron()}};
  return {Sphere{0.5},
          Box{{1, 2, 3}},
          MeshShape{mesh, 2},
          Capsule{0.5, 2},
          tetrahedron(),
          BendingMesh{std::make_shared<const MeshScript>(std::vector<MeshScript::Keyframe>{{0, std::move(vertices)}},
                                                         std::move(triangles))},
          HalfSpace{{0, 0, 1}, 1},
          compound(parts)};
}

TEST_CASE("shape forms: each shape has one", "[shapes]") {
  const std::vector<Shape> shapes = one_of_each();
  REQUIRE(shapes.size() == std::variant_size_v<Shape>);
  const ByForm name{
      [](const RoundedBox&) { return "rounded box"; }, [](const Polytope&) { return "polytope"; },
      [](const MeshShape&) { return "mesh"; },         [](const BendingMesh&) { return "bending mesh"; },
      [](const HalfSpace&) { return "half-space"; },   [](const Compound&) { return "compound"; },
  };
  const std::vector<std::string> expected{"rounded box", "rounded box",  "mesh",       "rounded box",
                                          "polytope",    "bending mesh", "half-space", "compound"};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    CAPTURE(i);
    CHECK(shapes[i].index() == i);
    const std::string form = ask_form(shapes[i], name);
    CHECK(form == expected[i]);
    CHECK(rounded_box_of(shapes[i]).has_value() == (form == "rounded box"));
    CHECK((polytope_of(shapes[i]) != nullptr) == (form == "polytope"));
    CHECK((script_of(shapes[i]) != nullptr) == (form == "bending mesh"));
    CHECK((triangles_of(shapes[i]) != nullptr) == (form == "polytope" || form == "mesh"));
  }
}

TEST_CASE("shape forms: rounded boxes", "[shapes]") {
  const RoundedBox ball = *rounded_box_of(Sphere{0.5});
  CHECK(ball.half_extents == Vector3d(0, 0, 0));
  CHECK(ball.radius == 0.5);
  CHECK(ball.dimension() == 0);
  const RoundedBox box = *rounded_box_of(Box{{1, 2, 3}});
  CHECK(box.half_extents == Vector3d(1, 2, 3));
  CHECK(box.radius == 0);
  CHECK(box.dimension() == 3);
  const RoundedBox capsule = *rounded_box_of(Capsule{0.5, 2});
  CHECK(capsule.half_extents == Vector3d(0, 0, 2));
  CHECK(capsule.radius == 0.5);
  CHECK(capsule.dimension() == 1);
  CHECK(rounding_radius(Capsule{0.5, 2}) == 0.5);
  CHECK(rounding_radius(Box{{1, 2, 3}}) == 0);
  CHECK(rounding_radius(tetrahedron()) == 0);
}

TEST_CASE("shape forms: cores of placed shapes, and of boxes as they are rounded", "[shapes]") {
  const PlacedShape box = place(Box{{1, 2, 3}}, turned());
  const RoundedCore exact = rounded_core(box), rounded = placed_core(box);
  REQUIRE(exact.generators.size() == 3);
  REQUIRE(rounded.generators.size() == 3);
  for (std::size_t d = 0; d < 3; ++d) {
    CHECK(exact.generators[d].direction == box.rotation.col(static_cast<Eigen::Index>(d)));
    CHECK(exact.generators[d].length == static_cast<double>(d + 1));
    CHECK(rounded.generators[d].direction == box.half_axes[d]);
    CHECK(rounded.generators[d].length == 1);
  }
  const PlacedShape capsule = place(Capsule{0.5, 2}, turned());
  const RoundedCore core = placed_core(capsule);
  REQUIRE(core.generators.size() == 1);
  CHECK(core.generators[0].direction == capsule.rotation.col(2));
  CHECK(core.generators[0].length == 2);
  CHECK(core.radius == 0.5);
  CHECK(placed_core(place(Sphere{0.5}, turned())).generators.empty());
  CHECK_THROWS_WITH(rounded_core(place(tetrahedron(), turned())), "rounded_core: asked of a hull");
}

}  // namespace
}  // namespace test_shape_forms
