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

/// Refuses a part of which the beginning is not what the run had written; `file` does so.
void check_beginning(const std::string& path, const FilePlace& from, const OutputFile& file) {
  BlockFile begun(begun_path(path), part_of_events);
  for (std::string content; begun.place().bytes < from.bytes;) begun.next(content);
  if (begun.place().bytes != from.bytes || begun.place().checksum != from.checksum) {
    file.refuse_to_go_on("it is not what the run had written");
  }
}

/// Whether a file is a part that a run has written.
bool is_of_run(const std::filesystem::path& path, std::uint64_t run) {
  try {
    BlockFile part(path, part_of_events);
    std::string content;
    SectionHead head;
    if (part.next(content) != BlockKind::section || content.size() != sizeof head) return false;
    std::memcpy(&head, content.data(), sizeof head);
    return head.run == run;
  } catch (const SceneError&) {
    return false;
  }
}

/// The same of a part that has not ended; one that has been made, and not been written yet, is no one's.
bool is_left_by_run(const std::filesystem::path& path, std::uint64_t run) {
  std::error_code ignored;
  return std::filesystem::file_size(path, ignored) == 0 || is_of_run(path, run);
}

}  // namespace

std::string part_path(const std::string& file, std::size_t rank) { return file + '.' + std::to_string(rank); }

EventPart::EventPart(const std::string& path, const PartOf& of) : of_(of), file_(path), chain_(first_chain) {}

EventPart::EventPart(const std::string& path, const PartOf& of, const std::optional<FilePlace>& from)
    : of_(of),
      file_(path, from ? std::optional(from->bytes) : std::nullopt),
      chain_(from && from->bytes > 0 ? from->checksum : first_chain),
      has_magic_(from && from->bytes > 0) {
  if (has_magic_) check_beginning(path, *from, file_);
  const std::filesystem::path left = unfinished_path(path);
  if (from && !has_magic_ && !is_left_by_run(left, of.run)) {
    throw OutputError(left.string() + ": file: is there already, of a run that has not ended", true);
  }
}

/// Nothing is written before there is something to write: a run may be refused when its parts are open.
void EventPart::begin() {
  if (std::exchange(begun_, true)) return;
  if (!has_magic_) file_.write(part_of_events.magic);
  if (of_.rank >= of_.processes) return;
  std::string content;
  append_bytes(content,
               SectionHead{KDS_VERSION_NUMBER, of_.scene, of_.bodies, of_.run, of_.section, of_.rank, of_.processes});
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
    for (const auto& event : log) {
      if (event.kind == kds::collision::DomainEvent::Kind::mark) append_mark(step_, event);
      if (!is_in_files(event)) continue;
      append_record(step_, to_event(event), event.other_owner, event.follows() ? &event.cause : nullptr);
    }
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

void EventPart::write(BlockKind kind, const std::string& content) {
  begin();
  write_block(file_, chain_, kind, content);
}

FilePlace EventPart::flush() {
  begin();
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
    : team_(team), file_(file), run_(of.run), count_(team.count()) {
  of.rank = team.rank(), of.processes = team.count();
  parts_.emplace_back(part_path(file, of.rank), of);
}

EventsApart::EventsApart(const std::string& file, PartOf of, kds::collision::Team& team,
                         const std::vector<FilePlace>& from)
    : team_(team), file_(file), run_(of.run), count_(std::max(from.size(), team.count())) {
  of.processes = team.count();
  for (of.rank = team.rank(); of.rank < count_; of.rank += of.processes) {
    std::optional<FilePlace> place;
    if (!from.empty()) place = of.rank < from.size() ? from[of.rank] : FilePlace{};
    parts_.emplace_back(part_path(file, of.rank), of, place);
  }
}

std::vector<FilePlace> EventsApart::places() {
  std::vector<FilePlace> all(count_), mine;
  for (EventPart& part : parts_) mine.push_back(part.flush());
  const auto note = [&](std::size_t process, const std::vector<FilePlace>& places) {
    for (std::size_t i = 0; i < places.size(); ++i) all[process + i * team_.count()] = places[i];
  };
  note(team_.rank(), mine);
  kds::collision::Letters letters;
  if (team_.rank() > 0) letters.to(0)(mine);
  team_.exchange(std::move(letters), [&](std::size_t process, auto& reader) {
    std::vector<FilePlace> places;
    reader(places);
    note(process, places);
  });
  return all;
}

void EventsApart::discard() {
  for (EventPart& part : parts_) part.discard();
}

void EventsApart::close() {
  for (EventPart& part : parts_) part.close();
}

void EventsApart::commit() {
  for (EventPart& part : parts_) part.commit();
  const auto remove_others = [this](const std::string& ending, const auto& is_ours) {
    for (const std::size_t number : part_numbers(file_, ending)) {
      if (number < count_ || number % team_.count() != team_.rank()) continue;
      const std::filesystem::path left = part_path(file_, number) + ending;
      std::error_code ignored;
      if (is_ours(left, run_)) std::filesystem::remove(left, ignored);
    }
  };
  remove_others("", is_of_run);
  remove_others(".unfinished", is_left_by_run);
}

}  // namespace kds::io
