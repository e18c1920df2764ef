// The blocks that the files of several processes are made of: parts of the events, and of checkpoints.
#pragma once

#include "io/output_file.hpp"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

namespace kds::io {

enum class BlockKind : std::uint64_t {
  section,  ///< SectionHead: a run begins, or one that had ended early goes on
  events,   ///< records, of a stretch that is run as one world
  /// The number of the step in the section, of domains, of the first of these logs and of logs; of each log its length
  /// in bytes, and its records.
  step,
  end,    ///< of the run; nothing follows
  bodies  ///< of a checkpoint: as BasicParallelWorld::save_parts() gives them
};

/// What a file is; it begins with the magic, and then come blocks. Each is its kind, its length in bytes, both in eight
/// bytes, its content, and a checksum of all that, which begins with the checksum of the block before; so a block that
/// is missing, or in another place, is noticed as one that is damaged. Numbers are as the machine has them.
struct BlockFormat {
  std::string_view magic;
  const char* what;
};
inline constexpr BlockFormat part_of_events{"KDSPART1", "part of events"};
inline constexpr BlockFormat part_of_checkpoint{"KDSBODY1", "part of a checkpoint"};
inline constexpr std::uint64_t first_chain = 0x9e3779b97f4a7c15;

/// How a section begins. `run` is a random number, the same in the parts of all processes.
struct SectionHead {
  std::uint64_t version = 0;  ///< of the program
  std::uint64_t scene = 0;    ///< fingerprint() of its file
  std::uint64_t bodies = 0;
  std::uint64_t run = 0;
  std::uint64_t rank = 0;
  std::uint64_t processes = 0;  ///< that take part in this section: those with lower ranks
};

/// Of a sequence of bytes after others. Each word changes it by a bijection, so damage within a word is always noticed.
/// By words, not by bytes as the checksum of snapshots: 0.2 ns a byte in place of 1.2, which for the 65 bytes of an
/// event is more than all else that reading it takes.
inline std::uint64_t chained(std::uint64_t before, std::string_view bytes) {
  const auto with = [&before](std::uint64_t word) {
    before = (before ^ word) * 0xbf58476d1ce4e5b9u;
    before ^= before >> 29;
  };
  std::size_t at = 0;
  for (std::uint64_t word = 0; at + sizeof word <= bytes.size(); at += sizeof word) {
    std::memcpy(&word, bytes.data() + at, sizeof word);
    with(word);
  }
  std::uint64_t last = 0;
  if (at < bytes.size()) std::memcpy(&last, bytes.data() + at, bytes.size() - at);
  with(last);
  return before;
}

/// Writes a block; `chain`: the checksum of the one before it, and then of this one.
void write_block(OutputFile& file, std::uint64_t& chain, BlockKind kind, std::string_view content);

/// Reads the blocks of a file. The file is open only while a block is read: there may be more parts than files that a
/// process may have open.
class BlockFile {
 public:
  /// Throws SceneError if it cannot be read, or is no such file.
  BlockFile(std::filesystem::path path, const BlockFormat& format);
  std::uint64_t size() const { return size_; }
  /// The checksum of the last block that was read or passed over.
  std::uint64_t chain() const { return chain_; }
  /// The kind of the next block, and its content. Throws SceneError if there is none, or it is damaged.
  BlockKind next(std::string& content);
  /// Passes over the next block, whose content may be damaged.
  void skip();
  bool at_end() const { return at_ == size_; }
  /// Throws SceneError: of this file, that it ...
  [[noreturn]] void refuse(const std::string& what) const;

 private:
  std::uint64_t next_length(char* head) const;
  void read(char* to, std::uint64_t size, std::uint64_t at) const;

  std::filesystem::path path_;
  const char* what_;
  std::uint64_t size_ = 0;
  std::uint64_t at_ = 0;
  std::uint64_t chain_ = first_chain;
};

}  // namespace kds::io
