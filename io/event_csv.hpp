// Events as lines of comma-separated values.
#pragma once

#include "io/checksum.hpp"
#include "io/events.hpp"
#include "io/output_file.hpp"

#include <optional>
#include <string>

namespace kds::io {

inline constexpr std::string_view event_csv_header = "time,kind,a,b,px,py,pz,nx,ny,nz,feature_a,feature_b\n";

/// Appends the line of one event. Numbers are the shortest that read back to the same double; names are quoted where
/// they hold a comma or a quote (RFC 4180). Point and normal of pair_begin and pair_end are empty.
void append_csv_line(std::string& text, const Event& event, const Scene& scene);

/// Writes every event to a file; close() and commit() are those of OutputFile.
class EventCsv final : public EventSink {
 public:
  EventCsv(const std::string& path, const Scene& scene);
  /// Of a run that may be written in several parts: see OutputFile. `from`: what flush() returned when the state was
  /// written from which the run goes on. Throws OutputError if the file has not these bytes.
  EventCsv(const std::string& path, const Scene& scene, const std::optional<FilePlace>& from);
  void on_event(const Event& event) override;
  bool hears_motions() const override { return false; }
  /// How many bytes there are, and a Checksum of them; they are in the file then.
  FilePlace flush();
  void discard() { file_.discard(); }  ///< as OutputFile does
  void close();
  void commit();

 private:
  void write();

  OutputFile file_;
  const Scene& scene_;
  std::string buffer_;
  Checksum checksum_;  ///< of all that has been written
};

}  // namespace kds::io
