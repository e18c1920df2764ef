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

/// All four are written, and the end is moved past those that count: which of them do cannot be predicted.
inline std::uint32_t* CellTable::Bucket::find(Ends limits, std::uint32_t* to) const {
#ifdef __SSE2__
  const __m128i most_allowed = _mm_set1_epi64x(static_cast<long long>(limits));
  const auto* const from = reinterpret_cast<const __m128i*>(ends.data());
  const auto over = [&](const __m128i& two) {
    return static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_cmpgt_epi8(_mm_load_si128(&two), most_allowed)));
  };
  const std::uint32_t first = over(from[0]);
  const std::uint32_t second = over(from[1]);
  const auto keep = [&to](std::uint32_t number, bool within) {
    *to = number;
    to += within;
  };
  keep(numbers[0], (first & 0xFF) == 0);
  keep(numbers[1], first < 0x100);
  keep(numbers[2], (second & 0xFF) == 0);
  keep(numbers[3], second < 0x100);
#else
  using Bytes = signed char __attribute__((vector_size(8)));
  Bytes most_allowed;
  std::memcpy(&most_allowed, &limits, sizeof most_allowed);
  for (std::size_t i = 0; i < most; ++i) {
    Bytes bytes;
    std::memcpy(&bytes, &ends[i], sizeof bytes);
    const auto over = bytes > most_allowed;
    std::uint64_t any = 0;
    std::memcpy(&any, &over, sizeof any);
    *to = numbers[i];
    to += any == 0;
  }
#endif
  return to;
}

void CellTable::find(std::size_t row, std::int64_t x, Ends common, std::span<const Ends> along_x,
                     Found& found) const {
  const Bucket* const buckets = buckets_.data();
  const std::size_t mask = buckets_.size() - 1;
  std::size_t at = row + static_cast<std::size_t>(x);
  std::uint32_t* to = found.end(most * along_x.size());
  for (std::size_t i = 0; i < along_x.size(); ++i) {
    const Ends limits = common | along_x[i];
    const Bucket* bucket = &buckets[at++ & mask];
    to = bucket->find(limits, to);
    while (bucket->next != none) {
      bucket = &chained_[bucket->next];
      found.end_at(to);
      to = bucket->find(limits, found.end(most * (along_x.size() - i)));
    }
  }
  found.end_at(to);
}

CellTable::Where CellTable::where(std::size_t place, std::uint32_t number) {
  for (Bucket* bucket = &buckets_[place];; bucket = &chained_[bucket->next]) {
    for (std::size_t i = 0; i < bucket->count; ++i) {
      if (bucket->numbers[i] == number) return {bucket, i};
    }
    if (bucket->next == none) return {nullptr, 0};
  }
}

bool CellTable::replace(std::size_t place, Ends ends, std::uint32_t number) {
  const auto [bucket, i] = where(place, number);
  if (bucket) bucket->ends[i] = ends;
  return bucket != nullptr;
}

bool CellTable::remove(std::size_t place, std::uint32_t number) {
  const auto [bucket, i] = where(place, number);
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
