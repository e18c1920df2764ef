#include "mpi/mpi_processes.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace kds::mpi {
namespace {

void require(int result, const char* what) {
  if (result == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(result, text.data(), &length);
  throw std::runtime_error("MPI: " + std::string(what) + ": " +
                           std::string(text.data(), static_cast<std::size_t>(length)));
}

}  // namespace

MpiProcesses::MpiProcesses(MPI_Comm communicator, std::size_t longest_part) : longest_part_(longest_part) {
  require(MPI_Comm_dup(communicator, &communicator_), "the communicator cannot be copied");
  require(MPI_Comm_set_errhandler(communicator_, MPI_ERRORS_RETURN), "the error handler cannot be set");
  int count = 0, rank = 0;
  require(MPI_Comm_size(communicator_, &count), "the number of processes is not known");
  require(MPI_Comm_rank(communicator_, &rank), "the rank is not known");
  count_ = static_cast<std::size_t>(count);
  rank_ = static_cast<std::size_t>(rank);
}

MpiProcesses::~MpiProcesses() {
  if (communicator_ != MPI_COMM_NULL) MPI_Comm_free(&communicator_);
}

std::vector<MpiProcesses::Letter> MpiProcesses::exchange(std::vector<Letter> letters) {
  // A process that has left this exchange may have begun the next one, but not the one after that: it would have had to
  // wait for this process. So two tags tell letters of different exchanges apart.
  const int tag = round_;
  round_ = 1 - round_;
  std::vector<MPI_Request> sending;
  for (const Letter& letter : letters) {
    for (std::size_t at = 0; at < letter.content.size(); at += longest_part_) {
      const int length = static_cast<int>(std::min(longest_part_, letter.content.size() - at));
      require(MPI_Issend(letter.content.data() + at, length, MPI_BYTE, static_cast<int>(letter.process), tag,
                         communicator_, &sending.emplace_back()),
              "a letter cannot be sent");
    }
  }
  std::map<int, std::vector<char>> received;  // by sender; parts arrive in their order
  MPI_Request all_received = MPI_REQUEST_NULL;
  bool joined = false;
  for (int done = 0; done == 0;) {
    int found = 0;
    MPI_Status status;
    require(MPI_Iprobe(MPI_ANY_SOURCE, tag, communicator_, &found, &status), "letters cannot be looked for");
    if (found != 0) {
      int length = 0;
      require(MPI_Get_count(&status, MPI_BYTE, &length), "the length of a letter is not known");
      std::vector<char>& content = received[status.MPI_SOURCE];
      const std::size_t before = content.size();
      content.resize(before + static_cast<std::size_t>(length));
      require(
          MPI_Recv(content.data() + before, length, MPI_BYTE, status.MPI_SOURCE, tag, communicator_, MPI_STATUS_IGNORE),
          "a letter cannot be received");
    }
    if (joined) {
      require(MPI_Test(&all_received, &done, MPI_STATUS_IGNORE), "the other processes cannot be waited for");
      continue;
    }
    int all_sent = 0;
    require(MPI_Testall(static_cast<int>(sending.size()), sending.data(), &all_sent, MPI_STATUSES_IGNORE),
            "letters cannot be sent");
    if (all_sent == 0) continue;
    require(MPI_Ibarrier(communicator_, &all_received), "the other processes cannot be waited for");
    joined = true;
  }
  std::vector<Letter> result;
  for (auto& [sender, content] : received) result.push_back({static_cast<std::size_t>(sender), std::move(content)});
  return result;
}

void MpiProcesses::combine(std::span<std::uint64_t> sums, std::span<double> maxima) {
  if (!sums.empty()) {
    require(
        MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_UINT64_T, MPI_SUM, communicator_),
        "sums cannot be found");
  }
  if (maxima.empty()) return;
  require(
      MPI_Allreduce(MPI_IN_PLACE, maxima.data(), static_cast<int>(maxima.size()), MPI_DOUBLE, MPI_MAX, communicator_),
      "maxima cannot be found");
}

}  // namespace kds::mpi
