// When bodies that turn come to rest in heaps, and what that costs.
//
//     bench_heaps [DIRECTORY [SECONDS]]      -> heaps.csv; 3 minutes
//
// Crates, boards and rods that are thrown into a box, and boxes that are put above each other with gaps of some
// centimetres; restitution 0.3, friction 0.5. Each with two lengths of the shortest flight. A run that has taken
// SECONDS (60) of the processor is given up, and its time of rest is empty. The deepest overlap is of all pairs of
// boxes by their fifteen axes, five times a second; the greatest rise of the energy is from one twentieth of a second
// to the next, over the energy at first. Of runs that come to rest, contacts in a thousand seconds more.

#include "collision/response/mass_properties.hpp"
#include "collision/world.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <vector>

namespace {

using namespace kds::collision;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using kds::benchmarks::tell;
using kds::benchmarks::thread_seconds;
using kds::certificates::RigidMotion;
using kds::tests::Random;
using Turning = TurningWorld<2>;

constexpr double gravity = 9.81;

struct Contacts : Turning::Listener {
  std::uint64_t count = 0;
  void contact(Turning&, const PairEvent&) override { ++count; }
};

/// Boxes, and the world that they are in.
class Heap {
 public:
  explicit Heap(double shortest_flight)
      : world_({.response = Response::elastic, .shortest_flight = shortest_flight}, &contacts_) {}

  void add(const Vector3d& half, const Vector3d& at, const Eigen::Quaterniond& orientation = upright(),
           const Vector3d& spin = Vector3d::Zero(), const Vector3d& velocity = Vector3d::Zero()) {
    RigidMotion<2> motion{{{at, velocity, Vector3d(0, 0, -gravity / 2)}}};
    motion.orientation = orientation;
    motion.angular_velocity = spin;
    free_.push_back(
        {world_.add_body({.shape = Box{half}, .motion = {motion}, .restitution = 0.3, .friction = 0.5}), half});
  }
  void add_fixed(const Vector3d& half, const Vector3d& at) {
    Turning::Description body{.shape = Box{half}, .fixed = true, .restitution = 0.3, .friction = 0.5};
    body.motion = {RigidMotion<2>{{{at, Vector3d::Zero(), Vector3d::Zero()}}}};
    fixed_.push_back({world_.add_body(body), half});
  }

  Turning& world() { return world_; }
  std::size_t bodies() const { return free_.size(); }
  std::uint64_t contacts() const { return contacts_.count; }

  bool all_rest() const {
    return std::all_of(free_.begin(), free_.end(), [&](const Member& member) {
      const auto& motion = world_.motion(member.id);
      return motion.path.coefficients[1].isZero(0) && motion.path.coefficients[2].isZero(0) &&
             motion.angular_velocity.isZero(0);
    });
  }
  double energy() const {
    double sum = 0;
    for (const Member& member : free_) {
      const auto turning = world_.free_turning(member.id);
      const auto& path = world_.motion(member.id).path;
      sum += gravity * path.position(world_.now())[2] + 0.5 * path.velocity(world_.now()).squaredNorm() +
             0.5 * turning.angular_momentum.dot(turning.angular_velocity);
    }
    return sum;
  }
  double deepest() const {
    std::vector<Placed> all;
    for (const auto* members : {&fixed_, &free_}) {
      for (const Member& member : *members) all.push_back(placed(member));
    }
    double most = 0;
    for (std::size_t i = fixed_.size(); i < all.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) most = std::max(most, -gap(all[i], all[j]));
    }
    return most;
  }

 private:
  struct Member {
    BodyId id;
    Vector3d half;
  };
  struct Placed {
    Vector3d centre;
    Matrix3d axes;
    Vector3d half;
  };

  static Eigen::Quaterniond upright() { return Eigen::Quaterniond::Identity(); }

  Placed placed(const Member& member) const {
    const auto& motion = world_.motion(member.id);
    Placed box{motion.path.position(world_.now()), {}, member.half};
    for (int d = 0; d < 3; ++d) box.axes.col(d) = motion.direction(Vector3d::Unit(d), world_.now()).vector;
    return box;
  }
  /// The greatest distance along one of the fifteen axes; below 0: how deep they are in each other.
  static double gap(const Placed& a, const Placed& b) {
    double most = -std::numeric_limits<double>::infinity();
    const auto along = [&](const Vector3d& axis) {
      const double length = axis.norm();
      if (length < 1e-6) return;  // of two parallel edges
      const Vector3d u = axis / length;
      const double half_widths =
          a.half.dot((a.axes.transpose() * u).cwiseAbs()) + b.half.dot((b.axes.transpose() * u).cwiseAbs());
      most = std::max(most, std::abs(u.dot(a.centre - b.centre)) - half_widths);
    };
    for (int d = 0; d < 3; ++d) {
      along(a.axes.col(d)), along(b.axes.col(d));
      for (int e = 0; e < 3; ++e) along(a.axes.col(d).cross(b.axes.col(e)));
    }
    return most;
  }

  Contacts contacts_;
  Turning world_;
  std::vector<Member> free_, fixed_;
};

/// Layers of nine above each other, which turn, in a box of 4.5 m x 4.5 m.
void throw_into_box(Heap& heap, int bodies, std::uint64_t seed) {
  Random random(seed);
  const auto any = [&](double size) { return random.between(-size, size); };
  constexpr double half = 2.25, thick = 0.25, edge = half + 2 * thick, middle = half + thick;
  const double height = 2 + bodies / 9;
  heap.add_fixed({edge, edge, thick}, {0, 0, -thick});
  for (const double side : {-middle, middle}) {
    heap.add_fixed({thick, half, height / 2}, {side, 0, height / 2});
    heap.add_fixed({half, thick, height / 2}, {0, side, height / 2});
  }
  const std::array halves{Vector3d(0.3, 0.3, 0.3), Vector3d(0.1, 0.125, 0.55), Vector3d(0.4, 0.3, 0.15)};
  for (int i = 0; i < bodies; ++i) {
    const double w = any(1), x = any(1), y = any(1), z = any(1);
    const Vector3d cell(i % 3 - 1, i / 3 % 3 - 1, 1 + i / 9);
    const double dx = any(0.05), dy = any(0.05), a = any(2), b = any(2), c = any(2);
    heap.add(halves[static_cast<std::size_t>(i % 3)], 1.25 * cell + Vector3d(dx, dy, 0),
             Eigen::Quaterniond(w, x, y, z).normalized(), {a, b, c});
  }
}

void put_on_floor(Heap& heap) { heap.add_fixed({20, 20, 1}, {0, 0, -1}); }

void stack(Heap& heap, int bodies, std::uint64_t seed) {
  Random random(seed);
  put_on_floor(heap);
  for (int i = 0; i < bodies; ++i) {
    const double dx = random.between(-0.05, 0.05), dy = random.between(-0.05, 0.05);
    heap.add({0.5, 0.5, 0.25}, {dx, dy, 0.3 + 0.55 * i});
  }
}

/// Rows of bricks: each of as many as the one below and shifted by half a brick, or of one less.
void lay_bricks(Heap& heap, int rows, int in_first, bool narrows, std::uint64_t seed) {
  Random random(seed);
  put_on_floor(heap);
  for (int row = 0; row < rows; ++row) {
    const double shift = narrows ? 0.5 * row : 0.5 * (row % 2);
    for (int i = 0; i < in_first - (narrows ? row : 0); ++i) {
      const double dx = random.between(-0.002, 0.002), dy = random.between(-0.01, 0.01);
      heap.add({0.25, 0.125, 0.1}, {(i + shift) * 0.52 + dx, dy, 0.11 + 0.22 * row});
    }
  }
}

void measure(std::ofstream& csv, const char* name, const auto& build, double flight, double patience) {
  Heap heap(flight);
  build(heap);
  const double first = heap.energy(), begin = thread_seconds();
  double last = first, rise = 0, deepest = 0;
  bool rests = false;
  for (int step = 1; !rests && thread_seconds() - begin < patience; ++step) {
    heap.world().advance_to(step / 20.0);
    const double energy = heap.energy();
    rise = std::max(rise, energy - last), last = energy;
    rests = heap.all_rest();
    if (rests || step % 4 == 0) deepest = std::max(deepest, heap.deepest());
  }
  const double seconds = thread_seconds() - begin, end = heap.world().now();
  const std::uint64_t contacts = heap.contacts();
  char rested[64] = ",";
  if (rests) {
    heap.world().advance_to(end + 1000);
    std::snprintf(rested, sizeof rested, "%.2f,%llu", end, static_cast<unsigned long long>(heap.contacts() - contacts));
  }
  tell(csv, "%s,%zu,%g,%s,%llu,%.2f,%.2g,%.2g\n", name, heap.bodies(), flight, rested,
       static_cast<unsigned long long>(contacts), seconds, deepest, rise / first);
}

}  // namespace

int main(int count, char** arguments) try {
  std::ofstream csv = kds::benchmarks::open_csv(count > 1 ? arguments[1] : ".", "heaps.csv");
  const double patience = count > 2 ? std::atof(arguments[2]) : 60;
  tell(csv,
       "heap,bodies,shortest flight s,at rest after s,contacts in 1000 s more,contacts,cpu s,deepest overlap m,"
       "rise of energy\n");
  for (const double flight : {0.001, 0.004}) {
    for (const int bodies : {12, 24, 48}) {
      for (const std::uint64_t seed : {1, 2}) {
        measure(
            csv, "box", [&](Heap& heap) { throw_into_box(heap, bodies, seed); }, flight, patience);
      }
    }
    for (const int bodies : {5, 10}) {
      measure(
          csv, "stack", [&](Heap& heap) { stack(heap, bodies, 1); }, flight, patience);
    }
    measure(
        csv, "pyramid", [&](Heap& heap) { lay_bricks(heap, 4, 4, true, 1); }, flight, patience);
    measure(
        csv, "wall", [&](Heap& heap) { lay_bricks(heap, 5, 4, false, 1); }, flight, patience);
    const auto struck = [&](Heap& heap) {
      lay_bricks(heap, 5, 4, false, 1);
      heap.add({0.3, 0.3, 0.3}, {1, -4, 1}, Eigen::Quaterniond::Identity(), Vector3d::Zero(), {0, 6, 2});
    };
    measure(csv, "wall that is struck", struck, flight, patience);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_heaps: %s\n", error.what());
  return 1;
}
