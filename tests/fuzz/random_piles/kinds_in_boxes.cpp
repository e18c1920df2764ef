// Between walls, and in crates made of fixed boxes.
#include "tests/fuzz/random_piles/maker.hpp"

#include <algorithm>
#include <cmath>

namespace kds::piles {
namespace {

using Eigen::Vector3d;

constexpr double sky = 1000;  ///< what is tossed up stays below it

/// A floor space of one to three bodies.
Vector3d draw_space(Maker& make, double high) {
  const double body = 2 * make.greatest_size * 1.01;
  const double x = body * make.random.between(1, 3.5);
  const double z = make.random.one_in(3) ? body : body * make.random.between(1, 3.5);
  return {x, high, z};
}

void between_walls(Maker& make) {
  const Vector3d space = draw_space(make, sky);
  make.scene.walls = collision::Walls{Vector3d::Zero(), space, make.restitution};
  make.drop(draw_count(make.random), Vector3d(0, make.random.between(0, 3), 0), Vector3d(space[0], 4, space[2]));
}

/// Gravity along any direction, so that what rests leans into an edge or a corner.
void tilted(Maker& make) {
  make.scene.gravity = Vector3d(make.random.between(-6, 6), -6, make.random.between(-6, 6));
  if (make.random.one_in(3)) make.scene.gravity[2] = 0;
  const Vector3d space = 2 * draw_space(make, 6);
  make.scene.walls = collision::Walls{Vector3d::Zero(), space, make.restitution};
  // As many as have room.
  const auto count = std::min<std::size_t>(draw_count(make.random), 8);
  make.drop(count, Vector3d::Zero(), Vector3d(space[0], 3, space[2]));
}

/// Walls of different sizes of balls: small ones fall into the gaps between large ones.
void sizes_and_masses(Maker& make) {
  make.least_size = 0.1;
  make.greatest_size = make.random.one_in(2) ? 1 : 10;
  make.greatest_mass = make.random.one_in(2) ? 1 : 1e6;
  const Vector3d space = draw_space(make, sky);
  make.scene.walls = collision::Walls{Vector3d::Zero(), space, make.restitution};
  const auto count = std::min<std::size_t>(draw_count(make.random), 25);
  make.drop(count, Vector3d(0, 0.1, 0), Vector3d(space[0], 2 + make.greatest_size, space[2]));
}

void build_crate(Maker& make, const Vector3d& space) {
  constexpr double thick = 1;
  const double high = 10;
  const double x = space[0], z = space[2];
  make.fix_box({-thick, -thick, -thick}, {x + thick, 0, z + thick});
  make.fix_box({-thick, 0, -thick}, {0, sky, z + thick});
  make.fix_box({x, 0, -thick}, {x + thick, sky, z + thick});
  make.fix_box({0, 0, -thick}, {x, high + sky, 0});
  make.fix_box({0, 0, z}, {x, high + sky, z + thick});
  make.scene.region = Scene::Region{Vector3d::Zero(), Vector3d(x, sky, z)};
}

void crate_of(Maker& make) {
  const Vector3d space = draw_space(make, sky);
  build_crate(make, space);
  make.drop(draw_count(make.random), Vector3d(0, make.random.between(0, 2), 0), Vector3d(space[0], 4, space[2]));
}

void crate(Maker& make) { crate_of(make); }

void crate_of_boxes(Maker& make) {
  make.boxes = true;
  make.turned = make.random.one_in(2);
  crate_of(make);
}

void crate_of_all(Maker& make) {
  make.boxes = make.capsules = true;
  make.turned = make.random.one_in(2);
  crate_of(make);
}

/// A crate whose bodies all move alike, in pieces, up, on, and down again.
void lift(Maker& make) {
  make.capsules = make.random.one_in(3);
  const Vector3d space = draw_space(make, sky);
  build_crate(make, space);
  make.scene.region.reset();
  const double up = make.random.between(0.05, 0.5), starts = make.random.between(0, 5),
               lasts = make.random.between(1, 6);
  const double sideways = make.random.one_in(2) ? make.random.between(-0.3, 0.3) : 0;
  for (Description& body : make.scene.bodies) {
    const Vector3d from = body.motion.front().coefficients[0];
    const Vector3d way(sideways, up, 0);
    const Vector3d top = from + lasts * way;
    const double down = make.random.one_in(1) ? 0.2 : 0;
    body.motion = {{{from}, 0},
                   {{from, way}, starts},
                   {{top}, starts + lasts},
                   {{top, Vector3d(0, -down, 0)}, starts + lasts + 2}};
  }
  make.drop(draw_count(make.random), Vector3d(0, make.random.between(0, 2), 0), Vector3d(space[0], 4, space[2]));
}

/// A fixed box that sweeps over a floor and pushes what lies there.
void paddle(Maker& make) {
  make.fix_box({-20, -1, -20}, {20, 0, 20});
  make.drop(draw_count(make.random), Vector3d(-1.5, 0, -1), Vector3d(1.5, 3, 1));
  const double starts = make.random.between(0, 6), speed = make.random.between(0.1, 2);
  const Vector3d from(-5, 2, 0);
  const double back = starts + make.random.between(3, 8);
  Description& box = make.fix(collision::Box{Vector3d(0.5, 2, 3)}, from,
                              make.random.one_in(2) ? make.about(Vector3d::UnitY(), make.random.between(-0.5, 0.5))
                                                    : Eigen::Quaterniond::Identity());
  const Vector3d way(speed, 0, 0);
  box.motion = {{{from}, 0}, {{from, way}, starts}, {{from + (back - starts) * way, -way}, back}};
}

}  // namespace

std::initializer_list<NamedKind> kinds_in_boxes() {
  static constexpr std::initializer_list<NamedKind> kinds{
      {"between walls", between_walls},
      {"tilted", tilted},
      {"sizes and masses", sizes_and_masses},
      {"crate", crate},
      {"crate of boxes", crate_of_boxes},
      {"crate of all", crate_of_all},
      {"lift", lift},
      {"paddle", paddle},
  };
  return kinds;
}

}  // namespace kds::piles
