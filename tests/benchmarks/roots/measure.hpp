// Runs all contenders of a degree on one family: answers judged, time taken.
#pragma once

#include "tests/benchmarks/roots/cell.hpp"
#include "tests/benchmarks/roots/contenders.hpp"
#include "tests/benchmarks/thread_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace bench_roots {

using kds::benchmarks::thread_seconds;

struct Options {
  int polynomials = 300;  ///< a family and degree
  int rounds = 5;         ///< of timing; the median counts; 0 for answers only
  std::uint64_t seed = 1;
};

inline constexpr double never = std::numeric_limits<double>::infinity();

/// The horizon of a kind for a polynomial. Precondition: at the edge there is a crossing after now.
inline double draw_horizon(kds::tests::Random& random, const Truth& truth, Horizon kind) {
  if (kind == Horizon::infinite) return never;
  const int crossing = truth.first_failure(never);
  if (kind == Horizon::edge) {
    const double t = truth.roots[static_cast<std::size_t>(crossing)].ceiling();
    return std::nextafter(t, random.one_in(3) ? 0 : random.one_in(2) ? never : t);
  }
  double scale = 1;
  if (crossing >= 0) {
    scale = truth.roots[static_cast<std::size_t>(crossing)].high;
  } else if (!truth.roots.empty()) {
    scale = truth.roots.back().high;
  }
  if (scale == 0) scale = 1;
  constexpr std::array factors{0.25, 0.9, 1.1, 2.0, 100.0};
  return std::min(scale * factors[random.below(factors.size())], 1e308);
}

template <int Degree>
struct Questions {
  std::vector<kds::Polynomial<Degree>> polynomials;
  std::vector<double> horizons;
};

/// Nanoseconds a call of each entry: rounds in which all take their turn, so that a change of the machine's pace meets
/// all alike; the median of the rounds. Each turn is repeated until it is long against the resolution of the clock.
template <int Degree>
std::vector<double> time_calls(const std::vector<Entry<Degree>>& entries, const Questions<Degree>& questions,
                               int rounds) {
  constexpr double least_seconds = 1e-4;
  volatile double sink = 0;
  std::vector<int> repeats;
  for (const auto& entry : entries) {
    const double start = thread_seconds();
    sink = sink + entry.sum(questions.polynomials, questions.horizons);
    repeats.push_back(1 + static_cast<int>(std::min(least_seconds / (thread_seconds() - start), 999.0)));
  }
  std::vector<std::vector<double>> seconds(entries.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t turn = 0; turn < entries.size(); ++turn) {
      const std::size_t e = (turn + static_cast<std::size_t>(round)) % entries.size();
      const double start = thread_seconds();
      for (int i = 0; i < repeats[e]; ++i) sink = sink + entries[e].sum(questions.polynomials, questions.horizons);
      seconds[e].push_back((thread_seconds() - start) / repeats[e]);
    }
  }
  std::vector<double> nanoseconds;
  for (auto& times : seconds) {
    std::nth_element(times.begin(), times.begin() + rounds / 2, times.end());
    nanoseconds.push_back(1e9 * times[static_cast<std::size_t>(rounds / 2)] /
                          static_cast<double>(questions.polynomials.size()));
  }
  return nanoseconds;
}

template <int Degree>
std::vector<Cell> measure(const Family& family, const Options& options) {
  kds::tests::Random random(options.seed + 1000 * Degree);
  std::vector<kds::Polynomial<Degree>> polynomials;
  std::vector<Truth> truths;
  for (int i = 0; i < options.polynomials; ++i) {
    const Coefficients c = family.draw(random, Degree);
    kds::Polynomial<Degree> p;
    std::copy(c.begin(), c.end(), p.c.begin());
    polynomials.push_back(p);
    truths.push_back(exact_truth(c));
  }

  const auto contenders = entries<Degree>();
  std::vector<Cell> cells;
  for (const Horizon kind : {Horizon::infinite, Horizon::finite, Horizon::edge}) {
    Questions<Degree> questions;
    std::vector<const Truth*> asked;
    for (std::size_t i = 0; i < polynomials.size(); ++i) {
      if (kind == Horizon::edge && truths[i].first_failure(never) < 0) continue;
      questions.polynomials.push_back(polynomials[i]);
      questions.horizons.push_back(draw_horizon(random, truths[i], kind));
      asked.push_back(&truths[i]);
    }
    if (asked.empty()) continue;
    std::vector<double> times(contenders.size(), 0);
    if (kind != Horizon::edge && options.rounds > 0) times = time_calls(contenders, questions, options.rounds);
    for (std::size_t e = 0; e < contenders.size(); ++e) {
      Cell cell{Degree, &family, kind, contenders[e].name, contenders[e].certified, {}, times[e]};
      for (std::size_t i = 0; i < asked.size(); ++i) {
        const double horizon = questions.horizons[i];
        const auto& p = questions.polynomials[i];
        const double answer = contenders[e].answer(p, horizon);
        if (contenders[e].enclosure) {
          const Enclosure enclosure = contenders[e].enclosure(p, horizon);
          cell.tally.add(judge(*asked[i], horizon, answer, enclosure.lower, enclosure.upper));
        } else {
          cell.tally.add(judge(*asked[i], horizon, answer));
        }
      }
      cells.push_back(std::move(cell));
    }
  }
  return cells;
}

}  // namespace bench_roots
