// A page of the course as its checker reads it.
#pragma once

#include "certificates/plane_motion.hpp"
#include "certificates/point_motion.hpp"
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
  throw std::runtime_error(file + " has no script '" + id + "'");
}

/// What the driver of a page has reported: see ../browser/page_tests.cmake.
inline json report_of(const std::string& file, const std::string& name) {
  json report = script_of(file, name);
  if (report.contains("unfinished")) {
    throw std::runtime_error(name + ": the page did not get to its end: " + report["unfinished"].dump());
  }
  return report;
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
  bool in_space() const { return page_["view"] == "space"; }

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
  static certificates::PointMotion<1> path_in_space(const json& piece) {
    certificates::PointMotion<1> path;
    path.start = piece["start"];
    for (std::size_t i = 0; i < 2; ++i) {
      const double x = piece["x"][i], y = piece["y"][i], z = piece["z"][i];
      path.coefficients[i] = {x, y, z};
    }
    return path;
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

  /// x, y and z; on a line the time and the value.
  std::array<double, 3> position(std::size_t id, double t) const {
    if (on_line()) return {t, value(id, t)(t), 0};
    const auto [x, y] = path(id, t)(t);
    return {x, y, in_space() ? motion(piece(id, t), "z")(t) : 0};
  }

 private:
  json page_;
  std::vector<json> elements_;
};

}  // namespace kds::tests
