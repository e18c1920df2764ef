// States of scenes that are saved in parts, kept in memory.
#pragma once

#include "collision/parallel/parallel_world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/parallel/thread_processes.hpp"

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace kds::collision::tests {

/// Work of several processes, or of one.
inline void run_by(std::size_t count, const std::function<void(Processes*, std::size_t rank)>& work) {
  if (count == 1) return work(nullptr, 0);
  ThreadProcesses(count).run([&](Processes& processes) { work(&processes, processes.rank()); });
}

/// What save_parts() has given to several processes.
class StateInParts {
 public:
  explicit StateInParts(std::size_t processes) : blocks_(processes) {}

  /// Each process calls it.
  template <class World>
  void save(World& world, std::size_t rank, std::size_t bodies_in_block) {
    blocks_[rank].clear();
    const auto keep = [&](std::vector<char> block) { blocks_[rank].push_back(std::move(block)); };
    Snapshot saved = world.save_parts(keep, bodies_in_block);
    if (rank == 0) rest = std::move(saved);
  }

  /// All blocks, by rank.
  std::vector<std::vector<char>> blocks() const {
    std::vector<std::vector<char>> all;
    for (const auto& of_rank : blocks_) all.insert(all.end(), of_rank.begin(), of_rank.end());
    return all;
  }

  Snapshot rest;

 private:
  std::vector<std::vector<std::vector<char>>> blocks_;
};

/// Every so many-th of the blocks, from `rank` on.
inline std::function<bool(std::vector<char>&)> share_of(const std::vector<std::vector<char>>& blocks, std::size_t rank,
                                                        std::size_t processes) {
  return [&blocks, processes, next = rank](std::vector<char>& block) mutable {
    if (next >= blocks.size()) return false;
    block = blocks[next];
    next += processes;
    return true;
  };
}

}  // namespace kds::collision::tests
