// Vertex-face and edge-edge contact: time against error, for queries of many kinds or those of a folder of files.
//
//   bench_features [--queries N]   N generated queries of each kind (default 50000), truth by exact arithmetic
//   bench_features FOLDER          the files of the published benchmark (features/query_files.hpp)
//
// Times are CPU times of this thread, all contenders one after the other on each block of queries, the best of five.
#include "certificates/features/feature_contact.hpp"
#include "tests/benchmarks/features/conservative_advancement.hpp"
#include "tests/benchmarks/features/cubic_solver.hpp"
#include "tests/benchmarks/features/query_files.hpp"
#include "tests/certificates/exact_features.hpp"
#include "tests/certificates/feature_queries.hpp"
#include "tests/benchmarks/thread_time.hpp"

#include <chrono>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace kds;
using namespace kds::tests;
using namespace kds::benchmarks;
using certificates::FeatureContact;
using certificates::FeatureContactStatus;
using Eigen::Vector3d;

struct Truth {
  bool touches;
  std::optional<oracle::Instant> time;  // empty for queries from files
};

struct Answer {
  bool hit;
  double time;
};

struct Contender {
  const char* name;
  std::function<Answer(const StepQuery&)> answer;
};

FeatureContact library(const StepQuery& q) {
  return q.kind == Features::vertex_face ? certificates::vertex_face_contact(q.ends[0], q.ends[1])
                                         : certificates::edge_edge_contact(q.ends[0], q.ends[1]);
}

std::array<certificates::PointMotion<2>, 4> parabolas(const StepQuery& q) {
  std::array<certificates::PointMotion<2>, 4> p;
  for (std::size_t k = 0; k < 4; ++k) {
    p[k].coefficients = {q.ends[0][k], q.ends[1][k] - q.ends[0][k], Vector3d::Zero()};
  }
  return p;
}

const std::vector<Contender>& contenders() {
  static const std::vector<Contender> all{
      {"cubic roots, plain doubles",
       [](const StepQuery& q) {
         const auto t = CubicSolver::first_contact(q.kind, q.ends[0], q.ends[1]);
         return Answer{t.has_value(), t.value_or(0)};
       }},
      {"conservative advancement",
       [](const StepQuery& q) {
         const auto t = ConservativeAdvancement::first_contact(q.kind, q.ends[0], q.ends[1]);
         return Answer{t.has_value(), t.value_or(0)};
       }},
      {"kinetic separating axis",
       [](const StepQuery& q) {
         const auto r = library(q);
         return Answer{bool(r), r.time};
       }},
      {"the same, as parabolas",
       [](const StepQuery& q) {
         const auto p = parabolas(q);
         const auto r = q.kind == Features::vertex_face
                            ? certificates::vertex_face_contact(p[0], p[1], p[2], p[3], 0, 1)
                            : certificates::edge_edge_contact(p[0], p[1], p[2], p[3], 0, 1);
         return Answer{bool(r), r.time};
       }},
  };
  return all;
}

std::array<Path, 4> exact_paths(const StepQuery& q) {
  std::array<Path, 4> paths;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t d = 0; d < 3; ++d) {
      const auto begin = oracle::rational(q.ends[0][k][static_cast<int>(d)]);
      paths[k][d] = oracle::Polynomial({begin, oracle::rational(q.ends[1][k][static_cast<int>(d)]) - begin});
    }
  }
  return paths;
}

volatile int sink;

/// Mean nanoseconds of each contender on these queries.
std::vector<double> mean_times(const std::vector<const StepQuery*>& queries) {
  constexpr std::size_t block = 512;
  std::vector<double> sums(contenders().size(), 0);
  for (std::size_t from = 0; from < queries.size(); from += block) {
    const std::size_t to = std::min(queries.size(), from + block);
    std::vector<double> best(contenders().size(), std::numeric_limits<double>::infinity());
    for (int round = 0; round < 5; ++round) {
      for (std::size_t c = 0; c < contenders().size(); ++c) {
        const auto& answer = contenders()[c].answer;
        const double start = thread_seconds();
        int hits = 0;
        for (std::size_t i = from; i < to; ++i) hits += answer(*queries[i]).hit;
        sink = hits;
        best[c] = std::min(best[c], thread_seconds() - start);
      }
    }
    for (std::size_t c = 0; c < best.size(); ++c) sums[c] += best[c];
  }
  for (double& s : sums) s *= 1e9 / static_cast<double>(queries.size());
  return sums;
}

/// Nanoseconds of each query by itself: the best of five, less what reading the clock takes.
std::vector<double> single_times(const std::vector<const StepQuery*>& queries, const Contender& contender) {
  using Clock = std::chrono::steady_clock;
  const auto time = [](const auto& work) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 5; ++i) {
      const auto start = Clock::now();
      work();
      best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - start).count());
    }
    return best;
  };
  double overhead = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1000; ++i) overhead = std::min(overhead, time([] {}));
  std::vector<double> times;
  for (const auto* q : queries)
    times.push_back(std::max(0.0, time([&] { sink = contender.answer(*q).hit; }) - overhead));
  std::sort(times.begin(), times.end());
  return times;
}

struct Errors {
  int missed = 0, false_hits = 0, late = 0;
};

void report(const char* title, const std::vector<StepQuery>& queries, const std::vector<Truth>& truths, Features kind) {
  std::vector<const StepQuery*> chosen;
  std::vector<Errors> errors(contenders().size());
  int touching = 0, certified = 0, steps = 0, most_steps = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (queries[i].kind != kind) continue;
    chosen.push_back(&queries[i]);
    touching += truths[i].touches;
    const auto mine = library(queries[i]);
    certified += mine.status == FeatureContactStatus::contact;
    steps += mine.steps;
    most_steps = std::max(most_steps, mine.steps);
    for (std::size_t c = 0; c < contenders().size(); ++c) {
      const Answer a = contenders()[c].answer(queries[i]);
      errors[c].missed += truths[i].touches && !a.hit;
      errors[c].false_hits += !truths[i].touches && a.hit;
      errors[c].late += a.hit && truths[i].time && truths[i].time->compare(oracle::rational(a.time)) < 0;
    }
  }
  if (chosen.empty()) return;
  std::printf("\n%s, %s: %zu queries, %d touch (%d certified); %.2f steps, at most %d\n", title,
              kind == Features::vertex_face ? "vertex and face" : "edge and edge", chosen.size(), touching, certified,
              steps / static_cast<double>(chosen.size()), most_steps);
  std::printf("%-28s %9s %7s %9s %9s %9s %9s %8s %8s %8s\n", "", "mean ns", "ratio", "median", "99 %", "99.9 %", "max",
              "missed", "false", "late");
  const auto means = mean_times(chosen);
  for (std::size_t c = 0; c < contenders().size(); ++c) {
    const auto times = single_times(chosen, contenders()[c]);
    const auto at = [&](double share) {
      return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
    };
    std::printf("%-28s %9.1f %7.2f %9.0f %9.0f %9.0f %9.0f %8d %8d %8d\n", contenders()[c].name, means[c],
                means[c] / means[0], at(0.5), at(0.99), at(0.999), times.back(), errors[c].missed, errors[c].false_hits,
                errors[c].late);
  }
}

/// The library by kind of query: where its time goes.
void by_encounter(const std::vector<StepQuery>& queries) {
  std::printf("\nkinetic separating axis by kind of query: mean ns (mean steps, most steps)\n");
  for (int i = 0; i < encounters; ++i) {
    std::printf("%-16s", name(static_cast<Encounter>(i)));
    for (const auto kind : {Features::vertex_face, Features::edge_edge}) {
      std::vector<const StepQuery*> chosen;
      int steps = 0, most = 0;
      for (const auto& q : queries) {
        if (q.kind != kind || std::string(q.family) != name(static_cast<Encounter>(i))) continue;
        chosen.push_back(&q);
        const int n = library(q).steps;
        steps += n;
        most = std::max(most, n);
      }
      if (chosen.empty()) continue;
      std::printf("  %s %7.1f (%5.2f, %3d)", kind == Features::vertex_face ? "vertex-face" : "edge-edge",
                  mean_times(chosen)[2], steps / static_cast<double>(chosen.size()), most);
    }
    std::printf("\n");
  }
}

std::vector<StepQuery> generated(int n) {
  std::vector<StepQuery> queries;
  const double scales[] = {1, 1e-6, 1e-3, 1e3, 1e6};
  for (int s = 0; s < 5; ++s) {
    FeatureQueries make(static_cast<std::uint64_t>(s + 1), 0, scales[s], s % 2 == 0 ? 0 : 1e6 * scales[s]);
    for (int i = 0; i < n / 5; ++i) {
      const auto encounter = static_cast<Encounter>(i % encounters);
      for (const auto kind : {Features::vertex_face, Features::edge_edge}) {
        queries.push_back({kind, ends(make(encounter, kind)), {}, name(encounter)});
      }
    }
  }
  return queries;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string first = argc > 1 ? argv[1] : "";
  const bool files = !first.empty() && first != "--queries";
  std::vector<StepQuery> queries;
  if (files) {
    std::size_t left_out = 0;
    queries = read_queries(first, left_out);
    std::printf("%zu queries read, %zu left out (coordinates that are no doubles)\n", queries.size(), left_out);
  } else {
    queries = generated(argc > 2 ? std::stoi(argv[2]) : 50000);
  }
  std::vector<Truth> truths;
  for (const auto& q : queries) {
    if (q.touches) {
      truths.push_back({*q.touches, {}});
    } else {
      auto time = ExactFeatures(q.kind, exact_paths(q)).first_touch(0, 1);
      truths.push_back({time.has_value(), std::move(time)});
    }
  }
  for (const auto kind : {Features::vertex_face, Features::edge_edge}) {
    report(files ? "files" : "all kinds, scales 1e-6 ... 1e6", queries, truths, kind);
  }
  if (files) return 0;
  std::vector<StepQuery> plain;
  std::vector<Truth> plain_truths;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (std::string(queries[i].family) != "random" && std::string(queries[i].family) != "inside") continue;
    plain.push_back(queries[i]);
    plain_truths.push_back(truths[i]);
  }
  for (const auto kind : {Features::vertex_face, Features::edge_edge}) {
    report("random or inside", plain, plain_truths, kind);
  }
  by_encounter(queries);
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_features: %s\n", e.what());
  return 1;
}
