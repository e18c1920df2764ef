#include "io/event_csv.hpp"

#include "kds/number_text.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>

namespace kds::io {
namespace {

void append_name(std::string& text, std::string_view name) {
  if (name.find_first_of(",\"") == std::string_view::npos) {
    text += name;
    return;
  }
  text += '"';
  for (const char c : name) {
    if (c == '"') text += '"';
    text += c;
  }
  text += '"';
}

void append_columns(std::string& text, const Eigen::Vector3d& v) {
  for (int d = 0; d < 3; ++d) {
    text += ',';
    // Adding zero turns -0 into 0, which says the same and compares equal as text.
    append_number(text, v[d] + 0.0);
  }
}

}  // namespace

void append_csv_line(std::string& text, const Event& event, const Scene& scene) {
  append_number(text, event.time);
  text += ',';
  text += event_kind_names[static_cast<std::size_t>(event.kind)];
  text += ',';
  append_name(text, scene.name_of(event.a));
  text += ',';
  append_name(text, event.is_at_wall() ? std::string(wall_names[event.b]) : scene.name_of(event.b));
  if (event.is_about_volumes()) {
    text += ",,,,,,,-,-\n";
    return;
  }
  append_columns(text, event.point);
  append_columns(text, event.normal);
  text += ',';
  text += to_string(event.feature_a);
  text += ',';
  text += to_string(event.feature_b);
  text += '\n';
}

EventCsv::EventCsv(const std::string& path, const Scene& scene) : file_(path), scene_(scene) {
  buffer_ = event_csv_header;
}

EventCsv::EventCsv(const std::string& path, const Scene& scene, const std::optional<FilePlace>& from)
    : file_(path, from ? std::optional(from->bytes) : std::nullopt), scene_(scene) {
  if (!from) {
    buffer_ = event_csv_header;
    return;
  }
  std::ifstream in(begun_path(path), std::ios::binary);
  std::string bytes(std::size_t{1} << 20, '\0');
  for (std::uint64_t left = from->bytes; left > 0;) {
    const std::uint64_t count = std::min<std::uint64_t>(left, bytes.size());
    if (!in.read(bytes.data(), static_cast<std::streamsize>(count))) file_.refuse_to_go_on("it cannot be read");
    checksum_.add({bytes.data(), count});
    left -= count;
  }
  if (checksum_.value() != from->checksum) file_.refuse_to_go_on("it is not what the run had written");
}

void EventCsv::on_event(const Event& event) {
  constexpr std::size_t enough = 1 << 16;  // bytes
  append_csv_line(buffer_, event, scene_);
  if (buffer_.size() >= enough) write();
}

void EventCsv::write() {
  if (buffer_.empty()) return;
  checksum_.add(buffer_);
  file_.write(buffer_);
  buffer_.clear();
}

FilePlace EventCsv::flush() {
  write();
  const std::uint64_t bytes = file_.flush();
  return {bytes, checksum_.value()};
}

void EventCsv::close() {
  write();
  file_.close();
}

void EventCsv::commit() {
  close();
  file_.commit();
}

}  // namespace kds::io
