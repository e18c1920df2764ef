// What a swap of the kinetic lists costs, and what listing fewer axes saves.
//
//     bench_swaps [ROUNDS]     default 7; writes CSV to the standard output
//
// Boxes of sizes 1-3 at 1 % density in free flight for one second, by number and by listed axes. Rounds run in turn, so
// that a change of the machine's pace hits all alike; figures are medians. `baseline` is the time against three lists
// of the same scene in the same round. Instructions are those of this thread in user mode, where the kernel counts them
// (perf_event_open), else the column is empty. Reference cycles (x86 alone) are ticks of the time-stamp counter: its
// rate is one whatever the clock's, and it goes on while others have the processor, so they are the least of the
// rounds. Every round checks that all ways report the same pairs at the same times.

#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/support/random_numbers.hpp"

#ifdef __x86_64__
#include <x86intrin.h>
#endif
#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace {

using namespace kds;
using namespace kds::collision;
using kds::tests::Random;

/// Counts this thread's instructions in user mode; says nothing where that is not possible.
class Instructions {
 public:
  Instructions() {
    perf_event_attr attributes;
    std::memset(&attributes, 0, sizeof attributes);
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.size = sizeof attributes;
    attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    file_ = static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
  }
  ~Instructions() {
    if (file_ >= 0) close(file_);
  }
  Instructions(const Instructions&) = delete;
  Instructions& operator=(const Instructions&) = delete;

  bool known() const { return file_ >= 0; }
  double now() const {
    std::uint64_t count = 0;
    return known() && read(file_, &count, sizeof count) == sizeof count ? static_cast<double>(count) : 0;
  }

 private:
  int file_ = -1;
};

#ifdef __x86_64__
constexpr bool ticks_known = true;
double ticks() { return static_cast<double>(__rdtsc()); }
#else
constexpr bool ticks_known = false;
double ticks() { return 0; }
#endif

std::vector<KineticBox<1>> make_scene(std::size_t bodies) {
  Random random(1);
  const double side = std::cbrt(4.19 * static_cast<double>(bodies) / 0.01);
  std::vector<KineticBox<1>> boxes;
  for (std::size_t i = 0; i < bodies; ++i) {
    certificates::PointMotion<1> centre;
    for (int d = 0; d < 3; ++d) {
      centre.coefficients[0][d] = random.between(0, side);
      centre.coefficients[1][d] = random.between(-1, 1);
    }
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(random.between(0.5, 1.5));
    boxes.push_back(box_around(centre, -half, half));
  }
  return boxes;
}

struct Report {
  double time;
  BodySlot a, b;
  bool began;
  friend bool operator==(const Report&, const Report&) = default;
};

struct Log final : PairListener {
  std::vector<Report> reports;
  void pair_began(BodySlot a, BodySlot b, double t) override { reports.push_back({t, a, b, true}); }
  void pair_ended(BodySlot a, BodySlot b, double t) override { reports.push_back({t, a, b, false}); }
};

struct Result {
  double setup = 0, run = 0, instructions = 0, ticks = 0;
  BroadPhaseCounters work;
  Log log;
};

Result run(const std::vector<KineticBox<1>>& boxes, ListedAxes listed, const Instructions& instructions) {
  Result result;
  const double begin = benchmarks::thread_seconds();
  KineticSweepAndPrune<1> broad_phase(0, {.listed = listed});
  broad_phase.extend_horizon(0, 1);
  std::vector<KineticSweepAndPrune<1>::Entry> entries;
  for (std::size_t i = 0; i < boxes.size(); ++i) entries.push_back({static_cast<BodySlot>(i), &boxes[i]});
  broad_phase.insert(entries, 0, result.log);
  const double start = benchmarks::thread_seconds();
  const double before = instructions.now();
  const double first_tick = ticks();
  while (broad_phase.advance(1, result.log)) {
  }
  result.ticks = ticks() - first_tick;
  result.instructions = instructions.now() - before;
  const double end = benchmarks::thread_seconds();
  result.setup = start - begin;
  result.run = end - start;
  result.work = broad_phase.counters();
  return result;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// False where two ways disagree.
bool measure(std::size_t bodies, int rounds, const Instructions& instructions) {
  const auto boxes = make_scene(bodies);
  constexpr std::array ways{ListedAxes::all, ListedAxes::one};
  struct Samples {
    std::vector<double> setup, run, whole, ratio, instructions, ticks;
  };
  std::array<Samples, ways.size()> samples;
  std::array<BroadPhaseCounters, ways.size()> work;
  for (int round = 0; round < rounds; ++round) {
    Result three;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      Result result = run(boxes, ways[i], instructions);
      samples[i].setup.push_back(result.setup);
      samples[i].run.push_back(result.run);
      samples[i].whole.push_back(result.setup + result.run);
      samples[i].instructions.push_back(result.instructions);
      samples[i].ticks.push_back(result.ticks);
      work[i] = result.work;
      if (i == 0)
        three = std::move(result);
      else if (result.log.reports != three.log.reports)
        return false;
      samples[i].ratio.push_back(samples[i].whole.back() / samples[0].whole.back());
    }
  }
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const auto swaps = static_cast<double>(work[i].swaps);
    std::printf("%zu,%d,%.0f,%.2f,%.1f,", bodies, ways[i] == ListedAxes::all ? 3 : 1, swaps,
                static_cast<double>(work[i].certificates) / swaps, 1e9 * median(samples[i].run) / swaps);
    if (instructions.known()) std::printf("%.0f", median(samples[i].instructions) / swaps);
    std::putchar(',');
    if (ticks_known) {
      std::printf("%.0f", *std::min_element(samples[i].ticks.begin(), samples[i].ticks.end()) / swaps);
    }
    std::printf(",%.6f,%.6f,%.3f\n", median(samples[i].setup), median(samples[i].whole), median(samples[i].ratio));
    std::fflush(stdout);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 7;
  if (rounds < 1) return std::fputs("usage: bench_swaps [ROUNDS]\n", stderr), 2;
  const Instructions instructions;
  std::puts(
      "bodies,listed_axes,swaps,certificates_per_swap,ns_per_swap,instructions_per_swap,reference_cycles_per_swap,"
      "setup_s,all_s,baseline");
  for (const std::size_t bodies : {1000, 4000, 16000}) {
    if (!measure(bodies, rounds, instructions)) {
      std::fputs("bench_swaps: the ways to list axes report different pairs\n", stderr);
      return 1;
    }
  }
}
