#include "collision/deforming/deforming_mesh.hpp"
#include "collision/deforming/rigid_surface.hpp"
#include "collision/deforming/surface_contact.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision/sample_sheets.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

namespace test_deforming_shapes {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::FeatureContactStatus;
using Eigen::Vector3d;
using samples::Sheet;
template <int Degree>
using Path = certificates::PointMotion<Degree>;

template <int Degree>
const MovingSurface<Degree>& moving(RigidSurface<Degree>& surface, const Path<Degree>& path, double t0, double t1) {
  surface.move(path, t0, t1);
  return surface.surface();
}

PlacedShape sample_shape(samples::Random& random, std::size_t kind) {
  const Eigen::Quaterniond turn = random.orientation();
  switch (kind) {
    case 0:
      return place(Sphere{0.5}, turn);
    case 1:
      return place(Box{Vector3d(0.5, 0.25, 0.375)}, turn);
    case 2:
      return place(Capsule{0.25, 0.5}, turn);
    default:
      return place(MeshShape{samples::torus(8, 5)}, turn);
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a mesh that bends not at all meets what a rigid one meets, when it does", "[deforming]",
                       ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(Degree, seed);
  samples::Random random(seed);
  const auto mesh = samples::torus(9, 6);
  const PlacedShape rigid = place(MeshShape{mesh}, random.orientation());
  const std::vector<Vector3d> vertices = mesh->placed_vertices(rigid.rotation, 1);
  int met = 0;
  for (int i = 0; i < 40; ++i) {
    const PlacedShape other = sample_shape(random, static_cast<std::size_t>(i % 4));
    Path<Degree> a = Path<Degree>::line(2 * random.direction(), Vector3d::Zero(), 0.5);
    a.coefficients[1] = -2 * a.coefficients[0] + random.vector(0.5);
    Path<Degree> b = Path<Degree>::line(random.vector(0.25), random.vector(0.5));
    if constexpr (Degree == 2) a.coefficients[2] = random.vector(0.5), b.coefficients[2] = random.vector(0.25);
    const double t0 = 0.5, t1 = 2;
    std::vector<Path<Degree>> motions;
    for (const Vector3d& v : vertices) {
      motions.push_back(a);
      motions.back().coefficients[0] += v;
    }
    DeformingMesh<Degree> bent(vertices, mesh->triangles());
    bent.set_motions(t0, t1, motions);
    bent.surface().audit();
    RigidSurface<Degree> shape(other);
    const auto found = first_contact(bent.surface(), moving(shape, b, t0, t1), {.tolerance = 1e-9});
    const double truth = first_contact(MovingShape<Path<Degree>>{rigid, a}, MovingShape<Path<Degree>>{other, b}, t0, t1,
                                       ContactMode::transparent);
    CAPTURE(i, truth, other.shape.index());
    const double speed = (b.velocity(truth < never ? truth : t0) - a.velocity(truth < never ? truth : t0)).norm();
    if (truth == never) {
      if (found) CHECK(found->distance > 0);  // a near miss
      continue;
    }
    REQUIRE(found);
    ++met;
    CHECK(found->contact.time <= truth + 1e-12);
    if (truth == t0) {
      CHECK(found->status == FeatureContactStatus::at_start);
      continue;
    }
    // They approach along the normal from a to b, and are within 1e-9 of the size (some 6) and the two gaps.
    const double approach = found->contact.normal.dot(a.velocity(truth) - b.velocity(truth));
    CHECK(approach > -1e-6);
    if (approach > 0.05 * speed) CHECK(truth - found->contact.time < 2e-8 / approach);
    const Contact expected =
        contact_at(MovingShape<Path<Degree>>{rigid, a}, MovingShape<Path<Degree>>{other, b}, truth);
    if (approach > 0.05 * speed && other.shape.index() != 2) CHECK((expected.point - found->contact.point).norm() < 1);
  }
  CHECK(met > 15);
}

TEST_CASE("a membrane that bulges meets a ball, a box and a capsule above it", "[deforming]") {
  // Its middle rises from 0 to 2 in the time from 1 to 3; the shapes stand still, one above it.
  const Sheet sheet(8);
  const std::size_t middle = sheet.positions.size() / 2;
  std::vector<Vector3d> bulged = sheet.positions;
  bulged[middle][2] = 2;
  DeformingMesh<1> membrane(sheet.positions, sheet.triangles, 1);
  membrane.step_to(3, bulged);
  const Path<1> at_rest = Path<1>::line(Vector3d(0, 0, 1.5), Vector3d::Zero());
  const auto upright = Eigen::Quaterniond::Identity();
  for (const auto& [shape, time, feature] :
       {std::tuple{place(Sphere{0.5}, upright), 2.0, Feature{}},
        std::tuple{place(Box{Vector3d(0.5, 0.5, 0.75)}, upright), 1.75, Feature::face(4)},
        std::tuple{place(Capsule{0.25, 0.25}, upright), 2.0, Feature::vertex(0)}}) {
    RigidSurface<1> other(shape);
    const auto found = first_contact(membrane.surface(), moving(other, at_rest, 1, 3));
    CAPTURE(shape.shape.index());
    REQUIRE(found);
    CHECK(found->contact.time <= time);
    CHECK(found->contact.time == Approx(time).epsilon(0).margin(1e-6));
    CHECK(found->contact.normal.isApprox(Vector3d::UnitZ(), 1e-6));
    CHECK(found->contact.point.isApprox(Vector3d(0, 0, time - 1), 1e-6));
    CHECK(found->contact.feature_a == Feature::vertex(static_cast<std::uint32_t>(middle)));
    CHECK(found->contact.feature_b == feature);
    CHECK(membrane.surface().velocity(middle, time).isApprox(Vector3d::UnitZ()));
  }
}

TEST_CASE("a sheet that folds meets itself when it is closed, and not before", "[deforming]") {
  // Two squares with a common edge on the y axis; the right one folds over to the left, parabola by parabola.
  const std::vector<Vector3d> flat{{-1, 0, 0}, {-1, 1, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0.25, 0}, {1, 0.75, 0}};
  const std::vector<Mesh::Triangle> triangles{{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}};
  DeformingMesh<2> sheet(flat, triangles);
  const auto step = [&](double t0, double t1, double from, double to) {
    std::vector<Vector3d> begin = flat, between = flat, end = flat;
    for (const std::size_t v : {4U, 5U}) {
      const auto at = [&](double angle) { return Vector3d(std::cos(angle), flat[v][1], std::sin(angle)); };
      begin[v] = at(from), end[v] = at(to);
      // The lines that touch the circle at both ends meet there.
      between[v] = at(0.5 * (from + to)) / std::cos(0.5 * (to - from));
      between[v][1] = flat[v][1];
    }
    sheet.set_control_points(t0, t1, {begin, between, end});
  };
  const double quarter = std::numbers::pi / 4;
  for (int i = 0; i < 3; ++i) {
    step(i, i + 1, i * quarter, (i + 1) * quarter);
    CHECK_FALSE(first_self_contact(sheet.surface()));
  }
  step(3, 4, 3 * quarter, 4 * quarter);
  const auto closed = first_self_contact(sheet.surface());
  REQUIRE(closed);
  CHECK(closed->contact.time == Approx(4).epsilon(0).margin(1e-5));
  CHECK(closed->contact.time <= 4);

  // Of a thickness of 0.2 it meets itself before.
  DeformingMesh<1> thick(flat, triangles, 0, 0.2);
  std::vector<Vector3d> folded = flat;
  folded[4] = {-1, 0.25, 0}, folded[5] = {-1, 0.75, 0};
  thick.step_to(1, folded);  // in the plane z = 0, through the edge
  CHECK(first_self_contact(thick.surface()));
}

TEST_CASE("an overlap at the start is told as one", "[deforming]") {
  const Sheet sheet(4);
  DeformingMesh<1> membrane(sheet.positions, sheet.triangles);
  membrane.step_to(1, sheet.moved({0, 0, 0.125}));
  const auto upright = Eigen::Quaterniond::Identity();
  SECTION("an edge goes through a face") {
    DeformingMesh<1> spike(std::vector<Vector3d>{{0.1, 0.2, -1}, {0.1, 0.2, 1}, {0.1, 5, 0}},
                           std::vector<Mesh::Triangle>{{0, 1, 2}});
    spike.step_to(1, std::vector<Vector3d>{{0.1, 0.2, -1}, {0.1, 0.2, 1}, {0.1, 5, 0}});
    const auto found = first_contact(membrane.surface(), spike.surface());
    REQUIRE(found);
    CHECK(found->status == FeatureContactStatus::at_start);
    CHECK(found->contact.time == 0);
    CHECK(std::abs(found->contact.point[2]) < 1e-12);
    const auto later = first_contact(membrane.surface(), spike.surface(), {.overlaps = false});
    if (later) CHECK(later->contact.time >= 0);
  }
  SECTION("all of it is in a box") {
    RigidSurface<1> box(place(Box{Vector3d(4, 4, 4)}, upright));
    const Path<1> path = Path<1>::line(Vector3d(0, 0, 0), Vector3d::Zero());
    const auto found = first_contact(membrane.surface(), moving(box, path, 0, 1));
    REQUIRE(found);
    CHECK(found->status == FeatureContactStatus::at_start);
    CHECK(found->kind == SurfaceContact::Kind::inside);
    CHECK_FALSE(first_contact(membrane.surface(), moving(box, path, 0, 1), {.overlaps = false}));
  }
  SECTION("a ball sticks in it") {
    RigidSurface<1> ball(place(Sphere{0.5}, upright));
    const auto found = first_contact(membrane.surface(), moving(ball, Path<1>::line({0, 0, 0.4}, {0, 0, 1}), 0, 1));
    REQUIRE(found);
    CHECK(found->status == FeatureContactStatus::at_start);
    CHECK(found->contact.normal.isApprox(Vector3d::UnitZ(), 1e-9));
  }
}

TEST_CASE("steps of a mesh that bends: what they begin with, and what is refused", "[deforming]") {
  const Sheet sheet(3);
  DeformingMesh<1> mesh(sheet.positions, sheet.triangles, 5);
  mesh.step_to(6, sheet.moved({0, 0, 1}));
  mesh.step_to(8, sheet.moved({0, 0, -3}));
  CHECK(mesh.surface().begin() == 6);
  CHECK(mesh.surface().end() == 8);
  CHECK(mesh.surface().control_points(0)[4] == sheet.positions[4] + Vector3d(0, 0, 1));
  CHECK(mesh.surface().velocity(4, 7) == Vector3d(0, 0, -2));
  CHECK(mesh.surface().position(4, 7) == sheet.positions[4] + Vector3d(0, 0, -1));
  mesh.surface().audit();

  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message([&] { mesh.step_to(8, sheet.positions); }).find("is no stretch of time") != std::string::npos);
  CHECK(message([&] { mesh.step_to(9, std::vector<Vector3d>(3)); }) ==
        "DeformingMesh.step_to: 3 positions for 16 vertices");
  auto bad = sheet.positions;
  bad[7][1] = std::nan("");
  CHECK(message([&] { mesh.step_to(9, bad); }) ==
        "DeformingMesh.step_to: vertex 7: its position must be finite, and at most 2^100 in magnitude");
  CHECK(mesh.surface().end() == 8);
  CHECK_THROWS_AS(DeformingMesh<1>(sheet.positions, std::vector<Mesh::Triangle>{{0, 1, 16}}), InvalidMesh);
  CHECK_THROWS_AS(DeformingMesh<1>(sheet.positions, sheet.triangles, 0, -1), std::invalid_argument);
  DeformingMesh<1> other(sheet.positions, sheet.triangles);
  other.step_to(1, sheet.positions);
  CHECK_THROWS_AS(first_contact(mesh.surface(), other.surface()), std::invalid_argument);
  CHECK_THROWS_AS(first_self_contact(mesh.surface(), {.from = 9}), std::invalid_argument);
}

}  // namespace test_deforming_shapes
