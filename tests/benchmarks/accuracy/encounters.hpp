// Pairs of bodies that meet, at any clock, place, speed and size, and the error of the time at which they do.
#pragma once

#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/world.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/support/exact_bodies.hpp"
#include "tests/support/exact_oracle.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace accuracy {

using Eigen::Vector3d;
using kds::collision::BodyDescription;
using kds::collision::Box;
using kds::collision::Shape;
using kds::collision::Sphere;
using kds::tests::Random;

/// Where, when and how fast two bodies meet.
struct Setting {
  std::string name;
  double clock = 0;        ///< s; the world starts there
  double coordinates = 0;  ///< each coordinate of the first body, but for a random part of the bodies' size
  double speed_a = 1;      ///< units of length / s
  double speed_b = 1;
  double size_a = 1;  ///< radius or half extent, units of length
  double size_b = 1;
};

/// The settings of docs/accuracy.md.
inline std::vector<Setting> settings() {
  return {{.name = "near"},
          {.name = "clock 1e9", .clock = 1e9},
          {.name = "coordinates 1e8", .coordinates = 1e8},
          {.name = "clock 1e9 and coordinates 1e8", .clock = 1e9, .coordinates = 1e8},
          {.name = "speeds 1e-9", .speed_a = 1e-9, .speed_b = 1e-9},
          {.name = "speeds 1e-3", .speed_a = 1e-3, .speed_b = 1e-3},
          {.name = "speeds 1e3", .speed_a = 1e3, .speed_b = 1e3},
          {.name = "speeds 1e9", .speed_a = 1e9, .speed_b = 1e9},
          {.name = "speeds 1e-9 and 1e9", .speed_a = 1e-9, .speed_b = 1e9},
          {.name = "sizes 1e6 and 1e-6", .size_a = 1e6, .size_b = 1e-6}};
}

template <int Degree>
struct Encounter {
  BodyDescription<Degree> a, b;
  double size;      ///< of both, units of length
  double duration;  ///< s; they meet within about that time from the clock's start
};

inline Vector3d random_vector(Random& random, double size) {
  Vector3d v;
  for (int d = 3; d-- > 0;) v[d] = random.between(-size, size);
  return v;
}

/// b passes a's centre by less than the sum of the sizes, most of the time within a second at speed 1.
template <int Degree>
Encounter<Degree> encounter(Random& random, const Setting& s, const Shape& shape_a, const Shape& shape_b) {
  Encounter<Degree> e;
  e.size = s.size_a + s.size_b;
  const double speed = std::max(s.speed_a, s.speed_b);
  const double distance = 5 * e.size;
  e.duration = distance / speed;
  const auto motion = [&](const Vector3d& at, const Vector3d& velocity) {
    kds::certificates::PointMotion<Degree> m;
    m.coefficients.fill(Vector3d::Zero());
    m.start = s.clock;
    m.coefficients[0] = at;
    m.coefficients[1] = velocity;
    return m;
  };
  Vector3d direction;
  do {
    direction = random_vector(random, 1);
  } while (direction.squaredNorm() < 0.01 || direction.squaredNorm() > 1);
  direction.normalize();
  const Vector3d at = Vector3d::Constant(s.coordinates) + random_vector(random, e.size);
  const Vector3d velocity_a = random_vector(random, s.speed_a);
  const double arrival = e.duration * random.between(0.5, 1);
  const Vector3d aim = random_vector(random, 0.4 * e.size);
  Vector3d velocity = (aim - distance * direction) / arrival + velocity_a;
  e.a.shape = shape_a;
  e.b.shape = shape_b;
  e.a.motion = {motion(at, velocity_a)};
  if constexpr (Degree == 2) {
    const Vector3d acceleration = random_vector(random, distance / (e.duration * e.duration));
    velocity -= acceleration * arrival;
    e.b.motion = {motion(at + distance * direction, velocity)};
    e.a.motion[0].coefficients[2] = random_vector(random, s.speed_a / e.duration);
    e.b.motion[0].coefficients[2] = acceleration + e.a.motion[0].coefficients[2];
  } else {
    e.b.motion = {motion(at + distance * direction, velocity)};
  }
  return e;
}

/// Of the times of contact, in s and in spacings of the doubles there.
struct TimeErrors {
  int contacts = 0;
  int wrong = 0;      ///< found where there is none, or the other way round
  int not_first = 0;  ///< another double than the first at or after the exact instant
  double least_ulps = std::numeric_limits<double>::infinity();
  double most_ulps = -std::numeric_limits<double>::infinity();  ///< < 0: early
  double most_seconds = 0;
  double most_roundings = 0;  ///< error of the place, in 2^-53 of the size
};

/// The engine's first contact, and that of exact arithmetic. Also asks a whole world.
template <int Degree>
void compare(const Encounter<Degree>& e, const Setting& s, TimeErrors& errors) {
  using namespace kds::collision;
  const PlacedShape a = place(e.a.shape, e.a.orientation);
  const PlacedShape b = place(e.b.shape, e.b.orientation);
  const double limit = s.clock + 4 * e.duration;
  const double t = first_contact(TranslatingShape<Degree>{a, e.a.motion[0]}, TranslatingShape<Degree>{b, e.b.motion[0]},
                                 s.clock, limit, ContactMode::transparent);
  const auto root = oracle::first_contact(oracle::exact_body(e.a), oracle::exact_body(e.b), s.clock, limit);
  const bool seen = root && root->ceiling() <= limit;
  if (seen != (t != kds::never)) {
    ++errors.wrong;
    return;
  }
  if (!seen || t == s.clock) return;
  ++errors.contacts;
  errors.not_first += root->ceiling() != t;
  root->narrow(200);
  const double seconds = oracle::approximate(oracle::rational(t) - root->low());
  const double ulps = seconds / (t - kds::next_down(t));
  errors.least_ulps = std::min(errors.least_ulps, ulps);
  errors.most_ulps = std::max(errors.most_ulps, ulps);
  errors.most_seconds = std::max(errors.most_seconds, std::abs(seconds));
  const double speed = (e.b.motion[0].velocity(t) - e.a.motion[0].velocity(t)).norm();
  errors.most_roundings = std::max(errors.most_roundings, std::abs(seconds) * speed / e.size * 0x1p53);
}

}  // namespace accuracy
