// What queries of a world cost: rays, and what a ball will meet.
//
//     bench_queries [DIRECTORY]      -> queries.csv, distances.csv; 10 s
//
// Balls of radius 0.3 fill a cube, one in a cube of the side 2 (1.4 %); rays go between two points at random in it, so
// most meet something. Beside it: a ray against every ball one by one, in doubles, as the simplest program does it.
// Then one mesh of so many triangles in the middle, at which all rays aim. Last the distances of two shapes of a kind,
// turned at random, whose bounding balls are a hundredth of a radius or a radius apart.

#include "collision/narrow_phase/shape_distance.hpp"
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/nearest.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace {

using namespace kds::collision;
using Eigen::Vector3d;
using kds::benchmarks::tell;
using kds::benchmarks::thread_seconds;
using samples::Random;

constexpr double radius = 0.3;

/// The first ball that a ray meets, as a part of its way; 2 for none.
double brute_force(const std::vector<Vector3d>& centres, const Ray& ray) {
  const Vector3d way = ray.to - ray.from;
  const double a = way.squaredNorm();
  double first = 2;
  for (const Vector3d& centre : centres) {
    const Vector3d apart = ray.from - centre;
    const double b = apart.dot(way);
    const double c = apart.squaredNorm() - radius * radius;
    const double d = b * b - a * c;
    if (d < 0) continue;
    const double t = c < 0 ? 0 : (-b - std::sqrt(d)) / a;
    if (t >= 0 && t <= 1 && t < first) first = t;
  }
  return first;
}

template <class Ask>
double microseconds_each(int times, const Ask& ask) {
  const double begin = thread_seconds();
  for (int i = 0; i < times; ++i) ask();
  return (thread_seconds() - begin) / times * 1e6;
}

void balls(std::ofstream& csv, int bodies) {
  Random random(11);
  const double half = std::cbrt(bodies);
  World<1> world(WorldOptions{});
  std::vector<Vector3d> centres;
  for (int i = 0; i < bodies; ++i) {
    centres.push_back(random.vector(half));
    BodyDescription<1> ball;
    ball.shape = Sphere{radius};
    ball.motion = {kds::certificates::PointMotion<1>{{centres.back(), Vector3d::Zero()}}};
    world.add_body(ball);
  }
  world.advance_to(0.01);
  const int rays = 2000;
  std::vector<Ray> ways;
  for (int i = 0; i < rays; ++i) ways.push_back({random.vector(half), random.vector(half)});
  std::size_t next = 0;
  int met = 0;
  double sum = 0;
  const double first = microseconds_each(rays, [&] {
    const auto hit = cast(world, ways[next++]);
    if (hit) ++met, sum += hit->contact.time;
  });
  next = 0;
  double sum_by_force = 0;
  const double by_force = microseconds_each(rays, [&] {
    const double t = brute_force(centres, ways[next++]);
    if (t < 2) sum_by_force += t;
  });
  next = 0;
  const double all = microseconds_each(rays / 10, [&] { cast_all(world, ways[next++]); });
  const PlacedShape bullet = place(Sphere{0.05}, Eigen::Quaterniond::Identity());
  next = 0;
  const double future = microseconds_each(rays, [&] {
    const Ray& way = ways[next++];
    next_contact(world, bullet,
                 kds::certificates::PointMotion<1>{{way.from, (way.to - way.from).normalized()}, world.now()},
                 world.now() + 4);
  });
  next = 0;
  const double near = microseconds_each(rays, [&] { nearest(world, ways[next++].from, 1); });
  next = 0;
  const double eight = microseconds_each(rays, [&] { nearest(world, ways[next++].from, 8); });
  if (std::abs(sum - sum_by_force) > 1e-6 * rays) throw std::runtime_error("rays meet something else by brute force");
  tell(csv, "balls,%d,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f,%.3f\n", bodies, first, all, future, near, eight, by_force,
       double(met) / rays);
}

void mesh(std::ofstream& csv, std::uint32_t around, std::uint32_t across) {
  Random random(12);
  World<1> world(WorldOptions{});
  BodyDescription<1> ring;
  ring.shape = MeshShape{samples::torus(around, across), 1};
  ring.motion = {kds::certificates::PointMotion<1>{{Vector3d::Zero(), Vector3d::Zero()}}};
  world.add_body(ring);
  world.advance_to(0.01);
  int met = 0;
  const int rays = 2000;
  const double first = microseconds_each(rays, [&] {
    met += cast(world, Ray{3 * random.direction(), random.vector(0.9)}).has_value();
  });
  tell(csv, "mesh,%u,%.2f,,,,,,%.3f\n", 2 * around * across, first, double(met) / rays);
}

double microseconds_of_distance(const Shape& shape, double gap) {
  Random random(13);
  std::vector<PlacedShape> placed;
  std::vector<Vector3d> ways;
  for (int i = 0; i < 64; ++i) {
    placed.push_back(place(shape, random.orientation()));
    ways.push_back((2 + gap) * placed.back().bounding_radius * random.direction());
  }
  std::size_t next = 0;
  return microseconds_each(2000, [&] {
    const std::size_t i = next++ % placed.size();
    shape_distance(placed[i], placed[(7 * i + 3) % placed.size()], ways[i]);
  });
}

void distances(std::ofstream& csv) {
  tell(csv, "two,near us,far us\n");
  Random random(14);
  std::vector<Vector3d> corners;
  for (int i = 0; i < 300; ++i) corners.push_back(random.direction());
  const std::pair<const char*, Shape> shapes[] = {{"balls", Sphere{1}},
                                                  {"boxes", Box{{1, 0.6, 0.3}}},
                                                  {"hulls of 300 corners", convex_hull(corners)},
                                                  {"rings of 64 triangles", MeshShape{samples::torus(8, 4), 1}},
                                                  {"rings of 6 080 triangles", MeshShape{samples::torus(76, 40), 1}}};
  for (const auto& [name, shape] : shapes) {
    tell(csv, "%s,%.2f,%.2f\n", name, microseconds_of_distance(shape, 0.01), microseconds_of_distance(shape, 1));
  }
}

}  // namespace

int main(int count, char** arguments) try {
  std::ofstream csv = kds::benchmarks::open_csv(count > 1 ? arguments[1] : ".", "queries.csv");
  tell(csv,
       "of,bodies or triangles,first us,all us,next contact within 4 us,nearest us,nearest eight us,brute force "
       "us,part that meets\n");
  for (const int bodies : {100, 1000, 10000, 100000}) balls(csv, bodies);
  mesh(csv, 8, 4);
  mesh(csv, 76, 40);
  std::ofstream of_distances = kds::benchmarks::open_csv(count > 1 ? arguments[1] : ".", "distances.csv");
  distances(of_distances);
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_queries: %s\n", error.what());
  return 1;
}
