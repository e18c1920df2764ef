#include "kds/large_vector.hpp"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace kds::detail {

void* allocate_large_pages(std::size_t bytes) {
  void* const memory = ::operator new(bytes, std::align_val_t{large_page});
#ifdef MADV_HUGEPAGE
  // A request that may be refused, and then changes nothing. The last page is left as it is, unless it is full.
  ::madvise(memory, bytes / large_page * large_page, MADV_HUGEPAGE);
#endif
  return memory;
}

void free_large_pages(void* memory) noexcept { ::operator delete(memory, std::align_val_t{large_page}); }

}  // namespace kds::detail
