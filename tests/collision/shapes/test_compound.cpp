// Compounds as shapes: what their parts become, their bounds, and what is refused.
#include "collision/shapes/compound.hpp"
#include "collision/drawing/outline.hpp"
#include "tests/collision/sample_compounds.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace kds::collision::test_compound {
namespace {

using namespace tests;

PlacedShape placed(const Compound& compound, const Eigen::Quaterniond& turned = Eigen::Quaterniond::Identity()) {
  return place(compound, turned);
}

}  // namespace

TEST_CASE("compound: a point of a part that is not turned is rounded once", "[compound]") {
  const double third = 1.0 / 3, far = 1e9 / 7;
  const std::vector<CompoundPart> parts{{Box{{third, 0.7, 0.1}}, {far, 0.1, -0.3}},
                                        {wedge(third), {0.1, far, 0.2}},
                                        {MeshShape{tetrahedron(), 0.7}, {0.1, 0.2, far}}};
  const auto made = compound(parts);
  const auto box = std::get<ConvexHull>(made.parts->parts()[0]).polytope->points();
  REQUIRE(box.size() == 8);
  for (unsigned i = 0; i < 8; ++i) {  // numbered as the corners of a box
    CHECK(box[i] == Vector3d(far + (i & 1 ? third : -third), 0.1 + (i & 2 ? 0.7 : -0.7), -0.3 + (i & 4 ? 0.1 : -0.1)));
  }
  const auto hull = std::get<ConvexHull>(made.parts->parts()[1]).polytope->points();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    CHECK(hull[i] == wedge(third).polytope->points()[i] + Vector3d(0.1, far, 0.2));
  }
  const auto mesh = std::get<MeshShape>(made.parts->parts()[2]);
  CHECK(mesh.scale == 1);
  CHECK(made.parts->has_mesh());
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(mesh.mesh->vertices()[i] == 0.7 * tetrahedron()->vertices()[i] + Vector3d(0.1, 0.2, far));
  }
  CHECK(mesh.mesh->triangles().size() == tetrahedron()->triangles().size());
}

TEST_CASE("compound: its bounds are those of all its points", "[compound]") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    const Parts kinds = seed % 2 == 0 ? Parts::all : Parts::solids;
    const Compound made = random_compound(random, kinds, 4, 2);
    const PlacedShape shape = placed(made, unit_quaternion(random.between(0.1, 1), 0.25, -0.5, 0.125));
    CHECK(is_placed(shape));
    CHECK(shape.parts->size() == 4);
    CHECK(has_mesh(shape.shape) == made.parts->has_mesh());
    double farthest = 0;
    std::vector<Vector3d> points;
    for (const Shape& part : made.parts->parts()) {
      const auto surface = surface_of(part).mesh;
      for (const Vector3d& v : surface->vertices()) points.push_back(placed_vertex(shape.rotation, 1, v));
    }
    Vector3d low = points[0], high = points[0];
    for (const Vector3d& x : points) {
      farthest = std::max(farthest, x.norm());
      low = low.cwiseMin(x), high = high.cwiseMax(x);
    }
    const double room = 4 * box_margin * farthest;
    CHECK((shape.low.array() <= low.array()).all());
    CHECK((shape.low.array() >= low.array() - room).all());
    CHECK((shape.high.array() >= high.array()).all());
    CHECK((shape.high.array() <= high.array() + room).all());
    CHECK(shape.bounding_radius >= farthest);
    CHECK(shape.bounding_radius <= farthest * (1 + 1e-12));
    for (const Vector3d& along : {Vector3d(1, 1, 0), Vector3d(1, -1, 1), Vector3d(0, 1, 1)}) {
      double least = never, most = -never;
      for (const Vector3d& x : points) least = std::min(least, x.dot(along)), most = std::max(most, x.dot(along));
      const auto [from, to] = extent(shape, along);
      CHECK((from <= least && from >= least - 2 * room));
      CHECK((to >= most && to <= most + 2 * room));
    }
  }
}

TEST_CASE("compound: a shape that is not what place() makes of it is known", "[compound]") {
  Random random(1);
  PlacedShape shape = placed(random_compound(random, Parts::boxes, 2));
  PlacedShape without = shape;
  without.parts = nullptr;
  CHECK(!is_placed(without));
  PlacedShape other = shape;
  other.parts = placed(random_compound(random, Parts::boxes, 2)).parts;
  CHECK(!is_placed(other));
  PlacedShape ball = placed_ball(1);
  ball.parts = shape.parts;
  CHECK(!is_placed(ball));
}

TEST_CASE("compound: the outline is that of all parts", "[compound]") {
  const std::vector<CompoundPart> parts{{Box{{1, 1, 1}}, {5, 0, 0}}, {wedge(1)}};
  const auto lines = outline(Shape(compound(parts)));
  CHECK(lines.size() == 12 + 6);
}

TEST_CASE("compound: what cannot be is refused, and the part is named", "[compound]") {
  const auto refused = [](const CompoundPart& part, const std::string& what) {
    const std::vector<CompoundPart> parts{{Box{{1, 1, 1}}}, part};
    CHECK_THROWS_AS(compound(parts), InvalidCompound);
    CHECK_THROWS_WITH(compound(parts), Catch::StartsWith("compound: part 1: " + what));
  };
  CHECK_THROWS_WITH(compound({}), "compound: has no parts");
  refused({Sphere{1}}, "is a sphere; parts are boxes, hulls and meshes");
  refused({Capsule{1, 1}}, "is a capsule; parts are boxes, hulls and meshes");
  refused({HalfSpace{Vector3d::UnitX()}}, "is a half-space; parts are boxes, hulls and meshes");
  refused({BendingMesh{}}, "is a bending mesh; parts are boxes, hulls and meshes");
  refused({Compound{}}, "is a compound; parts are boxes, hulls and meshes");
  refused({Box{{1, -1, 1}}}, "half_extents: must be > 0");
  refused({ConvexHull{}}, "hull: is missing");
  refused({MeshShape{}}, "mesh: is missing");
  refused({MeshShape{cube(), 0}}, "scale: must be > 0");
  refused({Box{{1, 1, 1}}, {0, std::numeric_limits<double>::quiet_NaN(), 0}}, "position: must be finite");
  refused({Box{{1, 1, 1}}, zero, Eigen::Quaterniond(1, 1, 0, 0)}, "orientation: must be a unit quaternion");
  refused({Box{{1, 1, 1}}, {1e31, 0, 0}}, "point 0: is beyond 2^100");
  refused({MeshShape{cube()}, {1e31, 0, 0}}, "vertex 0: is beyond 2^100");
  refused({Box{{1e-9, 1, 1}}, {1e9, 0, 0}}, "has no volume: all points lie in a plane");  // one place, rounded
  CHECK_THROWS_WITH(place(Compound{}, Eigen::Quaterniond::Identity()), "compound: is missing");
  CHECK_THROWS_WITH(CompoundParts({Box{{1, 1, 1}}}), "compound: part 0: is a box; parts are hulls and meshes");
}

}  // namespace kds::collision::test_compound
