#include "io/checkpoint.hpp"

#include "io/output_file.hpp"
#include "io/scene_reader.hpp"
#include "kds/version.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace kds::io {
namespace {

/// All of a checkpoint, for save() and restore().
struct Content {
  Checkpoint& checkpoint;

  template <class Archive>
  void archive(Archive& archive) {
    archive.tag("checkpoint of kds-collide, version " + std::to_string(KDS_VERSION_NUMBER));
    std::vector<char> world = checkpoint.world.bytes();
    archive(checkpoint.scene, checkpoint.events, checkpoint.parts, world);
    checkpoint.world = Snapshot(std::move(world));
  }
};

std::ifstream opened(const std::filesystem::path& file) {
  const auto fail = [&](const char* why) {
    throw SceneError(file.string(), "file", std::string("cannot be read: ") + why);
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) fail("Is a directory");
  std::ifstream in(file, std::ios::binary);
  if (!in) fail(std::strerror(errno));
  return in;
}

}  // namespace

std::uint64_t fingerprint(const std::filesystem::path& file) {
  std::ifstream in = opened(file);
  return kds::detail::checksum({std::istreambuf_iterator<char>(in), {}});
}

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  Checkpoint copy = checkpoint;
  Content content{copy};
  std::ostringstream text;
  write(text, save(content));
  OutputFile output(file.string());
  output.write(text.view());
  output.commit();
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  std::ifstream in = opened(file);
  try {
    Checkpoint checkpoint;
    Content content{checkpoint};
    restore(read_snapshot(in), content);
    return checkpoint;
  } catch (const std::runtime_error& error) {
    throw SceneError(file.string(), "checkpoint", error.what());
  }
}

}  // namespace kds::io
