// Several processes that run one scene.
#pragma once

#include "kds/framework/snapshot.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

/// Processes that run the same program and talk to each other: this one, and the others. How they do is left to who
/// implements this: `MpiProcesses` (mpi/mpi_processes.hpp) over MPI. All make the same calls, in the same order, each
/// with what it has to say.
class Processes {
 public:
  /// What one process has to say to another.
  struct Letter {
    std::size_t process;  ///< to which it goes, or from which it comes
    std::vector<char> content;
  };

  virtual ~Processes() = default;
  virtual std::size_t count() const = 0;
  /// Of this one: below count().
  virtual std::size_t rank() const = 0;
  /// Sends letters, each to another process, one at most to each, none of them empty. Returns those to this process,
  /// when all are there, in the order of their senders. Most processes write to few others: what it costs should go
  /// with the letters, and not with count().
  virtual std::vector<Letter> exchange(std::vector<Letter> letters) = 0;
  /// Puts into each place of `sums` the sum of what all processes have in that place, and into each of `maxima`, none
  /// of which is NaN, the greatest. All have as many of both.
  virtual void combine(std::span<std::uint64_t> sums, std::span<double> maxima) = 0;
};

/// What processes have said to each other so far.
struct MessageCounters {
  std::uint64_t exchanges = 0;     ///< in which each process could write to others
  std::uint64_t letters = 0;       ///< sent by this process
  std::uint64_t bytes = 0;         ///< of these
  std::uint64_t combinations = 0;  ///< in which all had a part
};

/// What a process writes to others: to(process) is for what it writes to one of them, as a snapshot is written.
class Letters {
 public:
  kds::detail::Writer& to(std::size_t process) { return letters_[process]; }
  std::vector<Processes::Letter> take() {
    std::vector<Processes::Letter> all;
    for (auto& [process, writer] : letters_) {
      all.push_back({process, writer.take()});
      if (all.back().content.empty()) all.pop_back();
    }
    letters_.clear();
    return all;
  }

 private:
  std::map<std::size_t, kds::detail::Writer> letters_;
};

/// This process and the others, if there are others.
class Team {
 public:
  /// `processes`: null if this one is alone.
  explicit Team(Processes* processes) : processes_(processes) {}

  std::size_t count() const { return processes_ ? processes_->count() : 1; }
  std::size_t rank() const { return processes_ ? processes_->rank() : 0; }
  const MessageCounters& counters() const { return counters_; }

  /// Sends letters to other processes, and calls read(process, reader), by rank, for each letter to this one. All of it
  /// must be read.
  template <class Read>
  void exchange(Letters letters, const Read& read) {
    if (count() == 1) return;
    auto sent = letters.take();
    ++counters_.exchanges, counters_.letters += sent.size();
    for (const auto& letter : sent) counters_.bytes += letter.content.size();
    for (const auto& letter : processes_->exchange(std::move(sent))) {
      kds::detail::Reader reader(letter.content);
      read(letter.process, reader);
      kds::detail::Reader::require(reader.at_end(), "a process has sent more than was expected");
    }
  }

  /// As Processes::combine().
  void combine(std::span<std::uint64_t> sums, std::span<double> maxima) {
    if (count() == 1) return;
    ++counters_.combinations;
    processes_->combine(sums, maxima);
  }

  /// Whether it is so in all processes.
  bool all(bool here) {
    std::array<std::uint64_t, 1> others{here ? 0u : 1u};
    combine(others, {});
    return others[0] == 0;
  }

  /// What process 0 says. No process goes on before all are here.
  std::uint64_t of_first(std::uint64_t value) {
    std::array<std::uint64_t, 1> sum{rank() == 0 ? value : 0};
    combine(sum, {});
    return sum[0];
  }

 private:
  Processes* processes_;
  MessageCounters counters_;
};

}  // namespace kds::collision
