// Checksums of bytes that are written and read: they detect damage, but not a forgery.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace kds::io {

inline constexpr std::uint64_t first_chain = 0x9e3779b97f4a7c15;

/// Of a word after others. A bijection of either: damage within one word is always noticed.
inline std::uint64_t chained(std::uint64_t before, std::uint64_t word) {
  before = (before ^ word) * 0xbf58476d1ce4e5b9u;
  return before ^ before >> 29;
}

/// Of a sequence of bytes after others. By words, not by bytes as the checksum of snapshots: 0.2 ns a byte in place of
/// 1.2, which for the 65 bytes of an event is more than all else that reading it takes.
inline std::uint64_t chained(std::uint64_t before, std::string_view bytes) {
  std::size_t at = 0;
  for (std::uint64_t word = 0; at + sizeof word <= bytes.size(); at += sizeof word) {
    std::memcpy(&word, bytes.data() + at, sizeof word);
    before = chained(before, word);
  }
  std::uint64_t last = 0;
  if (at < bytes.size()) std::memcpy(&last, bytes.data() + at, bytes.size() - at);
  return chained(before, last);
}

/// Of bytes that come one stretch after another; it does not depend on where one ends and the next begins.
class Checksum {
 public:
  void add(std::string_view bytes) {
    const std::size_t before = length_ % word_size;
    length_ += bytes.size();
    std::uint64_t chain = chain_;
    const auto add_word = [&chain](const char* at) {
      std::uint64_t word = 0;
      std::memcpy(&word, at, sizeof word);
      chain = chained(chain, word);
    };
    if (before > 0) {
      const std::size_t more = std::min(word_size - before, bytes.size());
      if (more > 0) std::memcpy(rest_.data() + before, bytes.data(), more);
      bytes.remove_prefix(more);
      if (before + more < word_size) return;
      add_word(rest_.data());
    }
    for (; bytes.size() >= word_size; bytes.remove_prefix(word_size)) add_word(bytes.data());
    if (!bytes.empty()) std::memcpy(rest_.data(), bytes.data(), bytes.size());
    chain_ = chain;
  }
  std::uint64_t value() const { return chained(chained(chain_, {rest_.data(), length_ % word_size}), length_); }

 private:
  static constexpr std::size_t word_size = sizeof(std::uint64_t);

  std::uint64_t chain_ = first_chain;
  std::uint64_t length_ = 0;
  std::array<char, word_size> rest_{};  ///< of the bytes, those that do not fill a word yet
};

/// Of all the bytes of a list of plain values.
template <class Values>
std::uint64_t checksum_of(const Values& values) {
  Checksum sum;
  if (!values.empty()) sum.add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])});
  return sum.value();
}

}  // namespace kds::io
