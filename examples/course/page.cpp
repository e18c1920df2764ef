#include "examples/course/page.hpp"

#include "kds/arithmetic/lattice.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace kds::course {

namespace {

using nlohmann::ordered_json;

template <class List>
void put(ordered_json& object, const char* key, const List& list) {
  if (!list.empty()) object[key] = list;
}

ordered_json time_or_null(double time) { return time == never ? ordered_json() : ordered_json(time); }

ordered_json json_of(double since, const Drawing& drawing) {
  const char* const kinds[] = {"tree", "ruler", "plane"};
  ordered_json entry{{"title", drawing.title}, {"since", since}, {"kind", kinds[static_cast<int>(drawing.kind)]}};
  entry["axis"] = drawing.axis;
  entry["places"] = ordered_json::array();
  for (const Drawing::Place& place : drawing.places) {
    ordered_json where{{"x", place.x}, {"y", place.y}};
    if (place.element != nobody) where["of"] = place.element;
    if (place.side != 0) where["side"] = place.side;
    put(where, "name", place.name);
    entry["places"].push_back(std::move(where));
  }
  entry["links"] = ordered_json::array();
  for (const auto& [from, to, fails] : drawing.links) entry["links"].push_back({from, to, time_or_null(fails)});
  put(entry, "circle", drawing.circle);
  return entry;
}

}  // namespace

Page::Page(View view, std::string title, std::string about, double begin, double end)
    : view_(view), title_(std::move(title)), about_(std::move(about)), begin_(begin), end_(end) {
  if (!(begin < end)) throw std::invalid_argument("Page: the end must come after the beginning");
}

void Page::element(Id id, std::string name, double radius) {
  elements_.push_back({id, std::move(name), radius, {}, {}});
}

void Page::box(Id id, std::string name, std::array<double, 2> half) {
  elements_.push_back({id, std::move(name), 0, half, {}});
}

Page::Element& Page::find(Id id) {
  const auto found = std::find_if(elements_.begin(), elements_.end(), [&](const Element& e) { return e.id == id; });
  if (found == elements_.end()) throw std::out_of_range("Page: no element with id " + std::to_string(id));
  return *found;
}

const std::string& Page::name(Id id) const { return const_cast<Page*>(this)->find(id).name; }

std::string Page::names(const std::vector<Id>& ids) const {
  std::string all;
  for (const Id id : ids) all += (all.empty() ? "" : " ") + name(id);
  return all;
}

/// The motions of motions(), read from text. In the plane they have x and y, on a line y alone.
std::vector<Page::Piece> Page::given(const std::string& text, std::size_t most, bool on_line) {
  const auto refuse = [](std::size_t element, const std::string& why) {
    throw std::invalid_argument("Page: motion " + std::to_string(element) + ": " + why);
  };
  const ordered_json list = ordered_json::parse(text);
  if (!list.is_array() || list.empty() || list.size() > 26) {
    throw std::invalid_argument("Page: motions must be an array of 1 to 26");
  }
  std::vector<Piece> pieces;
  for (const ordered_json& motion : list) {
    const std::size_t i = pieces.size();
    const auto read = [&](const char* name) {
      const auto coefficients = motion.at(name).get<std::vector<double>>();
      if (coefficients.size() > most)
        refuse(i, std::string(name) + " has more than " + std::to_string(most) + " numbers");
      for (const double c : coefficients) {
        if (!std::isfinite(c)) refuse(i, std::string(name) + " has a number that is not finite");
      }
      return coefficients;
    };
    const double start = motion.value("start", 0.0);
    if (!std::isfinite(start)) refuse(i, "start is not finite");
    pieces.push_back({0, start, on_line ? std::vector<double>() : read("x"), read("y")});
  }
  return pieces;
}

std::vector<Page::Piece> Page::given_to_drawing(const std::string& text, const std::string& title, std::size_t most) {
  const ordered_json drawings = ordered_json::parse(text);
  return drawings.contains(title) ? given(drawings[title].dump(), most, false) : std::vector<Piece>();
}

void Page::add_piece(Id id, Piece piece) {
  auto& pieces = find(id).pieces;
  // Of several changes at one instant only the last one counts.
  if (!pieces.empty() && pieces.back().since == piece.since) pieces.pop_back();
  pieces.push_back(std::move(piece));
}

void Page::starts(State state) {
  if (!states_.empty()) throw std::logic_error("Page: it has started already");
  add_state(std::move(state));
}

void Page::event(double time, std::string text, std::vector<Id> members, State state) {
  if (states_.empty()) throw std::logic_error("Page: starts() comes before event()");
  if (!events_.empty() && time < events_.back().time) throw std::logic_error("Page: an event comes before the last");
  events_.push_back({time, std::move(text), std::move(members)});
  add_state(std::move(state));
}

void Page::draws(double since, Drawing drawing) {
  const auto last = std::find_if(drawings_.rbegin(), drawings_.rend(),
                                 [&](const auto& other) { return other.second.title == drawing.title; });
  if (last == drawings_.rend() || last->first < since) {
    drawings_.emplace_back(since, std::move(drawing));
  } else if (last->first == since) {
    last->second = std::move(drawing);
  } else {
    throw std::logic_error("Page: a drawing of " + drawing.title + " comes before the last");
  }
}

/// Certificates that stay are not written again.
void Page::add_state(State state) {
  const std::size_t number = states_.size();
  std::vector<std::size_t> still;
  for (Held& held : state.certificates) {
    const auto same = std::find_if(open_.begin(), open_.end(), [&](std::size_t i) {
      return spans_[i].held == held && std::find(still.begin(), still.end(), i) == still.end();
    });
    if (same == open_.end()) spans_.push_back({std::move(held), number, 0});
    still.push_back(same == open_.end() ? spans_.size() - 1 : *same);
  }
  for (const std::size_t i : still) spans_[i].until = number + 1;
  open_ = std::move(still);
  state.certificates.clear();
  states_.push_back(std::move(state));
}

std::string Page::json() const {
  const char* const views[] = {"line", "plane", "space"};
  ordered_json page{{"title", title_}, {"about", about_}, {"view", views[static_cast<int>(view_)]}};
  page["begin"] = begin_;
  page["end"] = end_;
  page["play"] = play_time;
  if (coefficients_ > 0) page["coefficients"] = coefficients_;
  put(page, "changeable", changeable_);
  page["names"] = {
      {"event", legend.event}, {"marked", legend.marked}, {"outline", legend.outline}, {"edges", legend.edges}};
  for (const Standing& standing : standings) {
    page["standings"].push_back({{"structure", standing.structure},
                                 {"responsive", standing.responsive},
                                 {"efficient", standing.efficient},
                                 {"local", standing.local},
                                 {"compact", standing.compact}});
  }
  put(page, "window", window);
  put(page, "walls", walls);
  put(page, "edges", edge_style);
  if (intervals) page["intervals"] = true;
  page["elements"] = ordered_json::array();
  for (const Element& element : elements_) {
    if (element.pieces.empty()) throw std::logic_error("Page: " + element.name + " has no motion");
    const std::string label = element.name.size() <= 2 ? element.name : element.name.substr(0, 1);
    ordered_json entry{{"id", element.id}, {"name", element.name}, {"label", label}};
    if (element.radius > 0) entry["radius"] = element.radius;
    if (element.half[0] > 0) entry["half"] = element.half;
    entry["pieces"] = ordered_json::array();
    for (const Piece& piece : element.pieces) {
      ordered_json motion{{"since", piece.since}, {"start", piece.start}};
      put(motion, "x", piece.x);
      motion["y"] = piece.y;
      put(motion, "z", piece.z);
      entry["pieces"].push_back(std::move(motion));
    }
    page["elements"].push_back(std::move(entry));
  }
  page["events"] = ordered_json::array();
  for (const Event& event : events_) {
    page["events"].push_back({{"time", event.time}, {"text", event.text}, {"members", event.members}});
  }
  page["states"] = ordered_json::array();
  for (const State& state : states_) {
    ordered_json entry{{"text", state.text}};
    put(entry, "order", state.order);
    put(entry, "outline", state.outline);
    put(entry, "edges", state.edges);
    put(entry, "triangles", state.triangles);
    put(entry, "marked", state.marked);
    page["states"].push_back(std::move(entry));
  }
  page["certificates"] = ordered_json::array();
  for (const auto& [held, from, until] : spans_) {
    ordered_json entry{{"fact", held.fact}, {"members", held.members}, {"from", from}, {"until", until}};
    entry["fails"] = time_or_null(held.fails);
    if (!held.function.empty()) entry["function"] = held.function;
    put(entry, "polynomial", held.polynomial);
    page["certificates"].push_back(std::move(entry));
  }
  page["drawings"] = ordered_json::array();
  for (const auto& [since, drawing] : drawings_) page["drawings"].push_back(json_of(since, drawing));
  return page.dump();
}

}  // namespace kds::course
