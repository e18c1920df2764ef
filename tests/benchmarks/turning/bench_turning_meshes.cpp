// Pairs of meshes that turn: time of a search for the first contact within one second.
#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using tests::Random;

using RigidMotion = certificates::RigidMotion<1>;
struct Query {
  RigidMotion a, b;
};

Vector3d direction(Random& random) {
  return Vector3d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)).normalized();
}

/// Rings of the radius 1, that fly towards each other from a distance of 2.5, so that most meet within the second.
Query free_rings(Random& random, double turn) {
  Query query;
  const Vector3d from = direction(random);
  for (RigidMotion* motion : {&query.a, &query.b}) {
    const double side = motion == &query.a ? -1 : 1;
    motion->path.coefficients = {side * 1.25 * from, -side * 1.25 * from + 0.25 * direction(random)};
    motion->orientation.coeffs() =
        Eigen::Vector4d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    motion->angular_velocity = turn * direction(random);
  }
  return query;
}

/// Each through the other, at rest but for their turns: b is about x, its centre on the ring of a.
Query linked_rings(Random& random, double turn) {
  Query query;
  for (RigidMotion* motion : {&query.a, &query.b}) {
    motion->path.coefficients = {Vector3d::Zero(), 0.3 * direction(random)};
    motion->angular_velocity = turn * direction(random);
  }
  query.b.path.coefficients[0] = Vector3d(0.75, 0, 0);
  query.b.orientation = Eigen::Quaterniond(1, 1, 0, 0);
  return query;
}

}  // namespace

/// Arguments: a folder for turning-meshes.csv (the current one), and the number of pairs of each row (20).
int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  const int count = argc > 2 ? std::stoi(argv[2]) : 20;
  std::ofstream csv = benchmarks::open_csv(folder, "turning-meshes.csv");
  benchmarks::tell(csv, "triangles,rings,turn_rad,median_us,contacts\n");
  using Make = Query (*)(Random&, double);
  for (const std::uint32_t around : {8u, 80u}) {
    const std::uint32_t across = around == 8 ? 4 : 38;
    const PlacedShape ring = place(MeshShape{samples::torus(around, across), 1}, Eigen::Quaterniond::Identity());
    for (const auto& [name, make] : {std::pair<const char*, Make>{"free", free_rings}, {"linked", linked_rings}}) {
      for (const double turn : {0.01, 0.1, 1.0, 10.0, 100.0}) {
        Random random(1);
        std::vector<double> times;
        int contacts = 0;
        for (int i = 0; i < count; ++i) {
          const Query query = make(random, turn);
          const MovingShape<RigidMotion> a{ring, query.a}, b{ring, query.b};
          double best = never;
          double contact = 0;
          for (int round = 0; round < 3; ++round) {
            const double start = benchmarks::thread_seconds();
            contact = first_contact(a, b, 0, 1, ContactMode::transparent);
            best = std::min(best, benchmarks::thread_seconds() - start);
          }
          times.push_back(best);
          contacts += contact <= 1;
        }
        std::nth_element(times.begin(), times.begin() + count / 2, times.end());
        char line[100];
        std::snprintf(line, sizeof line, "%u,%s,%g,%.1f,%d\n", 2 * around * across, name, turn,
                      1e6 * times[times.size() / 2], contacts);
        benchmarks::tell(csv, line);
      }
    }
  }
}
