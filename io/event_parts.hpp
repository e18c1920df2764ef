// The events of a run as a file of each process, and how they become one log.
#pragma once

#include "collision/parallel/processes.hpp"
#include "collision/parallel/step_events.hpp"
#include "io/events.hpp"
#include "io/output_file.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kds::io {

enum class BlockKind : std::uint64_t;

/// The file of a process: FILE.0, FILE.1...
std::string part_path(const std::string& file, std::size_t rank);

/// What a part is of.
struct PartOf {
  std::uint64_t scene = 0;    ///< fingerprint()
  std::uint64_t bodies = 0;   ///< in it
  std::uint64_t run = 0;      ///< a random number, the same in all processes
  std::uint64_t section = 0;  ///< the same, and another one when the run goes on
  std::size_t rank = 0;
  std::size_t processes = 1;  ///< a part of a higher rank only ends: it is of a run that goes on with fewer processes
};

/// Writes the events that the domains of one process record, and those of stretches that are run as one world, of which
/// process 0 is told: some 65 bytes an event. RunOptions::steps leads the former here. EventParts reads it.
///
/// close() and commit() are those of OutputFile: all processes are to close their parts before one commits. Throws
/// OutputError.
class EventPart final : public EventSink, public kds::collision::StepListener {
 public:
  EventPart(const std::string& path, const PartOf& of);
  /// Of a run that may be written in several parts: see OutputFile. `from`: where the part was when the state was
  /// written from which the run goes on; all zero if it was not there. Throws OutputError or SceneError if it is not as
  /// it was.
  EventPart(const std::string& path, const PartOf& of, const std::optional<FilePlace>& from);

  void on_event(const Event& event) override;
  bool hears_motions() const override { return false; }
  void on_step(const kds::collision::StepEvents& events) override;
  /// Where the part is; all that is before is in the file then.
  FilePlace flush();
  void discard() { file_.discard(); }  ///< as OutputFile does
  void close();
  void commit();

 private:
  void begin();
  void write_events();
  void write(BlockKind kind, const std::string& content);

  const PartOf of_;
  OutputFile file_;
  std::uint64_t chain_;
  bool has_magic_ = false;
  bool begun_ = false;       ///< this section
  std::uint64_t steps_ = 0;  ///< of this section
  std::string records_;      ///< of events that are not in a block yet
  std::string step_;         ///< the block that is written
};

/// The parts that one of several processes writes: its own; and where a run goes on with fewer processes than it had,
/// those of some that are no longer there, which are only ended. commit() removes what the run has left of others: of
/// processes that had begun after the state was written from which it goes on. All processes make the same calls.
class EventsApart {
 public:
  /// `file`: as for part_path(). `of`: but for rank and processes, which are those of the team; it must outlive this.
  EventsApart(const std::string& file, PartOf of, kds::collision::Team& team);
  /// Of a run that may be written in several parts. `from`: what places() returned when the state was written from
  /// which the run goes on; empty where it begins.
  EventsApart(const std::string& file, PartOf of, kds::collision::Team& team, const std::vector<FilePlace>& from);

  EventPart& own() { return parts_.front(); }
  /// By rank, in process 0: where all parts are. What is before that is in the files then.
  std::vector<FilePlace> places();
  /// As OutputFile does, of the parts of this process.
  void discard();
  void close();
  void commit();

 private:
  kds::collision::Team& team_;
  const std::string file_;
  const std::uint64_t run_;
  std::size_t count_;  ///< of the parts of all processes
  std::list<EventPart> parts_;
};

class BlockFile;

/// The parts of a run, read side by side, a stretch of it at a time: the memory that it takes is that of the events of
/// a step of a window.
class EventParts {
 public:
  /// Events that follow each other.
  class Stretch {
   public:
    /// Tells of them in the order of one world. Throws SceneError. Stretches may be told by several threads.
    void tell(EventSink& sink) const;
    /// How many it is in the parts.
    std::size_t bytes() const;

   private:
    friend class EventParts;
    class StepLogs;
    template <class Work>
    void of_part(std::size_t rank, const Work& work) const;

    std::string file_;
    std::size_t bodies_ = 0;
    bool is_step_ = false;
    std::size_t processes_ = 0;          ///< whose parts have something here
    std::vector<std::string> contents_;  ///< of blocks, by rank
  };

  /// `file`: as for part_path(). `scene`: fingerprint(). Throws SceneError for a part that is
  /// missing, damaged, cut, of another run, scene or version, or of a run that has not ended: here and later, naming
  /// the file.
  EventParts(std::string file, std::uint64_t scene, std::size_t bodies);
  ~EventParts();
  /// Reads what follows, several parts at a time. False when all has been read, and each part has ended as it has to.
  bool read(Stretch& stretch, std::size_t threads = 1);

 private:
  void begin_section(const std::string& content);
  void read_of(std::size_t rank, BlockKind kind, std::string& content);
  BlockFile& part(std::size_t rank);

  const std::string file_;
  const std::uint64_t scene_;
  const std::size_t bodies_;
  std::vector<std::unique_ptr<BlockFile>> parts_;  ///< by rank, of all sections so far
  std::size_t processes_ = 0;                      ///< of this section
  std::uint64_t run_ = 0;                          ///< of all sections
};

/// Writes the events of all parts as EventCsv would, by several threads. `write` is called with lines, in order.
void merge_as_csv(EventParts& parts, const Scene& scene, std::size_t threads,
                  const std::function<void(std::string_view)>& write);

}  // namespace kds::io
