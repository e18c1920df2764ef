#include "kds/kept_memory.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace kds::detail {
namespace {

/// Smaller arrays are left to the C library, which keeps such memory itself.
constexpr std::size_t least = std::size_t{64} << 10;
constexpr std::size_t most = std::size_t{32} << 20;  // of all that a thread keeps

// The address sanitizer sees who uses memory that has been given back, unless it is kept here.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool keeps = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool keeps = false;
#else
constexpr bool keeps = true;
#endif
#else
constexpr bool keeps = true;
#endif

/// Sizes are rounded up to four for each power of two, so that arrays of about one size can replace each other.
std::size_t rounded(std::size_t bytes) {
  const std::size_t step = std::bit_floor(bytes) / 4;
  return (bytes + step - 1) / step * step;
}

struct Block {
  void* memory = nullptr;
  std::size_t bytes = 0;
};

thread_local bool closed = false;  // the thread ends, and what is below is gone

struct Kept {
  std::array<Block, 8> blocks;  // the last that was given back comes first
  std::size_t bytes = 0;

  ~Kept() {
    closed = true;
    for (const Block& block : blocks) ::operator delete(block.memory);
  }
  void* take(std::size_t wanted) {
    const auto found = std::find_if(blocks.begin(), blocks.end(), [&](const Block& b) { return b.bytes == wanted; });
    if (found == blocks.end()) return nullptr;
    bytes -= wanted;
    void* const memory = found->memory;
    std::move(found + 1, blocks.end(), found);
    blocks.back() = {};
    return memory;
  }
  void put(const Block& block) {
    while (blocks.back().memory || bytes + block.bytes > most) drop_last();
    std::move_backward(blocks.begin(), blocks.end() - 1, blocks.end());
    blocks.front() = block;
    bytes += block.bytes;
  }

 private:
  void drop_last() {
    const auto last = std::find_if(blocks.rbegin(), blocks.rend(), [](const Block& b) { return b.memory; });
    ::operator delete(last->memory);
    bytes -= last->bytes;
    *last = {};
  }
};

thread_local Kept kept;

}  // namespace

void* take_memory(std::size_t bytes) {
  if (!keeps || bytes < least) return ::operator new(bytes);
  const std::size_t size = rounded(bytes);
  if (!closed) {
    if (void* const memory = kept.take(size)) return memory;
  }
  return ::operator new(size);
}

void keep_memory(void* memory, std::size_t bytes) noexcept {
  const std::size_t size = keeps && bytes >= least ? rounded(bytes) : 0;
  if (size == 0 || size > most || closed) return ::operator delete(memory);
  kept.put({memory, size});
}

}  // namespace kds::detail
