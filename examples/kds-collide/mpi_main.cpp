// kds-collide-mpi: the same by the processes of an MPI run.
#include "examples/kds-collide/tool.hpp"
#include "mpi/mpi_processes.hpp"

#include <mpi.h>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  int threads = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &threads);
  int code = kds_collide::run_failed;
  try {
    kds::mpi::MpiProcesses processes(MPI_COMM_WORLD);
    const kds_collide::Together together{processes, [](int failure) { MPI_Abort(MPI_COMM_WORLD, failure); }};
    code = kds_collide::run_tool(argc, argv, "kds-collide-mpi", &together);
  } catch (const std::exception& error) {  // of messages that were not exchanged
    std::fprintf(stderr, "kds-collide-mpi: %s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, code);
  }
  MPI_Finalize();
  return code;
}
