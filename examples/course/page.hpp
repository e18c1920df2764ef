// A page that shows a run: motions, events, and the state after each event.
#pragma once

#include "certificates/plane_motion.hpp"
#include "certificates/point_motion.hpp"
#include "examples/course/drawing.hpp"
#include "examples/course/standing.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/motion.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::course {

/// How a page draws: values over time (a motion of degree 2 is a parabola), or the plane or space at one time.
enum class View { line, plane, space };

/// A certificate as a page shows it.
struct Held {
  std::string fact;                ///< in words
  std::vector<Id> members;         ///< the elements that it is about; for a circle or sphere first those that are on it
  double fails = never;            ///< s
  std::string function;            ///< what is not negative while it holds: "e \u2212 d"
  std::vector<double> polynomial;  ///< its coefficients in the time since the page begins, rounded

  friend bool operator==(const Held&, const Held&) = default;
};

/// The state of a structure between two events. Parts that a structure does not have stay empty.
struct State {
  std::string text;                          ///< in words
  std::vector<Id> order;                     ///< the least first
  std::vector<Id> outline;                   ///< corners of a polygon
  std::vector<std::array<Id, 2>> edges;      ///< lines between elements
  std::vector<std::array<Id, 3>> triangles;  ///< that turn left and cover the outline: the page draws Voronoi cells
  std::vector<Id> marked;                    ///< elements that stand out: the greatest, say
  std::vector<Held> certificates;            ///< that hold
};

/// The names of the parts of a state in the legend.
struct Legend {
  std::string event = "an event";  ///< the dots in the space-time diagram
  std::string marked = "marked";   ///< the elements of State::marked
  std::string outline = "hull";    ///< the polygon of State::outline
  std::string edges = "edge";      ///< the lines of State::edges
};

/// Collects a run and writes it as one HTML file that needs nothing else: no network, no library. Space is drawn by
/// three.js, which is in the file; where it is not installed, the page says so in place of the picture.
///
/// Motions are stored as polynomials, so the page can draw any time between `begin` and `end`; states of structures are
/// stored event by event, so the page decides nothing. Times are in seconds, all numbers are written so that they read
/// back the same.
class Page {
 public:
  /// From `begin` to `end` in s; the title and the text below it are plain text. Throws std::invalid_argument unless
  /// the end comes after the beginning.
  Page(View view, std::string title, std::string about, double begin, double end);

  /// The motions of the elements, each for the whole run: `usual`, or those of the program's second argument, in JSON:
  /// an array of 1 to 26 objects like {"start": 0, "y": [1, 0.2, 0.09]}, in the plane with "x" too. Whoever opens the
  /// page may then change them there, and it runs the program anew, if that is in the page (program_in_page.hpp).
  /// Throws std::invalid_argument for motions that are too many, too long or not finite, and what nlohmann::json throws
  /// for text that is something else.
  template <int Degree>
  std::vector<Motion<Degree>> motions(int argc, char** argv, std::vector<Motion<Degree>> usual) {
    coefficients_ = Degree + 1;
    if (argc <= 2) return usual;
    std::vector<Motion<Degree>> all;
    for (const Piece& piece : given(argv[2], Degree + 1, true))
      all.push_back({polynomial<Degree>(piece.y), piece.start});
    return all;
  }
  template <int Degree>
  std::vector<certificates::PlaneMotion<Degree>> motions(int argc, char** argv,
                                                         std::vector<certificates::PlaneMotion<Degree>> usual) {
    coefficients_ = Degree + 1;
    if (argc <= 2) return usual;
    std::vector<certificates::PlaneMotion<Degree>> all;
    for (const Piece& piece : given(argv[2], Degree + 1, false)) {
      all.push_back({{polynomial<Degree>(piece.x), polynomial<Degree>(piece.y)}, piece.start});
    }
    return all;
  }

  /// The motions of the points of a drawing (draws()) in the plane, written about time 0, of which whoever opens the
  /// page may drag them too: `usual`, or those that the program's third argument, a JSON object, has under the title,
  /// as many. Throws as motions() does.
  template <int Degree>
  std::vector<certificates::PlaneMotion<Degree>> motions_of_drawing(
      int argc, char** argv, const std::string& title, std::vector<certificates::PlaneMotion<Degree>> usual) {
    changeable_.push_back(title);
    const std::vector<Piece> pieces = argc > 3 ? given_to_drawing(argv[3], title, Degree + 1) : std::vector<Piece>();
    if (pieces.empty()) return usual;
    if (pieces.size() != usual.size()) throw std::invalid_argument("Page: " + title + ": other points than usual");
    for (std::size_t i = 0; i < usual.size(); ++i) {
      usual[i] = {{polynomial<Degree>(pieces[i].x), polynomial<Degree>(pieces[i].y)}, pieces[i].start};
    }
    return usual;
  }

  /// A moving element: a dot, or a ball of this radius, or a box of these half widths. Names of one or two letters are
  /// written in the dot, of longer ones the first letter.
  void element(Id id, std::string name, double radius = 0);
  void box(Id id, std::string name, std::array<double, 2> half);
  /// The name of an element. Throws std::out_of_range if there is none with this id.
  const std::string& name(Id id) const;
  double begin() const { return begin_; }  ///< s
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
  /// In the plane seen from above: x and y.
  template <int Degree>
  void moves(Id id, const certificates::PointMotion<Degree>& path, double since) {
    Piece piece{since, path.start, list(path.axis(0).position), list(path.axis(1).position)};
    if (view_ == View::space) piece.z = list(path.axis(2).position);
    add_piece(id, std::move(piece));
  }

  /// The state at the beginning; to be called once, before any event.
  void starts(State state);
  /// An event, and the state from then on. Events are given in order of time; in the space-time diagram an event is
  /// drawn at its first member. In the plane four members are on one circle then, which is drawn for a while. Throws
  /// std::logic_error for one that comes before another.
  void event(double time, std::string text, std::vector<Id> members, State state);
  /// Shows a structure beside the picture, from a time on until the next drawing with the same title. Drawings of one
  /// title are given in order of time; of several at one time only the last one counts. Throws std::logic_error for one
  /// that comes before another.
  void draws(double since, Drawing drawing);

  Legend legend;               ///< words for what is drawn
  std::vector<double> window;  ///< the visible part: least and greatest value; or x, y, x, y. By default all that moves
  std::vector<double> walls;   ///< x, y, x, y of a box to draw in the plane
  bool intervals = false;      ///< draw the shadows of boxes on both axes
  std::string edge_style;      ///< "pair" for a broken line
  double play_time = 14;       ///< s that the whole run lasts on the screen
  std::vector<Standing> standings;  ///< how the structures stand in the four measures

  /// The recording, for the page's scripts. Throws std::logic_error if an element has no motion.
  std::string json() const;
  /// The run in small, as an SVG image: motions over time, or the state at two fifths of the time.
  std::string picture() const;
  /// The page as a file.
  std::string html() const;
  /// Writes to the path given as first argument, else to `name`.html here, and says so. Throws std::runtime_error if it
  /// cannot. In a browser it writes json() to the standard output.
  void write(int argc, char** argv, const std::string& name) const;

 private:
  struct Piece {
    double since, start;
    std::vector<double> x, y, z = {};  ///< coefficients; no x on a line, a z in space alone
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
  template <int Degree>
  static Polynomial<Degree> polynomial(const std::vector<double>& coefficients) {
    Polynomial<Degree> p{};
    std::copy(coefficients.begin(), coefficients.end(), p.c.begin());
    return p;
  }
  static std::vector<Piece> given(const std::string& text, std::size_t most, bool on_line);
  static std::vector<Piece> given_to_drawing(const std::string& text, const std::string& title, std::size_t most);
  void add_piece(Id id, Piece piece);
  Element& find(Id id);
  /// Where a picture has an element: across and up.
  std::array<double, 2> seen(const Element& element, double t) const;
  void add_state(State state);

  View view_;
  std::string title_, about_;
  double begin_, end_;
  int coefficients_ = 0;                 ///< of a motion that may be changed, in a coordinate; 0: none may be
  std::vector<std::string> changeable_;  ///< titles of drawings whose points may be changed
  std::vector<Element> elements_;
  std::vector<Event> events_;
  std::vector<State> states_;
  std::vector<Span> spans_;
  std::vector<std::pair<double, Drawing>> drawings_;  ///< since when each is shown
  std::vector<std::size_t> open_;                     ///< spans that continue in the last state
};

}  // namespace kds::course
