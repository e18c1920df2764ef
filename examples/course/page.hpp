// A page that shows a run: motions, events, and the state after each event.
#pragma once

#include "certificates/plane_motion.hpp"
#include "certificates/point_motion.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/motion.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace kds::course {

/// How a page draws: values over time (a motion of degree 2 is a parabola), or the plane at one time.
enum class View { line, plane };

/// A certificate as a page shows it.
struct Held {
  std::string fact;         ///< in words
  std::vector<Id> members;  ///< the elements that it is about; for a circle first the three that are on it
  double fails = never;     ///< s

  friend bool operator==(const Held&, const Held&) = default;
};

/// The state of a structure between two events. Parts that a structure does not have stay empty.
struct State {
  std::string text;                     ///< in words
  std::vector<Id> order;                ///< the least first
  std::vector<Id> outline;              ///< corners of a polygon
  std::vector<std::array<Id, 2>> edges; ///< lines between elements
  std::vector<Id> marked;               ///< elements that stand out: the greatest, say
  std::vector<Held> certificates;
};

/// The names of the parts of a state in the legend.
struct Legend {
  std::string event = "an event";
  std::string marked = "marked";
  std::string outline = "hull";
  std::string edges = "edge";
};

/// Collects a run and writes it as one HTML file that needs nothing else: no network, no library.
///
/// Motions are stored as polynomials, so the page can draw any time between `begin` and `end`; states of structures are
/// stored event by event, so the page decides nothing. Times are in seconds, all numbers are written so that they read
/// back the same.
class Page {
 public:
  Page(View view, std::string title, std::string about, double begin, double end);

  /// A moving element: a dot, or a ball of this radius, or a box of these half widths. Names of one or two letters are
  /// written in the dot, of longer ones the first letter.
  void element(Id id, std::string name, double radius = 0);
  void box(Id id, std::string name, std::array<double, 2> half);
  const std::string& name(Id id) const;
  /// "a b c".
  std::string names(const std::vector<Id>& ids) const;

  /// The element's motion from a time on. An element needs one from `begin` on.
  template <int Degree>
  void moves(Id id, const Motion<Degree>& motion, double since) {
    add_piece(id, {since, motion.start, {}, list(motion.position)});
  }
  template <int Degree>
  void moves(Id id, const certificates::PlaneMotion<Degree>& path, double since) {
    add_piece(id, {since, path.start, list(path.coordinate[0]), list(path.coordinate[1])});
  }
  /// Seen from above: x and y.
  template <int Degree>
  void moves(Id id, const certificates::PointMotion<Degree>& path, double since) {
    add_piece(id, {since, path.start, list(path.axis(0).position), list(path.axis(1).position)});
  }

  /// The state at the beginning; to be called once, before any event.
  void starts(State state);
  /// An event, and the state from then on. Events are given in order of time; in the space-time diagram an event is
  /// drawn at its first member. Throws std::logic_error for one that comes before another.
  void event(double time, std::string text, std::vector<Id> members, State state);

  Legend legend;
  std::vector<double> window;  ///< the visible part: least and greatest value; or x, y, x, y. By default all that moves
  std::vector<double> walls;   ///< x, y, x, y of a box to draw in the plane
  bool intervals = false;      ///< draw the shadows of boxes on both axes
  std::string edge_style;      ///< "pair" for a broken line
  double play_time = 14;       ///< s that the whole run lasts on the screen

  std::string json() const;
  std::string html() const;
  /// Writes to the path given as first argument, else to `name`.html here, and says so. Throws std::runtime_error if it
  /// cannot.
  void write(int argc, char** argv, const std::string& name) const;

 private:
  struct Piece {
    double since, start;
    std::vector<double> x, y;  ///< coefficients; no x on a line
  };
  struct Element {
    Id id;
    std::string name;
    double radius;
    std::array<double, 2> half;
    std::vector<Piece> pieces;
  };
  struct Event {
    double time;
    std::string text;
    std::vector<Id> members;
  };
  /// A certificate, and the numbers of the states in which it exists: from the first up to below the second.
  struct Span {
    Held held;
    std::size_t from, until;
  };

  template <int Degree>
  static std::vector<double> list(const Polynomial<Degree>& p) {
    return {p.c.begin(), p.c.end()};
  }
  void add_piece(Id id, Piece piece);
  Element& find(Id id);
  void add_state(State state);

  View view_;
  std::string title_, about_;
  double begin_, end_;
  std::vector<Element> elements_;
  std::vector<Event> events_;
  std::vector<State> states_;
  std::vector<Span> spans_;
  std::vector<std::size_t> open_;  ///< spans that continue in the last state
};

}  // namespace kds::course
