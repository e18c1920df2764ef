#include "io/checkpoint.hpp"

#include "io/event_parts/block.hpp"
#include "io/output_file.hpp"
#include "io/scene_reader.hpp"
#include "kds/version.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
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
    archive(checkpoint.scene, checkpoint.events, checkpoint.parts, checkpoint.turn, checkpoint.bodies, world);
    if (checkpoint.turn > 1) throw std::runtime_error("snapshot: it has no such turn");
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

std::string bodies_path(const std::filesystem::path& file, std::uint64_t turn, std::size_t rank) {
  return part_path(file.string() + (turn == 0 ? ".a" : ".b"), rank);
}

CheckpointWriter::CheckpointWriter(std::filesystem::path file, kds::collision::Team& team,
                                   std::optional<std::uint64_t> turn)
    : file_(std::move(file)), team_(team) {
  if (!turn && team_.rank() == 0) {
    try {
      turn = read_checkpoint(file_).turn;
    } catch (const SceneError&) {  // There is none, and so nothing to keep until another one is there.
      turn = 1;
    }
  }
  turn_ = team_.of_first(turn.value_or(0));
  // Whether they can be written is found out now, and not after the hours that are to be saved.
  if (team_.rank() == 0) OutputFile(file_.string());
  OutputFile(bodies_path(file_, 1 - turn_, team_.rank()));
}

void CheckpointWriter::write_bodies(const std::vector<char>& block) {
  if (!part_) {
    part_ = std::make_unique<OutputFile>(bodies_path(file_, 1 - turn_, team_.rank()));
    part_->write(part_of_checkpoint.magic);
    place_ = {.bytes = 0, .chain = first_chain};
  }
  write_block(*part_, place_.chain, BlockKind::bodies, {block.data(), block.size()});
}

void CheckpointWriter::commit(Checkpoint checkpoint) {
  checkpoint.turn = 1 - turn_;
  checkpoint.bodies = places();
  if (team_.rank() == 0) {
    Content content{checkpoint};
    std::ostringstream text;
    write(text, save(content));
    OutputFile output(file_.string());
    output.write(text.view());
    output.commit();
  }
  team_.of_first(true);
  remove_parts(turn_, team_.rank());  // No file names them any more.
  turn_ = checkpoint.turn;
}

/// The files of bodies are whole, and in their places, when this returns. In process 0: what they are, by rank.
std::vector<PartPlace> CheckpointWriter::places() {
  std::vector<PartPlace> all;
  kds::collision::Letters letters;
  if (part_) {
    place_.bytes = part_->flush();
    part_->commit();
    part_.reset();
    // Those of a run of more processes that was ended before its checkpoint was there.
    remove_parts(1 - turn_, team_.rank() + team_.count());
    all.resize(team_.count());
    all[team_.rank()] = place_;
    if (team_.rank() > 0) letters.to(0)(place_);
  }
  team_.exchange(std::move(letters), [&](std::size_t process, auto& reader) { reader(all[process]); });
  return all;
}

/// The files of bodies of the processes `from`, and others that this one answers for.
void CheckpointWriter::remove_parts(std::uint64_t turn, std::size_t from) const {
  std::error_code ignored;
  while (std::filesystem::remove(bodies_path(file_, turn, from), ignored)) from += team_.count();
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

CheckpointReader::CheckpointReader(std::filesystem::path file, const Checkpoint& checkpoint, std::size_t rank,
                                   std::size_t processes)
    : file_(std::move(file)), turn_(checkpoint.turn), bodies_(checkpoint.bodies), rank_(rank), processes_(processes) {}

CheckpointReader::~CheckpointReader() = default;

void CheckpointReader::check() const {
  for (std::size_t part = rank_; part < bodies_.size(); part += processes_) {
    BlockFile file(path(part), part_of_checkpoint);
    const PartPlace& place = bodies_[part];
    if (file.size() != place.bytes) {
      file.refuse("has " + std::to_string(file.size()) + " bytes, and there were " + std::to_string(place.bytes) +
                  ": it has been cut, or is of another checkpoint");
    }
    for (std::string content; !file.at_end();) file.next(content);
    if (file.chain() != place.chain) file.refuse("is of another checkpoint");
  }
}

bool CheckpointReader::read(std::vector<char>& block) {
  for (; part_ < bodies_.size(); ++part_, block_ = 0, open_.reset()) {
    if (!open_) open_ = std::make_unique<BlockFile>(path(part_), part_of_checkpoint);
    while (!open_->at_end()) {
      if ((part_ + block_++) % processes_ != rank_) {
        open_->skip();
        continue;
      }
      std::string content;
      open_->next(content);
      block.assign(content.begin(), content.end());
      return true;
    }
  }
  return false;
}

}  // namespace kds::io
