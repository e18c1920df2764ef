// Several processes that run one scene.
#pragma once

#include "kds/framework/snapshot.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace kds::collision {

/// Processes that run the same program and talk to each other: this one, and the others. How they do is left to who
/// implements this: `MpiProcesses` (mpi/mpi_processes.hpp) over MPI. All make the same calls, in the same order.
class Processes {
 public:
  using Message = std::vector<char>;

  virtual ~Processes() = default;
  virtual std::size_t count() const = 0;
  /// Of this one: below count().
  virtual std::size_t rank() const = 0;
  /// Gives each process, by rank, a message, and returns what each has given to this one. Those of a process for itself
  /// are not read. Returns when all messages for this process are there.
  virtual std::vector<Message> exchange(std::vector<Message> to) = 0;
};

/// What processes have sent each other so far.
struct MessageCounters {
  std::uint64_t exchanges = 0;
  std::uint64_t bytes = 0;  ///< sent by this process
};

/// This process and the others, if there are others.
class Team {
 public:
  /// `processes`: null if this one is alone.
  explicit Team(Processes* processes) : processes_(processes) {}

  std::size_t count() const { return processes_ ? processes_->count() : 1; }
  std::size_t rank() const { return processes_ ? processes_->rank() : 0; }
  const MessageCounters& counters() const { return counters_; }

  /// What process 0 says.
  template <class T>
  T of_first(T value) {
    exchange([&](std::size_t, auto& writer) { writer(value); },
             [&](std::size_t process, auto& reader) {
               T other{};
               reader(other);
               if (process == 0) value = other;
             });
    return value;
  }

  /// Calls write(process, writer) for each other process, and then read(process, reader), by rank, for what it has
  /// written for this one. All of it must be read.
  template <class Write, class Read>
  void exchange(const Write& write, const Read& read) {
    if (count() == 1) return;
    std::vector<Processes::Message> messages(count());
    for (std::size_t process = 0; process < count(); ++process) {
      if (process == rank()) continue;
      kds::detail::Writer writer;
      write(process, writer);
      messages[process] = writer.take();
      counters_.bytes += messages[process].size();
    }
    ++counters_.exchanges;
    messages = processes_->exchange(std::move(messages));
    for (std::size_t process = 0; process < count(); ++process) {
      if (process == rank()) continue;
      kds::detail::Reader reader(messages[process]);
      read(process, reader);
      kds::detail::Reader::require(reader.at_end(), "a process has sent more than was expected");
    }
  }

 private:
  Processes* processes_;
  MessageCounters counters_;
};

}  // namespace kds::collision
