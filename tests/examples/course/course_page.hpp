// A page of the course as its checker reads it.
#pragma once

#include "certificates/plane_motion.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/motion.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::tests {

using nlohmann::json;

/// The text of the script element with this id, parsed.
inline json script_of(const std::string& file, const std::string& id) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  const std::string all = std::move(text).str();
  for (std::size_t at = all.find("<script"); at != std::string::npos; at = all.find("<script", at + 1)) {
    const std::size_t open = all.find('>', at);
    if (all.substr(at, open - at).find("id=\"" + id + '"') == std::string::npos) continue;
    return json::parse(all.substr(open + 1, all.find("</script>", open) - open - 1));
  }
  throw std::runtime_error(file + " has no script '" + id + "': the page did not get that far");
}

/// Who moves on a page, and how.
class CoursePage {
 public:
  explicit CoursePage(json page) : page_(std::move(page)) {
    for (const json& element : page_["elements"]) elements_.push_back(element);
  }

  const json& data() const { return page_; }
  std::size_t size() const { return elements_.size(); }
  const json& element(std::size_t id) const { return elements_[id]; }
  const json& pieces(std::size_t id) const { return elements_[id]["pieces"]; }
  bool on_line() const { return page_["view"] == "line"; }

  /// A coordinate of a piece of motion: "x" or "y".
  static Motion<2> motion(const json& piece, const char* coordinate) {
    Motion<2> motion;
    motion.start = piece["start"];
    for (std::size_t i = 0; i < piece[coordinate].size(); ++i) motion.position.c[i] = piece[coordinate][i];
    return motion;
  }
  static certificates::PlaneMotion<2> path(const json& piece) {
    return {{motion(piece, "x").position, motion(piece, "y").position}, piece["start"]};
  }
  /// The piece that holds at t+.
  const json& piece(std::size_t id, double t) const {
    const json* found = &pieces(id)[0];
    for (const json& piece : pieces(id)) {
      if (piece["since"] <= t) found = &piece;
    }
    return *found;
  }
  Motion<2> value(std::size_t id, double t) const { return motion(piece(id, t), "y"); }
  certificates::PlaneMotion<2> path(std::size_t id, double t) const { return path(piece(id, t)); }

  std::array<double, 2> position(std::size_t id, double t) const {
    if (on_line()) return {t, value(id, t)(t)};
    return path(id, t)(t);
  }

 private:
  json page_;
  std::vector<json> elements_;
};

}  // namespace kds::tests
