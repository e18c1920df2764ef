// Compares what a browser showed of a page of the course with what must be known there.
// Usage: check_course_page NAME PAGE.html REPORTS.html
#include "tests/examples/course/check_drawings.hpp"
#include "tests/examples/course/expected_states.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace kds;
using namespace kds::tests;

int mistakes = 0;

template <class... T>
void wrong(const T&... what) {
  if (++mistakes > 20) return;
  (std::cerr << ... << what) << '\n';
}

bool near(double a, double b) { return std::abs(a - b) <= 1e-9 * (1 + std::abs(b)); }

/// Where everything is drawn: dots, ends of edges and corners of the outline.
void check_places(const CoursePage& page, const Expected& expected, const json& frame) {
  const double t = frame["time"];
  const auto place = [&](Id id) { return expected.positions.empty() ? page.position(id, t) : expected.positions[id]; };
  // From a number on, of `shown` the two or three coordinates that a picture has.
  const std::size_t coordinates = page.in_space() ? 3 : 2;
  const auto check = [&](Id id, const json& shown, std::size_t first, const char* what) {
    const auto at = place(id);
    // A world of its own may differ by roundings that bounces magnify.
    const double slack = expected.positions.empty() ? 0 : 1e-6;
    const auto same = [&](double a, double b) { return near(a, b) || std::abs(a - b) < slack; };
    for (std::size_t d = 0; d < coordinates; ++d) {
      const double x = shown[first + d];
      if (!same(x, at[d])) wrong("t = ", t, ": ", what, " ", id, " is drawn at ", x, ", not at ", at[d], ": axis ", d);
    }
  };
  if (frame["positions"].size() != page.size()) wrong("t = ", t, ": not all elements are drawn");
  for (const json& p : frame["positions"]) check(p[0], p, 1, "element");
  for (const json& e : frame["edges"]) {
    check(e[0], e, 2, "an edge of element");
    check(e[1], e, 2 + coordinates, "an edge of element");
  }
  for (std::size_t i = 0; i < frame["outline"].size(); ++i) {
    check(frame["outline"][i], frame["corners"][i], 0, "the corner of element");
  }
}

template <class T>
void compare(const std::optional<T>& expected, const T& shown, double t, const char* what) {
  if (expected && *expected != shown) wrong("t = ", t, ": ", what, ": ", json(shown), " instead of ", json(*expected));
}

void check_frame(const CoursePage& page, const std::string& name, const json& frame) {
  const double t = frame["time"];
  const Expected expected = expectations().at(name)(page, t);
  check_places(page, expected, frame);
  auto marked = frame["marked"].get<std::vector<Id>>();
  std::sort(marked.begin(), marked.end());
  std::vector<std::pair<Id, Id>> edges;
  for (const json& e : frame["edges"]) edges.emplace_back(e[0], e[1]);
  std::sort(edges.begin(), edges.end());
  compare(expected.order, frame["order"].get<std::vector<Id>>(), t, "order");
  compare(expected.outline, frame["outline"].get<std::vector<Id>>(), t, "outline");
  compare(expected.marked, marked, t, "marked");
  compare(expected.edges, edges, t, "edges");
  const std::string text = frame["text"];
  if (text.compare(0, expected.text.size(), expected.text) != 0) wrong("t = ", t, ": text: ", text);

  const double fails = frame["fails"].is_null() ? never : frame["fails"].get<double>();
  if (expected.fails && *expected.fails != fails) {
    wrong("t = ", t, ": the next certificate fails at ", fails, " instead of ", *expected.fails);
  }
  if (fails < t) wrong("t = ", t, ": a certificate is shown that failed at ", fails);
  const std::string next = frame["next"];
  if (fails != never) {
    const double said = std::strtod(next.c_str() + next.rfind(", at ") + 5, nullptr);
    if (!(std::abs(said - fails) <= 1e-3 * (1 + std::abs(fails)))) wrong("t = ", t, ": next: ", next);
  }
  for (const std::string& mistake : wrong_in_drawings(page, name, frame)) wrong(mistake);
  // The function that proves the next certificate, and its root.
  const std::string formula = frame["formula"];
  if (fails != never && formula.find(" = ") == std::string::npos) wrong("t = ", t, ": there is no formula: ", formula);
  if (fails != never) {
    const double root = std::strtod(formula.c_str() + formula.rfind("t = ") + 4, nullptr);
    if (!(std::abs(root - fails) <= 1e-3 * (1 + std::abs(fails)))) wrong("t = ", t, ": formula: ", formula);
  }
  // The event that is lit in the list is the last one up to now.
  long latest = -1;
  for (const json& event : page.data()["events"]) latest += event["time"] <= t;
  if (frame["latest"] != latest) wrong("t = ", t, ": event ", frame["latest"], " is lit instead of ", latest);
}

void check_controls(const CoursePage& page, const json& report) {
  for (const json& click : report["clicks"]) {
    const double t = page.data()["events"][click["event"].get<std::size_t>()]["time"];
    if (click["time"] != t) wrong("a click on event ", click["event"], " led to ", click["time"], " instead of ", t);
  }
  std::vector<double> times{page.data()["begin"]};
  for (const json& event : page.data()["events"]) {
    if (event["time"] > times.back()) times.push_back(event["time"]);
  }
  const double end = page.data()["end"];
  times.resize(std::max<std::size_t>(times.size(), 3), end);
  const double nudge = (end - times[0]) / 200;
  const double past = times[2] + nudge;
  double before = times[2];
  for (const double t : times) before = t < past ? t : before;
  const std::vector<double> expected{times[0], times[1], times[2], past, before, end, end - nudge, times[0]};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const json& key = report["keys"][i];
    if (!near(key[2], expected[i])) wrong("key ", key[0], " at ", key[1], " led to ", key[2], ", not ", expected[i]);
  }
  if (!(report["played"] > page.data()["begin"])) wrong("play does not move the time");
  if (report["stayed"] != true) wrong("pause does not stop it");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: check_course_page NAME PAGE.html REPORTS.html\n";
    return 2;
  }
  try {
    const CoursePage page(script_of(argv[2], "data"));
    const json report = report_of(argv[3], argv[1]);
    for (const json& error : report["errors"]) wrong("error on the page: ", error);
    const auto& links = report["links"];
    if (links.size() < 2 || std::count(links.begin(), links.end(), json("index.html")) != 1)
      wrong("it leads to ", links);
    if (report["codeOpens"] != true) wrong("a key does not open the program");
    if (report["code"].get<std::string>().find("int main(") == std::string::npos) wrong("it does not show its program");
    if (page.on_line() != report.contains("axes")) wrong("the ends of the time axis are not reported");
    for (const json& end : report.value("axes", json::array())) {
      if (std::abs(end[0].get<double>() - end[1].get<double>()) > 0.5) {
        wrong("slider and picture do not share the time axis: an end is at ", end[0], " and at ", end[1]);
      }
    }
    if (page.in_space() != report.contains("turned")) wrong("whether space can be turned is not reported");
    if (page.in_space()) {
      const json& turned = report["turned"];
      for (const double part : turned["drawn"]) {
        if (!(part > 0.01 && part < 0.9)) wrong("of the picture's pixels ", part, " are drawn");
      }
      if (turned["names"] != page.size()) wrong("not all names follow when the view is turned");
      if (!(turned["bytes"] > 0.01)) wrong("the picture stays when the view is turned: ", turned["bytes"]);
    }
    if (report.contains("layers") != (argv[1] == std::string("07_delaunay"))) wrong("whether layers can be hidden");
    for (const json& seen : report.value("layers", json::array())) {
      if (seen != json({true, false, true})) wrong("a layer is not hidden and shown again: ", seen);
    }
    const auto happened = std::count_if(report["frames"].begin(), report["frames"].end(),
                                        [](const json& frame) { return frame.contains("happened"); });
    if (page.data()["states"][0].contains("triangles") && happened < 20) wrong("circles of events: ", happened);
    if (report["frames"].size() < 5) wrong("the slider has not been moved");
    for (const json& frame : report["frames"]) {
      const double asked = frame["wanted"];
      if (frame["slider"] != frame["time"]) wrong("slider at ", frame["slider"], ", picture at ", frame["time"]);
      if (!near(frame["slider"], asked)) wrong("the slider is at ", frame["slider"], ", not at ", asked);
      check_frame(page, argv[1], frame);
    }
    for (const json& click : report["clicks"]) check_frame(page, argv[1], click);
    check_controls(page, report);
    std::cout << argv[1] << ": " << report["frames"].size() + report["clicks"].size() << " pictures, " << mistakes
              << " mistakes\n";
  } catch (const std::exception& error) {
    wrong(error.what());
  }
  return mistakes == 0 ? 0 : 1;
}
