#include "kds/kept_memory.hpp"

#include "tests/support/sanitized.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

namespace test_kept_memory {

using kds::KeptVector;

TEST_CASE("arrays whose memory is kept hold what is put into them") {
  std::vector<KeptVector<std::uint32_t>> all;
  std::uint32_t state = 1;
  for (int i = 0; i < 400; ++i) {
    state = state * 1664525 + 1013904223;
    if (i % 3 == 2) {
      all.erase(all.begin() + state % all.size());
    } else {
      KeptVector<std::uint32_t> next(std::size_t{1} << (state >> 28), static_cast<std::uint32_t>(i));
      if (i % 50 == 0) next.resize(3 << 20, static_cast<std::uint32_t>(i));  // some are large
      if (i % 4 == 0 && !all.empty()) next = all.back();
      all.push_back(std::move(next));
    }
    for (const auto& one : all) {
      REQUIRE(one.front() == one.back());
      REQUIRE(one[one.size() / 2] == one.front());
    }
  }
}

TEST_CASE("an array has the memory of one that is gone, if both are of about one size") {
  constexpr std::size_t size = std::size_t{1} << 20;
  const auto* const first = std::make_unique<KeptVector<char>>(size)->data();
  KeptVector<char> other(size / 2);  // of another size
  const KeptVector<char> again(size - 100);
  if (KDS_SANITIZED == 0) {  // there nothing is kept
    CHECK(static_cast<const void*>(again.data()) == static_cast<const void*>(first));
  }
  CHECK(std::accumulate(again.begin(), again.end(), 0) == 0);
}

TEST_CASE("threads keep memory apart, and give all of it back") {
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([i] {
      for (int round = 0; round < 50; ++round) {
        KeptVector<int> one(100000 + 1000 * round, i), two(300000, i + 1);
        if (one.back() != i || two.back() != i + 1) std::terminate();
      }
    });
  }
  // An array may be thrown away by another thread than the one that has made it.
  KeptVector<int> made;
  threads.emplace_back([&made] { made.assign(200000, 7); });
  for (std::thread& thread : threads) thread.join();
  CHECK(made.back() == 7);
}

}  // namespace test_kept_memory
