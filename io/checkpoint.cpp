#include "io/checkpoint.hpp"

#include "io/event_parts/block.hpp"
#include "io/output_file.hpp"
#include "io/scene_reader.hpp"
#include "kds/version.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace kds::io {
namespace {

/// It changes with the members, so that bytes of another layout are refused as such.
constexpr int checkpoint_form = 2;

/// All of a checkpoint, for save() and restore().
struct Content {
  Checkpoint& checkpoint;

  template <class Archive>
  void archive(Archive& archive) {
    archive.tag("checkpoint of kds-collide, version " + std::to_string(KDS_VERSION_NUMBER) + ", form " +
                std::to_string(checkpoint_form));
    std::vector<char> world = checkpoint.world.bytes();
    archive(checkpoint.run, checkpoint.scene, checkpoint.options, checkpoint.time, checkpoint.events, checkpoint.parts,
            checkpoint.turn, checkpoint.bodies, world);
    if (checkpoint.turn > 1) throw std::runtime_error("snapshot: it has no such turn");
    checkpoint.world = Snapshot(std::move(world));
  }
};

const char* turn_ending(std::uint64_t turn) { return turn == 0 ? ".a" : ".b"; }

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

std::vector<std::uint64_t> checksums_of(const Scene& scene) {
  std::vector<std::uint64_t> all;
  for (const SceneSource& source : scene.sources) all.push_back(source.checksum);
  return all;
}

void require_same_scene(const Scene& scene, const std::filesystem::path& file, const Checkpoint& checkpoint) {
  const char* const changed = "is not what it was when the checkpoint was written";
  for (std::size_t i = 0; i < scene.sources.size(); ++i) {
    const SceneSource& source = scene.sources[i];
    if (i < checkpoint.scene.size() && checkpoint.scene[i] == source.checksum) continue;
    if (source.where.empty()) throw SceneError(file.string(), "file", changed);
    throw SceneError(file.string(), source.where, source.file + ": " + changed);
  }
}

std::string bodies_path(const std::filesystem::path& file, std::uint64_t turn, std::size_t rank) {
  return part_path(file.string() + turn_ending(turn), rank);
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
  if (team_.rank() == 0) OutputFile(file_.string(), 0);
  OutputFile(bodies_path(file_, 1 - turn_, team_.rank()), 0);
}

void CheckpointWriter::write_bodies(const std::vector<char>& block) {
  if (!part_) {
    part_ = std::make_unique<OutputFile>(bodies_path(file_, 1 - turn_, team_.rank()), 0);
    part_->write(part_of_checkpoint.magic);
    place_ = {.bytes = 0, .checksum = first_chain};
  }
  write_block(*part_, place_.checksum, BlockKind::bodies, {block.data(), block.size()});
}

void CheckpointWriter::commit(Checkpoint checkpoint) {
  checkpoint.turn = 1 - turn_;
  checkpoint.bodies = places();
  std::error_code ignored;
  try {
    if (team_.rank() == 0) {
      Content content{checkpoint};
      std::ostringstream text;
      write(text, save(content));
      OutputFile output(file_.string(), 0);
      output.write(text.view());
      output.commit();
    }
    team_.of_first(true);
  } catch (...) {  // No checkpoint names the file of bodies.
    if (!checkpoint.bodies.empty()) std::filesystem::remove(bodies_path(file_, checkpoint.turn, team_.rank()), ignored);
    throw;
  }
  // No file names those before any more. Of this run each process has written one, at most.
  if (std::exchange(is_first_, false)) {
    remove_others(checkpoint.turn, checkpoint.bodies.size());
  } else {
    std::filesystem::remove(bodies_path(file_, turn_, team_.rank()), ignored);
  }
  turn_ = checkpoint.turn;
}

/// The files of bodies are whole, and in their places, when this returns. In process 0: what they are, by rank.
std::vector<FilePlace> CheckpointWriter::places() {
  std::vector<FilePlace> all;
  kds::collision::Letters letters;
  if (part_) {
    place_.bytes = part_->flush();
    part_->commit();
    part_.reset();
    all.resize(team_.count());
    all[team_.rank()] = place_;
    if (team_.rank() > 0) letters.to(0)(place_);
  }
  team_.exchange(std::move(letters), [&](std::size_t process, auto& reader) { reader(all[process]); });
  return all;
}

void CheckpointWriter::finish(std::size_t named) const {
  if (is_first_) remove_others(turn_, named);
}

/// Files of bodies that the checkpoint does not name which is there now, of this turn and so many processes: of the one
/// before it, and of runs that were ended. Each process removes some.
void CheckpointWriter::remove_others(std::uint64_t turn_named, std::size_t named) const {
  std::error_code ignored;
  for (const std::uint64_t turn : {turn_named, 1 - turn_named}) {
    const std::string parts = file_.string() + turn_ending(turn);
    for (const char* const ending : {"", ".unfinished"}) {
      const bool whole = *ending == 0;
      for (const std::size_t number : part_numbers(parts, ending)) {
        const std::filesystem::path left = part_path(parts, number) + ending;
        if (number % team_.count() != team_.rank() || (whole && turn == turn_named && number < named)) continue;
        const bool not_begun = !whole && std::filesystem::file_size(left, ignored) == 0;
        if (not_begun || has_format(left, part_of_checkpoint)) std::filesystem::remove(left, ignored);
      }
    }
  }
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
    const FilePlace& place = bodies_[part];
    if (file.size() != place.bytes) {
      file.refuse("has " + std::to_string(file.size()) + " bytes, and there were " + std::to_string(place.bytes) +
                  ": it has been cut, or is of another checkpoint");
    }
    for (std::string content; !file.at_end();) file.next(content);
    if (file.place().checksum != place.checksum) file.refuse("is of another checkpoint");
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
