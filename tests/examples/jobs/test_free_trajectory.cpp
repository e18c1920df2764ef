// The proof against dense sampling of distances that shares no code with it.
#include "examples/jobs/free_trajectory/proof.hpp"
#include "examples/jobs/free_trajectory/scene.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>

namespace test_free_trajectory {

using namespace free_trajectory;
using Eigen::Vector3d;

/// Hermite's cubic by its four basis functions.
Vector3d at(const Drone& drone, double t) {
  std::size_t i = 0;
  while (i + 2 < drone.way.size() && drone.way[i + 1].time <= t) ++i;
  const WayPoint &p = drone.way[i], &q = drone.way[i + 1];
  const double length = q.time - p.time, s = (t - p.time) / length;
  return (1 + 2 * s) * (1 - s) * (1 - s) * p.place + s * (1 - s) * (1 - s) * length * p.velocity +
         s * s * (3 - 2 * s) * q.place + s * s * (s - 1) * length * q.velocity;
}

double to_segment(const Vector3d& x, const Vector3d& a, const Vector3d& b) {
  const double s = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - s * (b - a)).norm();
}

/// To the plane if the point is above the triangle, else to an edge.
double to_triangle(const Vector3d& x, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a).normalized();
  const auto inside = [&](const Vector3d& p, const Vector3d& q) { return normal.cross(q - p).dot(x - p) >= 0; };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(normal.dot(x - a));
  return std::min({to_segment(x, a, b), to_segment(x, b, c), to_segment(x, c, a)});
}

struct Gap {
  double margin = std::numeric_limits<double>::infinity();  ///< by which drones may grow
  std::size_t drone = 0;
  double time = 0;
};

/// The least margin of any drone at a time.
Gap gap(const Scene& scene, double t) {
  Gap least;
  const auto consider = [&](double margin, std::size_t drone) {
    if (margin < least.margin) least = {margin, drone, t};
  };
  for (std::size_t i = 0; i < scene.drones.size(); ++i) {
    const Vector3d x = at(scene.drones[i], t);
    for (const Obstacle& obstacle : scene.obstacles) {
      for (const auto& [a, b, c] : obstacle.triangles) {
        // Far triangles need no exact distance.
        if (to_segment(x, obstacle.vertices[a], obstacle.vertices[b]) > 15) continue;
        consider(
            to_triangle(x, obstacle.vertices[a], obstacle.vertices[b], obstacle.vertices[c]) - scene.drones[i].radius,
            i);
      }
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double apart = (x - at(scene.drones[j], t)).norm();
      consider((apart - scene.drones[i].radius - scene.drones[j].radius) / 2, i);
    }
  }
  return least;
}

Gap least_gap(const Scene& scene, double from, double to, double step) {
  Gap least;
  for (double t = from; t <= to; t += step) {
    const Gap here = gap(scene, t);
    if (here.margin < least.margin) least = here;
  }
  return least;
}

TEST_CASE("a free trajectory: the least clearance is that of dense sampling") {
  const auto seed = GENERATE(1u, 2u, 5u);
  CAPTURE(seed);
  const Scene scene = swarm_at_mast(3, seed);
  REQUIRE_FALSE(first_meeting(scene));
  const auto clearance = least_clearance(scene, 10, 1e-4);
  REQUIRE(clearance);
  CHECK(clearance->free < clearance->not_free);
  CHECK(clearance->not_free - clearance->free <= 1e-4);
  // Samples at 100 Hz, and where they are least, at 100 kHz: at 30 m/s those are off by 0.2 mm at most.
  const Gap rough = least_gap(scene, 0, scene.end, 0.01);
  const Gap fine = least_gap(scene, rough.time - 0.01, rough.time + 0.01, 1e-5);
  CHECK(clearance->free <= fine.margin + 1e-9);  // no sample is nearer than what is proved free
  CHECK(clearance->not_free > fine.margin - 1e-3);
  CHECK(clearance->nearest.time == Approx(fine.time).margin(0.02));
  CHECK((clearance->nearest.first == "drone " + std::to_string(fine.drone) ||
         clearance->nearest.second == "drone " + std::to_string(fine.drone)));
}

TEST_CASE("a free trajectory: a contact that samples miss") {
  Scene scene = swarm_at_mast(3, 1);
  add_cable(scene, 0, 12.405);
  const auto meeting = first_meeting(scene);
  REQUIRE(meeting);
  CHECK(meeting->first == "the cable");
  CHECK(meeting->second == "drone 0");
  CHECK(std::abs(meeting->time - 12.405) < 0.005);
  // They touch there: the drone is its radius away, and a millionth of a second later nearer.
  CHECK(std::abs(gap(scene, meeting->time).margin) < 1e-9);
  CHECK(gap(scene, meeting->time - 1e-6).margin > 0);
  CHECK(gap(scene, meeting->time + 1e-6).margin < 0);
  CHECK_FALSE(first_sample_in_contact(scene, 100));
  // Half a period later they see it, after the contact.
  const auto seen = first_sample_in_contact(scene, 100, 0.5);
  REQUIRE(seen);
  CHECK(seen->time >= meeting->time);
  CHECK(seen->time < meeting->time + 0.01);
  CHECK_THROWS_AS(least_clearance(scene, 1, 0.001), std::invalid_argument);
}

TEST_CASE("a free trajectory: drones meet each other, and start in contact") {
  Scene scene;
  scene.end = 2;
  const auto straight = [](const Vector3d& from, const Vector3d& way) {
    return Drone{0.25, {{0, from, way / 2}, {2, from + way, way / 2}}};
  };
  scene.drones = {straight({0, 0, 0}, {4, 0, 0}), straight({4, 0, 0}, {-4, 0, 0})};
  const auto meeting = first_meeting(scene);
  REQUIRE(meeting);
  CHECK(meeting->time == Approx(0.875).epsilon(1e-12));  // 3.5 m at 4 m/s
  CHECK((meeting->first == "drone 0" && meeting->second == "drone 1"));
  scene.drones[1] = straight({0.5 - 0.01, 0, 0}, {4, 0, 0});
  REQUIRE(first_meeting(scene));
  CHECK(first_meeting(scene)->time == 0);
  scene.drones[1] = straight({0, 3, 0}, {4, 0, 0});
  CHECK_FALSE(first_meeting(scene));
  const auto clearance = least_clearance(scene, 10, 1e-6);
  REQUIRE(clearance);
  CHECK(clearance->free == Approx(1.25).margin(1e-6));
  CHECK_FALSE(least_clearance(scene, 1, 1e-6));
  CHECK_THROWS_AS(first_meeting(scene, -0.25), std::invalid_argument);
}

}  // namespace test_free_trajectory
