// Pairs of bodies that turn: time and missed contacts, beside FCL and Bullet.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/benchmarks/turning/random_boxes.hpp"
#include "tests/support/random_numbers.hpp"

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
using tests::Random;
using turning::between;
using turning::Query;
using turning::random_boxes;

/// A rod of 1 : 100 that comes down on a thin plate.
Query rod_and_plate(Random& random, double turn) {
  Query query{Vector3d(1, 0.01, 0.01),
              Vector3d(3, 3, 0.01),
              {{{Vector3d(0, 0, 1.2), Vector3d(0, 0, -1.5)}}},
              {{{Vector3d(0, 0, 0), Vector3d(0, 0, 0)}}}};
  query.a.angular_velocity = turn * between(random, 1).normalized();
  return query;
}

double contact_of(const Shape& shape_a, const Shape& shape_b, const Query& query) {
  const PlacedShape a = place(shape_a, Eigen::Quaterniond::Identity());
  const PlacedShape b = place(shape_b, Eigen::Quaterniond::Identity());
  const MovingShape<certificates::RigidMotion<1>> of_a{a, query.a}, of_b{b, query.b};
  return std::min(2.0, first_contact(of_a, of_b, 0, 1, ContactMode::transparent));
}

double here(const Query& query) { return contact_of(Box{query.half_a}, Box{query.half_b}, query); }

/// The rounded rod in a box as it were: as long as its third edge, and as thick as the first.
Capsule rod_in(const Vector3d& half) { return {half[0], half[2]}; }
double capsules_here(const Query& query) { return contact_of(rod_in(query.half_a), rod_in(query.half_b), query); }
double capsule_and_box_here(const Query& query) { return contact_of(rod_in(query.half_a), Box{query.half_b}, query); }

double contact_of_two(const PlacedShape& shape, const Query& query) {
  const MovingShape<certificates::RigidMotion<1>> of_a{shape, query.a}, of_b{shape, query.b};
  return std::min(2.0, first_contact(of_a, of_b, 0, 1, ContactMode::transparent));
}

/// Two cubes and the rod between them; a top on four legs. Each is about as large as the boxes.
double dumb_bells_here(const Query& query) {
  static const PlacedShape bell = place(compound(std::vector<CompoundPart>{{Box{{0.5, 0.0625, 0.0625}}},
                                                                           {Box{{0.25, 0.25, 0.25}}, {0.75, 0, 0}},
                                                                           {Box{{0.25, 0.25, 0.25}}, {-0.75, 0, 0}}}),
                                        Eigen::Quaterniond::Identity());
  return contact_of_two(bell, query);
}
double tables_here(const Query& query) {
  static const PlacedShape table = [] {
    std::vector<CompoundPart> parts{{Box{{0.6, 0.6, 0.0625}}, {0, 0, 0.25}}};
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) parts.push_back({Box{{0.0625, 0.0625, 0.375}}, {x, y, -0.1875}});
    }
    return place(compound(parts), Eigen::Quaterniond::Identity());
  }();
  return contact_of_two(table, query);
}

/// Hulls of random points on a ball.
template <int Corners>
double hulls_here(const Query& query) {
  static const PlacedShape hull = [] {
    Random random(1);
    std::vector<Vector3d> points;
    for (int i = 0; i < Corners; ++i) points.push_back(0.6 * between(random, 1).normalized());
    return place(convex_hull(points), Eigen::Quaterniond::Identity());
  }();
  return contact_of_two(hull, query);
}

struct Row {
  double microseconds;  ///< median
  int contacts;
  int missed;  ///< of the contacts found here
};

Row run(const std::vector<Query>& queries, const std::vector<double>& truth,
        const std::function<double(const Query&)>& method) {
  std::vector<double> times;
  Row row{0, 0, 0};
  for (std::size_t i = 0; i < queries.size(); ++i) {
    double contact = 0;
    times.push_back(benchmarks::seconds_of_call(3, [&] { contact = method(queries[i]); }));
    row.contacts += contact <= 1;
    // Later than by a hundredth of the second counts as missed: it is another contact.
    row.missed += truth[i] <= 1 && contact > truth[i] + 0.01;
  }
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  row.microseconds = 1e6 * times[times.size() / 2];
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  const int count = argc > 2 ? std::stoi(argv[2]) : 400;
  std::vector<std::pair<std::string, std::function<double(const Query&)>>> methods{{"here", here}};
#ifdef KDS_PEER_FCL
  methods.emplace_back("FCL", [](const Query& query) { return turning::fcl_contact(query, 1); });
#endif
#ifdef KDS_PEER_BULLET
  methods.emplace_back("Bullet", turning::bullet_contact);
#endif
  std::FILE* const csv = std::fopen((folder + "/turning.csv").c_str(), "w");
  if (!csv) return std::perror("turning.csv"), 1;
  std::fprintf(csv, "scene,turn_rad,method,median_us,contacts,missed\n");
  struct Scene {
    const char* name;
    Query (*make)(Random&, double);
    double (*here)(const Query&);
    bool peers;
  };
  for (const auto& [scene, make, find, peers] :
       {Scene{"boxes", random_boxes, here, true}, Scene{"rod and plate", rod_and_plate, here, true},
        Scene{"capsules", random_boxes, capsules_here, false},
        Scene{"capsule, box", random_boxes, capsule_and_box_here, false},
        Scene{"dumb-bells", random_boxes, dumb_bells_here, false}, Scene{"tables", random_boxes, tables_here, false},
        Scene{"hulls of 8", random_boxes, hulls_here<8>, false},
        Scene{"hulls of 40", random_boxes, hulls_here<40>, false},
        Scene{"hulls of 128", random_boxes, hulls_here<128>, false}}) {
    for (const double turn : {0.01, 0.1, 1.0, 10.0, 100.0, 1000.0}) {
      Random random(1);
      std::vector<Query> queries;
      for (int i = 0; i < count; ++i) queries.push_back(make(random, turn));
      std::vector<double> truth;
      for (const Query& query : queries) truth.push_back(find(query));
      std::printf("%-14s %7g rad", scene, turn);
      for (const auto& [name, method] : methods) {
        if (name != "here" && (turn > 100 || !peers)) continue;
        const Row row = run(queries, truth, name == "here" ? find : method);
        std::printf("   %s %8.2f us, %3d contacts, %3d missed", name.c_str(), row.microseconds, row.contacts,
                    row.missed);
        std::fprintf(csv, "%s,%g,%s,%.3f,%d,%d\n", scene, turn, name.c_str(), row.microseconds, row.contacts,
                     row.missed);
      }
      std::printf("\n");
    }
  }
  return std::fclose(csv) == 0 ? 0 : 1;
}
