// Messages between the processes of an MPI run. Run by mpirun, with any number of processes; ends with 1 if one is
// wrong.
#include "mpi/mpi_processes.hpp"

#include <mpi.h>

#include <cstddef>
#include <cstdio>
#include <vector>

namespace {

using Message = kds::collision::Processes::Message;

/// What one process writes to another in a round: of many lengths, 0 among them.
Message message(std::size_t from, std::size_t to, std::size_t round) {
  Message bytes((from * 7 + to * 3 + round * 5) % 29);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(from * 31 + to * 17 + round * 11 + i);
  return bytes;
}

bool messages_arrive(kds::mpi::MpiProcesses& processes) {
  for (std::size_t round = 0; round < 100; ++round) {
    std::vector<Message> to;
    for (std::size_t other = 0; other < processes.count(); ++other) {
      to.push_back(message(processes.rank(), other, round));
    }
    const std::vector<Message> from = processes.exchange(to);
    for (std::size_t other = 0; other < processes.count(); ++other) {
      if (other != processes.rank() && from[other] != message(other, processes.rank(), round)) return false;
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  bool right = true;
  for (const std::size_t longest_part : {std::size_t{7}, std::size_t{1} << 30}) {
    kds::mpi::MpiProcesses processes(MPI_COMM_WORLD, longest_part);
    right = messages_arrive(processes) && right;
  }
  if (!right) std::fprintf(stderr, "a message is not what was sent\n");
  MPI_Finalize();
  return right ? 0 : 1;
}
