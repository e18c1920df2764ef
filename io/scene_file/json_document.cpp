#include "io/scene_file/json_document.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace kds::io {
namespace {

using nlohmann::json;

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

/// What is wrong where the text has a NUL byte: the parser takes it for the end of the text.
std::string nul_problem(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t column = at - (before.rfind('\n') + 1) + 1;  // rfind() + 1 is 0 where there is no line before
  return "line " + std::to_string(line) + ", column " + std::to_string(column) +
         ": a NUL byte, which JSON has no place for";
}

/// Makes the document of what the parser finds, and so knows where an error is.
///
/// json::parse with a callback would say where too, but takes quadratic time: at the end of each object it looks
/// through the array that the object stands in.
class DocumentBuilder final : public json::json_sax_t {
 public:
  explicit DocumentBuilder(std::string_view text) : text_(text) {}

  json take() { return std::move(document_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t& /*text*/) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t& /*value*/) override { return false; }  // not in JSON
  bool start_object(std::size_t /*size*/) override { return open(json::object()); }
  bool start_array(std::size_t /*size*/) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& key) override {
    Level& level = open_.back();
    level.key = std::move(key);
    level.has_key = true;
    if (level.value->contains(level.key)) throw JsonError(path(), "this key is given twice");
    return true;
  }

  /// `position`: how many bytes have been read.
  bool parse_error(std::size_t position, const std::string& /*token*/, const json::exception& error) override {
    if (position > 0 && position <= text_.size() && text_[position - 1] == 0) {
      throw JsonError(path(), nul_problem(text_, position - 1));
    }
    throw JsonError(path(), plain_message(error.what()));
  }

 private:
  /// An object or array that has not ended.
  struct Level {
    json* value;
    std::string key;  ///< of an object, the last one met
    bool has_key;
  };

  json& put(json&& value) {
    if (open_.empty()) return document_ = std::move(value);
    json& parent = *open_.back().value;
    if (parent.is_object()) return parent[open_.back().key] = std::move(value);
    parent.push_back(std::move(value));
    return parent.back();
  }
  bool add(json&& value) {
    put(std::move(value));
    return true;
  }
  bool open(json&& value) {
    open_.push_back({.value = &put(std::move(value)), .key = {}, .has_key = false});
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  /// Of the value that comes next; of one that is nested deeper than anything in a scene the beginning, and dots.
  std::string path() const {
    constexpr std::size_t most_levels = 32;
    std::string text;
    for (const Level& level : open_) {
      if (&level == &open_[0] + most_levels) return text + "...";
      if (level.value->is_array()) {
        const bool is_within = &level != &open_.back();
        text += '[' + std::to_string(level.value->size() - (is_within ? 1 : 0)) + ']';
      } else if (level.has_key) {
        text = path_to(text, level.key);
      }
    }
    return text.empty() ? "document" : text;
  }

  const std::string_view text_;
  json document_;
  std::vector<Level> open_;
};

}  // namespace

std::string path_to(const std::string& path, const std::string& key) {
  const std::string step = key.empty() ? "\"\"" : key;
  return path.empty() ? step : path + '.' + step;
}

json parse_json(std::string_view text) {
  DocumentBuilder builder(text);
  json::sax_parse(text.begin(), text.end(), &builder);
  // One that follows the document is no error to the parser, which reads no further.
  if (const auto nul = text.find('\0'); nul != text.npos) throw JsonError("document", nul_problem(text, nul));
  return builder.take();
}

}  // namespace kds::io
