#include "io/event_parts/block.hpp"

#include "io/scene.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

namespace kds::io {
namespace {

/// What is not the content of a block: its head and its checksum.
constexpr std::uint64_t head_size = 2 * sizeof(std::uint64_t);
constexpr std::uint64_t around = head_size + sizeof(std::uint64_t);

}  // namespace

bool has_format(const std::filesystem::path& path, const BlockFormat& format) {
  std::string magic(format.magic.size(), '\0');
  std::ifstream in(path, std::ios::binary);
  return in.read(magic.data(), static_cast<std::streamsize>(magic.size())) && magic == format.magic;
}

std::vector<std::size_t> part_numbers(const std::string& file, const std::string& ending) {
  const std::filesystem::path path(file);
  const std::string begin = path.filename().string() + '.';
  std::vector<std::size_t> numbers;
  std::error_code ignored;
  for (std::filesystem::directory_iterator entry(path.has_parent_path() ? path.parent_path() : ".", ignored), end;
       entry != end; entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(begin) || !name.ends_with(ending) || name.size() < begin.size() + ending.size()) continue;
    const std::string digits = name.substr(begin.size(), name.size() - begin.size() - ending.size());
    std::size_t number = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (std::to_string(number) == digits && entry->is_regular_file(ignored)) numbers.push_back(number);
  }
  return numbers;
}

void write_block(OutputFile& file, std::uint64_t& chain, BlockKind kind, std::string_view content) {
  const std::uint64_t head[2] = {static_cast<std::uint64_t>(kind), content.size()};
  char letters[sizeof head], checksum[sizeof chain];
  std::memcpy(letters, head, sizeof head);
  chain = chained(chained(chain, {letters, sizeof letters}), content);
  std::memcpy(checksum, &chain, sizeof chain);
  file.write({letters, sizeof letters});
  file.write(content);
  file.write({checksum, sizeof checksum});
}

BlockFile::BlockFile(std::filesystem::path path, const BlockFormat& format)
    : path_(std::move(path)), what_(format.what) {
  std::error_code error;
  size_ = std::filesystem::file_size(path_, error);
  if (error) throw SceneError(path_.string(), "file", "cannot be read: " + error.message());
  std::string magic(std::min<std::uint64_t>(size_, format.magic.size()), '\0');
  read(magic.data(), magic.size(), 0);
  if (magic != format.magic) refuse("is none, or is of another version");
  at_ = magic.size();
}

/// The length of the content of the next block, whose head is read.
std::uint64_t BlockFile::next_length(char* head) const {
  if (at_end()) refuse("ends before the run: it has not ended, or this has been cut");
  if (size_ - at_ < around) refuse("has been cut");
  read(head, head_size, at_);
  std::uint64_t length = 0;
  std::memcpy(&length, head + sizeof length, sizeof length);
  if (length > size_ - at_ - around) refuse("has been cut, or is damaged");
  return length;
}

BlockKind BlockFile::next(std::string& content) {
  char head[head_size], last[sizeof(std::uint64_t)];
  const std::uint64_t length = next_length(head);
  content.resize(length);
  read(content.data(), length, at_ + sizeof head);
  read(last, sizeof last, at_ + sizeof head + length);
  std::uint64_t checksum = 0, kind = 0;
  std::memcpy(&checksum, last, sizeof checksum);
  std::memcpy(&kind, head, sizeof kind);
  chain_ = chained(chained(chain_, {head, sizeof head}), content);
  if (checksum != chain_ || kind > static_cast<std::uint64_t>(BlockKind::bodies)) refuse("is damaged");
  at_ += around + length;
  return static_cast<BlockKind>(kind);
}

void BlockFile::skip() {
  char head[head_size], last[sizeof chain_];
  at_ += around + next_length(head);
  read(last, sizeof last, at_ - sizeof last);
  std::memcpy(&chain_, last, sizeof chain_);
}

void BlockFile::read(char* to, std::uint64_t size, std::uint64_t at) const {
  std::ifstream in(path_, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(at));
  if (!in.read(to, static_cast<std::streamsize>(size))) {
    throw SceneError(path_.string(), "file", std::string("cannot be read: ") + std::strerror(errno));
  }
}

void BlockFile::refuse(const std::string& what) const { throw SceneError(path_.string(), what_, what); }

}  // namespace kds::io
