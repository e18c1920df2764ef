#include "io/event_parts/block.hpp"

#include "io/scene.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

namespace kds::io {
namespace {

/// What is not the content of a block: its head and its checksum.
constexpr std::uint64_t around = 3 * sizeof(std::uint64_t);

}  // namespace

BlockFile::BlockFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  size_ = std::filesystem::file_size(path_, error);
  if (error) throw SceneError(path_.string(), "file", "cannot be read: " + error.message());
  std::string magic(std::min<std::uint64_t>(size_, part_magic.size()), '\0');
  read(magic.data(), magic.size(), 0);
  if (magic != part_magic) refuse("is none, or is of another version");
  at_ = magic.size();
}

BlockKind BlockFile::next(std::string& content) {
  if (at_end()) refuse("ends before the run: it has not ended, or this has been cut");
  if (size_ - at_ < around) refuse("has been cut");
  std::uint64_t head[2], checksum = 0;
  char letters[sizeof head];
  read(letters, sizeof head, at_);
  std::memcpy(head, letters, sizeof head);
  if (head[1] > size_ - at_ - around) refuse("has been cut, or is damaged");
  content.resize(head[1]);
  read(content.data(), head[1], at_ + sizeof head);
  char last[sizeof checksum];
  read(last, sizeof last, at_ + sizeof head + head[1]);
  std::memcpy(&checksum, last, sizeof checksum);
  chain_ = chained(chained(chain_, {letters, sizeof head}), content);
  const auto kind = static_cast<BlockKind>(head[0]);
  if (checksum != chain_ || kind > BlockKind::end) refuse("is damaged");
  at_ += around + head[1];
  return kind;
}

void BlockFile::read(char* to, std::uint64_t size, std::uint64_t at) const {
  std::ifstream in(path_, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(at));
  if (!in.read(to, static_cast<std::streamsize>(size))) {
    throw SceneError(path_.string(), "file", std::string("cannot be read: ") + std::strerror(errno));
  }
}

void BlockFile::refuse(const std::string& what) const { throw SceneError(path_.string(), "part of events", what); }

}  // namespace kds::io
