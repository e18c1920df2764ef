// How far apart two shapes are: against all pairs of features, planes that separate them, and common points.
#include "collision/narrow_phase/shape_distance.hpp"

#include "collision/narrow_phase/nearest_of_shape.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/polytope.hpp"
#include "tests/collision/narrow_phase/mesh_distances.hpp"
#include "tests/collision/sample_compounds.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

namespace kds::collision::test_shape_distance {
namespace {

using Eigen::Vector3d;
using samples::Long;
using samples::Random;
using samples::Vector3l;

const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();

/// As large as the coordinates, times some roundings.
double tolerance(const PlacedShape& a, const PlacedShape& b, const Vector3d& way) {
  return 0x1p-46 * (a.bounding_radius + b.bounding_radius + norm(way));
}

/// One time in four nearly in a plane, or nearly in a line.
std::vector<Vector3d> random_points(Random& random, std::size_t count, double size) {
  Vector3d extents = Vector3d::Constant(size);
  if (random.below(4) == 0) {
    extents[1] *= std::ldexp(1.0, -static_cast<int>(random.below(2) * random.below(16)));
    extents[2] *= std::ldexp(1.0, -static_cast<int>(random.below(16)));
  }
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(random.vector(1).cwiseProduct(extents));
  return points;
}

PlacedShape random_convex(Random& random) {
  const double size = std::ldexp(1.0, -static_cast<int>(random.below(4)));
  switch (random.below(5)) {
    case 0:
      return place(Sphere{size * random.uniform(0.1, 0.6)}, upright);
    case 1:
      return place(Box{size * Vector3d(random.uniform(0.1, 0.6), random.uniform(0.1, 0.6), random.uniform(1e-3, 0.6))},
                   random.below(3) == 0 ? upright : random.orientation());
    case 2:
      return place(Capsule{size * random.uniform(0.1, 0.4), size * random.uniform(0.1, 0.5)}, random.orientation());
    case 3:
      return place(convex_hull(random_points(random, 4 + random.below(20), 0.5 * size)), random.orientation());
    default: {
      std::vector<Vector3d> around;  // nearly a ball, of many corners
      for (int i = 0; i < 300; ++i) around.push_back(0.5 * size * random.direction());
      return place(convex_hull(around), random.orientation());
    }
  }
}

/// The corners of a convex shape, and by how much they are grown.
std::pair<std::vector<Vector3l>, Long> core_of(const PlacedShape& shape, const Vector3d& centre) {
  const Vector3l middle = centre.cast<Long>();
  std::vector<Vector3l> corners;
  Long radius = 0;
  if (const auto* const ball = std::get_if<Sphere>(&shape.shape)) {
    corners = {middle};
    radius = ball->radius;
  } else if (const auto* const capsule = std::get_if<Capsule>(&shape.shape)) {
    const Vector3l half = shape.rotation.col(2).cast<Long>() * capsule->half_length;
    corners = {middle + half, middle - half};
    radius = capsule->radius;
  } else if (const auto* const hull = std::get_if<ConvexHull>(&shape.shape)) {
    for (const Vector3d& point : hull->polytope->points()) {
      corners.push_back(middle + shape.rotation.cast<Long>() * point.cast<Long>());
    }
  } else {
    for (const int x : {-1, 1}) {
      for (const int y : {-1, 1}) {
        for (const int z : {-1, 1}) {
          corners.push_back(middle + x * shape.half_axes[0].cast<Long>() + y * shape.half_axes[1].cast<Long>() +
                            z * shape.half_axes[2].cast<Long>());
        }
      }
    }
  }
  return {corners, radius};
}

/// Checks that the points are of the shapes and as far apart as is said.
void check_points(const PlacedShape& a, const PlacedShape& b, const Vector3d& centre_of_b, const ShapeDistance& found) {
  const double error = tolerance(a, b, centre_of_b);
  constexpr double flat = 64;  // what nearest_of_shape() measures it by is less exact where a hull is flat
  CHECK(nearest_of_shape(a, found.of_a).distance <= flat * error);
  CHECK(nearest_of_shape(b, found.of_b - centre_of_b).distance <= flat * error);
  CHECK(norm(found.of_b - found.of_a) == Approx(found.distance).margin(error));
  const ShapeDistance back = shape_distance(b, a, -centre_of_b);
  CHECK(back.distance == Approx(found.distance).margin(error));
}

/// Corners, edges and triangles of the core of a convex shape.
struct Features {
  std::vector<Vector3l> corners;
  std::vector<std::array<Vector3l, 2>> edges;
  std::vector<samples::Corners> triangles;
};
Features features_of(const PlacedShape& shape, const Vector3d& centre) {
  Features features{core_of(shape, centre).first, {}, {}};
  const auto add = [&](std::size_t i, std::size_t j, std::size_t k) {
    const auto& corners = features.corners;
    features.triangles.push_back({corners[i], corners[j], corners[k]});
    features.edges.insert(features.edges.end(), {{corners[i], corners[j]}, {corners[j], corners[k]}});
  };
  if (std::holds_alternative<ConvexHull>(shape.shape)) {
    for (const auto& [i, j, k] : surface_of(shape.shape).mesh->triangles()) add(i, j, k);
  } else if (std::holds_alternative<Box>(shape.shape)) {
    for (const auto& [i, j, k, l] : std::initializer_list<std::array<std::size_t, 4>>{
             {0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}) {
      add(i, j, k), add(k, l, i);
    }
  } else if (features.corners.size() == 2) {
    features.edges.push_back({features.corners[0], features.corners[1]});
  }
  return features;
}

/// The distance of two cores that do not overlap, by all pairs of features.
Long brute_force(const Features& a, const Features& b) {
  Long best = std::numeric_limits<Long>::infinity();
  for (const Vector3l& p : a.corners) {
    for (const Vector3l& q : b.corners) best = std::min(best, (p - q).norm());
  }
  for (const auto* const pair : {&a, &b}) {
    const Features& other = pair == &a ? b : a;
    for (const Vector3l& corner : pair->corners) {
      for (const auto& triangle : other.triangles) best = std::min(best, samples::point_distance(corner, triangle));
      for (const auto& [p, q] : other.edges) {
        const Long along = std::clamp<Long>((q - p).dot(corner - p) / (q - p).squaredNorm(), 0, 1);
        best = std::min(best, (corner - p - along * (q - p)).norm());
      }
    }
  }
  for (const auto& [p, q] : a.edges) {
    for (const auto& [r, s] : b.edges) best = std::min(best, samples::segment_distance(p, q - p, r, s - r));
  }
  return best;
}

/// Checks that nothing of two convex shapes is nearer.
void check_nothing_nearer(const PlacedShape& a, const PlacedShape& b, const Vector3d& centre_of_b,
                          const ShapeDistance& found) {
  if (found.distance == 0) return;
  const double error = tolerance(a, b, centre_of_b);
  const auto [corners_of_a, radius_of_a] = core_of(a, Vector3d::Zero());
  const auto [corners_of_b, radius_of_b] = core_of(b, centre_of_b);
  if (corners_of_a.size() + corners_of_b.size() < 50) {
    const Long of_cores = brute_force(features_of(a, Vector3d::Zero()), features_of(b, centre_of_b));
    CHECK(found.distance == Approx(static_cast<double>(of_cores - radius_of_a - radius_of_b)).margin(error));
    return;
  }
  // The plane across the way between the points separates them; where that is short its direction is not known well.
  if (found.distance < 1e-3 * (a.bounding_radius + b.bounding_radius)) return;
  const Vector3l way = (found.of_b - found.of_a).cast<Long>();
  const Vector3l normal = way / way.norm();
  Long farthest = -std::numeric_limits<Long>::infinity(), nearest = std::numeric_limits<Long>::infinity();
  for (const Vector3l& corner : corners_of_a) farthest = std::max(farthest, normal.dot(corner) + radius_of_a);
  for (const Vector3l& corner : corners_of_b) nearest = std::min(nearest, normal.dot(corner) - radius_of_b);
  CHECK(static_cast<double>(nearest - farthest) == Approx(found.distance).margin(2000 * error));
}

}  // namespace

TEST_CASE("two boxes, a ball and a capsule, by hand", "[shape_distance]") {
  const PlacedShape box = place(Box{{1, 2, 3}}, upright);
  const PlacedShape ball = place(Sphere{0.5}, upright);
  const ShapeDistance faces = shape_distance(box, box, {5, 1, 1});
  CHECK(faces.distance == 3);
  CHECK(faces.of_a[0] == Approx(1));
  CHECK(faces.of_b[0] == Approx(4));
  const ShapeDistance corner = shape_distance(box, ball, {1 + 2, 2 + 3, 3 + 6});
  CHECK(corner.distance == Approx(6.5));
  CHECK((corner.of_a - Vector3d(1, 2, 3)).norm() < 1e-14);
  const PlacedShape capsule = place(Capsule{0.25, 1}, upright);  // along z
  CHECK(shape_distance(capsule, ball, {3, 0, 0.75}).distance == Approx(2.25));
  const ShapeDistance inside = shape_distance(box, ball, {0.5, 0.5, 0.5});
  CHECK(inside.distance == 0);
  CHECK((inside.of_a - inside.of_b).norm() < 1e-14);
  CHECK(shape_distance(ball, ball, {0, 0, 0}).distance == 0);
}

TEST_CASE("convex shapes: the points are theirs, and nothing is nearer", "[shape_distance]") {
  int apart = 0, near = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const PlacedShape a = random_convex(random), b = random_convex(random);
    const double sum_of_radii = a.bounding_radius + b.bounding_radius;
    Vector3d centre = random.vector(sum_of_radii * (random.below(4) == 0 ? 100 : 1));
    ShapeDistance found = shape_distance(a, b, centre);
    if (found.distance > 0 && random.below(2) == 0) {  // and brought to where they nearly touch
      centre -= (1 - std::ldexp(1.0, -static_cast<int>(random.below(40)))) * (found.of_b - found.of_a);
      found = shape_distance(a, b, centre);
      ++near;
    }
    if (found.distance > 0) ++apart;
    check_points(a, b, centre, found);
    check_nothing_nearer(a, b, centre, found);
  }
  CHECK(apart > 500);
  CHECK(near > 230);
}

TEST_CASE("meshes: as near as the nearest of all pairs of triangles", "[shape_distance]") {
  const std::vector<std::shared_ptr<const Mesh>> meshes{samples::torus(8, 4), samples::ball_mesh(1),
                                                        samples::cuboid({0.5, 0.7, 0.3})};
  int apart = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const auto any_mesh = [&] {
      return samples::placed(meshes[random.below(3)], random.uniform(0.3, 1.5), random.orientation());
    };
    const PlacedShape a = any_mesh(), b = any_mesh();
    const Vector3d centre = random.vector(random.below(2) == 0 ? 1.5 : 4);
    const ShapeDistance found = shape_distance(a, b, centre);
    check_points(a, b, centre, found);
    CHECK(found.distance ==
          Approx(static_cast<double>(samples::distance(a, b, centre.cast<Long>()))).margin(tolerance(a, b, centre)));
    if (found.distance > 0) ++apart;
    // Against a solid, the surface of which is a mesh; it may be all inside.
    const PlacedShape hull = place(convex_hull(random_points(random, 12, 0.8)), random.orientation());
    const MeshShape surface = surface_of(hull.shape);
    const ShapeDistance of_hull = shape_distance(a, hull, centre);
    check_points(a, hull, centre, of_hull);
    if (of_hull.distance > 0) {
      const PlacedShape shell = place_turned(surface, hull.rotation);
      CHECK(of_hull.distance == Approx(static_cast<double>(samples::distance(a, shell, centre.cast<Long>())))
                                    .margin(tolerance(a, hull, centre)));
    }
  }
  CHECK(apart > 60);
}

TEST_CASE("a mesh inside of a solid is at no distance, a solid inside of a mesh is at some", "[shape_distance]") {
  const PlacedShape shell = samples::placed(samples::cuboid({1, 1, 1}), 1, upright);
  CHECK(shape_distance(place(Box{{2, 2, 2}}, upright), shell, {0, 0, 0}).distance == 0);
  CHECK(shape_distance(place(Box{{0.5, 0.5, 0.75}}, upright), shell, {0, 0, 0}).distance == Approx(0.25));
  CHECK(shape_distance(place(Sphere{0.5}, upright), shell, {0.25, 0, 0}).distance == Approx(0.25));
}

TEST_CASE("compounds and meshes that bend: the nearest of their parts", "[shape_distance]") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    tests::Random of_parts(seed);
    const auto parts = tests::random_parts(of_parts, tests::Parts::all, 1 + random.below(4));
    const PlacedShape a = place(compound(parts), random.orientation());
    const PlacedShape b = random_convex(random);
    const Vector3d centre = random.vector(3);
    const ShapeDistance found = shape_distance(a, b, centre);
    check_points(a, b, centre, found);
    double least = std::numeric_limits<double>::infinity();
    for (const PlacedShape& part : *a.parts) least = std::min(least, shape_distance(part, b, centre).distance);
    CHECK(found.distance == Approx(least).margin(tolerance(a, b, centre)));

    const auto corners = random_points(random, 4, 0.5);
    auto later = corners;
    for (Vector3d& x : later) x += random.vector(0.5);
    const std::vector<Mesh::Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
    const PlacedShape bending = place(BendingMesh{std::make_shared<const MeshScript>(
                                          std::vector<MeshScript::Keyframe>{{0, corners}, {2, later}}, triangles)},
                                      upright);
    std::vector<Vector3d> between;
    for (std::size_t i = 0; i < 4; ++i) between.push_back((corners[i] + later[i]) / 2);
    const PlacedShape then = place(MeshShape{std::make_shared<const Mesh>(between, triangles), 1}, upright);
    CHECK(shape_distance(bending, b, centre, 1).distance ==
          Approx(shape_distance(then, b, centre).distance).margin(1e-13));
  }
}

TEST_CASE("half-spaces: the lowest point, and each other", "[shape_distance]") {
  const auto torus = samples::torus(16, 8);
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const Vector3d normal = random.direction();
    const PlacedShape ground = place(HalfSpace{normal, random.uniform(-1, 1)}, upright);
    const double offset = std::get<HalfSpace>(ground.shape).offset;
    const Vector3d centre = random.vector(3);
    const PlacedShape mesh = samples::placed(torus, 1, random.orientation());
    const ShapeDistance found = shape_distance(ground, mesh, centre);
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& triangle : samples::triangles_of(mesh)) {
      for (const Vector3d& corner : triangle.vertices) lowest = std::min(lowest, normal.dot(corner + centre) - offset);
    }
    CHECK(found.distance == Approx(std::max(0.0, lowest)).margin(1e-14));
    check_points(ground, mesh, centre, found);
    const PlacedShape convex = random_convex(random);
    check_points(ground, convex, centre, shape_distance(ground, convex, centre));
  }
  const PlacedShape floor = place(HalfSpace{{0, 0, 1}, 0}, upright);
  const PlacedShape roof = place(HalfSpace{{0, 0, -1}, 0}, upright);
  const PlacedShape wall = place(HalfSpace{{1, 0, 0}, 0.5}, upright);
  const ShapeDistance room = shape_distance(floor, roof, {0, 0, 3});
  CHECK(room.distance == 3);
  check_points(floor, roof, {0, 0, 3}, room);
  CHECK(shape_distance(floor, roof, {0, 0, -3}).distance == 0);
  for (const PlacedShape& other : {floor, wall, place(HalfSpace{Vector3d(0.6, 0, -0.8), 2}, upright)}) {
    const ShapeDistance common = shape_distance(floor, other, {1, 2, 3});
    CHECK(common.distance == 0);
    check_points(floor, other, {1, 2, 3}, common);
  }
}

}  // namespace kds::collision::test_shape_distance
