// What it costs to write events apart, and to merge the parts.
//
//     bench_event_parts [DIRECTORY [EVENTS]]      -> event_parts.csv; 4 000 000 events, 600 MB, unless given
//
// Events of balls, drawn at random: 64 domains of 16 processes, steps of 100 000 events, of which one of eight is of
// two domains. Seconds of CPU time of one thread, an event of the scene; files are in DIRECTORY while it runs.

#include "io/event_csv.hpp"
#include "io/event_parts.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using namespace kds::io;
using kds::benchmarks::tell;
using kds::benchmarks::thread_seconds;
using kds::collision::DomainEvent;
using kds::collision::StepEvents;

constexpr std::size_t domains = 64, processes = 16, bodies = 100'000, events_in_step = 100'000;

/// What each process has recorded in a step that begins at t.
std::vector<StepEvents> step_at(double t, kds::tests::Random& random) {
  std::vector<std::vector<DomainEvent>> logs(domains);
  const auto vector = [&] { return Eigen::Vector3d(random.between(0, 1), random.between(0, 1), random.between(0, 1)); };
  for (std::size_t i = 0; i < events_in_step; ++i) {
    const auto a = static_cast<std::uint32_t>(random.below(bodies - 1));
    DomainEvent event{
        DomainEvent::Kind::contact, DomainEvent::nobody, a, a + 1, {.time = t, .point = vector(), .normal = vector()}};
    t += random.between(0, 1e-6);
    const std::size_t domain = random.below(domains), other = random.below(domains);
    const bool shared = other != domain && random.below(8) == 0;
    if (shared) event.other_owner = static_cast<decltype(event.other_owner)>(other);
    logs[domain].push_back(event);
    if (!shared) continue;
    event.other_owner = static_cast<decltype(event.other_owner)>(domain);
    logs[other].push_back(event);
  }
  std::vector<StepEvents> steps;
  constexpr std::size_t each = domains / processes;
  for (std::size_t rank = 0; rank < processes; ++rank) {
    auto& step = steps.emplace_back(StepEvents{.domains = domains, .first = rank * each});
    for (std::size_t i = 0; i < each; ++i) step.logs.push_back(std::move(logs[rank * each + i]));
  }
  return steps;
}

/// Seconds of this thread.
template <class Work>
double seconds(const Work& work) {
  const double begin = thread_seconds();
  work();
  return thread_seconds() - begin;
}

struct Count final : EventSink {
  void on_event(const Event&) override { ++events; }
  std::size_t events = 0;
};

void measure(const std::filesystem::path& folder, std::size_t events) {
  Scene scene;
  scene.bodies.resize(bodies);
  for (std::size_t i = 0; i < bodies; ++i) scene.bodies[i].name = 'b' + std::to_string(i);
  const std::string file = (folder / "event_parts.events").string();
  std::vector<std::vector<StepEvents>> steps;
  kds::tests::Random random(1);
  for (std::size_t i = 0; i * events_in_step < events; ++i) steps.push_back(step_at(static_cast<double>(i), random));
  const double n = static_cast<double>(steps.size() * events_in_step);

  std::uintmax_t bytes = 0;
  const double write = seconds([&] {
    for (std::size_t rank = 0; rank < processes; ++rank) {
      EventPart part(part_path(file, rank), {1, bodies, 1, rank, processes});
      for (const auto& step : steps) part.on_step(step[rank]);
      part.close(), part.commit();
    }
  });
  for (std::size_t rank = 0; rank < processes; ++rank) bytes += std::filesystem::file_size(part_path(file, rank));

  const double read = seconds([&] {
    EventParts parts(file, 1, bodies);
    EventParts::Stretch stretch;
    while (parts.read(stretch)) continue;
  });
  Count count;
  const double merge = seconds([&] {
    EventParts parts(file, 1, bodies);
    EventParts::Stretch stretch;
    while (parts.read(stretch)) stretch.tell(count);
  });
  const double as_csv = seconds([&] {
    OutputFile output(file);
    EventParts parts(file, 1, bodies);
    merge_as_csv(parts, scene, 1, [&](std::string_view lines) { output.write(lines); });
    output.commit();
  });
  const double csv_bytes = static_cast<double>(std::filesystem::file_size(file));
  for (std::size_t rank = 0; rank < processes; ++rank) std::filesystem::remove(part_path(file, rank));
  std::filesystem::remove(file);
  if (static_cast<double>(count.events) != n) throw std::runtime_error("events are missing");

  std::ofstream csv = kds::benchmarks::open_csv(folder, "event_parts.csv");
  tell(csv, "events,bytes_an_event,csv_bytes_an_event,write_ns,read_ns,read_and_merge_ns,read_merge_and_csv_ns\n");
  const auto ns = [&](double time) { return time * 1e9 / n; };
  tell(csv, "%.0f,%.1f,%.1f,%.0f,%.0f,%.0f,%.0f\n", n, static_cast<double>(bytes) / n, csv_bytes / n, ns(write),
       ns(read), ns(merge), ns(as_csv));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    measure(argc > 1 ? argv[1] : ".", argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 4'000'000);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_event_parts: %s\n", error.what());
    return 1;
  }
}
