// Contacts of meshes: the laws they obey, simple ones with known answers, and the same on the clock of a run.
#include "tests/collision/narrow_phase/mesh_distances.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace test_mesh_contact {
namespace {

using namespace kds::collision;
using namespace kds::collision::samples;

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("Bodies that hardly move against each other are decided at once") {
  const PlacedShape ring = placed(torus(30, 20));
  const PlacedShape ball = place(Sphere{0.5}, Eigen::Quaterniond::Identity());
  for (const PlacedShape& other : {ring, ball}) {
    for (const double speed : {0.0, 1e-300, 1e-17}) {
      for (const double bend : {0.0, 1e-17}) {
        // Speeds that are nothing but the rounding of the bodies' own.
        const MeshPair<2> pair(
            ring, other,
            {{Vector3d{1.1, 1.2, 1.3}, speed * Vector3d::UnitX(), bend * Vector3d::UnitY()}, {0, 1e-16, 1e-17}});
        const auto soon = pair.first_contact(0, 1e6, ContactMode::resolved);
        CHECK_FALSE(soon);
        CHECK_NOTHROW(pair.first_contact(0, infinity, ContactMode::resolved));
        CHECK(pair.first_free_time(0, infinity) == 0);
      }
    }
  }
}

// ---- Laws ----------------------------------------------------------------------------------------------------------

TEST_CASE("The answer does not depend on the window or on the order of the bodies") {
  const std::uint64_t seed = 200;
  INFO("seed " << seed);
  Random random(seed);
  int met = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const PlacedShape a = random_shape(random, static_cast<int>(random.below(3)));
    const PlacedShape b = random_shape(random, static_cast<int>(random.below(3)));
    const auto motion = encounter<2>(random, 3, 1);
    const MeshPair<2> pair(a, b, motion);
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    if (!found) continue;
    ++met;
    const auto same = [&](double tau0, double tau1) {
      const auto again = pair.first_contact(tau0, tau1, ContactMode::resolved);
      REQUIRE(again);
      REQUIRE(again->tau == found->tau);
      REQUIRE(again->triangle_a == found->triangle_a);
      REQUIRE(again->triangle_b == found->triangle_b);
    };
    same(0, found->tau);
    same(random.uniform(0, 1) * found->tau, 100);
    same(found->tau, found->tau);
    REQUIRE_FALSE(pair.first_contact(0, std::nextafter(found->tau, 0), ContactMode::resolved));

    RelativeMotion<2> reverse = motion;
    for (auto& c : reverse.coefficients) c = -c;
    const MeshPair<2> swapped(b, a, reverse);
    const auto mirrored = swapped.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(mirrored);
    REQUIRE(mirrored->tau == found->tau);
    if (mirrored->triangle_a != found->triangle_b || mirrored->triangle_b != found->triangle_a) continue;  // a tie
    const auto there = swapped.where(found->tau);
    const auto here = pair.where(found->tau);
    REQUIRE((there.normal + here.normal).norm() < 1e-9);
    REQUIRE(there.feature_a == here.feature_b);
    REQUIRE(there.feature_b == here.feature_a);
  }
  CHECK(met > 50);
}

TEST_CASE("A quadratic motion without acceleration is a linear motion") {
  Random random(201);
  for (int trial = 0; trial < 50; ++trial) {
    const PlacedShape a = random_shape(random, 0);
    const PlacedShape b = random_shape(random, static_cast<int>(random.below(5)));
    const auto linear = encounter<1>(random, 3, 1);
    RelativeMotion<2> quadratic{{linear.coefficients[0], linear.coefficients[1], Vector3d::Zero()}};
    const auto x = MeshPair<1>(a, b, linear).first_contact(0, infinity, ContactMode::resolved);
    const auto y = MeshPair<2>(a, b, quadratic).first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(x.has_value() == y.has_value());
    if (x) REQUIRE(x->tau == y->tau);
    // And nearly one with hardly any.
    quadratic.coefficients[2] = 1e-13 * random.direction();
    const auto z = MeshPair<2>(a, b, quadratic).first_contact(0, 10, ContactMode::resolved);
    if (x && z) REQUIRE(x->tau == Approx(z->tau).epsilon(1e-6));
  }
}

TEST_CASE("A solid box meets a mesh when the mesh of the box does") {
  Random random(202);
  int met = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const PlacedShape a = random_shape(random, static_cast<int>(random.below(3)));
    const Vector3d half{random.uniform(0.2, 1), random.uniform(0.2, 1), random.uniform(0.2, 1)};
    const auto orientation = random.orientation();
    const PlacedShape solid = place(Box{half}, orientation);
    const PlacedShape hollow = placed(cuboid(half), 1, orientation);
    const auto motion = encounter<2>(random, 4, 1);
    const auto x = MeshPair<2>(a, solid, motion).first_contact(0, 2, ContactMode::resolved);
    const auto y = MeshPair<2>(a, hollow, motion).first_contact(0, 2, ContactMode::resolved);
    REQUIRE(x.has_value() == y.has_value());
    if (!x) continue;
    ++met;
    REQUIRE(x->tau == Approx(y->tau).epsilon(1e-10));
  }
  CHECK(met > 50);
}

// ---- Known cases ---------------------------------------------------------------------------------------------------

TEST_CASE("Equal cubes that are aligned meet face to face") {
  for (const double speed : {1e-6, 1.0, 1e6}) {
    for (const double offset : {0.0, 0.5, 1.0}) {
      const PlacedShape cube = placed(cuboid());
      RelativeMotion<1> motion{{Vector3d{10, offset, 0}, Vector3d{-speed, 0, 0}}};
      const MeshPair<1> pair(cube, cube, motion);
      const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
      REQUIRE(found);
      CHECK(found->tau == Approx(8 / speed).epsilon(1e-13));
      CHECK(found->tau <= 8 / speed);
      const auto where = pair.where(found->tau);
      CHECK(where.normal[0] == Approx(1));
      CHECK(where.point[0] == Approx(1));
      CHECK(pair.first_free_time(found->tau, infinity) == Approx(12 / speed).epsilon(1e-12));
    }
  }
}

TEST_CASE("Features, points and normals of simple contacts") {
  const PlacedShape cube = placed(cuboid());
  const auto turned = [](double degrees, const Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()));
  };
  SECTION("vertex on face") {
    const PlacedShape tip = placed(needle(), 1, turned(180, Vector3d::UnitX()));
    const MeshPair<1> pair(cube, tip, {{Vector3d{0.3, 0.1, 5}, Vector3d{0, 0, -1}}});
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(found);
    CHECK(found->tau == Approx(4));
    const auto where = pair.where(found->tau);
    CHECK(to_string(where.feature_b) == "v0");
    CHECK(where.feature_a.kind == Feature::Kind::face);
    CHECK((where.point - Vector3d{0.3, 0.1, 1}).norm() < 1e-12);
    CHECK((where.normal - Vector3d::UnitZ()).norm() < 1e-12);
  }
  SECTION("edge on edge") {
    const PlacedShape diamond = placed(cuboid(), 1, turned(45, Vector3d::UnitX()));
    const PlacedShape other = placed(cuboid(), 1, turned(45, Vector3d::UnitY()));
    const MeshPair<1> pair(diamond, other, {{Vector3d{0.1, 0.2, 5}, Vector3d{0, 0, -1}}});
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(found);
    CHECK(found->tau == Approx(5 - 2 * std::sqrt(2)));
    const auto where = pair.where(found->tau);
    CHECK(where.feature_a.kind == Feature::Kind::edge);
    CHECK(where.feature_b.kind == Feature::Kind::edge);
    CHECK((where.point - Vector3d{0.1, 0, std::sqrt(2)}).norm() < 1e-12);
  }
  SECTION("ball on face, edge, vertex") {
    const PlacedShape ball = place(Sphere{0.5}, Eigen::Quaterniond::Identity());
    const auto meet = [&](const Vector3d& start, const Vector3d& velocity) {
      const MeshPair<1> pair(cube, ball, {{start, velocity}});
      const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
      REQUIRE(found);
      return std::pair(found->tau, pair.where(found->tau));
    };
    const auto [face_time, face] = meet({0.2, 0.3, 5}, {0, 0, -1});
    CHECK(face_time == Approx(3.5));
    CHECK(face.feature_a.kind == Feature::Kind::face);
    CHECK(face.feature_b.kind == Feature::Kind::none);
    CHECK((face.point - Vector3d{0.2, 0.3, 1}).norm() < 1e-12);
    const auto [edge_time, edge] = meet({1.3, 0.2, 5}, {0, 0, -1});
    CHECK(edge_time == Approx(5 - 1 - 0.4));
    CHECK(to_string(edge.feature_a) == "e5-7");
    CHECK((edge.normal - Vector3d{0.6, 0, 0.8}).norm() < 1e-9);
    const auto [vertex_time, vertex] = meet({1.3, 1, 5}, {0, 0, -1});
    CHECK(vertex_time == Approx(5 - 1 - 0.4));
    CHECK(to_string(vertex.feature_a) == "v7");
  }
  SECTION("box on mesh") {
    const PlacedShape box = place(Box{{1, 1, 1}}, Eigen::Quaterniond::Identity());
    const PlacedShape tip = placed(needle());
    const MeshPair<1> pair(tip, box, {{Vector3d{0.5, 0.5, 5}, Vector3d{0, 0, -1}}});
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(found);
    CHECK(found->tau == Approx(4));
    const auto where = pair.where(found->tau);
    CHECK(to_string(where.feature_a) == "v0");
    CHECK(to_string(where.feature_b) == "f4");
    CHECK(where.normal[2] == Approx(1));
  }
}

TEST_CASE("After an impulse bodies that part are not in contact, and meet again when they turn") {
  const PlacedShape cube = placed(cuboid());
  SECTION("straight away") {
    const MeshPair<1> pair(cube, cube, {{Vector3d{2, 0.3, 0.1}, Vector3d{1, 0, 0}}});
    CHECK_FALSE(pair.first_contact(0, infinity, ContactMode::resolved));
    CHECK(pair.first_contact(0, infinity, ContactMode::transparent)->tau == 0);
  }
  SECTION("towards each other from within the gap") {
    const MeshPair<1> pair(cube, cube, {{Vector3d{2, 0.3, 0.1}, Vector3d{-1, 0, 0}}});
    CHECK(pair.first_contact(0, infinity, ContactMode::resolved)->tau == 0);
  }
  SECTION("sliding along each other") {
    const MeshPair<1> pair(cube, cube, {{Vector3d{2, 0.3, 0.1}, Vector3d{0, 0.01, 0.02}}});
    const auto found = pair.first_contact(0, 1, ContactMode::resolved);
    CHECK_FALSE(found);
  }
  SECTION("at rest") {
    const MeshPair<1> pair(cube, cube, {{Vector3d{2, 0.3, 0.1}, Vector3d::Zero()}});
    CHECK_FALSE(pair.first_contact(0, infinity, ContactMode::resolved));
    CHECK(pair.first_contact(0, infinity, ContactMode::transparent)->tau == 0);
    CHECK(pair.first_free_time(0, infinity) == infinity);
  }
  SECTION("a throw that comes back") {
    const MeshPair<2> pair(cube, cube, {{Vector3d{0.1, 0.2, 2}, Vector3d{0, 0, 3}, Vector3d{0, 0, -5}}});
    CHECK(pair.first_contact(0, infinity, ContactMode::resolved)->tau == Approx(0.6));
  }
  SECTION("a throw that turns within the gap") {
    const MeshPair<2> pair(cube, cube, {{Vector3d{0.1, 0.2, 2}, Vector3d{0, 0, 1e-8}, Vector3d{0, 0, -5}}});
    CHECK(pair.first_contact(0, infinity, ContactMode::resolved)->tau == Approx(1e-9).epsilon(1e-6));
  }
  SECTION("the same for a ball") {
    const PlacedShape ball = place(Sphere{0.5}, Eigen::Quaterniond::Identity());
    const Vector3d down{0, 0, -5};
    CHECK_FALSE(MeshPair<1>(cube, ball, {{Vector3d{0.3, 0.2, 1.5}, Vector3d{0.1, 0, 1}}})
                    .first_contact(0, infinity, ContactMode::resolved));
    CHECK(MeshPair<2>(cube, ball, {{Vector3d{0.3, 0.2, 1.5}, Vector3d{0, 0, 3}, down}})
              .first_contact(0, infinity, ContactMode::resolved)
              ->tau == Approx(0.6));
    CHECK(MeshPair<2>(cube, ball, {{Vector3d{0.3, 0.2, 1.5}, Vector3d{0, 0, 1e-8}, down}})
              .first_contact(0, infinity, ContactMode::resolved)
              ->tau == Approx(1e-9).epsilon(1e-6));
    // Over an edge and over a vertex.
    for (const Vector3d& start : {Vector3d{1.3, 0.2, 1.4}, Vector3d{1.3, 1, 1.4}}) {
      CHECK(MeshPair<2>(cube, ball, {{start, Vector3d{0, 0, 1e-8}, down}})
                .first_contact(0, infinity, ContactMode::resolved)
                ->tau == Approx(1e-9).epsilon(1e-6));
    }
  }
  SECTION("a ball that touches an edge or a vertex, moves sideways and is pressed down") {
    const PlacedShape ball = place(Sphere{0.5}, Eigen::Quaterniond::Identity());
    const auto first = [&](const Vector3d& start, const Vector3d& velocity) {
      const auto touch =
          MeshPair<2>(cube, ball, {{start, velocity, Vector3d{0, 0, -5}}}).first_contact(0, 1, ContactMode::resolved);
      return touch ? touch->tau : infinity;
    };
    // Onto the face it is pressed at once, however fast; off the face it leaves if fast enough.
    CHECK(first({1, 0.2, 1.5}, {-7, 0, 0}) == 0);
    CHECK(first({1, 1, 1.5}, {-7, -7, 0}) == 0);
    CHECK(first({1, 1, 1.5}, {0, -7, 0}) == 0);
    CHECK(first({1, 0.2, 1.5}, {7, 0, 0}) == infinity);
    CHECK(first({1, 1, 1.5}, {7, 7, 0}) == infinity);
    CHECK(first({1, 0.2, 1.5}, {1, 0, 0}) == 0);
  }
}

TEST_CASE("A mesh touches with its surface: what is inside touches nothing") {
  const PlacedShape shell = placed(ball_mesh(2));
  for (const PlacedShape& inner : {placed(cuboid(), 0.1), place(Sphere{0.1}, Eigen::Quaterniond::Identity())}) {
    const MeshPair<1> pair(shell, inner, {{Vector3d::Zero(), Vector3d::UnitX()}});
    CHECK_FALSE(pair.touching(0));
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(found);
    CHECK(found->tau > 0.5);
  }
}

// ---- On the clock --------------------------------------------------------------------------------------------------

namespace {

using kds::certificates::PointMotion;

template <int Degree>
void on_the_clock(std::uint64_t seed, double epoch) {
  INFO("seed " << seed << ", epoch " << epoch << ", degree " << Degree);
  Random random(seed);
  int met = 0;
  for (int trial = 0; trial < 40; ++trial) {
    INFO("trial " << trial);
    const PlacedShape shape_a = random_shape(random, static_cast<int>(random.below(5)));
    const PlacedShape shape_b = random_shape(random, static_cast<int>(random.below(3)));
    const auto relative = encounter<Degree>(random, 3, 1);
    PointMotion<Degree> path_a, path_b;
    for (std::size_t i = 0; i <= Degree; ++i) {
      path_a.coefficients[i] = random.vector(1);
      path_b.coefficients[i] = path_a.coefficients[i] + relative.coefficients[i];
    }
    path_a.start = path_b.start = epoch;
    const TranslatingShape<Degree> a{shape_a, path_a};
    const TranslatingShape<Degree> b{shape_b, path_b};
    const double begin = first_contact(a, b, epoch, infinity, ContactMode::transparent);
    REQUIRE(begin == first_contact(b, a, epoch, infinity, ContactMode::transparent));
    if (begin == infinity) continue;
    ++met;
    REQUIRE(begin >= epoch);
    REQUIRE(in_contact(a, b, begin));
    if (begin > epoch) REQUIRE_FALSE(in_contact(a, b, std::nextafter(begin, -infinity)));
    REQUIRE(first_contact(a, b, epoch, begin, ContactMode::transparent) == begin);
    const Contact contact = contact_at(a, b, begin);
    const Contact reverse = contact_at(b, a, begin);
    REQUIRE(contact.normal.norm() == Approx(1));
    REQUIRE((contact.normal + reverse.normal).norm() < 1e-9);
    REQUIRE(contact.normal.dot(path_b.velocity(begin) - path_a.velocity(begin)) < 0);
    const double end = first_separation(a, b, begin, infinity);
    REQUIRE(end > begin);
    if (end == infinity) continue;
    REQUIRE_FALSE(in_contact(a, b, end));
    const Contact last = contact_at(a, b, end);
    REQUIRE(last.normal.norm() == Approx(1));
    // An elastic impulse: nothing more of this contact.
    const double t = begin;
    PointMotion<Degree> after_a = path_a.restarted(t);
    PointMotion<Degree> after_b = path_b.restarted(t);
    const double approach = contact.normal.dot(after_b.coefficients[1] - after_a.coefficients[1]);
    after_b.coefficients[1] -= 2 * approach * contact.normal;
    const TranslatingShape<Degree> next_a{shape_a, after_a};
    const TranslatingShape<Degree> next_b{shape_b, after_b};
    const double next = first_contact(next_a, next_b, t, infinity, ContactMode::resolved);
    REQUIRE((next == infinity || next > t));
  }
  CHECK(met > 10);
}

}  // namespace

TEST_CASE("Contact begins and ends on the clock, at any time of day") {
  for (const double epoch : {0.0, 1.0, 1e3, 1e6, 1e9}) {
    on_the_clock<1>(301, epoch);
    on_the_clock<2>(302, epoch);
  }
}

TEST_CASE("A contact near clock 0 of bodies that have begun long before") {
  // The time since the epoch is one and the same for some 2^44 clock values there.
  for (const double epoch : {-1.0, -1e3, -1e9}) {
    for (const double late : {0.0, 1e-300, 1e-20, -1e-20}) {
      INFO("epoch " << epoch << ", " << late);
      // Cubes that reach 1 and 0.5 to the side.
      const PointMotion<1> path_a{{Vector3d{1.5 - epoch + late, 0, 0}, Vector3d::Zero()}, epoch};
      const PointMotion<1> path_b{{Vector3d::Zero(), Vector3d::UnitX()}, epoch};
      const TranslatingShape<1> a{placed(cuboid()), path_a};
      const TranslatingShape<1> b{place(Box{{0.5, 0.5, 0.5}}, Eigen::Quaterniond::Identity()), path_b};
      const double begin = first_contact(a, b, epoch, infinity, ContactMode::transparent);
      CHECK(std::abs(begin) < 1e-13 * -epoch);
      CHECK(in_contact(a, b, begin));
      CHECK_FALSE(in_contact(a, b, std::nextafter(begin, -infinity)));
      const double end = first_separation(a, b, begin, infinity);
      CHECK(end == Approx(1).margin(1e-4));  // within: a mesh is a surface
      CHECK_FALSE(in_contact(a, b, end));
      CHECK(in_contact(a, b, std::nextafter(end, -infinity)));
    }
  }
}

}  // namespace test_mesh_contact
