// Compares what a page shows after somebody has changed motions in it, computed by its program as WebAssembly in a
// browser, with what the program computes here for the same motions: all numbers, bit for bit.
// Usage: check_changed_page NAME PROGRAM PAGE.html REPORTS.html
#include "tests/examples/course/course_page.hpp"

#include <cstdlib>
#include <iostream>
#include <string>

namespace {

using kds::tests::json;
using kds::tests::report_of;
using kds::tests::script_of;

int mistakes = 0;

template <class... T>
void wrong(const T&... what) {
  ++mistakes;
  (std::cerr << ... << what) << '\n';
}

/// The data of the page that the program writes for these motions. No text of them has quotation marks of the shell.
json native(const std::string& program, const std::string& page, const json& motions, const json& points) {
  const std::string command =
      "'" + program + "' '" + page + "' '" + motions.dump() + "' '" + points.dump() + "' > /dev/null";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
  return script_of(page, "data");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: check_changed_page NAME PROGRAM PAGE.html REPORTS.html\n";
    return 2;
  }
  try {
    const json report = report_of(argv[4], argv[1]);
    for (const json& error : report["errors"]) wrong("error on the page: ", error);
    if (report["ready"] != true) wrong("the program does not run in the page: ", report["says"]);
    std::size_t events = 0;
    json before;
    for (const json& run : report["runs"]) {
      const std::string what = run["what"];
      const json right = native(argv[2], argv[3] + std::string(".native"), run["motions"], run["points"]);
      const json& shown = run["data"];
      for (const char* part : {"elements", "events", "states", "certificates", "drawings", "begin", "end"}) {
        if (right[part] != shown[part]) wrong(what, ": ", part, " are not those of the program here");
      }
      if (run["events"] != right["events"].size()) wrong(what, ": not all events are listed");
      if (run["drawn"] != right["elements"].size()) wrong(what, ": not all elements are drawn");
      const json given{run["motions"], run["points"]};
      if (given == before) wrong(what, ": nothing has changed");
      before = given;
      events += right["events"].size();
    }
    // Two more where points of drawings can be dragged too.
    const std::size_t runs = report["runs"].at(0)["points"].empty() ? 10 : 12;
    if (report["runs"].size() != runs) wrong("there are ", report["runs"].size(), " runs, not ", runs);
    if (events == 0) wrong("nothing has happened in any run");
    for (const json& guess : report["guesses"]) {
      const std::string says = guess[1];
      if ((says.rfind("Right: ", 0) == 0) != guess[0]) wrong("a guess was answered by: ", says);
    }
    std::cout << report["runs"].size() << " runs, " << events << " events, " << report["guesses"].size() << " guesses, "
              << mistakes << " mistakes\n";
  } catch (const std::exception& error) {
    wrong(error.what());
  }
  return mistakes == 0 ? 0 : 1;
}
