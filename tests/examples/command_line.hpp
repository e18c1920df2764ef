// Runs of the tool, as a shell would run it.
#pragma once

#include "tests/io/temporary_folder.hpp"

#include <sys/wait.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace kds::io::tests {

struct Outcome {
  int code;
  std::string out;
  std::string err;
};

/// Runs the tool in the folder; `by` stands before it: a program that is to run it, or a limit with its semicolon.
inline Outcome kds_collide_in(const TemporaryFolder& folder, const std::string& arguments, const std::string& by = "") {
  const TemporaryFolder streams;
  const std::string out = (streams / "out").string();
  const std::string err = (streams / "err").string();
  const std::string command = "cd '" + (folder / "").string() + "' && " + by + " '" KDS_COLLIDE_PROGRAM "' " +
                              arguments + " >" + out + " 2>" + err + " </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Two balls that meet at t = 1.
inline constexpr const char* head_on = R"({"scene": 1, "end_time": 3, "response": "none", "bodies": [
  {"name": "a", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0, "position": [[0,0,0], [1,0,0]]}]},
  {"name": "b", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0, "position": [[4,0,0], [-1,0,0]]}]}]})";

}  // namespace kds::io::tests
