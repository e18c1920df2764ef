// The state of a run in a file, to go on from.
#pragma once

#include "io/event_parts.hpp"
#include "kds/framework/snapshot.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace kds::io {

/// A run as it was at a time, between two events.
struct Checkpoint {
  std::uint64_t scene = 0;         ///< fingerprint() of the scene's file
  std::uint64_t events = 0;        ///< bytes that the events so far take
  std::vector<PartPlace> parts{};  ///< in their place where each process writes its own: where these are, by rank
  Snapshot world;
};

/// The same for files of the same bytes, and hardly ever for others. Throws SceneError if it cannot be read.
std::uint64_t fingerprint(const std::filesystem::path& file);

/// Replaces the file as a whole, or leaves it as it is. Throws OutputError.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws SceneError for a file that cannot be read, is damaged, is no checkpoint, or is one of another program or of
/// another kind of machine.
Checkpoint read_checkpoint(const std::filesystem::path& file);

}  // namespace kds::io
