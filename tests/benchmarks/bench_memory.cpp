// What a world of balls takes of the memory: bytes a ball that are allocated, whether they have been used yet or not.
//
//     bench_memory [BALLS [PACKING [CONTACTS]]]     10^5 balls, 0.01 of the space, 1 contact a ball
//
// An elastic gas in a box. Four figures: when all bodies have entered, after the contacts, the most at any time from
// when the bodies were added, and when nine in ten of them have gone again, still for each that there was. The
// descriptions of the bodies are given back before they enter.

#include "collision/world.hpp"
#include "tests/benchmarks/elastic_gas.hpp"
#include "tests/benchmarks/thread_time.hpp"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>

namespace {

std::atomic<std::size_t> held = 0, most = 0;

void* counted(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t now = held += malloc_usable_size(memory);
  if (now > most) most = now;
  return memory;
}
void release(void* memory) noexcept {
  held -= malloc_usable_size(memory);
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t bytes) { return counted(std::malloc(std::max<std::size_t>(bytes, 1))); }
void* operator new(std::size_t bytes, std::align_val_t boundary) {
  const auto to = static_cast<std::size_t>(boundary);
  return counted(std::aligned_alloc(to, (bytes + to - 1) / to * to));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace {

void measure(std::size_t balls, double packing, double contacts_a_ball) {
  const std::size_t before = held;
  kds::benchmarks::ElasticGas gas = kds::benchmarks::elastic_gas(balls, packing);
  kds::collision::World<1> world(gas.options);
  for (const auto& body : gas.bodies) world.add_body(body);
  const double spacing = gas.spacing;  // passed in a second, about
  gas = {};
  most = held.load();
  const auto a_ball = [&](std::size_t bytes) {
    return static_cast<double>(bytes - before) / static_cast<double>(balls);
  };
  world.advance_to(0x1p-30 * spacing);
  const double entered = a_ball(held);
  const double begin = kds::benchmarks::thread_seconds();
  const auto wanted = static_cast<std::uint64_t>(0.5 * contacts_a_ball * static_cast<double>(balls));
  while (world.counters().contacts < wanted) world.advance_to(world.now() + 0x1p-6 * spacing);
  const double seconds = kds::benchmarks::thread_seconds() - begin;
  const auto made = static_cast<double>(std::max<std::uint64_t>(world.counters().contacts, 1));
  const double after = a_ball(held);
  const double at_most = a_ball(most);
  for (kds::collision::BodyId id = 0; id < balls; ++id) {
    if (id % 10 != 0) world.remove_body(id);
  }
  world.advance_to(world.now() + 0x1p-30 * spacing);
  std::printf(
      "balls,packing,bytes_entered,bytes_after,bytes_most,bytes_left,us_a_contact\n%zu,%g,%.0f,%.0f,%.0f,%.0f,%.2f\n",
      balls, packing, entered, after, at_most, a_ball(held), 1e6 * seconds / made);
}

}  // namespace

int main(int arguments, char** argument) {
  try {
    const auto number = [&](int i, double otherwise) { return arguments > i ? std::stod(argument[i]) : otherwise; };
    measure(static_cast<std::size_t>(number(1, 100'000)), number(2, 0.01), number(3, 1));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_memory: %s\n", error.what());
    return 1;
  }
}
