// Pairs of meshes that turn: time of a search for the first contact within one second, beside FCL.
#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/benchmarks/turning/fcl_mesh.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
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

/// A wheel about z of the radius 1, with teeth as of a cosine on its rim.
std::shared_ptr<const Mesh> gear(std::uint32_t teeth, std::uint32_t corners_a_tooth, double height) {
  std::vector<Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
  const std::uint32_t corners = teeth * corners_a_tooth;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    const double radius = 1 + 0.5 * height * std::cos(teeth * angle);
    for (const double z : {-0.1, 0.1}) vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  const std::uint32_t below = 2 * corners, above = below + 1;
  vertices.emplace_back(0, 0, -0.1), vertices.emplace_back(0, 0, 0.1);
  for (std::uint32_t i = 0; i < corners; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % corners);
    triangles.insert(triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}, {below, b, a}, {above, a + 1, b + 1}});
  }
  return std::make_shared<Mesh>(vertices, triangles);
}

/// One radian after the other of two gears with an even number of teeth, each between those of the other, that turn
/// against each other at 1 rad/s. They never touch.
std::vector<Query> interlocked_gears(std::uint32_t teeth, double distance, int radians) {
  std::vector<Query> queries;
  for (int i = 0; i < radians; ++i) {
    Query query;
    query.a.path.coefficients = {Vector3d::Zero(), Vector3d::Zero()};
    query.b.path.coefficients = {Vector3d(distance, 0, 0.01), Vector3d::Zero()};
    query.a.angular_velocity = Vector3d::UnitZ(), query.b.angular_velocity = -Vector3d::UnitZ();
    query.b.orientation = Eigen::AngleAxisd(std::numbers::pi / teeth, Vector3d::UnitZ());
    query.a.path.start = query.b.path.start = -i;
    queries.push_back(query);
  }
  return queries;
}

struct Row {
  double microseconds;  ///< median
  int contacts;
  int missed;  ///< of the contacts found here: later by a hundredth of the second, or not at all
};

/// The least of some rounds of each.
Row run(const std::vector<Query>& queries, const std::vector<double>& truth, int rounds,
        const std::function<double(const Query&)>& method) {
  std::vector<double> times;
  Row row{0, 0, 0};
  for (std::size_t i = 0; i < queries.size(); ++i) {
    double contact = 0;
    times.push_back(benchmarks::seconds_of_call(rounds, [&] { contact = method(queries[i]); }));
    row.contacts += contact <= 1;
    row.missed += truth[i] <= 1 && contact > truth[i] + 0.01;
  }
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  row.microseconds = 1e6 * times[times.size() / 2];
  return row;
}

}  // namespace

/// Arguments: a folder for turning-meshes.csv (the current one), the number of pairs of each row (20), and how many of
/// them FCL is asked for (5; it takes tenths of a second for large rings; no more than 10 rad).
int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  const int count = argc > 2 ? std::stoi(argv[2]) : 20;
  [[maybe_unused]] const int of_fcl = argc > 3 ? std::stoi(argv[3]) : 5;
  std::ofstream csv = benchmarks::open_csv(folder, "turning-meshes.csv");
  benchmarks::tell(csv, "triangles,rings,turn_rad,method,pairs,median_us,contacts,missed\n");
  const auto tell = [&](std::uint32_t triangles, const char* name, double turn, const char* method, std::size_t asked,
                        const Row& row) {
    char line[160];
    std::snprintf(line, sizeof line, "%u,%s,%g,%s,%zu,%.1f,%d,%d\n", triangles, name, turn, method, asked,
                  row.microseconds, row.contacts, row.missed);
    benchmarks::tell(csv, line);
  };
  const auto here = [](const std::shared_ptr<const Mesh>& mesh) {
    const PlacedShape shape = place(MeshShape{mesh, 1}, Eigen::Quaterniond::Identity());
    return [shape](const Query& query) {
      const MovingShape<RigidMotion> a{shape, query.a}, b{shape, query.b};
      return first_contact(a, b, 0, 1, ContactMode::transparent);
    };
  };
  for (const auto& [teeth, corners, height] : {std::tuple(20u, 8u, 0.1), {40u, 16u, 0.05}}) {
    for (const double play : {0.4, 0.2}) {  // of the height
      const auto mesh = gear(teeth, corners, height);
      const auto queries = interlocked_gears(teeth, 2 + play * height, 6);
      const Row row = run(queries, std::vector<double>(queries.size(), never), 3, here(mesh));
      tell(4 * teeth * corners, play == 0.4 ? "gears" : "tight gears", 1, "here", queries.size(), row);
    }
  }
  using Make = Query (*)(Random&, double);
  for (const std::uint32_t around : {8u, 80u}) {
    const std::uint32_t across = around == 8 ? 4 : 38;
    const auto mesh = samples::torus(around, across);
    const auto method = here(mesh);
#ifdef KDS_PEER_FCL
    const turning::FclMesh of_peer(*mesh);
#endif
    for (const auto& [name, make] : {std::pair<const char*, Make>{"free", free_rings}, {"linked", linked_rings}}) {
      for (const double turn : {0.01, 0.1, 1.0, 10.0, 100.0}) {
        Random random(1);
        std::vector<Query> queries;
        for (int i = 0; i < count; ++i) queries.push_back(make(random, turn));
        std::vector<double> truth;
        for (const Query& query : queries) truth.push_back(method(query));
        tell(2 * around * across, name, turn, "here", queries.size(), run(queries, truth, 3, method));
#ifdef KDS_PEER_FCL
        if (turn > 10) continue;
        queries.resize(static_cast<std::size_t>(std::min(count, of_fcl)));
        tell(2 * around * across, name, turn, "here", queries.size(), run(queries, truth, 3, method));
        tell(2 * around * across, name, turn, "FCL", queries.size(),
             run(queries, truth, 1, [&](const Query& query) { return of_peer.contact(query.a, query.b); }));
#endif
      }
    }
  }
}
