// How parts are read.
#include "io/event_parts.hpp"

#include "collision/in_parts.hpp"
#include "io/event_csv.hpp"
#include "io/event_parts/block.hpp"
#include "io/event_parts/event_record.hpp"
#include "kds/version.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace kds::io {

using kds::collision::StepEvents;

namespace {

constexpr const char* where = "part of events";

/// What one process has recorded in a step.
StepEvents step_of(Records& records, std::uint64_t& number) {
  number = records.number();
  StepEvents events;
  events.domains = records.number();
  events.first = records.number();
  const std::size_t logs = records.number();
  if (events.first > events.domains || logs > events.domains - events.first) {
    throw std::runtime_error("has a step of domains that there are not");
  }
  for (std::size_t i = 0; i < logs; ++i) {
    auto& log = events.logs.emplace_back();
    for (std::size_t left = records.number(); left > 0; --left) {
      log.push_back(records.event_of(events.first + i, events.domains));
    }
  }
  return events;
}

}  // namespace

void EventParts::Stretch::tell(EventSink& sink) const {
  std::vector<StepEvents> steps;
  std::uint64_t step = 0;
  for (std::size_t rank = 0; rank < contents_.size(); ++rank) {
    try {
      Records records(contents_[rank], bodies_);
      if (is_step_) {
        std::uint64_t number = 0;
        steps.push_back(step_of(records, number));
        if (rank == 0) step = number;
        if (number != step) throw std::runtime_error("has another step than the part of process 0");
      } else {
        for (std::size_t left = records.number(); left > 0; --left) sink.on_event(records.event());
      }
      if (!records.at_end()) throw std::runtime_error("has more than its events");
    } catch (const std::runtime_error& error) {
      throw SceneError(files_[rank].string(), where, error.what());
    }
  }
  try {
    for (auto merge = kds::collision::merged(std::move(steps)); !merge.empty();) {
      sink.on_event(to_event(merge.take_next()));
    }
  } catch (const std::logic_error&) {
    throw SceneError(files_[0].string(), where, "does not agree with the others about what has happened");
  }
}

EventParts::EventParts(std::string file, std::uint64_t scene, std::size_t bodies)
    : file_(std::move(file)), scene_(scene), bodies_(bodies) {
  Block block = part(0).next();
  if (block.kind != BlockKind::section) part(0).refuse("does not begin with a run");
  begin_section(block.content);
}

EventParts::~EventParts() = default;

BlockFile& EventParts::part(std::size_t rank) {
  while (parts_.size() <= rank) parts_.push_back(std::make_unique<BlockFile>(part_path(file_, parts_.size())));
  return *parts_[rank];
}

/// The content of the next block of a part, which has to be of this kind.
std::string EventParts::of_part(std::size_t rank, std::uint64_t kind) {
  Block block = part(rank).next();
  if (static_cast<std::uint64_t>(block.kind) != kind) part(rank).refuse("does not fit to that of process 0");
  return std::move(block.content);
}

/// `content`: of its block in the part of process 0.
void EventParts::begin_section(const std::string& content) {
  const auto head_of = [&](std::size_t rank, const std::string& bytes) {
    SectionHead head;
    if (bytes.size() != sizeof head) part(rank).refuse("is of another version");
    std::memcpy(&head, bytes.data(), sizeof head);
    if (head.version != KDS_VERSION_NUMBER) part(rank).refuse("is of another version of the program");
    if (head.rank != rank) part(rank).refuse("is that of process " + std::to_string(head.rank));
    if (head.scene != scene_ || head.bodies != bodies_) part(rank).refuse("is of another scene");
    return head;
  };
  const SectionHead first = head_of(0, content);
  if (first.processes == 0) part(0).refuse("is of no process");
  processes_ = first.processes;
  for (std::size_t rank = 1; rank < processes_; ++rank) {
    const auto kind = static_cast<std::uint64_t>(BlockKind::section);
    const SectionHead head = head_of(rank, of_part(rank, kind));
    if (head.run != first.run || head.processes != first.processes) part(rank).refuse("is of another run");
  }
}

bool EventParts::read(Stretch& stretch) {
  stretch = {};
  stretch.bodies_ = bodies_;
  Block block = part(0).next();
  while (block.kind == BlockKind::section) {
    begin_section(block.content);
    block = part(0).next();
  }
  const auto kind = static_cast<std::uint64_t>(block.kind);
  if (block.kind == BlockKind::end) {
    for (std::size_t rank = 0; rank < parts_.size(); ++rank) {
      if (rank > 0) of_part(rank, kind);
      if (!part(rank).at_end()) part(rank).refuse("has something behind its end");
    }
    return false;
  }
  stretch.is_step_ = block.kind == BlockKind::step;
  stretch.files_.push_back(part(0).path());
  stretch.contents_.push_back(std::move(block.content));
  for (std::size_t rank = 1; stretch.is_step_ && rank < processes_; ++rank) {
    stretch.contents_.push_back(of_part(rank, kind));
    stretch.files_.push_back(part(rank).path());
  }
  return true;
}

namespace {

class Lines final : public EventSink {
 public:
  Lines(const Scene& scene, std::string& text) : scene_(scene), text_(text) {}
  void on_event(const Event& event) override { append_csv_line(text_, event, scene_); }

 private:
  const Scene& scene_;
  std::string& text_;
};

}  // namespace

void merge_as_csv(EventParts& parts, const Scene& scene, std::size_t threads,
                  const std::function<void(std::string_view)>& write) {
  write(event_csv_header);
  std::vector<EventParts::Stretch> stretches(threads);
  std::vector<std::string> texts(threads);
  for (bool more = true; more;) {
    std::size_t count = 0;
    while (count < threads && (more = parts.read(stretches[count]))) ++count;
    kds::collision::in_turn(count, threads, [&](std::size_t i) {
      texts[i].clear();
      Lines lines(scene, texts[i]);
      stretches[i].tell(lines);
    });
    for (std::size_t i = 0; i < count; ++i) write(texts[i]);
  }
}

}  // namespace kds::io
