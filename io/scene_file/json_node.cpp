#include "io/scene_file/json_node.hpp"

#include <algorithm>

namespace kds::io {

void JsonNode::fail(const std::string& what) const { throw JsonError(path_.empty() ? "document" : path_, what); }

const JsonNode& JsonNode::object(std::span<const std::string_view> keys) const {
  require(value_.is_object(), "must be an object");
  for (const auto& [key, child] : value_.items()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) at(key).fail("unknown key");
  }
  return *this;
}

JsonNode JsonNode::operator[](const std::string& key) const {
  if (!value_.contains(key)) throw JsonError(path_to(path_, key), "is missing");
  return at(key);
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
  require(value_.is_object(), "must be an object");
  std::vector<std::pair<std::string, JsonNode>> nodes;
  for (const auto& [key, child] : value_.items()) nodes.emplace_back(key, at(key));
  return nodes;
}

std::vector<JsonNode> JsonNode::elements() const {
  require(value_.is_array(), "must be an array");
  std::vector<JsonNode> nodes;
  for (std::size_t i = 0; i < value_.size(); ++i) nodes.emplace_back(value_[i], path_ + '[' + std::to_string(i) + ']');
  return nodes;
}

std::vector<JsonNode> JsonNode::tuple(std::size_t size) const {
  const bool fits = value_.is_array() && value_.size() == size;
  require(fits, "must be an array of " + std::to_string(size) + " numbers");
  return elements();
}

double JsonNode::number(std::string (*problem)(double)) const {
  require(value_.is_number(), "must be a number");
  const auto x = value_.get<double>();
  const std::string wrong = problem(x);
  require(wrong.empty(), wrong);
  return x;
}

Eigen::Vector3d JsonNode::vector() const {
  const std::vector<JsonNode> parts = tuple(3);
  return {parts[0].number(), parts[1].number(), parts[2].number()};
}

std::string JsonNode::string() const {
  require(value_.is_string(), "must be a string");
  auto s = value_.get<std::string>();
  require(!s.empty(), "must not be empty");
  const bool has_control = std::any_of(s.begin(), s.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  require(!has_control, "must not hold control characters");
  return s;
}

bool JsonNode::boolean() const {
  require(value_.is_boolean(), "must be true or false");
  return value_.get<bool>();
}

std::size_t JsonNode::choice(std::initializer_list<std::string_view> choices) const {
  const std::string s = value_.is_string() ? value_.get<std::string>() : "";
  const auto found = std::find(choices.begin(), choices.end(), s);
  if (found == choices.end()) {
    std::string list;
    for (const std::string_view c : choices) list += (list.empty() ? "\"" : " or \"") + std::string(c) + '"';
    fail("must be " + list);
  }
  return static_cast<std::size_t>(found - choices.begin());
}

}  // namespace kds::io
