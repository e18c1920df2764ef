#include "collision/narrow_phase/surface_gap.hpp"

#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>

namespace kds::collision::test_surface_gap {
namespace {

using namespace tests;

struct Placed {
  PlacedShape shape;
  certificates::PointMotion<2> motion;
  TranslatingShape<2> moving() const { return {shape, motion}; }
};

Placed at(const Shape& shape, const Vector3d& place) {
  return {kds::collision::place(shape, Eigen::Quaterniond::Identity()), motion<2>(place)};
}

TEST_CASE("Surface gap: of balls, along the line between their centres") {
  const Placed a = at(Sphere{1}, {0, 0, 0});
  const Placed b = at(Sphere{2}, {3, 4, 0});
  const SurfaceGap gap = surface_gap(a.moving(), b.moving(), 0);
  CHECK(gap.width == 2);
  CHECK((gap.normal - Vector3d(.6, .8, 0)).norm() < 1e-15);
  CHECK(std::abs(gap_along(a.moving(), b.moving(), gap.normal, 0) - 2) < 1e-15);
  CHECK(gap_along(a.moving(), b.moving(), Vector3d(1, 0, 0), 0) == 0);
}

TEST_CASE("Surface gap: of a ball beside a face, an edge and a corner of a box") {
  const Placed box = at(Box{{1, 2, 3}}, {0, 0, 0});
  const auto gap = [&](const Vector3d& place) { return surface_gap(box.moving(), at(Sphere{.5}, place).moving(), 0); };
  CHECK(std::abs(gap({2, .3, .2}).width - .5) < 1e-15);
  CHECK((gap({2, .3, .2}).normal - Vector3d(1, 0, 0)).norm() < 1e-15);
  CHECK(std::abs(gap({2, 3, 0}).width - (std::sqrt(2.) - .5)) < 1e-15);
  CHECK((gap({2, 3, 0}).normal - Vector3d(1, 1, 0).normalized()).norm() < 1e-15);
  CHECK(std::abs(gap({2, 3, -4}).width - (std::sqrt(3.) - .5)) < 1e-15);
  CHECK(std::abs(gap({1.25, 0, 0}).width + .25) < 1e-15);  // they overlap
}

TEST_CASE("Surface gap: of capsules, and of a capsule and a box") {
  const Placed upright = at(Capsule{.5, 1}, {0, 0, 0});
  CHECK(std::abs(surface_gap(upright.moving(), at(Capsule{.25, 1}, {2, 0, .5}).moving(), 0).width - 1.25) < 1e-15);
  CHECK(std::abs(surface_gap(upright.moving(), at(Sphere{.25}, {0, 0, 4}).moving(), 0).width - 2.25) < 1e-15);
  const SurfaceGap gap = surface_gap(upright.moving(), at(Box{{1, 1, 1}}, {0, 0, -3}).moving(), 0);
  CHECK(std::abs(gap.width - .5) < 1e-15);
  CHECK((gap.normal - Vector3d(0, 0, -1)).norm() < 1e-15);
}

}  // namespace
}  // namespace kds::collision::test_surface_gap
