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

using kds::collision::DomainEvent;

namespace {

/// Bytes: to read them takes a thread longer than to begin, by far.
constexpr std::size_t worth_a_thread = 1 << 20;

}  // namespace

/// The logs of all domains of a step, of which one event each is read at a time.
class EventParts::Stretch::StepLogs {
 public:
  explicit StepLogs(const Stretch& stretch) : stretch_(stretch) {
    std::uint64_t step = 0;
    std::size_t domains = 0;
    for (std::size_t rank = 0; rank < stretch.processes_; ++rank) {
      stretch.of_part(rank, [&] {
        Records records(stretch.contents_[rank], stretch.bodies_);
        const std::uint64_t number = records.number();
        const std::size_t of = records.number(), first = records.number(), count = records.number();
        if (rank == 0) step = number, domains = of;
        if (number != step || of != domains || (count > 0 && first != logs_.size())) {
          throw std::runtime_error("has not the step that follows in the others");
        }
        for (std::size_t i = 0; i < count; ++i) logs_.push_back({rank, records.part(records.number())});
        if (!records.at_end()) throw std::runtime_error("has more than its events");
      });
    }
    stretch.of_part(0, [&] {
      if (logs_.size() != domains) throw std::runtime_error("has a step of domains that are in no part");
    });
    for (std::size_t domain = 0; domain < domains; ++domain) go_on(domain);
  }

  std::size_t size() const { return logs_.size(); }
  const DomainEvent* head(std::size_t domain) const { return logs_[domain].left ? &logs_[domain].head : nullptr; }
  void go_on(std::size_t domain) {
    Log& log = logs_[domain];
    log.left = !log.records.at_end();
    if (log.left) stretch_.of_part(log.rank, [&] { log.head = log.records.event_of(domain, logs_.size()); });
  }

 private:
  struct Log {
    std::size_t rank;  ///< of its process
    Records records;
    bool left = false;
    DomainEvent head{};
  };
  const Stretch& stretch_;
  std::vector<Log> logs_;
};

/// Calls work(); what it finds wrong it says of the part.
template <class Work>
void EventParts::Stretch::of_part(std::size_t rank, const Work& work) const {
  try {
    work();
  } catch (const SceneError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw SceneError(part_path(file_, rank), "part of events", error.what());
  }
}

std::size_t EventParts::Stretch::bytes() const {
  std::size_t all = 0;
  for (std::size_t rank = 0; rank < processes_; ++rank) all += contents_[rank].size();
  return all;
}

void EventParts::Stretch::tell(EventSink& sink) const {
  if (!is_step_) {
    Records records(contents_[0], bodies_);
    while (!records.at_end()) {
      Event event;
      of_part(0, [&] { event = records.event(); });
      sink.on_event(event);
    }
    return;
  }
  kds::collision::BasicEventMerge<StepLogs> merge{StepLogs(*this)};
  while (!merge.empty()) {
    DomainEvent event{};
    try {
      event = merge.take_next();
    } catch (const std::logic_error&) {
      of_part(0, [] { throw std::runtime_error("does not agree with the others about what has happened"); });
    }
    sink.on_event(to_event(event));
  }
}

EventParts::EventParts(std::string file, std::uint64_t scene, std::size_t bodies)
    : file_(std::move(file)), scene_(scene), bodies_(bodies) {
  std::string content;
  if (part(0).next(content) != BlockKind::section) part(0).refuse("does not begin with a run");
  begin_section(content);
}

EventParts::~EventParts() = default;

BlockFile& EventParts::part(std::size_t rank) {
  while (parts_.size() <= rank)
    parts_.push_back(std::make_unique<BlockFile>(part_path(file_, parts_.size()), part_of_events));
  return *parts_[rank];
}

/// The content of the next block of a part, which has to be of this kind.
void EventParts::read_of(std::size_t rank, BlockKind kind, std::string& content) {
  if (part(rank).next(content) != kind) part(rank).refuse("does not fit to that of process 0");
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
  if (processes_ > 0 && first.run != run_) part(0).refuse("is of several runs");
  processes_ = first.processes, run_ = first.run;
  for (std::size_t rank = 1; rank < processes_; ++rank) {
    std::string its;
    read_of(rank, BlockKind::section, its);
    const SectionHead head = head_of(rank, its);
    if (head.run != run_ || head.section != first.section || head.processes != processes_)
      part(rank).refuse("is of another run");
  }
}

bool EventParts::read(Stretch& stretch, std::size_t threads) {
  // What it had is written over: to give back so much memory and take it again costs more than to read.
  std::vector<std::string>& contents = stretch.contents_;
  contents.resize(std::max<std::size_t>(contents.size(), 1));
  BlockKind kind = part(0).next(contents[0]);
  while (kind == BlockKind::section) {
    begin_section(contents[0]);
    kind = part(0).next(contents[0]);
  }
  if (kind == BlockKind::end) {
    for (std::size_t rank = 0; rank < parts_.size(); ++rank) {
      if (rank > 0) read_of(rank, kind, contents[0]);
      if (!part(rank).at_end()) part(rank).refuse("has something behind its end");
    }
    return false;
  }
  stretch.file_ = file_;
  stretch.bodies_ = bodies_;
  stretch.is_step_ = kind == BlockKind::step;
  stretch.processes_ = stretch.is_step_ ? processes_ : 1;
  contents.resize(std::max(contents.size(), stretch.processes_));
  const std::size_t readers = contents[0].size() < worth_a_thread ? 1 : threads;
  kds::collision::in_turn(stretch.processes_ - 1, readers,
                          [&](std::size_t i) { read_of(i + 1, kind, contents[i + 1]); });
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
  // Short stretches are told many at a time.
  const std::size_t most = threads > 1 ? 64 * threads : 1;
  std::vector<EventParts::Stretch> stretches(most);
  std::vector<std::string> texts(most);
  for (bool more = true; more;) {
    std::size_t count = 0, bytes = 0;
    while (count < most && (count < threads || bytes < threads * worth_a_thread) &&
           (more = parts.read(stretches[count], threads))) {
      bytes += stretches[count++].bytes();
    }
    kds::collision::in_turn(count, threads, [&](std::size_t i) {
      texts[i].clear();
      Lines lines(scene, texts[i]);
      stretches[i].tell(lines);
    });
    for (std::size_t i = 0; i < count; ++i) write(texts[i]);
  }
}

}  // namespace kds::io
