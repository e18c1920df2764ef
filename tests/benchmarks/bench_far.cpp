// Accuracy at any clock, place, speed and size: times of contact against exact rational arithmetic.
//
//     bench_far [DIRECTORY [PAIRS]]      -> far.csv (spheres and boxes), meshes.csv; 300 pairs a row
//
// Spheres and boxes: the error must lie in [0, 1) spacings of the doubles at that time: the first double at or after
// the true instant (turned boxes are rounded shapes: of them the error of the place is told, in 2^-53 of the size).
// Meshes: how early they are, against the contact gap that the library states. Exits with 1 where a law is broken.

#include "tests/benchmarks/accuracy/encounters.hpp"
#include "tests/benchmarks/accuracy/mesh_bounds.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace {

using namespace accuracy;
using kds::collision::MeshShape;

void tell(std::ofstream& file, const char* format, auto... values) {
  char line[512];
  std::snprintf(line, sizeof line, format, values...);
  file << line << std::flush;
  std::fputs(line, stdout);
}

std::ofstream open_csv(const std::filesystem::path& folder, const char* name) {
  std::filesystem::create_directories(folder);
  std::ofstream file(folder / name);
  if (!file) throw std::runtime_error("cannot write " + (folder / name).string());
  return file;
}

Eigen::Quaterniond random_orientation(Random& random) {
  const double z = random.between(0.1, 1);
  const Vector3d rest = random_vector(random, 1);
  return Eigen::Quaterniond(rest[0], rest[1], rest[2], z).normalized();
}

enum class Kind { balls, box_and_ball, boxes, turned_boxes };

const char* name(Kind kind) {
  switch (kind) {
    case Kind::balls: return "balls";
    case Kind::box_and_ball: return "box and ball";
    case Kind::boxes: return "boxes";
    case Kind::turned_boxes: return "turned boxes";
  }
  return "?";
}

template <int Degree>
bool measure(Kind kind, const Setting& setting, int pairs, std::ofstream& csv) {
  TimeErrors errors;
  for (int seed = 1; seed <= pairs; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const auto box = [&](double size) {
      const auto half = [&] { return size * random.between(0.3, 0.6); };
      return Box{{half(), half(), half()}};
    };
    Shape a = Sphere{setting.size_a * random.between(0.5, 1)};
    Shape b = Sphere{setting.size_b * random.between(0.5, 1)};
    if (kind != Kind::balls) a = box(setting.size_a);
    if (kind == Kind::boxes || kind == Kind::turned_boxes) b = box(setting.size_b);
    auto e = encounter<Degree>(random, setting, a, b);
    if (kind == Kind::turned_boxes) {
      for (auto* body : {&e.a, &e.b}) {
        body->orientation = random_orientation(random);
      }
    }
    compare(e, setting, errors);
  }
  tell(csv, "%s,%d,%s,%d,%d,%d,%.3g,%.3g,%.3g,%.3g\n", name(kind), Degree, setting.name.c_str(), errors.contacts,
       errors.wrong, errors.not_first, errors.least_ulps, errors.most_ulps, errors.most_seconds, errors.most_roundings);
  return errors.wrong == 0 && (kind == Kind::turned_boxes || errors.not_first == 0);
}

template <int Degree>
bool measure_meshes(const char* what, const std::shared_ptr<const kds::collision::Mesh>& mesh, const Setting& setting,
                    int pairs, std::ofstream& csv) {
  EarlyContacts errors;
  for (int seed = 1; seed <= pairs; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    auto e = encounter<Degree>(random, setting, MeshShape{mesh, setting.size_a * random.between(0.4, 0.8)},
                               MeshShape{mesh, setting.size_b * random.between(0.4, 0.8)});
    for (auto* body : {&e.a, &e.b}) {
      body->orientation = random_orientation(random);
    }
    compare(e, setting, errors);
  }
  tell(csv, "%s,%d,%s,%d,%d,%d,%d,%.4f,%.3g,%.3g,%.4f\n", what, Degree, setting.name.c_str(), errors.contacts,
       errors.missed, errors.near_misses, errors.late, errors.most_of_gap, errors.gap_over_size, errors.most_seconds,
       errors.most_of_bound);
  return errors.missed == 0 && errors.late == 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  const int pairs = argc > 2 ? std::atoi(argv[2]) : 300;
  try {
    if (pairs < 10) throw std::runtime_error("usage: bench_far [DIRECTORY [PAIRS]], at least 10 pairs");
    bool right = true;
    auto far = open_csv(folder, "far.csv");
    tell(far, "%s", "shapes,degree,setting,contacts,wrong,not_first_double,least_ulps,most_ulps,most_seconds,"
                    "most_roundings\n");
    for (const Setting& setting : settings()) {
      for (const Kind kind : {Kind::balls, Kind::box_and_ball, Kind::boxes}) {
        right &= measure<1>(kind, setting, pairs, far);
        right &= measure<2>(kind, setting, pairs / 3, far);
      }
      right &= measure<1>(Kind::turned_boxes, setting, pairs / 10, far);
    }
    auto meshes = open_csv(folder, "meshes.csv");
    tell(meshes, "%s", "mesh,degree,setting,contacts,missed,near_misses,late,most_of_gap,gap_over_size,"
                       "most_seconds_early,most_of_bound\n");
    const auto cube = kds::collision::samples::cuboid();
    const auto ring = kds::collision::samples::torus(8, 4);
    for (const Setting& setting : settings()) {
      right &= measure_meshes<1>("cubes of 12 triangles", cube, setting, pairs, meshes);
      right &= measure_meshes<2>("cubes of 12 triangles", cube, setting, pairs / 10, meshes);
      right &= measure_meshes<1>("rings of 64 triangles", ring, setting, pairs / 10, meshes);
    }
    if (!right) std::fputs("bench_far: a law is broken, see above\n", stderr);
    return right ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_far: %s\n", error.what());
    return 1;
  }
}
