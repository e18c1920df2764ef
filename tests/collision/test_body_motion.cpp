// What a world asks of a motion, of those that there are.
#include "collision/body_motion.hpp"

#include "certificates/turning/rigid_motion.hpp"
#include "collision/world.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <type_traits>

namespace kds::collision::test_body_motion {
namespace {

using certificates::PointMotion;
using certificates::RigidMotion;
using Eigen::Vector3d;

static_assert(BodyMotion<PointMotion<1>> && BodyMotion<PointMotion<2>> && BodyMotion<PointMotion<5>>);
static_assert(BodyMotion<RigidMotion<1>> && BodyMotion<RigidMotion<2>>);
static_assert(!BodyMotion<Vector3d>);
static_assert(!turns<PointMotion<2>> && turns<RigidMotion<2>>);

// A degree is deduced from all that is named by one.
template <int Degree>
constexpr int degree_of(const World<Degree>*, const WorldListener<Degree>*, const BodyDescription<Degree>*) {
  return Degree;
}
static_assert(degree_of(static_cast<World<2>*>(nullptr), static_cast<WorldListener<2>*>(nullptr),
                        static_cast<BodyDescription<2>*>(nullptr)) == 2);
static_assert(std::is_same_v<World<1>::Motion, PointMotion<1>>);
static_assert(std::is_same_v<BodyDescription<1>::Motion, PointMotion<1>>);

template <BodyMotion Motion>
void check_laws(Motion motion) {
  const double t = 2.5;
  CHECK(motion.finite());
  CHECK(path_of(motion).start == 1);
  CHECK(path_of(motion.restarted(t)) == path_of(motion).restarted(t));
  CHECK(path_of(motion.restarted(t)).start == t);
  CHECK(motion == Motion(motion));
  CHECK_FALSE(motion == motion.restarted(t));
}

TEST_CASE("body motions have a path that is restarted with them") {
  const PointMotion<2> path{{Vector3d(1, 2, 3), Vector3d(0.1, 0.7, -1), Vector3d(0, 0, -4.905)}, 1};
  check_laws(path);
  RigidMotion<2> turning{path};
  turning.angular_velocity = {0.3, 0, 1};
  check_laws(turning);
  turning.orientation.coeffs().setZero();
  CHECK_FALSE(turning.finite());
  CHECK(&path_of(path) == &path);
  CHECK(&path_of(turning) == &turning.path);
}

TEST_CASE("a motion as another type keeps the terms that both have") {
  RigidMotion<2> turning{{{Vector3d(1, 2, 3), Vector3d(0.1, 0.7, -1), Vector3d(0, 0, -4.905)}, 1}};
  turning.orientation = Eigen::Quaterniond(0.6, 0, 0.8, 0);
  turning.angular_velocity = {0.3, 0, 1};
  CHECK(motion_as<RigidMotion<2>>(turning) == turning);
  CHECK(motion_as<PointMotion<2>>(turning) == turning.path);

  const PointMotion<5> longer = motion_as<PointMotion<5>>(turning);
  for (std::size_t k = 0; k <= 5; ++k) {
    CHECK(longer.coefficients[k] == (k <= 2 ? turning.path.coefficients[k] : Vector3d(0, 0, 0)));
  }
  CHECK(longer.start == 1);
  CHECK(motion_as<PointMotion<2>>(longer) == turning.path);
  CHECK(motion_as<RigidMotion<2>>(longer) == RigidMotion<2>{turning.path});

  const PointMotion<1> line = motion_as<PointMotion<1>>(longer);
  CHECK(line.coefficients[0] == Vector3d(1, 2, 3));
  CHECK(line.coefficients[1] == Vector3d(0.1, 0.7, -1));
}

}  // namespace
}  // namespace kds::collision::test_body_motion
