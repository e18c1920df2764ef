// Threads of one program in the place of processes.
#pragma once

#include "collision/parallel/processes.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace kds::collision::tests {

/// Runs work(processes) in so many threads, each of which is a process to the others. If one throws, so do the others
/// when they next exchange messages, and then this throws what the first of them threw.
class ThreadProcesses {
 public:
  explicit ThreadProcesses(std::size_t count) : count_(count), sent_(count), received_(count) {}

  void run(const std::function<void(Processes&)>& work) {
    {
      std::vector<std::jthread> threads;
      for (std::size_t rank = 0; rank < count_; ++rank) {
        threads.emplace_back([&, rank] {
          Process process(*this, rank);
          try {
            work(process);
          } catch (...) {
            fail();
          }
        });
      }
    }
    if (first_failure_) std::rethrow_exception(first_failure_);
  }

 private:
  class Process final : public Processes {
   public:
    Process(ThreadProcesses& all, std::size_t rank) : all_(all), rank_(rank) {}
    std::size_t count() const override { return all_.count_; }
    std::size_t rank() const override { return rank_; }
    std::vector<Letter> exchange(std::vector<Letter> letters) override {
      return all_.exchange(rank_, std::move(letters));
    }
    void combine(std::span<std::uint64_t> sums, std::span<double> maxima) override { all_.combine(sums, maxima); }

   private:
    ThreadProcesses& all_;
    std::size_t rank_;
  };

  using Letter = Processes::Letter;

  std::vector<Letter> exchange(std::size_t rank, std::vector<Letter> letters) {
    std::unique_lock lock(mutex_);
    for (const Letter& letter : letters) {
      if (letter.process >= count_ || letter.process == rank || letter.content.empty()) {
        throw std::logic_error("a letter to nobody, to who sends it, or an empty one");
      }
    }
    sent_[rank] = std::move(letters);
    meet(lock, [&] {
      for (std::size_t sender = 0; sender < count_; ++sender) {
        for (Letter& letter : sent_[sender]) received_[letter.process].push_back({sender, std::move(letter.content)});
      }
    });
    return std::exchange(received_[rank], {});
  }

  void combine(std::span<std::uint64_t> sums, std::span<double> maxima) {
    std::unique_lock lock(mutex_);
    if (arrived_ == 0) {
      next_sums_.assign(sums.size(), 0), next_maxima_.assign(maxima.begin(), maxima.end());
    }
    if (next_sums_.size() != sums.size() || next_maxima_.size() != maxima.size()) {
      throw std::logic_error("processes combine different things");
    }
    for (std::size_t i = 0; i < sums.size(); ++i) next_sums_[i] += sums[i];
    for (std::size_t i = 0; i < maxima.size(); ++i) next_maxima_[i] = std::max(next_maxima_[i], maxima[i]);
    meet(lock, [&] { sums_ = next_sums_, maxima_ = next_maxima_; });
    std::copy(sums_.begin(), sums_.end(), sums.begin());
    std::copy(maxima_.begin(), maxima_.end(), maxima.begin());
  }

  /// Returns when all are there. The last calls `finish`.
  template <class Finish>
  void meet(std::unique_lock<std::mutex>& lock, const Finish& finish) {
    const std::size_t round = round_;
    if (++arrived_ == count_) {
      finish();
      arrived_ = 0;
      ++round_;
      changed_.notify_all();
    }
    changed_.wait(lock, [&] { return round_ != round || first_failure_; });
    if (round_ == round) throw std::runtime_error("another process has ended");
  }

  void fail() {
    const std::unique_lock lock(mutex_);
    if (!first_failure_) first_failure_ = std::current_exception();
    changed_.notify_all();
  }

  const std::size_t count_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::vector<Letter>> sent_, received_;  ///< by sender, and by who receives them
  std::vector<std::uint64_t> next_sums_, sums_;       ///< those of the round that has begun, and of the last one
  std::vector<double> next_maxima_, maxima_;
  std::size_t arrived_ = 0;
  std::size_t round_ = 0;
  std::exception_ptr first_failure_;
};

}  // namespace kds::collision::tests
