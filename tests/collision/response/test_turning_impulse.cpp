// Impulses between bodies that turn: their laws, what they keep, and that their roundings are not biased.
#include "collision/response/impulse.hpp"
#include "collision/response/inertia.hpp"
#include "collision/response/turning_impulse.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace test_turning_impulse {
namespace {

using namespace kds::collision;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using kds::tests::Random;
using Long = long double;
using Vector3l = Eigen::Matrix<Long, 3, 1>;
using Matrix3l = Eigen::Matrix<Long, 3, 3>;

constexpr double rounding = 0x1p-53;

Vector3d vector(Random& random) {
  Vector3d v;
  for (int d = 0; d < 3; ++d) v[d] = random.between(-1, 1);
  return v;
}

Vector3d direction(Random& random) {
  Vector3d v;
  do {
    v = vector(random);
  } while (v.norm() < 0.1);
  return v.normalized();
}

Matrix3d any_rotation(Random& random) {
  Eigen::Vector4d q;
  do {
    for (int i = 0; i < 4; ++i) q[i] = random.between(-1, 1);
  } while (q.norm() < 0.1);
  return Eigen::Quaterniond(q.normalized()).toRotationMatrix();
}

/// A body as the formulas take it: its mass and inertia are the inverses of what it is given, in long doubles.
struct Body {
  RigidVelocity motion;
  Mobility mobility;
  Long mass = 0;
  Matrix3l inertia = Matrix3l::Zero();
};

Body fixed() { return {{}, Mobility::fixed()}; }

Body ball(double inverse_mass, double inverse_moment) {
  return {{},
          Mobility::of_spherical(inverse_mass, inverse_moment),
          1 / Long(inverse_mass),
          Matrix3l::Identity() / Long(inverse_moment)};
}

Body any_body(Random& random, double mass, double thin) {
  const Vector3d moments(random.between(0.5, 1) * thin, random.between(0.5, 0.7), 0.6);
  const Matrix3d inertia = mass * Matrix3d(moments.asDiagonal());
  const Matrix3d inverse = turned_tensor(inverse_inertia(inertia), any_rotation(random));
  return {{}, Mobility::of(1 / mass, inverse), 1 / Long(1 / mass), inverse.cast<Long>().inverse()};
}

void set_moving(Body& body, Random& random) {
  body.motion.velocity = vector(random) / std::sqrt(static_cast<double>(body.mass));
  body.motion.angular_velocity = vector(random) / std::sqrt(static_cast<double>(body.mass));
}

struct State {
  Vector3l v, w;
};
State state(const RigidVelocity& body) { return {body.velocity.cast<Long>(), body.angular_velocity.cast<Long>()}; }

Long energy(const Body& body) {
  const auto [v, w] = state(body.motion);
  return (body.mass * v.squaredNorm() + w.dot(body.inertia * w)) / 2;
}

/// What rounding each coordinate of the velocities, by u of itself, makes of the energy at most.
Long rounding_of_energy(const Body& body) {
  const auto [v, w] = state(body.motion);
  const Vector3l angular = body.inertia * w;
  return rounding * (body.mass * v.squaredNorm() + w.cwiseAbs().dot(angular.cwiseAbs()));
}

Vector3l slip(const Body& a, const Body& b, const ContactArms& arms) {
  const auto at = [](const Body& body, const Vector3d& arm) -> Vector3l {
    const auto [v, w] = state(body.motion);
    return v + w.cross(arm.cast<Long>());
  };
  return at(b, arms.b) - at(a, arms.a);
}

/// What rounding of the velocities makes of the relative velocity at the contact.
Long rounding_of_slip(const Body& a, const Body& b, const ContactArms& arms) {
  const auto of = [](const Body& body, const Vector3d& arm) {
    return body.motion.velocity.cwiseAbs().sum() + 2 * body.motion.angular_velocity.cwiseAbs().sum() * arm.norm();
  };
  return rounding * (of(a, arms.a) + of(b, arms.b));
}

Matrix3l response(const Body& a, const Body& b, const ContactArms& arms) {
  Matrix3l k = Matrix3l::Zero();
  const auto add = [&](const Body& body, const Vector3d& arm) {
    Matrix3l lever, inverse = body.mobility.inverse_inertia.cast<Long>();
    lever << 0, -arm[2], arm[1], arm[2], 0, -arm[0], -arm[1], arm[0], 0;
    if (body.mobility.spherical) inverse = Matrix3l::Identity() * Long(body.mobility.inverse_moment);
    k += Matrix3l::Identity() * Long(body.mobility.inverse_mass) - lever * inverse * lever;
  };
  add(a, arms.a), add(b, arms.b);
  return k;
}

TurningImpulse strike(Body& a, Body& b, const ContactArms& arms, const Surfaces& surfaces) {
  return collide(a.motion, b.motion, a.mobility, b.mobility, arms, surfaces);
}

/// A pair that approaches: any bodies, one in five of them fixed, or moving without being movable.
struct Meeting {
  Body a, b;
  ContactArms arms;

  Meeting(Random& random, double ratio) {
    const auto any = [&](double mass) {
      const std::size_t kind = random.below(3);
      return kind == 0 ? ball(1 / mass, random.between(1, 3) / mass) : any_body(random, mass, kind == 1 ? 1 : 1e-2);
    };
    a = any(1), b = any(ratio);
    const std::size_t unmoved = random.below(10);
    if (unmoved < 2) (unmoved == 0 ? a : b) = fixed();
    for (Body* body : {&a, &b}) {
      if (body->mass != 0) {
        set_moving(*body, random);
      } else if (random.one_in(2)) {
        body->motion.velocity = vector(random);
        body->motion.angular_velocity = vector(random);
      }
    }
    arms.normal = direction(random);
    const Vector3d x = direction(random), y = direction(random);
    arms.a = random.one_in(5) ? Vector3d(Vector3d::Zero()) : x;
    arms.b = random.one_in(5) ? Vector3d(Vector3d::Zero()) : y;
    if (slip(a, b, arms).dot(arms.normal.cast<Long>()) > 0) arms.normal *= -1;
  }
};

Surfaces any_surfaces(Random& random) {
  Surfaces surfaces;
  surfaces.restitution = random.one_in(3) ? static_cast<double>(random.below(2)) : random.unit();
  const std::array<double, 5> frictions{0, 0.05, random.unit(), 3, 1e9};
  surfaces.friction = frictions[random.below(5)];
  surfaces.tangential_restitution = random.one_in(2) ? static_cast<double>(random.below(3)) - 1 : random.between(-1, 1);
  return surfaces;
}

TEST_CASE("Where no turning matters, velocities change as without it, bit for bit", "[turning impulse]") {
  Random random(31);
  for (int i = 0; i < 2000; ++i) {
    const double inverse_a = random.one_in(5) ? 0 : random.scaled(-3, 3) * random.scaled(-3, 3);
    const double mass_a = std::abs(inverse_a), mass_b = 1 / random.between(0.01, 10);
    Body a{{vector(random)}, Mobility::of_spherical(mass_a, mass_a)}, b{{vector(random)}, Mobility::fixed()};
    b.mobility.inverse_mass = mass_b;  // a body that nothing turns
    ContactArms arms{direction(random), Vector3d::Zero(), vector(random)};
    if (i % 2 == 0) {
      arms.normal = Vector3d::UnitY() * (i % 4 == 0 ? 1 : -1);
      arms.a = 0.7 * arms.normal;
      a.motion.angular_velocity = vector(random);
    }
    Surfaces surfaces{random.unit(), 0, random.between(-1, 1)};
    if (i % 3 == 0) surfaces = {1, 0.5, -1};
    Vector3d va = a.motion.velocity, vb = b.motion.velocity;
    const Vector3d wa = a.motion.angular_velocity;
    const double approach =
        -(arms.normal[0] * (vb - va)[0] + arms.normal[1] * (vb - va)[1] + arms.normal[2] * (vb - va)[2]);
    if (approach > 0) {
      change_relative_velocity(va, vb, arms.normal, (1 + surfaces.restitution) * approach, mass_a, mass_b);
    }
    const TurningImpulse impulse = strike(a, b, arms, surfaces);
    CHECK(a.motion.velocity == va);
    CHECK(b.motion.velocity == vb);
    CHECK(a.motion.angular_velocity == wa);
    CHECK(b.motion.angular_velocity.isZero(0));
    CHECK(!impulse.slides);
    CHECK((impulse.impulse.isZero(0)) == !(approach > 0));
  }
}

TEST_CASE("Nothing happens to what parts, and to two that are fixed", "[turning impulse]") {
  Random random(32);
  for (int i = 0; i < 1000; ++i) {
    Meeting m(random, 2);
    m.arms.normal *= -1;
    const Meeting before = m;
    CHECK(strike(m.a, m.b, m.arms, any_surfaces(random)).impulse.isZero(0));
    CHECK(m.a.motion.velocity == before.a.motion.velocity);
    CHECK(m.b.motion.angular_velocity == before.b.motion.angular_velocity);
    m.arms.normal *= -1;
    m.a.mobility = m.b.mobility = Mobility::fixed();
    CHECK(strike(m.a, m.b, m.arms, any_surfaces(random)).impulse.isZero(0));
    CHECK(m.b.motion.velocity == before.b.motion.velocity);
    CHECK(m.a.motion.angular_velocity == before.a.motion.angular_velocity);
  }
}

TEST_CASE("The laws of impulses hold for pairs of any kind", "[turning impulse]") {
  for (const double ratio : {1.0, 7.0, 1e4}) {
    Random random(33);
    std::array<int, 3> kinds{};  // without tangential part, sliding, not sliding
    for (int i = 0; i < 20'000; ++i) {
      Meeting m(random, ratio);
      const Surfaces surfaces = any_surfaces(random);
      const Meeting before = m;
      const TurningImpulse impulse = strike(m.a, m.b, m.arms, surfaces);
      const double e = surfaces.restitution, et = surfaces.tangential_restitution, mu = surfaces.friction;
      const Vector3l n = m.arms.normal.cast<Long>().normalized(), j = impulse.impulse.cast<Long>();
      const Vector3l g0 = slip(before.a, before.b, m.arms), g1 = slip(m.a, m.b, m.arms);
      const Long blur = rounding_of_slip(m.a, m.b, m.arms) + rounding_of_slip(before.a, before.b, m.arms) * 0x1p-9L;
      INFO("ratio " << ratio << ", meeting " << i);
      if (m.a.mass == 0 && m.b.mass == 0) continue;
      // Law 1. Central impulses are made in doubles: 16 roundings of theirs.
      const Long allowed = impulse.slides || j.isZero(0) ? blur : blur * 16;
      REQUIRE(std::abs(g1.dot(n) + e * g0.dot(n)) <= allowed);
      // Momentum, and angular momentum about the point of contact: either body takes what the impulse says. Its
      // rounding to doubles is half a rounding of each coordinate; a central impulse has 8.
      const auto takes = [&](const Body& now, const Body& then, Long sign, const Vector3d& arm) {
        const Long inverse_mass = now.mobility.inverse_mass;
        const Vector3l v = state(now.motion).v - state(then.motion).v - sign * inverse_mass * j;
        REQUIRE(v.norm() <= rounding * (now.motion.velocity.norm() + 8 * inverse_mass * j.norm()));
        Matrix3l inverse = now.mobility.inverse_inertia.cast<Long>();
        if (now.mobility.spherical) inverse = Matrix3l::Identity() * Long(now.mobility.inverse_moment);
        const Vector3l w = state(now.motion).w - state(then.motion).w - sign * inverse * arm.cast<Long>().cross(j);
        REQUIRE(w.norm() <= rounding * (now.motion.angular_velocity.norm() + 2 * inverse.norm() * j.norm()));
      };
      takes(m.a, before.a, -1, m.arms.a);
      takes(m.b, before.b, 1, m.arms.b);
      const Vector3l kn = response(m.a, m.b, m.arms) * n;
      const Vector3l tilt = kn / kn.dot(n) - n;
      // Coulomb's cone. A greater tangential part changes the normal one by the tilt.
      const Long normal = j.dot(n), tangential = (j - normal * n).norm();
      const Long of_parts = 2 * rounding * j.norm() * (1 + tilt.norm());
      REQUIRE(normal >= -of_parts);
      REQUIRE(tangential <= mu * normal + (1 + mu) * of_parts);
      if (impulse.slides) REQUIRE(tangential >= mu * normal * (1 - 0x1p-40) - (1 + mu) * of_parts);
      // Law 4: the slip when compression ends becomes -e_t of itself, and friction never turns it further.
      const Vector3l h = g0 - g0.dot(n) * n - g0.dot(n) * tilt;
      const Vector3l after = g1 - g1.dot(n) * n - g1.dot(n) * tilt;
      const Long size = h.norm(), unsure = blur * 16 * (1 + tilt.norm());
      if (mu == 0 || et == -1) {
        ++kinds[0];
        REQUIRE((after - h).norm() <= unsure);
        REQUIRE(tangential <= 8 * rounding * j.norm());
      } else if (!impulse.slides) {
        ++kinds[2];
        REQUIRE((after + et * h).norm() <= unsure);
      } else {
        ++kinds[1];
        REQUIRE(after.dot(h) >= -et * size * size - unsure * size);
        // Where slip along h is left, the impulse is along -h.
        const Vector3l along = j - normal * n;
        if (after.dot(h) > (-et + 1e-6L) * size * size + unsure * size) {
          REQUIRE((along / tangential + h / size).norm() <=
                  1e-13L + 8 * rounding * j.norm() / tangential + unsure / size);
        }
      }
      // Energy. What is driven may give any.
      const bool driven =
          (m.a.mass == 0 && !m.a.motion.velocity.isZero(0)) || (m.b.mass == 0 && !m.b.motion.velocity.isZero(0));
      if (driven) continue;
      const Long gain = energy(m.a) + energy(m.b) - energy(before.a) - energy(before.b);
      const Long bound =
          16 * (rounding_of_energy(m.a) + rounding_of_energy(m.b)) + 1e-18L * (energy(before.a) + energy(before.b));
      REQUIRE(gain <= bound);
      if (e == 1 && (mu == 0 || et == -1 || (et == 1 && !impulse.slides))) REQUIRE(gain >= -bound);
      const Long expected = -(1 - e * e) * g0.dot(n) * g0.dot(n) / (2 * kn.dot(n));
      if (mu == 0 || et == -1) REQUIRE(std::abs(gain - expected) <= bound);
      if (mu != 0) REQUIRE(gain <= expected + bound);
    }
    for (const int count : kinds) CHECK(count > 2000);
  }
}

TEST_CASE("Neither of two bodies is the first", "[turning impulse]") {
  Random random(34);
  for (int i = 0; i < 5000; ++i) {
    Meeting m(random, 3);
    Meeting swapped = m;
    std::swap(swapped.a, swapped.b);
    std::swap(swapped.arms.a, swapped.arms.b);
    swapped.arms.normal *= -1;
    const Surfaces surfaces = any_surfaces(random);
    const TurningImpulse one = strike(m.a, m.b, m.arms, surfaces);
    const TurningImpulse other = strike(swapped.a, swapped.b, swapped.arms, surfaces);
    CHECK(one.impulse == -other.impulse);
    CHECK(one.slides == other.slides);
    CHECK(m.a.motion.velocity == swapped.b.motion.velocity);
    CHECK(m.a.motion.angular_velocity == swapped.b.motion.angular_velocity);
    CHECK(m.b.motion.velocity == swapped.a.motion.velocity);
    CHECK(m.b.motion.angular_velocity == swapped.a.motion.angular_velocity);
  }
}

TEST_CASE("A tensor of equal moments does what their number does", "[turning impulse]") {
  Random random(35);
  for (int i = 0; i < 1000; ++i) {
    Body a = ball(0.5, 1.25), b = ball(2, 5);
    set_moving(a, random), set_moving(b, random);
    Body c = a;
    c.mobility = Mobility::of(0.5, 1.25 * Matrix3d::Identity());
    Body d = b;
    const ContactArms arms{direction(random), vector(random), vector(random)};
    const Surfaces surfaces = any_surfaces(random);
    CHECK(strike(a, b, arms, surfaces).impulse == strike(c, d, arms, surfaces).impulse);
    CHECK(a.motion.angular_velocity == c.motion.angular_velocity);
    CHECK(b.motion.velocity == d.motion.velocity);
  }
}

/// A solid ball of mass and radius 1 that falls on a floor at the speed 1, and goes along x at the speed 1.
struct Falling {
  Body ground = fixed(), one = ball(1, 2.5);
  ContactArms arms{Vector3d::UnitZ(), {5, 3, 0}, -Vector3d::UnitZ()};

  explicit Falling(const Surfaces& surfaces) {
    one.motion.velocity = {1, 0, -1};
    slides = strike(ground, one, arms, surfaces).slides;
  }
  bool slides;
};

TEST_CASE("A ball on a floor: smooth, rough, rolling and sliding", "[turning impulse]") {
  const auto close = [](const Vector3d& a, const Vector3d& b) { return (a - b).norm() < 1e-15; };
  const Falling smooth({1, 0.5, -1});
  CHECK(smooth.one.motion.velocity == Vector3d(1, 0, 1));
  CHECK(smooth.one.motion.angular_velocity.isZero(0));
  // 2 / 7 of the velocity are lost until it rolls, twice as much until the slip is turned round.
  const Falling rolling({0.5, 9, 0});
  CHECK(close(rolling.one.motion.velocity, {5.0 / 7, 0, 0.5}));
  CHECK(close(rolling.one.motion.angular_velocity, {0, 5.0 / 7, 0}));
  CHECK(!rolling.slides);
  const Falling rough({1, 9, 1});
  CHECK(close(rough.one.motion.velocity, {3.0 / 7, 0, 1}));
  CHECK(close(rough.one.motion.angular_velocity, {0, 10.0 / 7, 0}));
  const Falling sliding({0.5, 0.125, 0});
  CHECK(close(sliding.one.motion.velocity, {1 - 0.125 * 1.5, 0, 0.5}));
  CHECK(close(sliding.one.motion.angular_velocity, {0, 2.5 * 0.125 * 1.5, 0}));
  CHECK(sliding.slides);
}

TEST_CASE("A rod struck at its end, and a floor that turns", "[turning impulse]") {
  // A rod of the length 2 and mass 3 along x at rest, its moments 1 across: K = 1 / 3 + 1 / 1 + 1 / 1.
  Body rod;
  rod.mobility = Mobility::of(1.0 / 3, Vector3d(1e3, 1, 1).asDiagonal());
  Body point = ball(1, 1);
  point.motion.velocity = {0, 0, 7};
  strike(point, rod, {Vector3d::UnitZ(), Vector3d::Zero(), Vector3d::UnitX()}, {1});
  CHECK(point.motion.velocity[2] == Approx(7 - 6.0).epsilon(1e-15));
  CHECK(rod.motion.velocity[2] == Approx(2).epsilon(1e-15));
  CHECK(rod.motion.angular_velocity[1] == Approx(-6).epsilon(1e-15));
  // What is driven keeps its motion, and gives that of its surface: here (0, 2, 0), which law 4 with e_t = 1 mirrors.
  Body wheel = fixed(), one = ball(1, 0);
  wheel.motion.angular_velocity = {0, 0, 2};
  one.motion.velocity = {-1, 0, 0};
  strike(wheel, one, {Vector3d::UnitX(), Vector3d::UnitX(), Vector3d::Zero()}, {0.5, 100, 1});
  CHECK(wheel.motion.angular_velocity == Vector3d(0, 0, 2));
  CHECK(wheel.motion.velocity.isZero(0));
  CHECK((one.motion.velocity - Vector3d(0.5, 4, 0)).norm() < 1e-15);
}

struct Drift {
  Long energy = 0, squares = 0, worst = 0;
  Vector3l momentum = Vector3l::Zero(), angular = Vector3l::Zero();
  Long momentum_squares = 0, angular_squares = 0;
};

/// Collisions at random of four bodies whose tensors stay as they are; `slides` are taken back.
Drift drift(std::vector<Body> bodies, const Surfaces& surfaces, bool along_normal, int steps, std::uint64_t seed) {
  Random random(seed);
  Drift drift;
  Long whole = 0;
  for (Body& body : bodies) set_moving(body, random);
  for (const Body& body : bodies) whole += energy(body);
  for (int i = 0; i < steps; ++i) {
    const std::size_t first = random.below(bodies.size());
    Body& a = bodies[first];
    Body& b = bodies[(first + 1 + random.below(bodies.size() - 1)) % bodies.size()];
    const Vector3d n = direction(random), x = direction(random), y = direction(random);
    ContactArms arms{n, x, y};
    if (along_normal) arms.a = 0.5 * n, arms.b = -0.7 * n;
    if (slip(a, b, arms).dot(n.cast<Long>()) > 0) {
      arms.normal *= -1;
      if (along_normal) arms.a *= -1, arms.b *= -1;
    }
    const Body was_a = a, was_b = b;
    if (strike(a, b, arms, surfaces).slides) {
      a = was_a, b = was_b;
      continue;
    }
    const Long error = energy(a) + energy(b) - energy(was_a) - energy(was_b);
    drift.energy += error / whole;
    drift.squares += error * error / (whole * whole);
    // Of central impulses in doubles too: see impulse.hpp.
    drift.worst = std::max(drift.worst, std::abs(error) / (rounding_of_energy(a) + rounding_of_energy(b)));
    const auto add = [&](const Body& now, const Body& then, const Vector3d& arm) {
      const Vector3l p = now.mass * (state(now.motion).v - state(then.motion).v);
      const Vector3l l = now.inertia * (state(now.motion).w - state(then.motion).w);
      return std::pair<Vector3l, Vector3l>(p, l + arm.cast<Long>().cross(p));
    };
    const auto of_a = add(a, was_a, arms.a), of_b = add(b, was_b, arms.b);
    const Vector3l p = of_a.first + of_b.first, l = of_a.second + of_b.second;
    drift.momentum += p, drift.momentum_squares += p.squaredNorm();
    drift.angular += l, drift.angular_squares += l.squaredNorm();
  }
  return drift;
}

TEST_CASE("Rounding of impulses with spin neither gains nor loses energy or momentum in the mean",
          "[turning impulse]") {
  Random random(36);
  for (const double ratio : {1.3, 3.0, 100.0}) {
    std::vector<Body> balls, others;
    for (int i = 0; i < 4; ++i) {
      const double mass = std::pow(ratio, i);
      balls.push_back(ball(1 / mass, 2.5 / mass));
      others.push_back(any_body(random, mass, 1));
    }
    struct Case {
      const std::vector<Body>& bodies;
      Surfaces surfaces;
      bool balls;
    };
    for (const Case& each : {Case{balls, {1, 0, 0}, true}, Case{balls, {1, 1e12, 1}, true},
                             Case{others, {1, 0, 0}, false}, Case{others, {1, 20, 1}, false}}) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        INFO("ratio " << ratio << ", seed " << seed << ", friction " << each.surfaces.friction);
        const Drift found = drift(each.bodies, each.surfaces, each.balls, 10'000, seed);
        // Errors that are not biased add up to their root of the sum of squares; five times that has a chance of 1e-6.
        CHECK(std::abs(found.energy) < 5 * std::sqrt(found.squares));
        CHECK(found.momentum.norm() < 5 * std::sqrt(found.momentum_squares));
        CHECK(found.angular.norm() < 5 * std::sqrt(found.angular_squares));
        // A ball whose arm is along the normal in doubles is struck centrally, with the 32 roundings of that.
        CHECK(found.worst < (each.balls && each.surfaces.friction == 0 ? 32 : 1.001));
      }
    }
  }
}

TEST_CASE("Impulses at the ends of the range of numbers", "[turning impulse]") {
  for (const double size : {0x1p-200, 1.0, 0x1p200}) {
    for (const double mass : {0x1p-200, 1.0, 0x1p200}) {
      for (const double speed : {0x1p-200, 1.0, 0x1p200}) {
        Random random(37);
        Body a = ball(1 / mass, 2.5), b = any_body(random, 1, 1);
        const auto scale = [&](Body& body) {
          body.mobility.inverse_mass = 1 / mass;
          body.mobility.inverse_moment = body.mobility.inverse_moment / mass / size / size;
          body.mobility.inverse_inertia = body.mobility.inverse_inertia / mass / size / size;
          body.motion = {speed * vector(random), speed / size * vector(random)};
        };
        scale(a), scale(b);
        ContactArms arms{direction(random), size * direction(random), size * direction(random)};
        if (slip(a, b, arms).dot(arms.normal.cast<Long>()) > 0) arms.normal *= -1;
        const Long before = slip(a, b, arms).dot(arms.normal.cast<Long>());
        const TurningImpulse impulse = strike(a, b, arms, {0.5, 0.4, 0.25});
        CHECK(impulse.impulse.allFinite());
        const Long after = slip(a, b, arms).dot(arms.normal.cast<Long>());
        CHECK(std::abs(after / before + 0.5L) < 16 * rounding);
      }
    }
  }
}

}  // namespace

}  // namespace test_turning_impulse
