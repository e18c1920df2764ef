// Meshes that bend: time of a step with its search for the first contact, boxes included; and a cloth that falls over a
// ball.
#include "collision/deforming/deforming_mesh.hpp"
#include "collision/deforming/rigid_surface.hpp"
#include "collision/deforming/surface_contact.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision/sample_sheets.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using tests::Random;

Vector3d vector(Random& random, double size) {
  const double x = random.between(-size, size), y = random.between(-size, size), z = random.between(-size, size);
  return {x, y, z};
}

/// A ring that flies from a place to another, and is bent on the way: pressed by an affine map, and each vertex moves a
/// little on its own.
struct BentRing {
  std::vector<Vector3d> begin, end;

  BentRing(Random& random, const Mesh& ring, const Vector3d& from, const Vector3d& to) {
    const Eigen::Quaterniond turn(
        Eigen::Vector4d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1))
            .normalized());
    Eigen::Matrix3d bend = Eigen::Matrix3d::Identity();
    for (int d = 0; d < 3; ++d) bend.col(d) += vector(random, 0.2);
    for (const Vector3d& v : ring.vertices()) {
      begin.push_back(from + turn * v);
      end.push_back(to + turn * (bend * v) + vector(random, 0.005));
    }
  }
};

/// Each ring through the other, bent where it is.
void link(Random& random, const Mesh& ring, BentRing& a, BentRing& b) {
  for (std::size_t v = 0; v < ring.vertices().size(); ++v) {
    const Vector3d p = ring.vertices()[v];
    a.begin[v] = p;
    b.begin[v] = Vector3d(0.75 + p[0], p[2], p[1]);
    a.end[v] = a.begin[v] + vector(random, 0.005);
    b.end[v] = b.begin[v] + vector(random, 0.005);
  }
}

enum class Kind { free, linked, itself };

/// Median of the times of a step of both rings with a search for the first contact, us.
void measure_rings(std::ofstream& csv, std::uint32_t around, std::uint32_t across, Kind kind, int count) {
  const auto ring = samples::torus(around, across);
  DeformingMesh<1> a(ring->vertices(), ring->triangles());
  DeformingMesh<1> b = a;
  Random random(1);
  std::vector<double> times, refits;
  int contacts = 0;
  for (int i = 0; i < count; ++i) {
    const Vector3d from = vector(random, 1).normalized();
    const bool free = kind == Kind::free;
    const Vector3d place_a = free ? Vector3d(-1.25 * from) : Vector3d::Zero();
    const Vector3d end_a = free ? vector(random, 0.2) : Vector3d::Zero();
    const Vector3d end_b = free ? vector(random, 0.2) : Vector3d::Zero();
    BentRing of_a(random, *ring, place_a, end_a);
    BentRing of_b(random, *ring, -place_a, end_b);
    if (kind == Kind::linked) link(random, *ring, of_a, of_b);
    double best = 1e9, best_refit = 1e9;
    bool found = false;
    for (int round = 0; round < 3; ++round) {
      const double start = benchmarks::thread_seconds();
      a.set_step(0, 1, of_a.begin, of_a.end);
      if (kind != Kind::itself) b.set_step(0, 1, of_b.begin, of_b.end);
      const double fitted = benchmarks::thread_seconds();
      found = kind == Kind::itself ? first_self_contact(a.surface()).has_value()
                                   : first_contact(a.surface(), b.surface()).has_value();
      best = std::min(best, benchmarks::thread_seconds() - start);
      best_refit = std::min(best_refit, fitted - start);
    }
    times.push_back(best);
    refits.push_back(best_refit);
    contacts += found;
  }
  const auto median = [](std::vector<double>& x) {
    std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2), x.end());
    return 1e6 * x[x.size() / 2];
  };
  const char* const name = kind == Kind::free ? "free" : (kind == Kind::linked ? "linked" : "itself");
  const double worst = 1e6 * *std::max_element(times.begin(), times.end());
  char line[120];
  std::snprintf(line, sizeof line, "%u,%s,%.1f,%.1f,%.1f,%d\n", 2 * around * across, name, median(refits),
                median(times), worst, contacts);
  benchmarks::tell(csv, line);
}

/// The same of one that bends and one that keeps its shape and turns by an angle on its way, as worlds test them: until
/// the first contact, or until they have passed.
void measure_turning(std::ofstream& csv, std::uint32_t around, std::uint32_t across, double radians, int count) {
  const auto ring = samples::torus(around, across);
  const std::vector<Mesh::Triangle> triangles(ring->triangles().begin(), ring->triangles().end());
  Random random(1);
  std::vector<double> times;
  int contacts = 0;
  for (int i = 0; i < count; ++i) {
    const Vector3d from = vector(random, 1).normalized();
    const BentRing bent(random, *ring, -1.25 * from, vector(random, 0.2));
    const auto script = std::make_shared<const MeshScript>(
        std::vector<MeshScript::Keyframe>{{0, bent.begin}, {1, bent.end}}, triangles);
    const PlacedShape bends = place(BendingMesh{script}, Eigen::Quaterniond::Identity());
    const PlacedShape turns = place(MeshShape{ring}, Eigen::Quaterniond::Identity());
    using Turning = certificates::RigidMotion<1>;
    const Turning still{certificates::PointMotion<1>::line(Vector3d::Zero(), Vector3d::Zero())};
    Turning motion{certificates::PointMotion<1>::line(1.25 * from, vector(random, 0.2) - 1.25 * from)};
    motion.angular_velocity = radians * vector(random, 1).normalized();
    double best = 1e9;
    bool found = false;
    for (int round = 0; round < 3; ++round) {
      const double start = benchmarks::thread_seconds();
      const MovingShape<Turning> a{bends, still}, b{turns, motion};
      double time = 0;  // first_contact() looks so far as the world would
      for (bool exact = false; !exact && time < 1;) {
        const ContactEstimate next = certified_first_contact(a, b, time, 1, ContactMode::transparent);
        time = next.time, exact = next.exact;
      }
      found = time <= 1;
      best = std::min(best, benchmarks::thread_seconds() - start);
    }
    times.push_back(best);
    contacts += found;
  }
  std::sort(times.begin(), times.end());
  char line[120];
  std::snprintf(line, sizeof line, "%u,turns by %g rad,,%.1f,%.1f,%d\n", 2 * around * across, radians,
                1e6 * times[times.size() / 2], 1e6 * times.back(), contacts);
  benchmarks::tell(csv, line);
}

/// A cloth of squares, moved by positions: gravity, lengths of its edges, and the ball pushes out what is in it.
class FallingCloth {
 public:
  explicit FallingCloth(std::uint32_t n) : n_(n) {
    samples::Sheet sheet(n, 2);
    positions = std::move(sheet.positions);
    triangles = std::move(sheet.triangles);
    for (std::uint32_t i = 0; i <= n; ++i) {
      for (std::uint32_t j = 0; j <= n; ++j) {
        positions[i * (n + 1) + j][2] = 1.2 + 0.01 * std::sin(i * 0.7) * std::cos(j * 0.9);
      }
    }
    velocities_.assign(positions.size(), Vector3d::Zero());
  }

  void step(double h, double radius) {
    const std::vector<Vector3d> before = positions;
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] += h * velocities_[v] - Vector3d(0, 0, 9.8 * h * h);
    const double length = 4.0 / n_;
    for (int round = 0; round < 10; ++round) {
      for (std::uint32_t i = 0; i <= n_; ++i) {
        for (std::uint32_t j = 0; j <= n_; ++j) {
          const std::uint32_t v = i * (n_ + 1) + j;
          if (j < n_) keep_length(v, v + 1, length);
          if (i < n_) keep_length(v, v + n_ + 1, length);
          if (i < n_ && j < n_) keep_length(v, v + n_ + 2, length * std::sqrt(2.0));
        }
      }
      for (Vector3d& p : positions) {
        if (p.norm() < radius) p *= radius / p.norm();
      }
    }
    for (std::size_t v = 0; v < positions.size(); ++v) velocities_[v] = 0.99 * (positions[v] - before[v]) / h;
  }

  std::vector<Vector3d> positions;
  std::vector<Mesh::Triangle> triangles;

 private:
  void keep_length(std::uint32_t a, std::uint32_t b, double length) {
    const Vector3d way = positions[b] - positions[a];
    const Vector3d by = 0.5 * (1 - length / way.norm()) * way;
    positions[a] += by;
    positions[b] -= by;
  }

  std::uint32_t n_;
  std::vector<Vector3d> velocities_;
};

void measure_cloth(std::ofstream& csv, int steps) {
  FallingCloth cloth(71);
  DeformingMesh<1> mesh(cloth.positions, cloth.triangles);
  RigidSurface<1> ball(place(Sphere{1}, Eigen::Quaterniond::Identity()));
  const auto at_rest = certificates::PointMotion<1>::line(Vector3d::Zero(), Vector3d::Zero());
  double refit = 0, with_ball = 0, with_itself = 0;
  std::size_t with_ball_found = 0, with_itself_found = 0;
  const double h = 1.0 / 240;
  for (int i = 0; i < steps; ++i) {
    cloth.step(h, 1.02);
    const double t = i * h;
    const double start = benchmarks::thread_seconds();
    mesh.step_to((i + 1) * h, cloth.positions);
    const double fitted = benchmarks::thread_seconds();
    ball.move(at_rest, t, (i + 1) * h);
    with_ball_found += all_contacts(mesh.surface(), ball.surface(), {.overlaps = false}).size();
    const double met = benchmarks::thread_seconds();
    with_itself_found += all_self_contacts(mesh.surface(), {.overlaps = false}).size();
    refit += fitted - start;
    with_ball += met - fitted;
    with_itself += benchmarks::thread_seconds() - met;
  }
  char line[200];
  std::snprintf(line, sizeof line, "%zu,%d,%.1f,%.1f,%.1f,%.0f,%zu,%zu\n", cloth.triangles.size(), steps,
                1e6 * refit / steps, 1e6 * with_ball / steps, 1e6 * with_itself / steps,
                steps / (refit + with_ball + with_itself), with_ball_found, with_itself_found);
  benchmarks::tell(csv, line);
}

}  // namespace

/// Arguments: a folder for deforming.csv and deforming-cloth.csv (the current one), and the number of pairs of each row
/// (100).
int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  const int count = argc > 2 ? std::stoi(argv[2]) : 100;
  std::ofstream csv = benchmarks::open_csv(folder, "deforming.csv");
  benchmarks::tell(csv, "triangles,rings,boxes_us,median_us,worst_us,contacts\n");
  for (const std::uint32_t around : {8u, 80u}) {
    const std::uint32_t across = around == 8 ? 4 : 38;
    for (const Kind kind : {Kind::free, Kind::linked, Kind::itself}) measure_rings(csv, around, across, kind, count);
    for (const double radians : {0.0, 1.0, 10.0}) measure_turning(csv, around, across, radians, count);
  }
  std::ofstream cloth = benchmarks::open_csv(folder, "deforming-cloth.csv");
  benchmarks::tell(cloth, "triangles,steps,boxes_us,ball_us,itself_us,steps_per_second,with_ball,with_itself\n");
  measure_cloth(cloth, 240);
}
