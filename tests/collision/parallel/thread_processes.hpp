// Threads of one program in the place of processes.
#pragma once

#include "collision/parallel/processes.hpp"

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace kds::collision::tests {

/// Runs work(processes) in so many threads, each of which is a process to the others. If one throws, so do the others
/// when they next exchange messages, and then this throws what the first of them threw.
class ThreadProcesses {
 public:
  explicit ThreadProcesses(std::size_t count) : count_(count), given_(count), taken_(count) {}

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
    std::vector<Message> exchange(std::vector<Message> to) override { return all_.exchange(rank_, std::move(to)); }

   private:
    ThreadProcesses& all_;
    std::size_t rank_;
  };

  std::vector<Processes::Message> exchange(std::size_t rank, std::vector<Processes::Message> to) {
    std::unique_lock lock(mutex_);
    given_[rank] = std::move(to);
    const std::size_t round = round_;
    if (++arrived_ == count_) {
      taken_ = std::exchange(given_, std::vector<std::vector<Processes::Message>>(count_));
      arrived_ = 0;
      ++round_;
      changed_.notify_all();
    }
    changed_.wait(lock, [&] { return round_ != round || first_failure_; });
    if (round_ == round) throw std::runtime_error("another process has ended");
    std::vector<Processes::Message> messages;
    for (auto& from : taken_) messages.push_back(std::move(from[rank]));
    return messages;
  }

  void fail() {
    const std::unique_lock lock(mutex_);
    if (!first_failure_) first_failure_ = std::current_exception();
    changed_.notify_all();
  }

  const std::size_t count_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::vector<Processes::Message>> given_, taken_;  ///< by sender and receiver
  std::size_t arrived_ = 0;
  std::size_t round_ = 0;
  std::exception_ptr first_failure_;
};

}  // namespace kds::collision::tests
