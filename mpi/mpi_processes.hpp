// The processes of an MPI run, to divide a scene among them.
#pragma once

#include "collision/parallel/processes.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mpi.h>

namespace kds::mpi {

/// The processes of a communicator, for the constructor of collision::ParallelWorld. MPI must have been initialised,
/// and not be finalised before this is destroyed; of the threads of a process only the one that runs the world calls
/// MPI (MPI_THREAD_FUNNELED).
class MpiProcesses final : public collision::Processes {
 public:
  /// All processes of the communicator construct one. Throws std::runtime_error if MPI fails, here and in what follows,
  /// unless it ends the processes itself, as most do when one of them has gone.
  /// `longest_part`: bytes, up to 2^31 - 1, since lengths are ints to MPI; longer messages go in several parts.
  explicit MpiProcesses(MPI_Comm communicator, std::size_t longest_part = std::size_t{1} << 30);
  ~MpiProcesses() override;
  MpiProcesses(const MpiProcesses&) = delete;
  MpiProcesses& operator=(const MpiProcesses&) = delete;

  std::size_t count() const override { return count_; }
  std::size_t rank() const override { return rank_; }
  /// Nobody is told how many letters there are: that all have arrived is known when all processes have joined a
  /// barrier, which each does when its own have been received. Paper: [Hoefler10], algorithm NBX.
  std::vector<Letter> exchange(std::vector<Letter> letters) override;
  void combine(std::span<std::uint64_t> sums, std::span<double> maxima) override;

 private:
  MPI_Comm communicator_ = MPI_COMM_NULL;  ///< a copy: no message is taken for one of the caller's
  std::size_t longest_part_;
  std::size_t count_ = 0;
  std::size_t rank_ = 0;
  int round_ = 0;  ///< of exchanges: 0 and 1 in turn
};

}  // namespace kds::mpi
