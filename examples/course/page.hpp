// A page that shows a run: who moved how, what happened, and what was known after each event.
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
  std::vector<Id> members;  ///< whom it is about; of a circle the three that are on it first
  double fails = never;     ///< s

  friend bool operator==(const Held&, const Held&) = default;
};

/// What a structure knows between two events. What a structure does not keep stays empty.
struct State {
  std::string text;                     ///< in words
  std::vector<Id> order;                ///< the least first
  std::vector<Id> outline;              ///< corners of a polygon
  std::vector<std::array<Id, 2>> edges; ///< lines between elements
  std::vector<Id> marked;               ///< elements that stand out: the greatest, say
  std::vector<Held> certificates;
};

/// What the legend calls the parts of a state.
struct Legend {
  std::string event = "an event";
  std::string marked = "marked";
  std::string outline = "hull";
  std::string edges = "edge";
};

/// Collects a run and writes it as one HTML file that needs nothing else: no network, no library.
///
/// Motions are stored as they are, so the page draws any time between `begin` and `end`; what structures know is stored
/// event by event, so the page decides nothing. Times are in seconds, all numbers are written so that they read back
/// the same.
class Page {
 public:
  Page(View view, std::string title, std::string about, double begin, double end);

  /// Someone who moves: a dot, or a ball of this radius, or a box of these half widths. Names of one or two letters
  /// stand in the dot, of others the first.
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

  /// What is known at the beginning; to be called once, before any event.
  void starts(State state);
  /// Something happened, and this is known from then on. Events come in order of time; in the space-time diagram one is
  /// drawn where its first member is. Throws std::logic_error for one that comes before another.
  void event(double time, std::string text, std::vector<Id> members, State state);

  Legend legend;
  std::vector<double> window;  ///< what is to be seen: least and greatest value; or x, y, x, y. Else all that moves
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
  /// A certificate, and the numbers of the states in which it is held: from the one up to below the other.
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
  std::vector<std::size_t> open_;  ///< spans that are held in the last state
};

}  // namespace kds::course
