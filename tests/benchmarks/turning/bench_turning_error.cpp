// Boxes that turn: error of the time of contact against run time, beside sampling, FCL and Bullet.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/benchmarks/turning/random_boxes.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using turning::Query;

double here(const Query& query) {
  const PlacedShape a = place(Box{query.half_a}, Eigen::Quaterniond::Identity());
  const PlacedShape b = place(Box{query.half_b}, Eigen::Quaterniond::Identity());
  const MovingShape<certificates::RigidMotion<1>> of_a{a, query.a}, of_b{b, query.b};
  return std::min(2.0, first_contact(of_a, of_b, 0, 1, ContactMode::transparent));
}

/// [Gottschalk96], in plain doubles.
bool overlap(const Query& query, double t) {
  const Eigen::Isometry3d a = turning::pose(query.a, t), b = turning::pose(query.b, t);
  const Eigen::Matrix3d between = a.linear().transpose() * b.linear();
  const Vector3d way = a.linear().transpose() * (b.translation() - a.translation());
  const Eigen::Matrix3d size = between.cwiseAbs();
  const Vector3d &p = query.half_a, &q = query.half_b;
  if (((way.cwiseAbs() - p - size * q).array() > 0).any()) return false;
  if ((((between.transpose() * way).cwiseAbs() - q - size.transpose() * p).array() > 0).any()) return false;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double greatest = p[i1] * size(i2, j) + p[i2] * size(i1, j) + q[j1] * size(i, j2) + q[j2] * size(i, j1);
      if (std::abs(way[i2] * between(i1, j) - way[i1] * between(i2, j)) > greatest) return false;
    }
  }
  return true;
}

/// The first of so many samples a second at which they overlap.
double sampled(const Query& query, double rate) {
  for (int i = 0; i <= rate; ++i) {
    if (overlap(query, i / rate)) return i / rate;
  }
  return 2;
}

struct Method {
  std::string name;
  double setting;  ///< samples a second; of FCL frames
  std::function<double(const Query&)> contact;
};

std::vector<Method> methods() {
  std::vector<Method> all{{"here", 0, here}};
  for (const double rate : {60.0, 125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0, 16000.0}) {
    all.push_back({"sampling", rate, [rate](const Query& query) { return sampled(query, rate); }});
  }
#ifdef KDS_PEER_FCL
  for (const int frames : {1, 60, 240, 1000, 4000}) {
    all.push_back({"FCL", static_cast<double>(frames),
                   [frames](const Query& query) { return turning::fcl_contact(query, frames); }});
  }
#endif
#ifdef KDS_PEER_BULLET
  all.push_back({"Bullet", 0, turning::bullet_contact});
#endif
  return all;
}

}  // namespace

/// Arguments: a folder for turning-error.csv (the current one), and the number of pairs (400). Bodies that overlap at
/// the start count for nothing. Errors are of contacts that a method finds within a hundredth of a second; the others
/// it misses. Of times found here the error is at most the spacing of doubles, which is what is given.
int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  const int count = argc > 2 ? std::stoi(argv[2]) : 400;
  std::ofstream csv = benchmarks::open_csv(folder, "turning-error.csv");
  benchmarks::tell(csv, "turn_rad,method,setting,mean_us,mean_error_s,contacts,missed\n");
  for (const double turn : {1.0, 10.0, 100.0}) {
    tests::Random random(1);
    std::vector<Query> queries;
    std::vector<double> truth;
    while (static_cast<int>(queries.size()) < count) {
      const Query query = turning::random_boxes(random, turn);
      const double contact = here(query);
      if (contact == 0) continue;
      queries.push_back(query), truth.push_back(contact);
    }
    for (const Method& method : methods()) {
      double seconds = 0, error = 0;
      int found = 0, missed = 0;
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const double start = benchmarks::thread_seconds();
        const double contact = method.contact(queries[i]);
        seconds += benchmarks::thread_seconds() - start;
        if (!(truth[i] <= 1)) continue;
        const double off = std::max(std::abs(contact - truth[i]), truth[i] - next_down(truth[i]));
        // One sample of a hundredth of a second, and more, would else be missed for its rate.
        const double late = method.name == "sampling" ? std::max(0.01, 1 / method.setting) : 0.01;
        off <= late ? ++found : ++missed;
        if (off <= late) error += off;
      }
      char line[160];
      std::snprintf(line, sizeof line, "%g,%s,%g,%.3f,%.3g,%d,%d\n", turn, method.name.c_str(), method.setting,
                    1e6 * seconds / count, error / std::max(1, found), found + missed, missed);
      benchmarks::tell(csv, line);
    }
  }
}
