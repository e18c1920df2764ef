// A value of a JSON document that knows where it is.
#pragma once

#include "io/scene_file/json_document.hpp"
#include "io/scene_file/number_rules.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kds::io {

/// A value and its path (`bodies[3].shape`). Every look at it gives what was asked for or throws JsonError.
/// It refers to the document, which must outlive it.
class JsonNode {
 public:
  JsonNode(const nlohmann::json& value, std::string path) : value_(value), path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  [[noreturn]] void fail(const std::string& what) const;

  /// Itself, an object with these keys only.
  const JsonNode& object(std::initializer_list<std::string_view> keys) const {
    return object(std::span(keys.begin(), keys.size()));
  }
  const JsonNode& object(std::span<const std::string_view> keys) const;

  bool has(const char* key) const { return value_.contains(key); }
  JsonNode operator[](const std::string& key) const;  ///< of a key that must be there
  std::vector<std::pair<std::string, JsonNode>> members() const;
  std::vector<JsonNode> elements() const;
  std::vector<JsonNode> tuple(std::size_t size) const;

  double number() const { return number(number_problem); }
  double positive() const { return number(positive_problem); }
  double length() const { return number(length_problem); }
  double fraction() const { return number(fraction_problem); }
  double number(std::string (*problem)(double)) const;  ///< that keeps to a rule of number_rules.hpp
  Eigen::Vector3d vector() const;
  std::string string() const;  ///< not empty, without control characters
  bool boolean() const;
  std::size_t choice(std::initializer_list<std::string_view> choices) const;  ///< which of them it is
  bool is_array() const { return value_.is_array(); }
  bool is(int n) const { return value_.is_number() && value_ == n; }

 private:
  void require(bool holds, const std::string& what) const {
    if (!holds) fail(what);
  }
  JsonNode at(const std::string& key) const { return {value_.at(key), path_to(path_, key)}; }

  const nlohmann::json& value_;
  std::string path_;
};

}  // namespace kds::io
