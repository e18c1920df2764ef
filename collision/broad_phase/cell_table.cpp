#include "collision/broad_phase/cell_table.hpp"

#include "kds/simd/target.hpp"

#include <utility>

namespace kds::collision {

void CellTable::Found::grow(std::size_t count) {
  std::vector<std::uint32_t> more(2 * room_ + count);
  std::copy_n(numbers_, size_, more.begin());
  many_ = std::move(more);
  numbers_ = many_.data();
  room_ = many_.size();
}

void CellTable::restart(std::size_t numbers) {
  const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(numbers, 64));
  // With much less memory than before, the rest is given back.
  if (buckets_.capacity() > 2 * buckets) LargeVector<Bucket>().swap(buckets_);
  if (chained_.capacity() > buckets) LargeVector<Bucket>().swap(chained_);
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

inline std::uint64_t CellTable::Bucket::within(Ends limits) const {
  return simd::target::within_limits(ends.data(), limits);
}

/// Branches on which numbers of a bucket match would be mispredicted; so matches are gathered as bits, and those of
/// many buckets are read in one loop.
class CellTable::Gathering {
 public:
  explicit Gathering(Found& found) : found_(found) {}
  Gathering(const Gathering&) = delete;
  Gathering& operator=(const Gathering&) = delete;

  void look(const Bucket& bucket, Ends limits) {
    bits_ = bits_ >> most | bucket.within(limits) << (64 - most);
    buckets_[count_++] = &bucket;
    // Once in sixteen times. If the compiler is told, it keeps the search's variables in registers (a seventh fewer
    // instructions).
    if (count_ == buckets_.size()) [[unlikely]]
      take();
  }

  void take() {
    if (count_ == 0) return;
    std::uint32_t* to = found_.room_for(64);
    for (std::uint64_t left = bits_ >> (64 - most * count_); left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      *to++ = buckets_[i / most]->numbers[i % most];
    }
    found_.end_at(to);
    count_ = 0;
    bits_ = 0;
  }

 private:
  Found& found_;
  std::uint64_t bits_ = 0;  ///< a group for each bucket, the last one highest
  std::size_t count_ = 0;
  std::array<const Bucket*, 64 / most> buckets_;
};

std::size_t CellTable::find(const Block& block, Found& found) const {
  std::size_t walked = 0;
  Gathering gathering(found);
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
          gathering.look(*bucket, limits);
          if (bucket->next == none) break;
        }
      }
    }
  }
  gathering.take();
  return walked;
}

/// Without Gathering, since few buckets of a slab have anything within the limits.
std::size_t CellTable::find(const Slab& slab, Found& found) const {
  std::size_t walked = 0;
  const Bucket* const buckets = buckets_.data();
  const std::size_t mask = buckets_.size() - 1;
  const auto [first, second] = slab.steps;
  std::uint64_t first_row = slab.row;
  std::size_t first_place = slab.place;
  for (std::size_t i = 0; i < slab.lengths[0]; ++i) {
    const Ends limits_first = slab.limit | slab.limits[0][i];
    std::uint64_t row = first_row;
    std::size_t place = first_place;
    for (std::size_t j = 0; j < slab.lengths[1]; ++j) {
      const Ends limits = limits_first | slab.limits[1][j];
      const auto begin = static_cast<std::size_t>(row >> shift_) + place;
      for (const Bucket* bucket = &buckets[begin & mask];; bucket = &chained_[bucket->next], ++walked) {
        std::uint64_t left = bucket->within(limits);
        if (left != 0) [[unlikely]] {
          std::uint32_t* to = found.room_for(most);
          for (; left != 0; left &= left - 1) *to++ = bucket->numbers[static_cast<std::size_t>(std::countr_zero(left))];
          found.end_at(to);
        }
        if (bucket->next == none) break;
      }
      row += second.row;
      place += second.place;
    }
    first_row += first.row;
    first_place += first.place;
  }
  return walked;
}

/// Most are in the first bucket; further ones are full but for one, and are compared four numbers at a time.
CellTable::Where CellTable::where(std::size_t place, Ends ends, std::uint32_t number) {
  Bucket* bucket = &buckets_[place];
  for (std::size_t i = 0; i < bucket->count; ++i) {
    if (bucket->numbers[i] == number && bucket->ends[i] == ends) return {bucket, i};
  }
  while (bucket->next != none) {
    bucket = &chained_[bucket->next];
    ++walked_;
    for (std::uint64_t may_be = bucket->within(ends); may_be != 0; may_be &= may_be - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(may_be));
      if (bucket->numbers[i] == number && bucket->ends[i] == ends) return {bucket, i};
    }
  }
  return {nullptr, 0};
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
  // The last number takes the place of the one removed.
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
