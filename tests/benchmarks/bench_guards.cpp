// What exactness costs: kinetic lists on certified failure times against the same lists on bare doubles.
//
//     bench_guards [ROUNDS]     default 15; writes CSV to the standard output
//
// The lists are made of a rule, since the tuned one has no other solver. They are those of kinetic sweep and prune: the
// interval ends of 1 000 boxes at 1 % density on three axes, one second of free flight, straight or curved, all motions
// written about one time or each about its own (as after an impact). Both kinds run in turn, round by round; a ratio is
// the median over the rounds. The rungs of the sign ladder are counted in the certified run.

#include "kds/simulator.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/structures/rule_list.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

using namespace kds;
using kds::tests::Random;

/// What one would write first: closed forms in doubles, nothing checked. It claims to be certified so that structures
/// trust it as they trust the certified one.
struct BareSolver {
  static constexpr bool certified = true;

  template <Certificate C>
  double operator()(const C& certificate, double now, double horizon) const {
    return solve(certificate.template polynomial<double>(now), now, horizon);
  }

  template <Certificate C>
  double after_turn(const C& certificate, double now, double horizon) const {
    if constexpr (C::degree == 1) return never;
    auto p = certificate.template polynomial<double>(now);
    p.c[0] = 0;  // They are at one place.
    return solve(p, now, horizon);
  }

 private:
  static double solve(const Polynomial<1>& p, double now, double horizon) {
    if (!(p.c[1] < 0)) return never;
    const double t = now - p.c[0] / p.c[1];
    return t <= horizon ? t : never;
  }

  static double solve(const Polynomial<2>& p, double now, double horizon) {
    const auto [c, b, a] = p.c;
    if (a == 0) return solve(Polynomial<1>{{c, b}}, now, horizon);
    const double discriminant = b * b - 4 * a * c;
    if (a > 0 && (b >= 0 || discriminant <= 0)) return never;
    const double root = std::sqrt(std::max(discriminant, 0.0));
    const double t = now + (b > 0 ? (-b - root) / (2 * a) : 2 * c / (root - b));
    return t <= horizon ? t : never;
  }
};

/// Reads what kinetic sweep and prune reads at a swap: whether the ends are of different kinds.
struct EndListener {
  std::uint64_t* meetings;
  void swapped(std::uint32_t left, std::uint32_t right, double) { *meetings += (left ^ right) & 1; }
  static std::uint32_t rank(std::uint32_t id) { return ~id & 1; }
};

template <int Degree>
using Scene = std::array<std::vector<std::pair<Motion<Degree>, std::uint32_t>>, 3>;

template <int Degree>
Scene<Degree> make_scene(std::uint64_t seed, std::uint32_t bodies, bool own_starts) {
  Random random(seed);
  const double side = std::cbrt(4.19 * bodies / 0.01);
  Scene<Degree> scene;
  for (std::uint32_t id = 0; id < bodies; ++id) {
    const double radius = random.between(0.5, 1.5);
    const double start = own_starts ? -random.unit() : 0;
    for (auto& axis : scene) {
      Motion<Degree> centre;
      centre.start = start;
      centre.position.c[0] = random.between(0, side);
      centre.position.c[1] = random.between(-1, 1);
      if constexpr (Degree >= 2) centre.position.c[2] = random.between(-1, 1);
      for (const bool upper : {false, true}) {
        Motion<Degree> end = centre;
        end.position.c[0] += upper ? radius : -radius;
        axis.emplace_back(end, 2 * id + upper);
      }
    }
  }
  return scene;
}

struct Result {
  double seconds = 0;
  Counters counters;
  std::uint64_t meetings = 0;
};

template <int Degree, class Solver>
Result run(const Scene<Degree>& scene) {
  Result result;
  using List = tests::RuleList<Degree, EndListener, DefaultEventQueue, Solver>;
  std::array<List, 3> lists{List(EndListener{&result.meetings}), List(EndListener{&result.meetings}),
                            List(EndListener{&result.meetings})};
  for (std::size_t d = 0; d < 3; ++d) {
    std::vector<typename List::Entry> entries;
    for (const auto& [motion, id] : scene[d]) entries.push_back({motion, id});
    lists[d].assign(entries, 0);
  }
  Simulator simulator(0, lists[0], lists[1], lists[2]);
  const double start = kds::benchmarks::thread_seconds();
  simulator.advance_to(1);
  result.seconds = kds::benchmarks::thread_seconds() - start;
  result.counters = simulator.counters();
  return result;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

template <int Degree>
void compare(const char* name, int rounds, bool own_starts) {
  const auto scene = make_scene<Degree>(1, 1000, own_starts);
  std::vector<double> certified, bare, ratio;
  Result exact, naive;
  sign_counters = {};
  run<Degree, CertifiedSolver>(scene);
  const SignCounters rungs = sign_counters;
  for (int i = 0; i < rounds; ++i) {
    exact = run<Degree, CertifiedSolver>(scene);
    naive = run<Degree, BareSolver>(scene);
    certified.push_back(1e9 * exact.seconds / static_cast<double>(exact.counters.events));
    bare.push_back(1e9 * naive.seconds / static_cast<double>(naive.counters.events));
    ratio.push_back(certified.back() / bare.back());
  }
  const auto certificates = static_cast<double>(exact.counters.certificates);
  std::printf("%s,%llu,%.0f,%.1f,%.1f,%.3f,%.2g,%.2g\n", name, static_cast<unsigned long long>(exact.counters.events),
              certificates, median(certified), median(bare), median(ratio),
              static_cast<double>(rungs.extended) / certificates, static_cast<double>(rungs.exact) / certificates);
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 15;
  if (rounds < 1) return std::fputs("usage: bench_guards [ROUNDS]\n", stderr), 2;
  std::puts(
      "motion,swaps,certificates,certified_ns_per_swap,bare_ns_per_swap,ratio,extended_per_certificate,"
      "exact_per_certificate");
  for (const bool own_starts : {false, true}) {
    compare<1>(own_starts ? "linear from own starts" : "linear", rounds, own_starts);
    compare<2>(own_starts ? "quadratic from own starts" : "quadratic", rounds, own_starts);
  }
}
