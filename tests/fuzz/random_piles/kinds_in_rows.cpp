// Stacks, rows, pyramids, cradles, and clusters in free space: bodies that touch from the start.
#include "tests/fuzz/random_piles/maker.hpp"

#include <algorithm>
#include <cmath>

namespace kds::piles {
namespace {

using collision::Box;
using collision::Sphere;
using Eigen::Vector3d;

void floor(Maker& make) { make.fix_box({-30, -1, -30}, {30, 0, 30}); }

double draw_gap(Maker& make) { return make.random.one_in(2) ? 0 : make.random.between(0, 0.5); }

double draw_mass(Maker& make, double size) {
  const double usual = size * size * size;
  return make.random.one_in(3) ? usual * std::pow(10, make.random.between(-3, 3)) : usual;
}

/// Boxes one above the other, with and without gaps, and what falls on them.
void stack(Maker& make) {
  floor(make);
  const std::size_t count = 1 + draw_count(make.random) / 2;
  double top = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d half(make.random.between(0.2, 0.6), make.random.between(0.1, 0.4), make.random.between(0.2, 0.6));
    top += draw_gap(make);
    make.add({.shape = Box{half}, .mass = draw_mass(make, 0.3)},
             Vector3d(make.random.between(-0.15, 0.15), top + half[1], make.random.between(-0.15, 0.15)));
    top += 2 * half[1];
  }
  make.drop(make.random.below(4), Vector3d(-1, top + 0.1, -1), Vector3d(1, top + 2, 1));
}

/// Thin boxes side by side, pushed over a floor by a ball that comes along it.
void dominoes(Maker& make) {
  floor(make);
  const std::size_t count = 2 + draw_count(make.random) / 2;
  const double gap = draw_gap(make);
  const Vector3d half(0.1, 0.6, 0.4);
  double x = 0;
  for (std::size_t i = 0; i < count; ++i) {
    make.add({.shape = Box{half}, .mass = draw_mass(make, 0.4)}, Vector3d(x, half[1], 0));
    x += 2 * half[0] + gap;
  }
  const double radius = make.draw_size();
  make.add_ball(radius, Vector3d(-2, radius, 0), Vector3d(make.random.between(1, 6), 0, 0));
  if (make.random.one_in(2)) make.fix_box({x + 0.5, 0, -2}, {x + 1, 4, 2});
}

/// Balls in a row, on a floor or in free space, hit by one or more.
void cradle(Maker& make) {
  const bool on_floor = make.random.one_in(2);
  if (on_floor) {
    floor(make);
  } else {
    make.scene.gravity.setZero();
  }
  const std::size_t count = 1 + draw_count(make.random) / 2;
  const double gap = make.random.one_in(3) ? make.random.between(0, 0.1) : 0;
  const double radius = make.random.one_in(2) ? 0.5 : make.draw_size();
  for (std::size_t i = 0; i < count; ++i) {
    make.add_ball(radius, Vector3d(double(i) * (2 * radius + gap), radius, 0)).mass = draw_mass(make, radius);
  }
  const std::size_t hits = 1 + make.random.below(2);
  for (std::size_t i = 0; i < hits; ++i) {
    make.add_ball(radius, Vector3d(-1.5 - 2 * radius * double(i), radius, 0), Vector3d(make.random.between(1, 4), 0, 0))
        .mass = draw_mass(make, radius);
  }
  if (on_floor && make.random.one_in(2)) {
    const double end = double(count) * (2 * radius + gap) + 1;
    make.fix_box({end, 0, -2}, {end + 1, 4, 2});
    make.fix_box({-7, 0, -2}, {-6, 4, 2});
  }
}

/// Balls on balls: each layer in the hollows of the one below, touching it or falling on it.
void pyramid(Maker& make) {
  const bool walls = make.random.one_in(2);
  const int layers = make.random.integer(2, 4);
  constexpr double radius = 0.5;
  const double lift = make.random.one_in(2) ? 0 : make.random.between(0, 0.3);
  const double apart = 2 * radius * (make.random.one_in(2) ? 1 : 1 + make.random.between(0, 0.2));
  if (walls) {
    const double wide = layers * apart;
    make.scene.walls = collision::Walls{Vector3d::Zero(), Vector3d(wide, 1000, wide), make.restitution};
  } else {
    floor(make);
  }
  for (int layer = 0; layer < layers; ++layer) {
    const double high = radius + layer * (std::sqrt(std::max(4 * radius * radius - apart * apart / 2, 0.01)) + lift);
    const double from = apart / 2 + layer * apart / 2;
    for (int i = 0; i < layers - layer; ++i) {
      for (int k = 0; k < layers - layer; ++k) {
        make.add_ball(radius, Vector3d(from + i * apart, high, from + k * apart)).mass = draw_mass(make, radius);
      }
    }
  }
}

/// Balls exactly above each other, or nearly.
void column(Maker& make) {
  floor(make);
  const std::size_t count = 1 + draw_count(make.random) / 3;
  const double aside = make.random.one_in(2) ? 0 : std::pow(10, make.random.between(-12, -1));
  double top = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double radius = make.draw_size();
    top += draw_gap(make);
    make.add_ball(radius, Vector3d(i % 2 ? aside : 0, top + radius, 0)).mass = draw_mass(make, radius);
    top += 2 * radius;
  }
}

/// Nothing but bodies: balls that fly at each other from all sides.
void free_cluster(Maker& make) {
  make.scene.gravity.setZero();
  make.capsules = make.random.one_in(3);
  make.boxes = make.random.one_in(3);
  make.turned = true;
  make.speed = 0;
  make.drop(2 + draw_count(make.random) / 2, Vector3d(-1, -1, -1), Vector3d(1, 1, 1));
  for (Description& body : make.scene.bodies) {
    auto& path = body.motion.front().coefficients;
    path[1] = -make.random.between(0.2, 1) * path[0];
  }
}

}  // namespace

std::initializer_list<NamedKind> kinds_in_rows() {
  static constexpr std::initializer_list<NamedKind> kinds{
      {"stack", stack},     {"dominoes", dominoes}, {"cradle", cradle},
      {"pyramid", pyramid}, {"column", column},     {"free cluster", free_cluster},
  };
  return kinds;
}

}  // namespace kds::piles
