// Messages between the processes of an MPI run. Run by mpirun, with any number of processes; ends with 1 if one is
// wrong.
#include "mpi/mpi_processes.hpp"

#include <mpi.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

namespace {

using Letter = kds::collision::Processes::Letter;

/// What one process writes to another in a round: of many lengths; none at all to most.
std::vector<char> content(std::size_t from, std::size_t to, std::size_t round) {
  if (from == to || (from + 2 * to + round) % 3 == 0) return {};
  std::vector<char> bytes((from * 7 + to * 3 + round * 5) % 29);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(from * 31 + to * 17 + round * 11 + i);
  return bytes;
}

bool letters_arrive(kds::mpi::MpiProcesses& processes) {
  for (std::size_t round = 0; round < 200; ++round) {
    std::vector<Letter> letters;
    for (std::size_t other = 0; other < processes.count(); ++other) {
      const auto bytes = content(processes.rank(), other, round);
      if (!bytes.empty()) letters.push_back({other, bytes});
    }
    const std::vector<Letter> from = processes.exchange(std::move(letters));
    std::size_t next = 0;
    for (std::size_t other = 0; other < processes.count(); ++other) {
      const auto expected = content(other, processes.rank(), round);
      if (expected.empty()) continue;
      if (next == from.size() || from[next].process != other || from[next].content != expected) return false;
      ++next;
    }
    if (next != from.size()) return false;
  }
  return true;
}

bool numbers_are_combined(kds::mpi::MpiProcesses& processes) {
  const std::size_t count = processes.count(), rank = processes.rank();
  std::array<std::uint64_t, 2> sums{rank, std::uint64_t{1} << 60};
  std::array<double, 3> maxima{static_cast<double>(rank), -static_cast<double>(rank), rank == 1 ? INFINITY : 0};
  processes.combine(sums, maxima);
  std::array<std::uint64_t, 1> ones{1};
  processes.combine(ones, {});
  const double last = static_cast<double>(count - 1);
  return sums[0] == count * (count - 1) / 2 && sums[1] == count << 60 && ones[0] == count && maxima[0] == last &&
         maxima[1] == 0 && maxima[2] == (count > 1 ? INFINITY : 0);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  bool right = true;
  for (const std::size_t longest_part : {std::size_t{7}, std::size_t{1} << 30}) {
    kds::mpi::MpiProcesses processes(MPI_COMM_WORLD, longest_part);
    right = letters_arrive(processes) && right;
    right = numbers_are_combined(processes) && right;
  }
  if (!right) std::fprintf(stderr, "a letter, or a number that was combined, is not what it should be\n");
  MPI_Finalize();
  return right ? 0 : 1;
}
