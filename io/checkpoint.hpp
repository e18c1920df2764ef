// The state of a run in files, to go on from.
#pragma once

#include "collision/parallel/processes.hpp"
#include "io/event_parts.hpp"
#include "io/output_file.hpp"
#include "io/scene.hpp"
#include "kds/framework/snapshot.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kds::io {

/// An option of a run, and what was given, as text.
struct SavedOption {
  std::string name, value;
  friend bool operator==(const SavedOption&, const SavedOption&) = default;

  template <class Archive>
  void archive(Archive& archive) {
    archive(name, value);
  }
};

/// A run as it was at a time, between two events: what is in the file of a checkpoint. Of a scene that is divided the
/// bodies are in files beside it, one of each process, in its place.
struct Checkpoint {
  std::uint64_t run = 0;               ///< a random number: that of the run, in all its parts
  std::vector<std::uint64_t> scene{};  ///< the checksums of Scene::sources
  std::vector<SavedOption> options{};  ///< those that decide events
  double time = 0;                     ///< s
  std::optional<FilePlace> events{};   ///< where the events are, if one process writes all
  std::vector<FilePlace> parts{};      ///< in their place where each process writes its own: where these are, by rank
  std::uint64_t turn = 0;              ///< 0 or 1, that of the checkpoint before it is the other: part of the names
  std::vector<FilePlace> bodies{};  ///< the length and the checksum of each file of bodies, by rank; empty: in `world`
  Snapshot world;
};

/// The checksums of the sources of a scene: of a share after complete().
std::vector<std::uint64_t> checksums_of(const Scene& scene);
/// Throws SceneError, which names the file, if the scene is not the one that a checkpoint is of. `file`: of the scene.
void require_same_scene(const Scene& scene, const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Where the bodies are that a process has written: FILE.a.0, FILE.a.1..., at the next turn FILE.b.0...
std::string bodies_path(const std::filesystem::path& file, std::uint64_t turn, std::size_t rank);

/// Writes the checkpoints of a run, each in the place of the one before. What is ended at any moment, by a power cut,
/// too, leaves one of the two, whole: files of bodies have other names than those before, and the file that names them
/// is replaced last, when they are on the disk. The first one removes all files of bodies beside the file which it does
/// not name. All processes of the run make the same calls but of write_bodies(). Throws OutputError.
class CheckpointWriter {
 public:
  /// `turn`: of the checkpoint that is there, from which the run goes on; if none is given, it is looked up. The team
  /// must outlive this.
  CheckpointWriter(std::filesystem::path file, kds::collision::Team& team, std::optional<std::uint64_t> turn = {});

  /// For RunOptions::checkpoint_bodies: the next block of this process.
  void write_bodies(const std::vector<char>& block);
  /// `checkpoint`: in process 0, but for what is about the bodies that have been written; the others' does not count.
  void commit(Checkpoint checkpoint);
  /// At the end of a run that has gone on from a checkpoint with the bodies in so many files: removes what earlier runs
  /// have left, if no checkpoint of this run has.
  void finish(std::size_t named) const;

 private:
  std::vector<FilePlace> places();
  void remove_others(std::uint64_t turn_named, std::size_t named) const;

  const std::filesystem::path file_;
  kds::collision::Team& team_;
  std::uint64_t turn_ = 0;  ///< of the checkpoint that is there
  bool is_first_ = true;    ///< the next one, of this run
  std::unique_ptr<OutputFile> part_;
  FilePlace place_;  ///< in it
};

/// Throws SceneError for a file that cannot be read, is damaged, is no checkpoint, or is one of another program or of
/// another kind of machine.
Checkpoint read_checkpoint(const std::filesystem::path& file);

/// Reads the bodies of a checkpoint: of several processes each a share of the blocks.
class CheckpointReader {
 public:
  /// `file`, `checkpoint`: as of read_checkpoint(). `rank`: of so many processes.
  CheckpointReader(std::filesystem::path file, const Checkpoint& checkpoint, std::size_t rank, std::size_t processes);
  ~CheckpointReader();

  /// Reads a share of the files from end to end: afterwards, if it has not thrown in any of the processes, all of them
  /// are those that belong to the checkpoint. Throws SceneError for one that is missing, cut, damaged, or of another
  /// checkpoint.
  void check() const;
  /// For RunOptions::resume_bodies: the next block for this process, false if it has had them all. Throws SceneError.
  bool read(std::vector<char>& block);

 private:
  std::string path(std::size_t part) const { return bodies_path(file_, turn_, part); }

  const std::filesystem::path file_;
  const std::uint64_t turn_;
  const std::vector<FilePlace> bodies_;
  const std::size_t rank_, processes_;
  std::size_t part_ = 0, block_ = 0;  ///< the next one of all
  std::unique_ptr<BlockFile> open_;
};

}  // namespace kds::io
