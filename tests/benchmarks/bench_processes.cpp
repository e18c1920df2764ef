// What a scene in domains costs in counts, how well these are predicted, and what follows for many processes.
//
//     bench_processes [DIRECTORY [BODIES...]]     -> processes.csv and processes_predicted.csv; 30 000 and 100 000
//     bodies
//                                                    unless given
//
// The balls of elastic_gas.hpp. Counts do not depend on the machine: up to 8 domains, and 64 of few balls, are run by
// as many processes, which are threads here and send the messages that processes send; others by one. Times are of this
// machine: what a contact costs in one world, and what it costs to merge the logs of domains. docs/efficiency.md
// explains the model.

#include "collision/parallel/motion_changes.hpp"
#include "collision/parallel/news.hpp"
#include "collision/parallel/parallel_world.hpp"
#include "collision/parallel/world_events.hpp"
#include "collision/world.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/elastic_gas.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <mutex>
#include <utility>
#include <vector>

namespace {

using namespace kds::collision;
using kds::benchmarks::ElasticGas;
using kds::benchmarks::tell;
using kds::benchmarks::thread_seconds;
using kds::collision::DomainEvent;
using kds::collision::EventMerge;

// What is sent (domains.cpp), in bytes.
template <class... Values>
double bytes_of(Values... values) {
  kds::detail::Writer writer;
  writer(values...);
  return static_cast<double>(writer.take().size());
}
using Motion = World<1>::Motion;
const double change_bytes = bytes_of(MotionChange<Motion>{});
const double news_bytes = bytes_of(BodyNews<Motion>{});
const double nearest_bytes = bytes_of(NearestStranger{});  // of a domain, to each that is near it
const double event_bytes = bytes_of(DomainEvent{});
/// Of a ball that another process is to know, all that there is of it.
double ball_bytes() {
  Parcel<Motion> parcel;
  const double none = bytes_of(parcel);
  auto& ball = parcel.bodies.bodies.emplace_back();
  ball.alive = true, ball.placed = place(Sphere{0.5}, Eigen::Quaterniond::Identity());
  parcel.numbers.push_back(0), parcel.to_come.emplace_back(), parcel.resting.emplace_back();
  return bytes_of(parcel) - none;
}
/// Memory for a ball that a process stores, and in the world of a domain that knows it (bench_memory, at 0.25).
constexpr double stored_bytes = 178, world_bytes = 640;
// In a step there is one exchange, which ends with a barrier, and a combination, of sums and of maxima; at the end of a
// window another exchange.
constexpr double collectives_of_step = 3, collectives_of_window = 1;

/// The cells of a cube that has been halved again and again, along the longest side.
std::array<double, 3> cells_along_axes(std::size_t domains) {
  std::array<double, 3> cells{1, 1, 1};
  for (std::size_t axis = 0; domains > 1; domains /= 2, axis = (axis + 1) % 3) cells[axis] *= 2;
  return cells;
}

/// What follows from the number of domains and from the halo, for bodies that are spread evenly over a cube.
struct Predicted {
  double known = 1;    ///< bodies known for one owned
  double busiest = 1;  ///< the same, of a domain that has neighbours on as many sides as any has
  double near = 0;     ///< domains to which another is so near that it writes to them
};
Predicted predicted(std::size_t domains, double halo_over_side) {
  Predicted result;
  double within = 1;  // domains within two halos, itself among them
  for (const double cells : cells_along_axes(domains)) {
    const double steps = std::min(cells - 1, std::floor(2 * halo_over_side * cells) + 1);
    within *= 1 + 2 * steps - steps * (steps + 1) / cells;
    const double neighbours = 2 - 2 / cells, most_neighbours = std::min(2.0, cells - 1);
    result.known *= std::min(cells, 1 + neighbours * cells * halo_over_side);
    result.busiest *= std::min(cells, 1 + most_neighbours * cells * halo_over_side);
  }
  result.near = within - 1;
  return result;
}

/// Bytes that a process sends in a step, if it runs one domain. `near`: domains to which it writes; `copies`: of its
/// bodies, in other domains; `changes`: of the motion of a body, in a step; `come`: of a copy, how often it is made in
/// a step; `steps`: of a window.
double predicted_bytes(std::size_t processes, double near, double copies, double changes, double come, double steps,
                       double events) {
  const double p = static_cast<double>(processes);
  const double changed_in_window = 1 - std::exp(-changes * steps);
  return copies * changes * change_bytes + near * nearest_bytes + events * event_bytes * (p - 1) / p +
         copies * changed_in_window * news_bytes / steps + copies * come * ball_bytes();
}

/// Messages that it sends: to the domains near it; and, if they are sent, of its events.
double predicted_messages(std::size_t processes, double near, double steps, bool events) {
  const double p = static_cast<double>(processes);
  return near * (1 + 1 / steps) + (events ? (p - 1) / p : 0);
}

struct Counts {
  ParallelCounters of{};
  double messages = 0, bytes = 0;  ///< sent by all processes
};

/// Whether a process runs each of so many domains.
bool by_processes(std::size_t bodies, std::size_t domains) {
  return domains <= 8 || (domains == 64 && bodies <= 30'000);
}

/// What has been counted since.
ParallelCounters difference(const ParallelCounters& counters, const ParallelCounters& before) {
  using Numbers = std::array<std::uint64_t, sizeof(ParallelCounters) / sizeof(std::uint64_t)>;
  Numbers numbers = std::bit_cast<Numbers>(counters);
  const Numbers of_before = std::bit_cast<Numbers>(before);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] -= of_before[i];
  return std::bit_cast<ParallelCounters>(numbers);
}

/// Runs a gas in domains.
Counts run_divided(const ElasticGas& gas, std::size_t domains, double end) {
  Counts counts;
  std::mutex mutex;
  const auto run = [&](Processes* processes) {
    ParallelListener listener;
    ParallelWorld<1> world(gas.options, {.threads = 1, .domains = domains}, &listener, processes);
    for (const auto& ball : gas.bodies) world.add_body(ball);
    world.advance_to(0);  // All bodies have been sent to where they are known.
    const ParallelCounters before = world.counters();
    const MessageCounters sent = world.messages();
    world.advance_to(end);
    const std::scoped_lock lock(mutex);
    counts.of = difference(world.counters(), before);
    counts.messages += static_cast<double>(world.messages().letters - sent.letters);
    counts.bytes += static_cast<double>(world.messages().bytes - sent.bytes);
  };
  if (by_processes(gas.bodies.size(), domains)) {
    kds::collision::tests::ThreadProcesses(domains).run([&](Processes& processes) { run(&processes); });
  } else {
    run(nullptr);
  }
  return counts;
}

/// Seconds to merge the logs of domains, an event: one of eight is of two domains.
double merge_seconds(std::size_t domains) {
  constexpr std::size_t events = 400'000;
  std::vector<std::vector<DomainEvent>> logs(domains);
  kds::tests::Random random(1);
  for (std::size_t i = 0; i < events; ++i) {
    const auto slot = static_cast<BodySlot>(i);
    DomainEvent event{DomainEvent::Kind::contact, DomainEvent::nobody, slot, slot + 1,
                      Contact{.time = static_cast<double>(i)}};
    const std::size_t domain = random.below(domains), other = random.below(domains);
    const bool shared = other != domain && random.below(8) == 0;
    if (shared) event.other_owner = static_cast<DomainIndex>(other);
    logs[domain].push_back(event);
    if (!shared) continue;
    event.other_owner = static_cast<DomainIndex>(domain);
    logs[other].push_back(event);
  }
  const double begin = thread_seconds();
  EventMerge merge(std::move(logs));
  while (!merge.empty()) merge.take_next();
  return (thread_seconds() - begin) / static_cast<double>(events);
}

/// What the predictions for many processes start from, of one packing.
struct Measured {
  double contact_seconds = 0;        ///< in one world
  double contacts = 0, changes = 0;  ///< a body and step
  double come = 0;                   ///< a copy and step: how often it is made
  double steps = 0;                  ///< of a window
  double halo = 0;                   ///< in mean distances of neighbours
};

double ratio(double a, double b) { return b != 0 ? a / b : 1; }

Measured measure(std::ofstream& csv, std::size_t bodies, double packing) {
  const ElasticGas gas = kds::benchmarks::elastic_gas(bodies, packing);
  const double end = packing > 0.1 ? 1 : 8, n = static_cast<double>(bodies);
  Measured measured;
  measured.halo = ParallelOptions{}.halo + 1 / gas.spacing;
  {
    World<1> world(gas.options);
    for (const auto& ball : gas.bodies) world.add_body(ball);
    world.advance_to(0);
    const double begin = thread_seconds();
    world.advance_to(end);
    measured.contact_seconds = (thread_seconds() - begin) / static_cast<double>(world.counters().contacts);
  }
  for (const std::size_t domains : {2, 4, 8, 16, 32, 64}) {
    const Counts counts = run_divided(gas, domains, end);
    const ParallelCounters& c = counts.of;
    const double steps = static_cast<double>(c.steps), k = static_cast<double>(domains);
    const double events = static_cast<double>(c.contacts + c.wall_contacts);
    const double known = ratio(static_cast<double>(c.bodies_known), static_cast<double>(c.bodies_owned));
    const double efficiency = ratio(events, k * static_cast<double>(c.events_of_busiest));
    measured.contacts = static_cast<double>(c.contacts) / n / steps;
    measured.changes = static_cast<double>(2 * c.contacts + c.wall_contacts) / n / steps;
    measured.come = static_cast<double>(c.copies_made) / static_cast<double>(c.bodies_known - c.bodies_owned);
    measured.steps = steps / static_cast<double>(c.windows);
    const Predicted p = predicted(domains, measured.halo / std::cbrt(n));
    const double messages_predicted = predicted_messages(domains, p.near, measured.steps, true);
    const double bytes_predicted = predicted_bytes(domains, p.near, (p.known - 1) * n / k, measured.changes,
                                                   measured.come, measured.steps, events / steps / k);
    tell(csv, "%zu,%g,%zu,%llu,%.2f,%.3f,%llu,%.3f,%.3f,%.3f,%.3f,%.3f,%.1f,%.1f,%.0f,%.0f\n", bodies, packing, domains,
         static_cast<unsigned long long>(c.windows), measured.steps, measured.contacts,
         static_cast<unsigned long long>(c.windows_failed), known, p.known,
         ratio(static_cast<double>(c.events_computed), events), efficiency, 1 / p.busiest, counts.messages / k / steps,
         messages_predicted, counts.bytes / k / steps, bytes_predicted);
  }
  return measured;
}

/// Assumed of the machines: a message costs its sender a microsecond, and they send 10^10 bytes a second each.
constexpr double message_seconds = 1e-6, bytes_a_second = 1e10;

void predict(std::ofstream& csv, double packing, const Measured& from, double merge) {
  for (const double n : {1e6, 1e7, 1e8, 1e9}) {
    for (const std::size_t processes : {8, 64, 1024, 16384}) {
      const double p = static_cast<double>(processes), own = n / p;
      if (own < 900) continue;  // Most bodies would be known to all domains around.
      const Predicted counts = predicted(processes, from.halo / std::cbrt(n));
      const double events = own * from.contacts;
      const double bytes =
          predicted_bytes(processes, counts.near, (counts.known - 1) * own, from.changes, from.come, from.steps, 0);
      const double rounds = std::log2(p) * (collectives_of_step + collectives_of_window / from.steps);
      const double sent = predicted_messages(processes, counts.near, from.steps, false);
      const double messages = (sent + rounds) * message_seconds;
      const double computed = events * from.contact_seconds * counts.busiest;
      const double step = computed + messages + bytes / bytes_a_second;
      const double log = p * events * merge + (p - 1) * events * event_bytes / bytes_a_second;
      const double alone = p * events * from.contact_seconds;
      tell(csv, "%g,%g,%zu,%.3f,%.3f,%.3f,%.1f,%.2g,%.5f,%.2g\n", packing, n, processes, 1 / counts.busiest,
           alone / step, alone / (step + log), sent + rounds, bytes / 1e6, (step - computed) / step,
           (stored_bytes + world_bytes) * own * counts.busiest / 1e9);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const char* const folder = argc > 1 ? argv[1] : ".";
    std::ofstream csv = kds::benchmarks::open_csv(folder, "processes.csv");
    tell(csv,
         "bodies,packing,domains,windows,steps_a_window,contacts_a_body_and_step,failed,known_per_owned,predicted,"
         "computed_per_event,efficiency,predicted,messages_a_step,predicted,bytes_a_step,predicted\n");
    std::vector<std::size_t> sizes;
    for (int i = 2; i < argc; ++i) sizes.push_back(std::strtoull(argv[i], nullptr, 10));
    if (sizes.empty()) sizes = {30'000, 100'000};
    const std::array<double, 2> packings{0.25, 0.01};
    std::array<Measured, 2> measured;
    for (std::size_t i = 0; i < packings.size(); ++i) {
      for (const std::size_t bodies : sizes) measured[i] = measure(csv, bodies, packings[i]);
    }
    const double merge = merge_seconds(64);
    std::printf("bytes: a change of motion %.0f, news of a body %.0f, a distance %.0f, an event %.0f, a ball %.0f\n",
                change_bytes, news_bytes, nearest_bytes, event_bytes, ball_bytes());
    std::printf("merging 64 logs: %.0f ns an event; a contact in one world: %.0f ns at 0.25, %.0f ns at 0.01\n",
                merge * 1e9, measured[0].contact_seconds * 1e9, measured[1].contact_seconds * 1e9);
    std::ofstream table = kds::benchmarks::open_csv(folder, "processes_predicted.csv");
    tell(table,
         "packing,bodies,processes,efficiency_by_counts,without_log,with_log,messages_a_step,MB_a_step,"
         "share_of_messages,GB_a_process\n");
    for (std::size_t i = 0; i < packings.size(); ++i) predict(table, packings[i], measured[i], merge);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_processes: %s\n", error.what());
    return 1;
  }
}
