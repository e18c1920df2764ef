// Bodies on cubics, quartics and quintics, in domains: the events are those of one world, bit for bit.
#include "collision/parallel/division.hpp"
#include "tests/collision/parallel/contact_laws.hpp"
#include "tests/collision/parallel/piles.hpp"
#include "tests/collision/parallel/stagings.hpp"
#include "tests/collision/parallel/tables.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kds::collision::test_spline_domains {
namespace {

using Eigen::Vector3d;
using tests::compare_runs;
using tests::Manner;
using tests::Random;
using tests::Seen;
using Path = certificates::PointMotion<5>;

/// A circle about the origin, as a stream of quintics.
struct Orbit {
  Vector3d x, y;
  double rate;

  Path piece(double from, double to) const {
    const auto at = [this](double t, double of_x, double of_y) -> Vector3d {
      return x * (of_x * std::cos(rate * t) + of_y * std::sin(rate * t)) +
             y * (of_x * std::sin(rate * t) - of_y * std::cos(rate * t));
    };
    const double r = rate;
    return Path::quintic(at(from, 1, 0), at(from, 0, -r), at(from, -r * r, 0), at(to, 1, 0), at(to, 0, -r),
                         at(to, -r * r, 0), from, to);
  }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("Domains: how far a path leaves the chord between two of its places", "[parallel]",
                       ((int Degree), Degree), 2, 3, 5) {
  Random random(3);
  double nearest = 0;  // to the bound
  for (int i = 0; i < 500; ++i) {
    const auto vector = [&] {
      const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-1, 1);
      return Vector3d(x, y, z);
    };
    certificates::PointMotion<Degree> path{{}, random.between(-1, 1)};
    for (auto& c : path.coefficients) c = vector();
    const double from = random.between(-1, 2), to = from + random.between(0, 2), bulge = bulge_of(path, from, to);
    const double begin = std::max(from, path.start), end = std::max(to, path.start);
    for (int k = 1; k < 16; ++k) {
      const double part = k / 16.0;
      const Vector3d chord = (1 - part) * path.position(begin) + part * path.position(end);
      const double off = (path.position(begin + part * (end - begin)) - chord).cwiseAbs().maxCoeff();
      REQUIRE(off <= bulge + 1e-12);
      if (bulge > 0) nearest = std::max(nearest, off / bulge);
    }
  }
  CHECK(nearest > 0.9);
  certificates::PointMotion<Degree> line{};
  line.coefficients[1] = Vector3d(1, 2, 3);
  CHECK(bulge_of(line, 0, 10) == 0);
}

TEMPLATE_TEST_CASE_SIG("Domains of bodies on cubics to quintics have the events of one world", "[parallel]",
                       ((int Degree), Degree), 3, 4, 5) {
  Seen seen;
  tests::compare_stagings<certificates::PointMotion<Degree>>({{1, 16, 8}, {1001, 2, 100}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 1200);
  CHECK(seen.divided > 6);
  CHECK(seen.windows > 25);
  CHECK(seen.corrected > 4);
}

TEMPLATE_TEST_CASE_SIG("Domains of bodies on cubics and quintics that respond by a law", "[parallel]",
                       ((int Degree), Degree), 3, 5) {
  Seen seen;
  tests::compare_laws<certificates::PointMotion<Degree>>({{1, 12, 8}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 500);
  CHECK(seen.divided > 4);
  CHECK(seen.corrected > 5);
}

TEST_CASE("Domains: bodies on cubics that come to rest on floors have the events of one world", "[parallel]") {
  Seen seen;
  tests::compare_tables<3>({{1, 20, 8}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 3000);
  CHECK(seen.divided > 8);
  CHECK(seen.rests > 300);
  CHECK(seen.tables > 3);
}

TEST_CASE("Domains: bodies on cubics that lean on each other have the events of one world", "[parallel]") {
  Seen seen;
  // In the last one body reaches a wall for that another has, at the same instant.
  tests::compare_piles<3>({{1, 8, 6}, {528, 1, 8}}, seen);
  INFO(seen.text());
  CHECK(seen.windows > 5);
  CHECK(seen.rests > 50);
}

TEST_CASE("Domains: balls on cubics slide off a floor beyond the time for which events were predicted", "[parallel]") {
  const auto fill = [](World<3>& world) {
    world.add_body(tests::fixed_body<3>(Box{{3, 30, 1}}, tests::motion<3>({0, 0, -1})));
    for (int i = 0; i < 24; ++i) {
      auto ball =
          tests::ball<3>(0.5, {i % 2 - 0.5, 2.0 * i - 24, 0.5}, {(i % 2 - 0.5) * (2 + 0.25 * i), 0, 0}, {0, 0, -5});
      ball.motion[0].coefficients[3] = Vector3d(0, 0, 0.25);  // Nothing presses it on the floor after 3.3 s.
      world.add_body(ball);
    }
  };
  WorldOptions options = tests::with_response(Response::elastic);
  options.window = 0.5;
  Seen seen;
  Manner manner{.parallel = {}, .polls = 3};
  manner.parallel.threads = 2, manner.parallel.domains = 2, manner.parallel.halo = 1;
  compare_runs<certificates::PointMotion<3>>({options, fill, 2, "sliding off"}, manner, seen);
  CHECK(seen.divided == 1);
  CHECK(seen.rests > 24);
}

TEST_CASE("Domains: satellites on streams of quintics pass each other", "[parallel]") {
  const auto fill = [](World<5>& world) {
    Random random(8);
    for (int i = 0; i < 150; ++i) {
      const auto draw = [&] { return random.between(-1, 1); };
      const double a = draw(), b = draw(), c = draw(), u = draw(), v = draw(), w = draw();
      const double radius = random.between(4, 5);
      Orbit orbit;
      orbit.x = radius * Vector3d(a, b, c).normalized();
      orbit.y = orbit.x.cross(Vector3d(u, v, w)).normalized() * radius;
      orbit.rate = 6 / radius;
      BodyDescription<5> satellite{.shape = Sphere{0.15}};
      satellite.motion.clear();
      double start = 0;
      while (start < 3) {
        const double end = start + random.between(0.2, 0.5);
        satellite.motion.push_back(orbit.piece(start, end));
        start = end;
      }
      world.add_body(satellite);
    }
  };
  Seen seen;
  for (const std::size_t domains : {2u, 8u}) {
    for (const std::size_t processes : {1u, 3u}) {
      Manner manner{.processes = processes, .polls = 3};
      manner.parallel.threads = 2, manner.parallel.domains = domains, manner.parallel.halo = 1;
      compare_runs<Path>({tests::with_response(Response::none), fill, 3, "satellites"}, manner, seen);
    }
  }
  INFO(seen.text());
  CHECK(seen.divided == 4);
  CHECK(seen.whole == 0);
  CHECK(seen.windows > 40);
  CHECK(seen.copies > 200);
  CHECK(seen.events > 1000);
}

}  // namespace kds::collision::test_spline_domains
