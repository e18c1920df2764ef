// The blocks that the files of several processes are made of: parts of the events, and of checkpoints.
#pragma once

#include "io/checksum.hpp"
#include "io/output_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kds::io {

/// What a block of a part of a log contains.
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

/// Whether a file begins as one of this format.
bool has_format(const std::filesystem::path& path, const BlockFormat& format);

/// The numbers of the files FILE.0, FILE.1... that there are, with `ending` after the number.
std::vector<std::size_t> part_numbers(const std::string& file, const std::string& ending);

/// How a section begins. `run` and `section` are random numbers, the same in the parts of all processes; that of the
/// run is the same in all its sections.
struct SectionHead {
  std::uint64_t version = 0;  ///< of the program
  std::uint64_t scene = 0;    ///< fingerprint()
  std::uint64_t bodies = 0;
  std::uint64_t run = 0;
  std::uint64_t section = 0;
  std::uint64_t rank = 0;
  std::uint64_t processes = 0;  ///< that take part in this section: those with lower ranks
};

/// Writes a block; `chain`: the checksum of the one before it, and then of this one, which is FilePlace::checksum of
/// such files.
void write_block(OutputFile& file, std::uint64_t& chain, BlockKind kind, std::string_view content);

/// Reads the blocks of a file. The file is open only while a block is read: there may be more parts than files that a
/// process may have open.
class BlockFile {
 public:
  /// Throws SceneError if it cannot be read, or is no such file.
  BlockFile(std::filesystem::path path, const BlockFormat& format);
  std::uint64_t size() const { return size_; }
  /// What has been read or passed over, and the checksum of the last block of it.
  FilePlace place() const { return {at_, chain_}; }
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
