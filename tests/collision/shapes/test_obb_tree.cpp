#include "collision/narrow_phase/obb_descent.hpp"
#include "collision/shapes/obb_tree.hpp"
#include "kds/audit.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace test_obb_tree {
namespace {

using namespace kds::collision;
using namespace kds::collision::samples;

int depth(const ObbTree& tree) {
  const std::function<int(std::uint32_t)> below = [&](std::uint32_t node) -> int {
    const ObbNode& box = tree.nodes()[node];
    return box.is_leaf() ? 1 : 1 + std::max(below(box.first), below(box.first + 1));
  };
  return below(0);
}

Mesh grid(std::uint32_t n) {
  std::vector<Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) vertices.emplace_back(i, j, 0);
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t corner = i * (n + 1) + j;
      triangles.push_back({corner, corner + 1, corner + n + 1});
      triangles.push_back({corner + 1, corner + n + 2, corner + n + 1});
    }
  }
  return {vertices, triangles};
}

Mesh soup(Random& random, std::uint32_t n, double size) {
  std::vector<Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Vector3d place = random.vector(1);
    for (int k = 0; k < 3; ++k) vertices.push_back(place + random.vector(size));
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return {vertices, triangles};
}

void check(const Mesh& mesh) {
  CHECK_NOTHROW(mesh.tree().audit(mesh.vertices()));
  const auto n = static_cast<double>(mesh.triangles().size());
  CHECK(depth(mesh.tree()) <= 3 + std::log(n) / std::log(8.0 / 7.0));
}

}  // namespace

TEST_CASE("Trees hold their triangles") {
  Random random(21);
  check(*torus(8, 4));
  check(*torus(30, 20, 0.75, 0.25, 0.2));
  check(*cuboid());
  check(*ball_mesh(3));
  check(grid(20));
  for (const double size : {1e-6, 0.1, 3.0}) check(soup(random, 200, size));
}

TEST_CASE("Trees hold their triangles at any scale and far from the origin") {
  Random random(22);
  for (const double scale : {1e-25, 1e-6, 1e6, 1e25}) {
    const auto ring = torus(8, 4);
    std::vector<Vector3d> vertices(ring->vertices().begin(), ring->vertices().end());
    const Vector3d offset = random.vector(1000);
    for (Vector3d& v : vertices) v = scale * (v + offset);
    check(Mesh(vertices, {ring->triangles().begin(), ring->triangles().end()}));
  }
}

TEST_CASE("Triangles that no plane parts are halved by number") {
  // The same triangle many times, and a fan of triangles with one centre.
  std::vector<Mesh::Triangle> same(1000, Mesh::Triangle{0, 1, 2});
  check(Mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, same));
  std::vector<Vector3d> vertices;
  std::vector<Mesh::Triangle> star;
  for (std::uint32_t i = 0; i < 100; ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const double angle = 0.01 * i + 2 * std::numbers::pi * k / 3;
      vertices.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    star.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  check(Mesh(vertices, star));
}

TEST_CASE("The audit of a tree finds a triangle that sticks out") {
  const auto ring = torus(8, 4);
  std::vector<Vector3d> vertices(ring->vertices().begin(), ring->vertices().end());
  vertices[5] *= 1.01;
  CHECK_THROWS_AS(ring->tree().audit(vertices), kds::AuditFailure);
}

namespace {

/// Whether the boxes of two nodes surely overlap when b's centre is at `offset`: some point of b on a grid is in a.
bool overlap(const TreePose& a, const ObbNode& box_a, const TreePose& b, const ObbNode& box_b, const Vector3d& offset) {
  const auto vector = [](Lanes x) { return Vector3d(x[0], x[1], x[2]); };
  const auto axes = [&](const ObbNode& node) {
    Eigen::Matrix3d m;
    for (int k = 0; k < 3; ++k) m.row(k) = vector(node.axes[static_cast<std::size_t>(k)]).transpose();
    return m;
  };
  const Eigen::Matrix3d turn_a = a.rotation * axes(box_a);
  const Eigen::Matrix3d turn_b = b.rotation * axes(box_b);
  const Vector3d centre_a = a.rotation * (a.unit * vector(box_a.centre));
  const Vector3d centre_b = offset + b.rotation * (b.unit * vector(box_b.centre));
  for (int i = 0; i < 5 * 5 * 5; ++i) {
    const Vector3d part(i % 5 * 0.5 - 1, i / 5 % 5 * 0.5 - 1, i / 25 * 0.5 - 1);
    const Vector3d point = centre_b + turn_b * (b.unit * part.cwiseProduct(vector(box_b.half_extents)));
    const Vector3d x = turn_a.transpose() * (point - centre_a);
    if ((x.cwiseAbs().array() <= a.unit * vector(box_a.half_extents).array()).all()) return true;
  }
  return false;
}

template <int Degree>
void box_windows(std::uint64_t seed) {
  INFO("seed " << seed << ", degree " << Degree);
  Random random(seed);
  const auto mesh = torus(8, 4);
  const auto nodes = mesh->tree().nodes();
  int windows = 0, tight = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const TreePose a{nodes, random.uniform(0.5, 2) * mesh->tree().unit(), random.orientation().toRotationMatrix()};
    const TreePose b{nodes, random.uniform(0.5, 2) * mesh->tree().unit(), random.orientation().toRotationMatrix()};
    const double radii = a.unit + b.unit;
    const auto motion = encounter<Degree>(random, radii, 0.5);
    const auto gap = contact_gap(motion, radii);
    const TimeSlice slice{random.uniform(0, 0.5), random.uniform(0.6, 1.5)};
    const SliceMotion<Degree> in_slice(motion, gap, slice, radii);
    const BoxPairTest<Degree> pair_test(a, b, in_slice);
    const ObbNode& box_a = nodes[random.below(static_cast<std::uint32_t>(nodes.size()))];
    const ObbNode& box_b = nodes[random.below(static_cast<std::uint32_t>(nodes.size()))];
    StepWindow window;
    const bool possible = pair_test(pair_test.frame(box_a), box_b, window);
    const TimeWindow seconds = in_seconds(slice, window);
    windows += possible;
    const int samples = 60;
    for (int i = 0; i <= samples; ++i) {
      const double tau = std::min(slice.begin + i * slice.length() / samples, slice.end);
      if (!overlap(a, box_a, b, box_b, motion.position(tau))) continue;
      REQUIRE(possible);
      REQUIRE(seconds.begin <= tau);
      REQUIRE(seconds.end >= tau);
      ++tight;
    }
  }
  CHECK(windows > 20);  // the test has seen something
  CHECK(tight > 100);
}

template <int Degree>
void ball_windows(std::uint64_t seed) {
  INFO("seed " << seed << ", degree " << Degree);
  Random random(seed);
  const auto mesh = torus(8, 4);
  const auto nodes = mesh->tree().nodes();
  int met = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const TreePose a{nodes, random.uniform(0.5, 2), random.orientation().toRotationMatrix()};
    const double radius = random.uniform(0.01, 1);
    const double radii = a.unit + radius;
    const auto motion = encounter<Degree>(random, radii, 0.5);
    const TimeSlice slice{0, random.uniform(0.6, 1.5)};
    const BoxBallTest<Degree> test(a, radius, SliceMotion<Degree>(motion, contact_gap(motion, radii), slice, radii));
    const ObbNode& box = nodes[random.below(static_cast<std::uint32_t>(nodes.size()))];
    StepWindow window;
    const bool possible = test(box, window);
    const TimeWindow seconds = in_seconds(slice, window);
    for (int i = 0; i <= 100; ++i) {
      const double tau = std::min(slice.begin + i * slice.length() / 100, slice.end);
      Vector3d x = Vector3d::Zero();
      const Vector3d place = a.rotation.transpose() * motion.position(tau) / a.unit;
      for (int k = 0; k < 3; ++k) {
        for (int d = 0; d < 3; ++d) {
          x[d] += static_cast<double>(box.axes[static_cast<std::size_t>(k)][d]) * (place[k] - box.centre[k]);
        }
      }
      Vector3d outside;
      for (int d = 0; d < 3; ++d) outside[d] = std::max(std::abs(x[d]) - box.half_extents[d], 0.0);
      if (outside.norm() * a.unit > radius) continue;
      REQUIRE(possible);
      REQUIRE(seconds.begin <= tau);
      REQUIRE(seconds.end >= tau);
      ++met;
    }
  }
  CHECK(met > 100);
}

}  // namespace

TEST_CASE("Windows of moving boxes hold every time at which they overlap") {
  for (const std::uint64_t seed : {31u, 32u, 33u}) {
    box_windows<1>(seed);
    box_windows<2>(seed);
  }
}

TEST_CASE("Windows of a moving ball and a box hold every time at which they overlap") {
  for (const std::uint64_t seed : {41u, 42u, 43u}) {
    ball_windows<1>(seed);
    ball_windows<2>(seed);
  }
}

}  // namespace test_obb_tree
