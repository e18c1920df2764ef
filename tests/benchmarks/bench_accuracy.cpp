// Error against run time: the event-driven engine and sampling at 30 ... 16 000 Hz.
//
//     bench_accuracy [DIRECTORY [ROUNDS [BODIES]]]      -> DIRECTORY/accuracy.csv; 3 rounds, 1 000 bodies
//
// Bodies pass through each other in open space, so the truth is one list of contacts: the engine's, which is accepted
// only if testing all pairs gives the same bits, and if each contact looked at is that of exact rational arithmetic.
// Every report of a sampler must lie in a contact of that list (column `phantom`), so a contact that the engine missed
// would show. Methods are measured in turn, on this thread's clock; the median of the rounds is told. Columns: times in
// s, depths in units of length (bounding radii are 0.5-1.5, but in `bullets`).

#include "tests/support/exact_bodies.hpp"
#include "tests/benchmarks/accuracy/exact_mesh.hpp"
#include "tests/benchmarks/accuracy/methods.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace accuracy;
using kds::collision::BroadPhaseKind;

constexpr std::array rates{30.0, 60.0, 120.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0, 16000.0};

/// The engine's own error: of times against exact arithmetic.
struct ExactCheck {
  std::size_t looked_at = 0;
  double mean = 0, max = 0;  ///< s
};

/// Spheres and boxes. Throws if a sphere's contact is not the first double after the true root.
template <int Degree>
ExactCheck check_exactly(const Scene<Degree>& scene, const std::vector<TrueContact>& truth) {
  constexpr std::size_t most_balls = 2000;
  constexpr std::size_t most_boxes = 60;  // about 50 ms each
  const bool balls = std::holds_alternative<Sphere>(scene.bodies[0].shape);
  const std::size_t step = truth.size() / (balls ? most_balls : most_boxes) + 1;
  ExactCheck check;
  for (std::size_t i = 0; i < truth.size(); i += step) {
    const TrueContact& c = truth[i];
    const auto root =
        oracle::first_contact(oracle::exact_body(scene.bodies[c.a]), oracle::exact_body(scene.bodies[c.b]), 0);
    if (!root) throw std::runtime_error(scene.name + ": exact arithmetic knows no such contact");
    if (balls && root->ceiling() != c.begin) throw std::runtime_error(scene.name + ": not the first double");
    root->narrow(120);
    const double error = std::abs(oracle::approximate(oracle::rational(c.begin) - root->low()));
    ++check.looked_at;
    check.mean += error;
    check.max = std::max(check.max, error);
  }
  check.mean /= static_cast<double>(std::max<std::size_t>(check.looked_at, 1));
  return check;
}

/// Meshes on straight paths. Throws if a contact is late.
template <int Degree>
ExactCheck check_meshes_exactly(const Scene<Degree>& scene, const std::vector<TrueContact>& truth) {
  constexpr std::size_t most = 60;  // about 50 ms each
  ExactCheck check;
  if constexpr (Degree == 1) {
    for (std::size_t i = 0; i < truth.size(); i += truth.size() / most + 1) {
      const TrueContact& c = truth[i];
      const auto& a = scene.bodies[c.a];
      const auto& b = scene.bodies[c.b];
      const auto root = first_touch(ExactMesh(a), ExactMesh(b), a.motion[0], b.motion[0], 0);
      if (!root) throw std::runtime_error(scene.name + ": exact arithmetic knows no such contact");
      if (*root < oracle::rational(c.begin)) throw std::runtime_error(scene.name + ": a late contact");
      const double early = oracle::approximate(*root - oracle::rational(c.begin));
      ++check.looked_at;
      check.mean += early;
      check.max = std::max(check.max, early);
    }
  }
  check.mean /= static_cast<double>(std::max<std::size_t>(check.looked_at, 1));
  return check;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

constexpr double long_run = 1;  // CPU s; runs that take longer are made once

struct Times {
  std::vector<double> setup, run;
};

template <int Degree>
void measure(const Scene<Degree>& scene, int rounds, std::ofstream& csv) {
  Outcome outcome, other;
  const auto truth = run_world(scene, BroadPhaseKind::automatic, 0, outcome);
  if (run_world(scene, BroadPhaseKind::all_pairs, 0, other) != truth) {
    throw std::runtime_error(scene.name + ": all pairs give other contacts");
  }
  const bool mesh = std::holds_alternative<kds::collision::MeshShape>(scene.bodies[0].shape);
  const ExactCheck exact = mesh ? check_meshes_exactly(scene, truth) : check_exactly(scene, truth);
  std::printf("\n%s: %s; %zu bodies, %g s, %zu contacts; the engine's error of time: mean %.2g s, max %.2g s "
              "(%zu looked at)\n",
              scene.name.c_str(), scene.what.c_str(), scene.bodies.size(), scene.end_time, truth.size(), exact.mean,
              exact.max, exact.looked_at);

  std::vector<std::pair<Method, double>> runs{{Method::event_driven, 0}};
  for (const Method method : {Method::swept, Method::polling, Method::discrete}) {
    for (const double rate : rates) runs.emplace_back(method, rate);
  }
  std::vector<Times> times(runs.size());
  std::vector<Errors> errors(runs.size());
  const auto shapes = placed_shapes(scene);
  const auto paths = motions(scene);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (round > 0 && times[i].run[0] * scene.end_time > long_run) continue;
      const Outcome result = run(scene, runs[i].first, runs[i].second);
      times[i].setup.push_back(result.setup);
      times[i].run.push_back(result.run / scene.end_time);
      if (round == 0) errors[i] = compare<Degree>(truth, result.reports, shapes, paths);
    }
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto& [method, rate] = runs[i];
    Errors& e = errors[i];
    if (method == Method::event_driven || method == Method::swept) {
      if (e.missed > 0 || e.time_max > 0) throw std::runtime_error("an exact method differs from the truth");
      e.time_mean = exact.mean;
      e.time_max = e.time_p99 = exact.max;
    }
    char line[400];
    std::snprintf(line, sizeof line, "%s,%s,%g,%.6g,%.6g,%zu,%zu,%.6f,%zu,%.4g,%.4g,%.4g,%.4g,%.4g\n",
                  scene.name.c_str(), name(method), rate, median(times[i].run), median(times[i].setup), e.contacts,
                  e.missed, static_cast<double>(e.missed) / static_cast<double>(e.contacts), e.phantom, e.time_mean,
                  e.time_p99, e.time_max, e.depth_mean, e.depth_max);
    csv << line << std::flush;
    std::fputs(line, stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 3;
  const auto bodies = static_cast<std::size_t>(argc > 3 ? std::atoi(argv[3]) : 1000);
  try {
    if (rounds < 1 || bodies < 10) throw std::runtime_error("usage: bench_accuracy [DIRECTORY [ROUNDS [BODIES]]]");
    std::filesystem::create_directories(folder);
    std::ofstream csv(folder / "accuracy.csv");
    if (!csv) throw std::runtime_error("cannot write " + (folder / "accuracy.csv").string());
    csv << "scene,method,rate,cpu_per_sim_second,setup_cpu,contacts,missed,missed_share,phantom,time_mean,time_p99,"
           "time_max,depth_mean,depth_max\n";
    const auto make = [&](const char* kind, double density) {
      return kds_collide::GeneratorOptions{
          .kind = kind, .bodies = bodies, .density = density, .seed = 1, .end_time = 2};
    };
    measure(generated<1>("spheres-1", "balls, 1 %", make("spheres", 0.01)), rounds, csv);
    measure(generated<1>("spheres-10", "balls, 10 %", make("spheres", 0.1)), rounds, csv);
    measure(generated<1>("boxes-10", "turned boxes, 10 %", make("boxes", 0.1)), rounds, csv);
    auto rings = make("rings", 0.1);
    rings.end_time = 1;
    measure(generated<1>("rings-10", "rings of 64 triangles, 10 %", rings), rounds, csv);
    measure(bullets(bodies, 1), rounds, csv);
    measure(curved(bodies, 0.01, 1), rounds, csv);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_accuracy: %s\n", error.what());
    return 1;
  }
}
