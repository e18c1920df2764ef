// JSON text to a document, without what nlohmann::json lets pass: a key given twice, and what follows a NUL byte.
#pragma once

#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string>
#include <string_view>

namespace kds::io {

/// Where in a document (`bodies[3].shape`), and what is wrong there.
struct JsonError : std::runtime_error {
  JsonError(std::string place, const std::string& what) : std::runtime_error(what), where(std::move(place)) {}
  std::string where;
};

/// The path of what is at `key` of the object at `path`, which is empty for the document itself.
std::string path_to(const std::string& path, const std::string& key);

/// Throws JsonError with the path of the value that could not be read.
nlohmann::json parse_json(std::string_view text);

}  // namespace kds::io
