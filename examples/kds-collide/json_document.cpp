#include "examples/kds-collide/json_document.hpp"

#include <cstddef>
#include <set>
#include <utility>
#include <vector>

namespace kds_collide {
namespace {

using nlohmann::json;

/// Follows the parser through the document, so that an error can be said where it is.
class PathTracker {
 public:
  void operator()(json::parse_event_t event, const json& parsed) {
    using Event = json::parse_event_t;
    switch (event) {
      case Event::object_start:
        frames_.push_back({.is_array = false, .index = 0, .key = {}, .keys = {}});
        break;
      case Event::array_start:
        frames_.push_back({.is_array = true, .index = 0, .key = {}, .keys = {}});
        break;
      case Event::key: {
        Frame& frame = frames_.back();
        frame.key = parsed.get<std::string>();
        if (!frame.keys.insert(frame.key).second) throw JsonError(path(), "this key is given twice");
        break;
      }
      case Event::object_end:
      case Event::array_end:
        frames_.pop_back();
        value_ended();
        break;
      case Event::value:
        value_ended();
        break;
    }
  }

  std::string path() const {
    std::string text;
    for (const Frame& frame : frames_) {
      if (frame.is_array) {
        text += '[' + std::to_string(frame.index) + ']';
      } else if (!frame.key.empty()) {
        text += (text.empty() ? "" : ".") + frame.key;
      }
    }
    return text.empty() ? "document" : text;
  }

 private:
  struct Frame {
    bool is_array;
    std::size_t index;
    std::string key;
    std::set<std::string> keys;
  };

  void value_ended() {
    if (!frames_.empty() && frames_.back().is_array) ++frames_.back().index;
  }

  std::vector<Frame> frames_;
};

/// "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while ..." -> from "line" on.
std::string plain_message(const std::string& message) {
  std::string text = message;
  if (const auto end = text.find("] "); !text.empty() && text.front() == '[' && end != std::string::npos) {
    text.erase(0, end + 2);
  }
  constexpr std::string_view prefix = "parse error at ";
  if (text.starts_with(prefix)) text.erase(0, prefix.size());
  return text;
}

}  // namespace

json parse_json(std::string_view text) {
  PathTracker tracker;
  const auto follow = [&tracker](int /*depth*/, json::parse_event_t event, json& parsed) {
    tracker(event, parsed);
    return true;
  };
  try {
    return json::parse(text.begin(), text.end(), follow);
  } catch (const json::parse_error& error) {
    throw JsonError(tracker.path(), plain_message(error.what()));
  } catch (const json::out_of_range& error) {
    throw JsonError(tracker.path(), plain_message(error.what()));
  }
}

}  // namespace kds_collide
