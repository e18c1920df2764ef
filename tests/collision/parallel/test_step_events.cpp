// What the domains of several processes record, each for itself, is the log of one world.
#include "collision/parallel/step_events.hpp"

#include "collision/parallel/parallel_world.hpp"
#include "collision/parallel/relayed_events.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/parallel/parallel_log.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/collision/parallel/trials.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kds::collision::test_step_events {
namespace {

using tests::Event;
using tests::EventLog;
using tests::ParallelLog;
using tests::Random;
using tests::ThreadProcesses;
using tests::Trial;

/// What a process was told: steps, and before each of them the events of stretches that were run as one world.
struct ToldSteps final : StepListener {
  explicit ToldSteps(const ParallelLog& told) : log(told) {}
  void on_step(const StepEvents& events) override {
    steps.push_back(events);
    before.push_back(log.events.size());
  }

  const ParallelLog& log;
  std::vector<StepEvents> steps;
  std::vector<std::size_t> before;
};

/// What the processes were told, as one log.
std::vector<Event> one_log(const std::vector<ParallelLog>& logs, const std::vector<ToldSteps>& told) {
  std::vector<Event> all;
  const auto first = logs[0].events.begin();
  std::size_t next = 0;
  for (std::size_t step = 0; step < told[0].steps.size(); ++step) {
    for (; next < told[0].before[step]; ++next) all.push_back(first[static_cast<std::ptrdiff_t>(next)]);
    std::vector<StepEvents> of_processes;
    for (const ToldSteps& process : told) of_processes.push_back(process.steps.at(step));
    ParallelLog of_step;
    for (EventMerge merge = merged(std::move(of_processes)); !merge.empty();) relay(merge.take_next(), of_step);
    all.insert(all.end(), of_step.events.begin(), of_step.events.end());
  }
  all.insert(all.end(), first + static_cast<std::ptrdiff_t>(next), logs[0].events.end());
  return all;
}

struct Seen {
  std::size_t events = 0, in_steps = 0, shared = 0, whole = 0;
  std::uint64_t bytes = 0, bytes_gathered = 0;
};

template <int Degree>
void compare(const Trial<Degree>& trial, ParallelOptions parallel, std::size_t count, Seen& seen) {
  INFO(trial.what << ", " << count << " processes, " << parallel.domains << " domains");
  EventLog<Degree> right;
  World<Degree> world(trial.options, &right);
  for (const auto& body : trial.scene.bodies) world.add_body(body);
  world.advance_to(trial.scene.end_time);

  const auto run = [&](bool apart, std::vector<ParallelLog>& logs, std::vector<ToldSteps>& told) {
    std::vector<MessageCounters> messages(count);
    ThreadProcesses(count).run([&](Processes& processes) {
      const std::size_t rank = processes.rank();
      ParallelOptions options = parallel;
      if (apart) options.steps = &told[rank];
      ParallelWorld<Degree> divided(trial.options, options, &logs[rank], &processes);
      for (const auto& body : trial.scene.bodies) divided.add_body(body);
      divided.advance_to(trial.scene.end_time);
      messages[rank] = divided.messages();
    });
    std::uint64_t bytes = 0;
    for (const MessageCounters& of_process : messages) bytes += of_process.bytes;
    return bytes;
  };
  std::vector<ParallelLog> logs(count), gathered(count);
  std::vector<ToldSteps> told(logs.begin(), logs.end()), none(gathered.begin(), gathered.end());
  seen.bytes += run(true, logs, told);
  seen.bytes_gathered += run(false, gathered, none);
  REQUIRE(gathered[0].events == right.events);
  REQUIRE(one_log(logs, told) == right.events);
  for (std::size_t rank = 1; rank < count; ++rank) REQUIRE(logs[rank].events.empty());
  seen.events += right.events.size(), seen.whole += logs[0].events.size();
  for (const ToldSteps& process : told) {
    for (const StepEvents& step : process.steps) {
      for (const auto& log : step.logs) {
        seen.in_steps += log.size();
        for (const DomainEvent& event : log) seen.shared += event.other_owner != DomainEvent::nobody ? 1 : 0;
      }
    }
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Steps: what processes record by themselves is the log of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    Random random(seed + 1000);
    ParallelOptions parallel{.domains = 2 + random.below(7), .halo = random.between(0.3, 4)};
    if (random.one_in(2)) parallel.longest_window = random.between(0.01, 0.2);
    compare(tests::trial<Degree>(seed + 50), parallel, 1 + random.below(4), seen);
  }
  tests::Trial<Degree> row{.options = tests::with_response(Response::elastic), .what = "a row across several domains"};
  row.scene.end_time = 1;
  for (int i = 0; i < 12; ++i) {
    row.scene.bodies.push_back(tests::ball<Degree>(0.5, {1.0 * i, 0, 0}, {0.05 * (6 - i), 0, 0}));
    row.scene.bodies.back().restitution = 0;
  }
  compare(row, {.domains = 4, .halo = 1}, 2, seen);
  INFO(seen.events << " events, " << seen.in_steps << " in steps, " << seen.shared << " shared, " << seen.whole
                   << " in one world");
  CHECK(seen.events > 500);
  CHECK(seen.in_steps > 300);
  CHECK(seen.shared > 50);
  CHECK(seen.whole > 0);
  CHECK(seen.bytes < seen.bytes_gathered);
}

TEST_CASE("Steps: simultaneous contacts by the thousand", "[parallel]") {
  Seen seen;
  compare(tests::lattice(8, 1.5), {.domains = 5, .halo = 1.5}, 3, seen);
  CHECK(seen.in_steps > 3000);
  CHECK(seen.shared > 500);
}

TEST_CASE("Steps: a listener that not all processes have is refused", "[parallel]") {
  const auto one = tests::trial<1>(9);
  CHECK_THROWS_WITH(ThreadProcesses(3).run([&](Processes& processes) {
    const ParallelLog log;
    ToldSteps steps(log);
    const ParallelOptions parallel{.domains = 3, .steps = processes.rank() == 1 ? &steps : nullptr};
    ParallelWorld<1> world(one.options, parallel, nullptr, &processes);
  }),
                    "ParallelOptions.steps: either all processes have one or none");
}

TEST_CASE("Steps: one whose listener throws counts as told, and the next call goes on", "[parallel]") {
  struct Throws final : StepListener {
    void on_step(const StepEvents& events) override {
      for (EventMerge merge = merged({events}); !merge.empty();) relay(merge.take_next(), told);
      if (++steps % 2 == 0) throw std::runtime_error("full");
    }
    ParallelLog told;
    std::size_t steps = 0;
  };
  const auto one = tests::lattice(6, 1.5);
  EventLog<1> right;
  World<1> world(one.options, &right);
  for (const auto& body : one.scene.bodies) world.add_body(body);
  world.advance_to(one.scene.end_time);
  Throws steps;
  ParallelWorld<1> divided(one.options, {.domains = 4, .halo = 1.5, .longest_window = 0.3, .steps = &steps});
  for (const auto& body : one.scene.bodies) divided.add_body(body);
  std::size_t thrown = 0;
  while (divided.now() < one.scene.end_time) {
    try {
      divided.advance_to(one.scene.end_time);
    } catch (const std::runtime_error&) {
      ++thrown;
    }
  }
  CHECK(thrown > 3);
  CHECK(steps.told.events == right.events);
}

TEST_CASE("Steps that are not of one step are refused", "[parallel]") {
  StepEvents first{.domains = 3, .first = 0, .logs = {{}, {}}}, second{.domains = 3, .first = 2, .logs = {{}}};
  CHECK(merged({first, second}).empty());
  CHECK(merged({first, second, {.domains = 3}}).empty());
  CHECK_THROWS_AS(merged({first}), std::invalid_argument);
  CHECK_THROWS_AS(merged({second, first}), std::invalid_argument);
  second.domains = 4;
  CHECK_THROWS_AS(merged({first, second}), std::invalid_argument);
}

}  // namespace kds::collision::test_step_events
