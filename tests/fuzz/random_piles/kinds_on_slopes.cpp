// On inclined boxes, on curved surfaces, and on meshes.
#include "collision/shapes/mesh.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/fuzz/random_piles/maker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

namespace kds::piles {
namespace {

using collision::Box;
using collision::Capsule;
using collision::Mesh;
using collision::MeshShape;
using collision::Sphere;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// A box whose upper face goes through `lip`, where it ends, and rises to the side of `side` (-1 or 1) by an angle.
void slope(Maker& make, const Vector3d& lip, int side, double angle, double length, double depth) {
  const Vector3d along(side * std::cos(angle), std::sin(angle), 0);
  const Vector3d up(-side * std::sin(angle), std::cos(angle), 0);
  constexpr double thick = 0.25;
  make.fix(Box{Vector3d(length / 2, thick, depth)}, lip + along * (length / 2) - up * thick,
           make.about(Vector3d::UnitZ(), side * angle));
}

void sides(Maker& make, double width, double depth) {
  make.fix_box({-width, -2, -depth - 1}, {width, 100, -depth});
  make.fix_box({-width, -2, depth}, {width, 100, depth + 1});
}

void hopper(Maker& make) {
  const double hole = make.greatest_size * make.random.between(0.8, 4);
  const double depth = make.greatest_size * make.random.between(1.01, 3);
  const double angle = make.random.between(0.2, 1.2);
  const double high = make.random.between(1, 3);
  make.fix_box({-20, -1, -20}, {20, 0, 20});
  sides(make, 20, depth);
  for (const int side : {-1, 1}) slope(make, {side * hole / 2, high, 0}, side, angle, 5, depth);
  make.drop(draw_count(make.random), Vector3d(-1.5, high + 3, -depth), Vector3d(1.5, high + 5, depth));
}

void wedge(Maker& make) {
  make.capsules = make.random.one_in(4);
  make.boxes = make.random.one_in(4);
  const double depth = make.greatest_size * make.random.between(1.01, 3);
  sides(make, 20, depth);
  for (const int side : {-1, 1}) slope(make, Vector3d::Zero(), side, make.random.between(0.2, 1.4), 8, depth);
  make.drop(std::min<std::size_t>(draw_count(make.random), 12), Vector3d(-1, 4, -depth), Vector3d(1, 6, depth));
}

/// A slope that ends over a floor.
void chute(Maker& make) {
  const double angle = make.random.between(0.1, 1.2);
  make.fix_box({-40, -1, -20}, {40, 0, 20});
  sides(make, 40, 1);
  make.fix_box({-8, 0, -1}, {-7, 100, 1});
  slope(make, {0, 1, 0}, 1, angle, 8, 1);
  make.boxes = make.random.one_in(4);
  make.drop(draw_count(make.random), Vector3d(1, 9, -1), Vector3d(4, 12, 1));
}

void staircase(Maker& make) {
  make.boxes = make.random.one_in(3);
  make.capsules = make.random.one_in(3);
  const double high = make.random.between(0.2, 1), wide = make.random.between(0.3, 1.5);
  const int steps = make.random.integer(2, 7);
  for (int i = 0; i < steps; ++i) make.fix_box({i * wide, -(i + 1) * high - 1, -2}, {(i + 1) * wide, -i * high, 2});
  make.fix_box({steps * wide, -steps * high - 2, -2}, {steps * wide + 20, -steps * high, 2});
  make.drop(draw_count(make.random), Vector3d(0, 0.01, -1), Vector3d(2 * wide, 3, 1));
  for (Description& body : make.scene.bodies) {
    if (!body.fixed) body.motion.front().coefficients[1] += Vector3d(make.random.between(0, 2), 0, 0);
  }
}

/// On and between fixed balls and capsules, with a floor below.
void bumps(Maker& make) {
  make.fix_box({-30, -1, -30}, {30, 0, 30});
  const int wide = make.random.integer(1, 3);
  const double apart = make.random.between(0.9, 1.6);
  for (int i = 0; i < wide; ++i) {
    for (int k = 0; k < wide; ++k) {
      const Vector3d place(i * apart, 0.5, k * apart);
      if (make.random.one_in(3)) {
        make.fix(Capsule{0.4, 0.3}, place, make.orientation());
      } else {
        make.fix(Sphere{make.random.between(0.3, 0.6)}, place);
      }
    }
  }
  make.capsules = make.random.one_in(3);
  make.boxes = make.random.one_in(3);
  make.speed = make.random.one_in(2) ? 0 : 1;
  make.drop(draw_count(make.random), Vector3d(-0.5, 1.2, -0.5), Vector3d(wide * apart, 3, wide * apart));
}

/// Turns of points about y, the lowest first; the first is a single point.
std::shared_ptr<const Mesh> bowl(std::uint32_t rings, std::uint32_t around, double radius, double high) {
  std::vector<Vector3d> vertices{Vector3d::Zero()};
  std::vector<Mesh::Triangle> triangles;
  for (std::uint32_t i = 1; i <= rings; ++i) {
    const double part = double(i) / rings;
    for (std::uint32_t k = 0; k < around; ++k) {
      const double turn = 2 * std::numbers::pi * k / around;
      vertices.emplace_back(radius * part * std::cos(turn), high * part * part, radius * part * std::sin(turn));
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t k) { return i == 0 ? 0 : 1 + (i - 1) * around + k % around; };
  for (std::uint32_t k = 0; k < around; ++k) {
    triangles.push_back({at(0, 0), at(1, k), at(1, k + 1)});
    for (std::uint32_t i = 1; i < rings; ++i) {
      triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return std::make_shared<const Mesh>(std::move(vertices), std::move(triangles));
}

std::shared_ptr<const Mesh> tetrahedron() {
  return std::make_shared<const Mesh>(
      std::vector<Vector3d>{{0, 1, 0}, {1, -0.5, 0.2}, {-0.6, -0.5, 0.8}, {-0.5, -0.5, -0.9}},
      std::vector<Mesh::Triangle>{{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}});
}

void mesh_bowl(Maker& make) {
  make.fix(MeshShape{bowl(4, 12, 2.5, make.random.between(0.5, 4)), 1}, Vector3d::Zero());
  make.fix_box({-30, -3, -30}, {30, -2, 30});
  make.speed = 1;
  make.drop(std::min<std::size_t>(draw_count(make.random), 12), Vector3d(-1, 4, -1), Vector3d(1, 6, 1));
}

/// Meshes that lie on a floor, or fall on it.
void mesh_on_floor(Maker& make) {
  make.fix_box({-30, -1, -30}, {30, 0, 30});
  const auto mesh = make.random.one_in(2) ? tetrahedron() : collision::samples::cuboid();
  const Quaterniond turn = make.random.one_in(2) ? Quaterniond::Identity() : make.orientation();
  if (make.random.one_in(3)) {
    make.add({.shape = MeshShape{mesh, 0.5}, .orientation = turn}, Vector3d(0, make.random.between(1, 3), 0));
  } else {
    make.fix(MeshShape{mesh, 1}, Vector3d(0, 0.5, 0), turn);
  }
  make.boxes = make.random.one_in(4);
  make.speed = 0.5;
  make.drop(std::min<std::size_t>(draw_count(make.random), 8), Vector3d(-1, 4.2, -1), Vector3d(1, 6, 1));
}

}  // namespace

std::initializer_list<NamedKind> kinds_on_slopes() {
  static constexpr std::initializer_list<NamedKind> kinds{
      {"hopper", hopper},
      {"wedge", wedge},
      {"chute", chute},
      {"staircase", staircase},
      {"bumps", bumps},
      {"mesh bowl", mesh_bowl},
      {"mesh on floor", mesh_on_floor},
  };
  return kinds;
}

}  // namespace kds::piles
