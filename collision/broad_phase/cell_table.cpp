#include "collision/broad_phase/cell_table.hpp"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <cstring>

namespace kds::collision {

void CellTable::restart(std::size_t numbers) {
  const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(numbers, 64));
  buckets_.assign(buckets, Bucket{});
  chained_.clear();
  free_ = none;
  size_ = 0;
  shift_ = 64 - std::countr_zero(buckets);
}

void CellTable::add(std::size_t place, Ends ends, std::uint32_t number) {
  ++size_;
  Bucket* bucket = &buckets_[place];
  if (bucket->count == most) {
    if (bucket->next == none || chained_[bucket->next].count == most) {
      std::uint32_t added = free_;
      if (added != none) {
        free_ = chained_[added].next;
      } else {
        added = static_cast<std::uint32_t>(chained_.size());
        chained_.emplace_back();
      }
      chained_[added].next = bucket->next;
      bucket->next = added;
    }
    bucket = &chained_[bucket->next];
  }
  bucket->ends[bucket->count] = ends;
  bucket->numbers[bucket->count++] = number;
}

inline std::uint32_t CellTable::Bucket::within(Ends limits) const {
#ifdef __SSE2__
  const __m128i most_allowed = _mm_set1_epi64x(static_cast<long long>(limits));
  const auto* const from = reinterpret_cast<const __m128i*>(ends.data());
  const auto exceed = [&](const __m128i& two) {
    return static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_cmpgt_epi8(_mm_load_si128(&two), most_allowed)));
  };
  const std::uint32_t over = exceed(from[0]) | exceed(from[1]) << 16;
  return ~(((over & 0x7F7F7F7Fu) + 0x7F7F7F7Fu) | over) & 0x80808080u;  // bytes that are zero
#else
  using Bytes = signed char __attribute__((vector_size(8)));
  Bytes most_allowed;
  std::memcpy(&most_allowed, &limits, sizeof most_allowed);
  std::uint32_t within = 0;
  for (std::size_t i = 0; i < most; ++i) {
    Bytes bytes;
    std::memcpy(&bytes, &ends[i], sizeof bytes);
    const auto over = bytes > most_allowed;
    std::uint64_t any = 0;
    std::memcpy(&any, &over, sizeof any);
    within |= std::uint32_t{any == 0} << (8 * i + 7);
  }
  return within;
#endif
}

std::size_t CellTable::find(const Block& block, Found& found) const {
  std::size_t walked = 0;
  const Bucket* const buckets = buckets_.data();
  const std::size_t mask = buckets_.size() - 1;
  const auto [cells_x, cells_y, cells_z] = block.lengths;
  std::uint64_t row_z = mixed(block.family, block.low[1], block.low[2]);
  for (std::size_t z = 0; z < cells_z; ++z, row_z += along_z) {
    std::uint64_t row_y = row_z;
    for (std::size_t y = 0; y < cells_y; ++y, row_y += along_y) {
      const Ends limits_yz = block.limits[2][z] | block.limits[1][y];
      const std::size_t begin = static_cast<std::size_t>(row_y >> shift_) + static_cast<std::size_t>(block.low[0]);
      for (std::size_t x = 0; x < cells_x; ++x) {
        const Ends limits = limits_yz | block.limits[0][x];
        for (const Bucket* bucket = &buckets[(begin + x) & mask];; bucket = &chained_[bucket->next], ++walked) {
          found.add(bucket->numbers, bucket->within(limits));
          if (bucket->next == none) break;
        }
      }
    }
  }
  return walked;
}

CellTable::Where CellTable::where(std::size_t place, Ends ends, std::uint32_t number) {
  for (Bucket* bucket = &buckets_[place];; bucket = &chained_[bucket->next]) {
    for (std::size_t i = 0; i < bucket->count; ++i) {
      if (bucket->numbers[i] == number && bucket->ends[i] == ends) return {bucket, i};
    }
    if (bucket->next == none) return {nullptr, 0};
  }
}

bool CellTable::replace(std::size_t place, Ends from, Ends to, std::uint32_t number) {
  const auto [bucket, i] = where(place, from, number);
  if (bucket) bucket->ends[i] = to;
  return bucket != nullptr;
}

bool CellTable::remove(std::size_t place, Ends ends, std::uint32_t number) {
  const auto [bucket, i] = where(place, ends, number);
  if (!bucket) return false;
  --size_;
  // The last one takes its place.
  Bucket& first = buckets_[place];
  Bucket& last = first.next == none ? first : chained_[first.next];
  const std::size_t end = --last.count;
  bucket->ends[i] = last.ends[end];
  bucket->numbers[i] = last.numbers[end];
  last.ends[end] = vacant;
  if (end == 0 && &last != &first) {
    const std::uint32_t empty = first.next;
    first.next = last.next;
    last.next = free_;
    free_ = empty;
  }
  return true;
}

}  // namespace kds::collision
