#include "mpi/mpi_processes.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

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

std::vector<MpiProcesses::Message> MpiProcesses::exchange(std::vector<Message> to) {
  std::vector<std::uint64_t> sent(count_), received(count_);
  std::transform(to.begin(), to.end(), sent.begin(), [](const Message& message) { return message.size(); });
  require(MPI_Alltoall(sent.data(), 1, MPI_UINT64_T, received.data(), 1, MPI_UINT64_T, communicator_),
          "the lengths of messages cannot be exchanged");
  std::vector<Message> from(count_);
  std::vector<MPI_Request> requests;
  const auto in_parts = [&](Message& message, const auto& part) {
    for (std::size_t at = 0; at < message.size(); at += longest_part_) {
      const int length = static_cast<int>(std::min(longest_part_, message.size() - at));
      require(part(message.data() + at, length, &requests.emplace_back()), "a message cannot be exchanged");
    }
  };
  for (std::size_t other = 0; other < count_; ++other) {
    if (other == rank_) continue;
    from[other].resize(received[other]);
    in_parts(from[other], [&](char* data, int length, MPI_Request* request) {
      return MPI_Irecv(data, length, MPI_BYTE, static_cast<int>(other), 0, communicator_, request);
    });
  }
  for (std::size_t other = 0; other < count_; ++other) {
    if (other == rank_) continue;
    in_parts(to[other], [&](const char* data, int length, MPI_Request* request) {
      return MPI_Isend(data, length, MPI_BYTE, static_cast<int>(other), 0, communicator_, request);
    });
  }
  require(MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE),
          "messages cannot be exchanged");
  return from;
}

}  // namespace kds::mpi
