// Curves where things are degenerate: double roots, stops, ties, numbers at the ends of the range.
#include "collision/broad_phase/swept_box.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/exact_rational.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

namespace kds::collision::test_degeneracies {
namespace {

using namespace tests;

template <int Degree>
using Path = certificates::PointMotion<Degree>;

/// Events of all methods, which must agree; the world is audited after each.
template <int Degree>
std::vector<Event> events_of(const Scene<Degree>& scene, Response response = Response::none) {
  WorldOptions options = with_response(response);
  const auto expected = run(scene, options, {.audit = true});
  for (const BroadPhaseKind kind : all_methods) {
    options.broad_phase = kind;
    options.rate = 30;
    INFO("method " << static_cast<int>(kind));
    REQUIRE(run(scene, options) == expected);
  }
  return expected;
}

template <int Degree>
Scene<Degree> against_rest(const Shape& at_rest, const Shape& moving, const Path<Degree>& path, double end_time) {
  return {{body<Degree>(at_rest, Path<Degree>{{zero}}), body<Degree>(moving, path)}, end_time};
}

const Shape& mesh_cube() {
  static const Shape shape = MeshShape{cube(), 1};
  return shape;
}

TEST_CASE("Curves: a cubic that only touches at its double root is no contact", "[splines][degeneracies]") {
  // x - 2 = (t - 1)^2 (t + 1), the distance of two unit bodies along x.
  const Path<3> touching{{{3, 0, 0}, {-1, 0, 0}, {-1, 0, 0}, {1, 0, 0}}};
  Path<3> crossing = touching;
  crossing.coefficients[0][0] -= 0x1p-40;
  for (const Shape& moving : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}})}) {
    for (const Shape& at_rest : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}})}) {
      CHECK(events_of(against_rest<3>(at_rest, moving, touching, 3)).empty());
      const auto events = events_of(against_rest<3>(at_rest, moving, crossing, 3));
      REQUIRE(events.size() == 2);
      CHECK(events[0].time() == Approx(1 - 0x1p-20 / std::sqrt(2.0)).epsilon(1e-9));
      CHECK(events[1].time() == Approx(1 + 0x1p-20 / std::sqrt(2.0)).epsilon(1e-9));
      CHECK(events_of(against_rest<3>(at_rest, moving, touching, 3), Response::elastic).empty());
      CHECK(events_of(against_rest<3>(at_rest, moving, crossing, 3), Response::elastic).size() == 1);
    }
  }
  // A mesh's contact gap is more than that touch: it may be reported, but never missed.
  Path<3> deeper = touching;
  deeper.coefficients[0][0] -= 0x1p-30;
  CHECK(events_of(against_rest<3>(mesh_cube(), Sphere{1}, deeper, 3)).size() == 2);
}

TEST_CASE("Curves: a triple root is one contact", "[splines][degeneracies]") {
  // x - 2 = (1 - t)^3: it comes to a stop at the touch, and goes on.
  const Path<3> path{{{3, 0, 0}, {-3, 0, 0}, {3, 0, 0}, {-1, 0, 0}}};
  for (const Shape& moving : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}})}) {
    for (const Response response : {Response::none, Response::elastic}) {
      const auto events = events_of(against_rest<3>(Box{{1, 1, 1}}, moving, path, 2), response);
      REQUIRE(!events.empty());
      CHECK(events[0].kind == Kind::contact);
      CHECK(events[0].time() == 1);
    }
  }
  const auto events = events_of(against_rest<3>(mesh_cube(), Box{{1, 1, 1}}, path, 2));
  REQUIRE(events.size() == 1);
  CHECK(events[0].time() <= 1);
  CHECK(events[0].time() == Approx(1).epsilon(1e-4));  // a gap of 1e-14 is as wide as that of a cubic root
}

TEST_CASE("Curves: a quintic that stops at a body is no contact, and one that stops within is", "[splines]") {
  const Vector3d far(6, 0, 0);
  const auto stop_at = [&](double x) {
    return std::vector<Path<5>>{Path<5>::quintic(far, zero, zero, {x, 0, 0}, zero, zero, 0, 2),
                                Path<5>{{{x, 0, 0}}, 2}};
  };
  Scene<5> scene = against_rest<5>(Sphere{1}, Sphere{1}, {}, 4);
  scene.bodies[1].motion = stop_at(2);
  for (const Event& e : events_of(scene)) {  // by rounding, at the very end, it may
    CHECK(e.time() == Approx(2).epsilon(1e-4));
  }
  scene.bodies[1].motion = stop_at(2.5);
  CHECK(events_of(scene).empty());
  scene.bodies[1].motion = stop_at(1.5);
  CHECK(events_of(scene).size() == 1);
}

TEST_CASE("Curves: what stops at the start and leaves by its jerk alone begins without a contact", "[splines]") {
  // In touch at the start, with neither speed nor acceleration.
  for (const double jerk : {1.0, -1.0}) {
    const Path<3> path{{{2, 0, 0}, zero, zero, {jerk, 0, 0}}};
    for (const Shape& moving : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}})}) {
      const auto events = events_of(against_rest<3>(Box{{1, 1, 1}}, moving, path, 1));
      CHECK(events.size() == (jerk < 0 ? 1u : 0u));
      if (jerk < 0) CHECK(events[0].time() == 0);
      const auto bounces = events_of(against_rest<3>(Box{{1, 1, 1}}, moving, path, 1), Response::elastic);
      CHECK(bounces.empty() == (jerk > 0));
    }
    const auto meets = events_of(against_rest<3>(mesh_cube(), Box{{1, 1, 1}}, path, 1), Response::callback);
    CHECK(meets.empty() == (jerk > 0));
  }
}

TEST_CASE("Curves: last coefficients that are subnormal change nothing that can be seen", "[splines]") {
  const double tiny = std::numeric_limits<double>::denorm_min();
  const Path<2> parabola{{{4, 0.25, 0}, {-3, 0, 0}, {0.5, 0, 0}}};
  for (const Shape& moving : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}}), mesh_cube()}) {
    const auto expected = run(against_rest<2>(Box{{1, 1, 1}}, moving, parabola, 4), {});
    REQUIRE(!expected.empty());
    Path<5> path{{{4, 0.25, 0}, {-3, 0, 0}, {0.5, 0, 0}}};
    path.coefficients[5] = path.coefficients[4] = path.coefficients[3] = {tiny, -tiny, tiny};
    const auto found = events_of(against_rest<5>(Box{{1, 1, 1}}, moving, path, 4));
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      CHECK(found[i].kind == expected[i].kind);
      CHECK(found[i].time() == Approx(expected[i].time()).epsilon(1e-12));
    }
  }
}

TEST_CASE("Curves: huge last coefficients", "[splines]") {
  // 2^150 t^5 - ...: through the other body within 2^-29 s.
  const double huge = 0x1p150;
  for (const Shape& moving : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}}), mesh_cube()}) {
    const Path<5> path{{{4, 0, 0}, zero, zero, zero, zero, Vector3d(-huge, 0, 0)}};
    const auto events = events_of(against_rest<5>(Box{{1, 1, 1}}, moving, path, 1));
    REQUIRE(events.size() == 2);
    CHECK(events[0].time() == Approx(std::pow(2 / huge, 0.2)).epsilon(1e-9));
    CHECK(events[1].time() == Approx(std::pow(6 / huge, 0.2)).epsilon(1e-9));
  }
  World<5> world(WorldOptions{});
  auto beyond = ball<5>(1, zero);
  beyond.motion[0].coefficients[5] = {0x1p300, 0, 0};
  CHECK_THROWS_AS(world.add_body(beyond), std::invalid_argument);
  beyond.motion[0].coefficients[5] = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  CHECK_THROWS_AS(world.add_body(beyond), std::invalid_argument);
}

TEST_CASE("Curves: bodies that share their curve meet as straight ones do", "[splines]") {
  const Vector3d swing(0.5, 1, -2);
  Scene<5> scene;
  scene.end_time = 4;
  for (const double start : {0.0, -1.0}) {
    scene.bodies.clear();
    for (const double x : {0.0, 4.0}) {
      Path<5> path{{{x, 0, 0}, {-0.5 * x, 0, 0}, swing, swing, swing, swing}, start};
      scene.bodies.push_back(body<5>(Sphere{1}, path));
    }
    const auto events = events_of(scene);
    REQUIRE(events.size() == 2);
    CHECK(events[0].time() == start + 1);
    CHECK(events[1].time() == start + 3);
  }
}

TEST_CASE("Curves: a body that comes back late is met", "[splines]") {
  // Out to some hundreds of lengths and back, at t = 16 and t = 32: x = (t - 16) (t - 32) (t + 1) / 32 + ...
  const Path<3> path{{{16, 0, 0}, {14.5, 0, 0}, {-1.46875, 0, 0}, {0.03125, 0, 0}}};
  for (const Shape& moving : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}}), mesh_cube()}) {
    const auto events = events_of(against_rest<3>(Box{{1, 1, 1}}, moving, path, 40));
    REQUIRE(events.size() == 4);
    CHECK(events[0].time() < 16);
    CHECK(events[1].time() > 16);
    CHECK(events[2].time() < 32);
    CHECK(events[3].time() > 32);
  }
}

oracle::Rational place(const Motion<5>& x, const oracle::Rational& t) {
  const auto elapsed = t - oracle::rational(x.start);
  oracle::Rational sum = oracle::rational(x.position.c[5]);
  for (std::size_t i = 5; i-- > 0;) sum = sum * elapsed + oracle::rational(x.position.c[i]);
  return sum;
}

TEST_CASE("Curves: boxes at rest hold what a point sweeps, exactly", "[splines]") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    Path<5> path;
    for (auto& c : path.coefficients) {
      for (int d = 0; d < 3; ++d) c[d] = random.one_in(5) ? 0.0 : random.scaled(-20, 20);
    }
    path.start = random.scaled(-10, 10);
    const double from = path.start + std::abs(random.scaled(-20, 6));
    const double to = from + (random.one_in(8) ? 0.0 : std::abs(random.scaled(-20, 6)));
    const StaticBox box = swept_point(path, from, to);
    for (int i = 0; i <= 8; ++i) {
      const auto t = oracle::rational(from) + (oracle::rational(to) - oracle::rational(from)) *
                                                  oracle::Rational(oracle::Integer(i), oracle::Integer(8));
      for (int d = 0; d < 3; ++d) {
        const auto x = place(path.axis(d), t);
        REQUIRE(oracle::rational(box.min[d]) <= x);
        REQUIRE(oracle::rational(box.max[d]) >= x);
      }
    }
  }
}

}  // namespace
}  // namespace kds::collision::test_degeneracies
