// kds-collide-mpi: the same by the processes of an MPI run.
#include "examples/kds-collide/tool.hpp"
#include "mpi/mpi_processes.hpp"

#include <mpi.h>

#include <atomic>
#include <cstdio>
#include <exception>
#include <new>

namespace {

/// Whether one of the processes of this machine has said why they end: in memory that they share.
class SaidOnce {
 public:
  SaidOnce() {
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine_);
    int rank = 0, unit = 0;
    MPI_Comm_rank(machine_, &rank);
    void* place = nullptr;
    MPI_Win_allocate_shared(rank == 0 ? sizeof(Flag) : 0, 1, MPI_INFO_NULL, machine_, &place, &window_);
    if (rank == 0) new (place) Flag(false);
    MPI_Aint size = 0;
    MPI_Win_shared_query(window_, 0, &size, &unit, &place);
    MPI_Barrier(machine_);
    said_ = static_cast<Flag*>(place);
  }
  ~SaidOnce() {
    said_ = nullptr;
    MPI_Win_free(&window_);
    MPI_Comm_free(&machine_);
  }
  SaidOnce(const SaidOnce&) = delete;
  SaidOnce& operator=(const SaidOnce&) = delete;

  static bool may_say() { return said_ == nullptr || !said_->exchange(true); }

 private:
  using Flag = std::atomic<bool>;
  static_assert(Flag::is_always_lock_free);

  MPI_Comm machine_ = MPI_COMM_NULL;
  MPI_Win window_ = MPI_WIN_NULL;
  static inline Flag* said_ = nullptr;
};

}  // namespace

int main(int argc, char** argv) {
  int threads = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &threads);
  int code = kds_collide::run_failed;
  try {
    kds::mpi::MpiProcesses processes(MPI_COMM_WORLD);
    const SaidOnce said_once;
    const kds_collide::Together together{processes, [](int failure) { MPI_Abort(MPI_COMM_WORLD, failure); },
                                         SaidOnce::may_say};
    code = kds_collide::run_tool(argc, argv, "kds-collide-mpi", &together);
  } catch (const std::exception& error) {  // of messages that were not exchanged
    std::fprintf(stderr, "kds-collide-mpi: %s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, code);
  }
  MPI_Finalize();
  return code;
}
