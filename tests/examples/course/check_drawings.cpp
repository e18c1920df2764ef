#include "tests/examples/course/check_drawings.hpp"

#include "certificates/order.hpp"
#include "kds/roots/failure_time.hpp"
#include "tests/examples/course/boxes_of_page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace kds::tests {

namespace {

using certificates::Order;
using Point = std::array<double, 2>;

Point point(const json& pair, std::size_t first = 0) { return {pair[first], pair[first + 1]}; }
double distance(Point a, Point b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }
double turn(Point a, Point b, Point c) { return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]); }

bool in_order(const Motion<2>& lower, const Motion<2>& upper, double t) {
  return sign_after(Order<2>{lower, upper}, t) >= 0;
}
double order_fails(const Motion<2>& lower, const Motion<2>& upper, double t) {
  return failure_time(Order<2>{lower, upper}, t);
}

/// A drawing, and where to say what is wrong with it.
class Check {
 public:
  Check(const json& drawing, double t, std::vector<std::string>& wrong) : drawing_(drawing), t_(t), wrong_(wrong) {
    for (const json& link : links()) {
      const std::size_t from = link["of"][0], to = link["of"][1];
      const bool ends =
          distance(point(link["ends"]), at(from)) < 1e-6 && distance(point(link["ends"], 2), at(to)) < 1e-6;
      expect(ends, "a link does not end at its places");
    }
  }

  void expect(bool right, const std::string& what) {
    if (!right)
      wrong_.push_back("t = " + std::to_string(t_) + ": " + drawing_["title"].get<std::string>() + ": " + what);
  }
  std::size_t size() const { return drawing_["places"].size(); }
  const json& links() const { return drawing_["links"]; }
  const json& place(std::size_t i) const { return drawing_["places"][i]; }
  std::size_t element(std::size_t i) const { return place(i)["of"]; }
  Point at(std::size_t i) const { return point(place(i)["at"]); }
  /// In the units of the drawing's places.
  Point unscaled(std::size_t i) const {
    const json& scale = drawing_["scale"];
    return {(at(i)[0] - scale["x0"].get<double>()) / scale["kx"].get<double>(),
            (at(i)[1] - scale["y0"].get<double>()) / scale["ky"].get<double>()};
  }

  /// The one that fails first of the links is marked, if any ever fails.
  template <class FailureTime>
  void check_next(FailureTime&& fails) {
    double first = never, marked = never;
    int marks = 0;
    for (const json& link : links()) {
      const double time = fails(link["of"][0].get<std::size_t>(), link["of"][1].get<std::size_t>());
      first = std::min(first, time);
      if (link["next"] != true) continue;
      ++marks;
      marked = time;
    }
    expect(marked == first && marks == (first == never ? 0 : 1), "the link that fails next is not marked");
  }

 private:
  const json& drawing_;
  double t_;
  std::vector<std::string>& wrong_;
};

/// Nobody is above whom it stands below, and the highest is on top. `leaves`: elements stand at leaves, and at each
/// place above that they win; otherwise each stands at one place.
void check_tree(Check& check, const CoursePage& page, const json& drawing, double t, bool leaves) {
  std::vector<int> below(check.size()), above(check.size()), seen(page.size());
  const auto value = [&](std::size_t i) { return page.value(check.element(i), t); };
  for (const json& link : check.links()) {
    const std::size_t from = link["of"][0], to = link["of"][1];
    ++below[from], ++above[to];
    check.expect(check.at(to)[1] > check.at(from)[1], "a child is not below its parent");
    check.expect(in_order(value(to), value(from), t), "a child is greater than its parent");
  }
  check.expect(check.links().size() + 1 == check.size(), "it is no tree");
  for (std::size_t i = 0; i < check.size(); ++i) {
    check.expect(below[i] <= 2 && above[i] == (i > 0), "a place has not two children and one parent at most");
    if (!leaves || below[i] == 0) ++seen[check.element(i)];
    if (i > 0) continue;
    for (Id id = 0; id < page.size(); ++id) {
      check.expect(in_order(page.value(id, t), value(0), t), "the greatest is not on top");
    }
  }
  if (leaves) {
    for (const json& link : check.links()) {
      const std::size_t from = link["of"][0];
      const auto won = [&](const json& other) {
        const std::size_t winner = other["of"][0], player = other["of"][1];
        return winner == from && check.element(player) == check.element(from);
      };
      check.expect(std::count_if(check.links().begin(), check.links().end(), won) == 1, "a winner has not played");
    }
  }
  for (Id id = 0; id < page.size(); ++id) check.expect(seen[id] == 1, "an element has not one place");
  check.check_next([&](std::size_t from, std::size_t to) {
    return check.element(from) == check.element(to) ? never : order_fails(value(to), value(from), t);
  });
  const json& values = drawing["values"];
  check.expect(values.size() == check.size() || values.empty(), "some places have values");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = value(i)(t);
    check.expect(std::abs(values[i].get<double>() - x) <= 6e-3 * std::abs(x) + 1e-12,
                 "a value is not that of its time");
  }
}

/// Ends ascend, each is there once, and is joined with its place on the axis.
void check_ends(Check& check, const CoursePage& page, const json& drawing, double t, int axis) {
  const auto boxes = boxes_of(page, t);
  const auto end = [&](std::size_t i) {
    const auto& box = boxes[check.element(i)];
    return (check.place(i)["side"] == 1 ? box.max : box.min).axis(axis);
  };
  std::set<std::pair<std::size_t, int>> ends;
  const double v0 = drawing["scale"]["v0"], kv = drawing["scale"]["kv"];
  for (std::size_t i = 0; i < check.size(); ++i) {
    ends.emplace(check.element(i), check.place(i)["side"].get<int>());
    const json& leader = drawing["leaders"][i];
    check.expect(std::abs(leader[0].get<double>() - (v0 + kv * end(i)(t))) < 1e-6,
                 "an end is not at its place on the axis");
    check.expect(std::abs(leader[2].get<double>() - check.at(i)[0]) < 1e-6, "a leader does not lead to its end");
    if (i == 0) continue;
    check.expect(check.at(i - 1)[0] < check.at(i)[0], "ends do not follow one another");
    check.expect(in_order(end(i - 1), end(i), t), "ends do not ascend");
  }
  check.expect(ends.size() == 2 * page.size() && check.size() == 2 * page.size(), "not each end is there once");
  check.expect(check.links().size() + 1 == check.size(), "not all neighbours are joined");
  check.check_next([&](std::size_t i, std::size_t k) { return order_fails(end(i), end(k), t); });
}

/// Corners of a growing square, of which the first is slower and faster than that in the second drawing.
void check_four(Check& check, const json& drawing, double t) {
  const bool once = drawing["title"] == "Four on a circle once";
  const double r = 1 + 0.25 * t, p = once ? 0.5 + 0.375 * t : r;
  const std::array<Point, 4> square{Point{p, p}, Point{-r, r}, Point{-r, -r}, Point{r, -r}};
  check.expect(check.size() == 4 && check.links().size() == 5, "it is no triangulation of four points");
  for (std::size_t i = 0; i < 4; ++i) {
    check.expect(distance(check.unscaled(i), square[i]) < 1e-9, "a corner is at another place");
  }
  if (!drawing.contains("circle")) return check.expect(false, "there is no circle");
  const Point middle = point(drawing["circle"]["at"]);
  const double radius = drawing["circle"]["at"][2];
  for (std::size_t k = 0; k < 4; ++k) {
    const double off = distance(check.at(drawing["circle"]["of"][k]), middle) - radius;
    if (k < 3 || !once || t == 4)
      check.expect(std::abs(off) < 1e-6, "a point is not on the circle");
    else
      check.expect(off > 0, "the fourth point is in the circle");
  }
  const double fails = once && t < 4 ? 4 : never;
  // The diagonal: two that are not neighbours in the square.
  check.check_next([&](std::size_t i, std::size_t k) { return (i + k) % 2 == 0 ? fails : never; });
}

/// Each line is where two points are nearest, and where two points are there is a line. Between the bounds of the
/// points.
void check_cells(const CoursePage& page, const json& frame, std::vector<std::string>& wrong) {
  const double t = frame["time"];
  std::vector<Point> points;
  for (Id id = 0; id < page.size(); ++id) points.push_back({page.position(id, t)[0], page.position(id, t)[1]});
  /// By how much others are farther from a place than the two are.
  const auto lead = [&](Point x, std::size_t a, std::size_t b) {
    double other = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i != a && i != b) other = std::min(other, distance(x, points[i]));
    }
    return other - std::max(distance(x, points[a]), distance(x, points[b]));
  };
  const auto expect = [&](bool right, std::size_t a, std::size_t b, const std::string& what) {
    if (!right)
      wrong.push_back("t = " + std::to_string(t) + ": cells of " + std::to_string(a) + " and " + std::to_string(b) +
                      what);
  };
  std::map<std::pair<std::size_t, std::size_t>, std::pair<Point, Point>> lines;
  for (const json& line : frame["cells"]) {
    const std::size_t a = line[0], b = line[1];
    const Point p = point(line, 2), q = point(line, 4);
    lines[{std::min(a, b), std::max(a, b)}] = {p, q};
    for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Point x{p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])};
      expect(std::abs(distance(x, points[a]) - distance(x, points[b])) < 1e-6, a, b, ": the line is not between them");
      expect(lead(x, a, b) > -1e-6, a, b, ": another point is nearer");
    }
  }
  for (std::size_t a = 0; a < points.size(); ++a) {
    for (std::size_t b = a + 1; b < points.size(); ++b) {
      const Point d{points[b][0] - points[a][0], points[b][1] - points[a][1]};
      for (double s = -3; s <= 3; s += 0.01) {
        const Point x{(points[a][0] + points[b][0]) / 2 - s * d[1], (points[a][1] + points[b][1]) / 2 + s * d[0]};
        const bool inside =
            x[0] > 0.05 && x[0] < 0.95 && x[1] > 0.05 && x[1] < 0.95;  // arcs() stay in this square, nearly
        if (!inside || lead(x, a, b) < 1e-3) continue;
        const auto found = lines.find({a, b});
        if (found == lines.end()) return expect(false, a, b, ": no line");
        const auto& [p, q] = found->second;
        expect(distance(x, p) + distance(x, q) < distance(p, q) + 1e-6, a, b, ": the line is too short");
      }
    }
  }
}

/// All points are left of each edge of the hull, whose corners turn left.
void check_hull(const CoursePage& page, const json& frame, std::vector<std::string>& wrong) {
  const double t = frame["time"];
  const auto at = [&](Id id) { return Point{page.position(id, t)[0], page.position(id, t)[1]}; };
  const json& hull = frame["outline"];
  if (hull.size() < 3) wrong.push_back("t = " + std::to_string(t) + ": the hull has no area");
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Id a = hull[i], b = hull[(i + 1) % hull.size()];
    for (Id id = 0; id < page.size(); ++id) {
      if (turn(at(a), at(b), at(id)) < -1e-12)
        wrong.push_back("t = " + std::to_string(t) + ": a point is outside the hull");
    }
  }
}

/// The circle of an event goes through three of its points, at the event through all four.
void check_happened(const CoursePage& page, const json& happened, double t, std::vector<std::string>& wrong) {
  bool now = false;
  for (const json& event : page.data()["events"]) now |= event["time"] == t;
  const Point middle = point(happened["circle"]);
  const double radius = happened["circle"][2];
  for (std::size_t k = 0; k < (now ? 4u : 3u); ++k) {
    const auto at = page.position(happened["members"][k], t);
    if (!(std::abs(distance({at[0], at[1]}, middle) - radius) < 1e-6 * (1 + radius))) {
      wrong.push_back("t = " + std::to_string(t) + ": the circle of an event does not go through point " +
                      std::to_string(k));
    }
  }
}

}  // namespace

std::vector<std::string> wrong_in_drawings(const CoursePage& page, const std::string& program, const json& frame) {
  std::vector<std::string> wrong;
  const double t = frame["time"];
  const std::map<std::string, std::size_t> drawings{
      {"05_tournament", 2}, {"08_degeneracies", 2}, {"09_sweep_and_prune", 2}};
  const auto found = drawings.find(program);
  if (frame["drawings"].size() != (found == drawings.end() ? 0 : found->second))
    wrong.push_back("drawings are missing");
  for (const json& drawing : frame["drawings"]) {
    Check check(drawing, t, wrong);
    const std::string title = drawing["title"];
    if (program == "05_tournament") check_tree(check, page, drawing, t, title == "Tournament");
    if (program == "08_degeneracies") check_four(check, drawing, t);
    if (program == "09_sweep_and_prune") check_ends(check, page, drawing, t, title.back() - 'x');
  }
  if (program == "07_delaunay") {
    check_cells(page, frame, wrong);
    check_hull(page, frame, wrong);
  }
  if (frame.contains("happened")) check_happened(page, frame["happened"], t, wrong);
  return wrong;
}

}  // namespace kds::tests
