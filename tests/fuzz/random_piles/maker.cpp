#include "tests/fuzz/random_piles/maker.hpp"

#include <algorithm>
#include <cmath>

namespace kds::piles {

using collision::Box;
using collision::Capsule;
using collision::Shape;
using collision::Sphere;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

/// Places that are tried before a body is put higher.
constexpr int tries = 40;
/// Bodies that are drawn begin no nearer to others than this part of the least size.
constexpr double least_gap = 0x1p-20;

}  // namespace

std::size_t draw_count(tests::Random& random) {
  switch (random.below(6)) {
    case 0:
      return 1;
    case 1:
    case 2:
      return 2 + random.below(3);
    case 3:
    case 4:
      return 3 + random.below(10);
    default:
      return 10 + random.below(31);
  }
}

Quaterniond Maker::orientation() {
  const auto part = [&] { return random.between(-1, 1); };
  const double w = part(), x = part(), y = part(), z = part();
  const Quaterniond q(w, x, y, z);
  return q.norm() > 0.1 ? q.normalized() : Quaterniond::Identity();
}

Quaterniond Maker::about(const Vector3d& axis, double angle) const {
  return Quaterniond(Eigen::AngleAxisd(angle, axis)).normalized();
}

/// Evenly on the scale of logarithms, so that small ones are among large ones.
double Maker::draw_size() { return least_size * std::pow(greatest_size / least_size, random.unit()); }

Description Maker::draw_body() {
  const double size = draw_size();
  Description body{.shape = Sphere{size}, .restitution = restitution};
  std::size_t kinds = 1 + std::size_t{boxes} + std::size_t{capsules};
  const std::size_t kind = random.below(kinds);
  if (kind == 1 && boxes) {
    const Vector3d part(random.between(0.4, 1), random.between(0.4, 1), random.between(0.4, 1));
    body.shape = Box{size * part / std::sqrt(3.0)};
  } else if (kind > 0) {
    const double half = random.between(0.1, 0.7);
    body.shape = Capsule{size * (1 - half), size * half};
    body.orientation = orientation();
  }
  if (turned) body.orientation = orientation();
  body.mass = size * size * size * std::pow(greatest_mass, random.unit());
  return body;
}

Description& Maker::add(Description body, const Vector3d& place, const Vector3d& velocity) {
  body.motion = {{{place, velocity, 0.5 * scene.gravity}, 0}};
  body.restitution = restitution;
  solids.emplace_back(collision::place(body.shape, body.orientation));
  scene.bodies.push_back(std::move(body));
  return scene.bodies.back();
}

Description& Maker::add_ball(double radius, const Vector3d& place, const Vector3d& velocity) {
  return add({.shape = Sphere{radius}, .mass = radius * radius * radius}, place, velocity);
}

Description& Maker::fix(const Shape& shape, const Vector3d& place, const Quaterniond& turn) {
  Description& body = add({.shape = shape, .orientation = turn, .fixed = true}, place);
  body.motion.front().coefficients[2].setZero();
  return body;
}

Description& Maker::fix_box(const Vector3d& min, const Vector3d& max) {
  return fix(Box{(max - min) / 2}, (min + max) / 2);
}

bool Maker::has_room(const Description& body, const Vector3d& place) const {
  const Solid solid(collision::place(body.shape, body.orientation));
  const double gap = least_gap * solid.shape.bounding_radius;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Vector3d there = scene.bodies[i].motion.front().position(0);
    if (depth(solid, place, solids[i], there) > -gap) return false;
  }
  return true;
}

void Maker::drop(std::size_t count, const Vector3d& min, const Vector3d& max) {
  double rise = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Description body = draw_body();
    const double radius = collision::place(body.shape, body.orientation).bounding_radius * (1 + least_gap);
    const auto within = [&](int d) {
      const double low = min[d] + radius, high = max[d] - radius;
      return low < high ? random.between(low, high) : (min[d] + max[d]) / 2;
    };
    for (int attempt = 1;; ++attempt) {
      const double x = within(0), z = within(2);
      const Vector3d place(x, min[1] + radius + rise + random.between(0, std::max(max[1] - min[1] - 2 * radius, 0.0)),
                           z);
      if (has_room(body, place)) {
        add(body, place, Vector3d(random.between(-speed, speed), 0, random.between(-speed, speed)));
        break;
      }
      if (attempt % tries == 0) rise += radius;
    }
  }
}

}  // namespace kds::piles
