#include "examples/jobs/free_trajectory/proof.hpp"

#include "collision/queries/nearest.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/world.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace free_trajectory {
namespace {

using namespace kds::collision;
using Eigen::Vector3d;
using Path = kds::certificates::PointMotion<3>;

/// A cubic to each way point but the first; the drone stays at the last.
std::vector<Path> pieces(const Drone& drone) {
  std::vector<Path> pieces;
  for (std::size_t i = 0; i + 1 < drone.way.size(); ++i) {
    const WayPoint &from = drone.way[i], &to = drone.way[i + 1];
    pieces.push_back(Path::cubic(from.place, from.velocity, to.place, to.velocity, from.time, to.time));
  }
  pieces.push_back(Path::line(drone.way.back().place, Vector3d::Zero(), drone.way.back().time));
  return pieces;
}

Path piece_at(const Drone& drone, double t) {
  const std::vector<Path> all = pieces(drone);
  auto piece = all.begin();
  while (std::next(piece) != all.end() && std::next(piece)->start <= t) ++piece;
  return *piece;
}

Shape shape_of(const Obstacle& obstacle) {
  return MeshShape{std::make_shared<const Mesh>(obstacle.vertices, obstacle.triangles), 1};
}

/// Bodies are numbered as they are added: obstacles first.
std::string name(const Scene& scene, std::size_t body) {
  const std::size_t obstacles = scene.obstacles.size();
  return body < obstacles ? scene.obstacles[body].name : "drone " + std::to_string(body - obstacles);
}

struct FirstMeeting : WorldListener<3> {
  void contact(World<3>&, const PairEvent& event) override {
    if (!found) found = event;
  }
  void overlap(World<3>& world, const PairEvent& event) override { contact(world, event); }
  std::optional<PairEvent> found;
};

constexpr std::uint32_t drones = 1, obstacles = 2;  // categories

void add_obstacles(World<3>& world, const Scene& scene) {
  for (const Obstacle& obstacle : scene.obstacles) {
    world.add_body({.shape = shape_of(obstacle),
                    .motion = {Path::line(Vector3d::Zero(), Vector3d::Zero())},
                    .fixed = true,
                    .category = obstacles,
                    .collides_with = drones});
  }
}

}  // namespace

Vector3d place(const Drone& drone, double t) { return piece_at(drone, t).position(t); }
Vector3d velocity(const Drone& drone, double t) { return piece_at(drone, t).velocity(t); }

std::optional<Meeting> first_meeting(const Scene& scene, double margin) {
  FirstMeeting meeting;
  World<3> world({.response = Response::none}, &meeting);
  add_obstacles(world, scene);
  for (const Drone& drone : scene.drones) {
    world.add_body({.shape = Sphere{drone.radius + margin}, .motion = pieces(drone), .category = drones});
  }
  while (!meeting.found && world.step(scene.end)) {
  }
  if (!meeting.found) return std::nullopt;
  const PairEvent& event = *meeting.found;
  return Meeting{event.contact.time, name(scene, event.a), name(scene, event.b), event.contact.point};
}

std::optional<Clearance> least_clearance(const Scene& scene, double most, double resolution) {
  if (!(most > 0 && resolution > 0)) throw std::invalid_argument("least_clearance: most and resolution must be > 0");
  if (const auto meeting = first_meeting(scene)) {
    throw std::invalid_argument("least_clearance: not free, " + meeting->first + " and " + meeting->second +
                                " meet at " + kds::number_text(meeting->time) + " s");
  }
  auto nearest = first_meeting(scene, most);
  if (!nearest) return std::nullopt;
  Clearance clearance{0, most, *nearest};
  while (clearance.not_free - clearance.free > resolution) {
    const double margin = (clearance.free + clearance.not_free) / 2;
    if (const auto meeting = first_meeting(scene, margin)) {
      clearance.not_free = margin;
      clearance.nearest = *meeting;
    } else {
      clearance.free = margin;
    }
  }
  return clearance;
}

std::optional<Meeting> first_sample_in_contact(const Scene& scene, double rate, double phase) {
  World<3> world({.response = Response::none});
  add_obstacles(world, scene);
  world.advance_to(0);
  std::vector<std::vector<Path>> ways;
  for (const Drone& drone : scene.drones) ways.push_back(pieces(drone));
  std::vector<Vector3d> places(ways.size());
  for (int k = 0; (k + phase) / rate <= scene.end; ++k) {
    const double t = (k + phase) / rate;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const auto later =
          std::find_if(std::next(ways[i].begin()), ways[i].end(), [t](const Path& p) { return p.start > t; });
      places[i] = std::prev(later)->position(t);
      const std::string drone = "drone " + std::to_string(i);
      const auto nearest_body = nearest(world, places[i], 1);
      if (!nearest_body.empty() && nearest_body[0].distance < scene.drones[i].radius) {
        return Meeting{t, name(scene, nearest_body[0].body), drone, nearest_body[0].point};
      }
      for (std::size_t j = 0; j < i; ++j) {
        if ((places[i] - places[j]).norm() >= scene.drones[i].radius + scene.drones[j].radius) continue;
        return Meeting{t, "drone " + std::to_string(j), drone, (places[i] + places[j]) / 2};
      }
    }
  }
  return std::nullopt;
}

std::vector<double> gaps(const Scene& scene, std::size_t drone, std::span<const double> times) {
  World<3> world({.response = Response::none});
  add_obstacles(world, scene);
  world.advance_to(0);
  std::vector<double> gaps;
  for (const double t : times) {
    const auto found = nearest(world, place(scene.drones.at(drone), t), 1);
    gaps.push_back(found.empty() ? kds::never : found[0].distance - scene.drones[drone].radius);
  }
  return gaps;
}

}  // namespace free_trajectory
