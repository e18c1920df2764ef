// A small picture of a run: for the index of the pages, and as the sign of a page in its tab.
#include "examples/course/page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace kds::course {

namespace {

constexpr double width = 480, height = 300, margin = 16;
// Those of page/style.css for elements, as far as a page has one for each; then the one for points.
constexpr const char* colours[] = {"#1d5fd1", "#b4480b", "#14783a", "#8330c9",
                                   "#b01850", "#0b7285", "#86600a", "#4b5666"};
constexpr const char* colour_of_points = "#38414f";

double value(const std::vector<double>& coefficients, double elapsed) {
  double sum = 0;
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) sum = sum * elapsed + *c;
  return sum;
}

std::string whole(double number) { return std::to_string(std::lround(number)); }

}  // namespace

std::array<double, 2> Page::seen(const Element& element, double t) const {
  const Piece* piece = &element.pieces.front();
  for (const Piece& other : element.pieces) {
    if (other.since <= t) piece = &other;
  }
  const double x = value(piece->x, t - piece->start), y = value(piece->y, t - piece->start);
  if (view_ == View::line) return {t, y};
  if (view_ == View::plane) return {x, y};
  // Space from in front, a little from the left and from above.
  return {0.88 * x - 0.47 * y, 0.16 * x + 0.3 * y + 0.94 * value(piece->z, t - piece->start)};
}

std::string Page::picture() const {
  constexpr int samples = 40;
  const double duration = end_ - begin_, now = begin_ + 0.4 * duration;
  std::array<double, 2> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Element& element : elements_) {
    for (int k = 0; k <= samples; ++k) {
      const auto place = seen(element, begin_ + duration * k / samples);
      for (std::size_t d = 0; d < 2; ++d) {
        const double half = std::max(element.radius, element.half[d]);
        low[d] = std::min(low[d], place[d] - half), high[d] = std::max(high[d], place[d] + half);
      }
    }
  }
  // Time has a scale of its own, places have one for both coordinates.
  std::array<double, 2> scale{(width - 2 * margin) / std::max(high[0] - low[0], 1e-9),
                              (height - 2 * margin) / std::max(high[1] - low[1], 1e-9)};
  if (view_ != View::line) scale.fill(std::min(scale[0], scale[1]));
  const auto across = [&](double u) { return whole(width / 2 + (u - (low[0] + high[0]) / 2) * scale[0]); };
  const auto down = [&](double v) { return whole(height / 2 - (v - (low[1] + high[1]) / 2) * scale[1]); };
  const auto point = [&](Id id) {
    const auto found = std::find_if(elements_.begin(), elements_.end(), [&](const Element& e) { return e.id == id; });
    const auto [u, v] = seen(*found, now);
    return across(u) + ' ' + down(v);
  };

  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 480 300\" fill=\"none\">"
      "<path fill=\"#fbfaf7\" d=\"M0 0H480V300H0Z\"/>";
  if (view_ == View::line) svg += "<path stroke=\"#9aa1ab\" d=\"M" + across(now) + " 0V300\"/>";
  std::size_t number = 0;
  while (number < events_.size() && events_[number].time <= now) ++number;
  const State state = number < states_.size() ? states_[number] : State{};
  if (!state.outline.empty()) {
    std::string corners;
    for (const Id id : state.outline) corners += (corners.empty() ? "M" : "L") + point(id);
    svg += "<path fill=\"#1d5fd1\" fill-opacity=\".15\" stroke=\"#1d5fd1\" stroke-width=\"4\" d=\"" + corners + "Z\"/>";
  }
  std::string edges;
  for (const auto& [a, b] : state.edges) edges += "M" + point(a) + 'L' + point(b);
  svg += "<path stroke=\"#5d6470\" stroke-width=\"2\" d=\"" + edges + "\"/>";
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    const Element& element = elements_[i];
    const std::string colour = elements_.size() <= std::size(colours) ? colours[i] : colour_of_points;
    if (view_ == View::line) {
      std::string line;
      for (int k = 0; k <= samples; ++k) {
        const auto [u, v] = seen(element, begin_ + duration * k / samples);
        line += (k == 0 ? "M" : "L") + across(u) + ' ' + down(v);
      }
      svg += "<path stroke=\"" + colour + "\" stroke-width=\"4\" d=\"" + line + "\"/>";
    }
    const auto [u, v] = seen(element, now);
    const std::string body =
        "fill-opacity=\".3\" stroke=\"" + colour + "\" stroke-width=\"3\" fill=\"" + colour + "\"/>";
    if (element.half[0] > 0) {
      const auto [w, h] = element.half;
      svg += "<path d=\"M" + across(u - w) + ' ' + down(v - h) + 'H' + across(u + w) + 'V' + down(v + h) + 'H' +
             across(u - w) + "Z\" " + body;
    }
    const std::string circle = "<circle cx=\"" + across(u) + "\" cy=\"" + down(v) + "\" r=\"";
    if (element.radius > 0) svg += circle + whole(element.radius * scale[0]) + "\" " + body;
    svg += circle + "9\" fill=\"" + colour + "\"/>";
  }
  return svg + "</svg>";
}

}  // namespace kds::course
