// How parts are written.
#include "io/event_parts.hpp"
#include "io/event_parts/block.hpp"
#include "io/event_parts/event_record.hpp"
#include "kds/version.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <type_traits>
#include <utility>

namespace kds::io {
namespace {

template <class T>
void append_bytes(std::string& bytes, const T& value) {
  static_assert(std::has_unique_object_representations_v<T>);
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(T));
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

/// As OutputFile names it.
std::string unfinished(const std::string& path) { return past_dangling_links(path).string() + ".unfinished"; }

/// Refuses a file that is longer than it was when the state was written, and has something else there.
const std::string& checked(const std::string& path, const PartPlace& from) {
  std::ifstream in(unfinished(path), std::ios::binary);
  std::uint64_t chain = 0;
  char letters[sizeof chain];
  if (from.bytes < sizeof chain || !in.seekg(static_cast<std::streamoff>(from.bytes - sizeof chain))) return path;
  if (!in.read(letters, sizeof letters)) return path;  // OutputFile says that it is too short
  std::memcpy(&chain, letters, sizeof chain);
  if (chain != from.chain) {
    throw OutputError(unfinished(path) + ": file: cannot be gone on with: it is not what the run had written", true);
  }
  return path;
}

}  // namespace

std::string part_path(const std::string& file, std::size_t rank) { return file + '.' + std::to_string(rank); }

EventPart::EventPart(const std::string& path, const PartOf& of) : file_(path), chain_(first_chain) {
  file_.write(part_of_events.magic);
  begin(of);
}

EventPart::EventPart(const std::string& path, const PartOf& of, const PartPlace& from)
    : file_(checked(path, from), from.bytes), chain_(from.bytes > 0 ? from.chain : first_chain) {
  if (from.bytes == 0) file_.write(part_of_events.magic);
  begin(of);
}

void EventPart::begin(const PartOf& of) {
  if (of.rank >= of.processes) return;
  std::string content;
  append_bytes(content, SectionHead{KDS_VERSION_NUMBER, of.scene, of.bodies, of.run, of.rank, of.processes});
  write(BlockKind::section, content);
}

void EventPart::on_event(const Event& event) {
  constexpr std::size_t enough = 1 << 16;  // bytes
  append_record(records_, event, kds::collision::DomainEvent::nobody);
  if (records_.size() >= enough) write_events();
}

void EventPart::on_step(const kds::collision::StepEvents& events) {
  write_events();
  step_.clear();
  for (const std::uint64_t number : {std::uint64_t{steps_++}, std::uint64_t{events.domains},
                                     std::uint64_t{events.first}, std::uint64_t{events.logs.size()}}) {
    append_bytes(step_, number);
  }
  for (const auto& log : events.logs) {
    const std::size_t before = step_.size();
    append_bytes(step_, std::uint64_t{0});
    for (const auto& event : log) append_record(step_, to_event(event), event.other_owner);
    const std::uint64_t length = step_.size() - before - sizeof length;
    std::memcpy(step_.data() + before, &length, sizeof length);
  }
  write(BlockKind::step, step_);
}

void EventPart::write_events() {
  if (records_.empty()) return;
  write(BlockKind::events, records_);
  records_.clear();
}

void EventPart::write(BlockKind kind, const std::string& content) { write_block(file_, chain_, kind, content); }

PartPlace EventPart::flush() {
  write_events();
  const std::uint64_t bytes = file_.flush();
  return {bytes, chain_};
}

void EventPart::close() {
  write_events();
  write(BlockKind::end, "");
  file_.close();
}

void EventPart::commit() { file_.commit(); }

EventsApart::EventsApart(const std::string& file, PartOf of, kds::collision::Team& team)
    : team_(team), count_(team.count()) {
  of.rank = team.rank(), of.processes = team.count();
  parts_.emplace_back(part_path(file, of.rank), of);
}

EventsApart::EventsApart(const std::string& file, PartOf of, kds::collision::Team& team,
                         const std::vector<PartPlace>& from)
    : team_(team), count_(std::max(from.size(), team.count())) {
  of.processes = team.count();
  for (of.rank = team.rank(); of.rank < count_; of.rank += of.processes) {
    const std::string path = part_path(file, of.rank);
    const PartPlace place = of.rank < from.size() ? from[of.rank] : PartPlace{};
    // What a run has left of a part that it had begun after its last checkpoint.
    if (!from.empty() && place.bytes == 0) std::filesystem::remove(unfinished(path));
    parts_.emplace_back(path, of, place);
  }
}

std::vector<PartPlace> EventsApart::places() {
  std::vector<PartPlace> all(count_), mine;
  for (EventPart& part : parts_) mine.push_back(part.flush());
  const auto note = [&](std::size_t process, const std::vector<PartPlace>& places) {
    for (std::size_t i = 0; i < places.size(); ++i) all[process + i * team_.count()] = places[i];
  };
  note(team_.rank(), mine);
  kds::collision::Letters letters;
  if (team_.rank() > 0) letters.to(0)(mine);
  team_.exchange(std::move(letters), [&](std::size_t process, auto& reader) {
    std::vector<PartPlace> places;
    reader(places);
    note(process, places);
  });
  return all;
}

void EventsApart::close() {
  for (EventPart& part : parts_) part.close();
}

void EventsApart::commit() {
  for (EventPart& part : parts_) part.commit();
}

}  // namespace kds::io
