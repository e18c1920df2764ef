// Hashes the event logs of fixed scenes, and compares them with what they shall be.
//
// PROGRAM                  prints a line `NAME RECORDS HASH` for each scene
// PROGRAM GOLDEN           compares these lines with a file, says what differs, and exits 1 where something does
// PROGRAM --log NAME WAY   prints the events of one scene, numbers in hexadecimal, for diff
//
// Each scene is run in several ways, and all must give the line of the file.
#pragma once

#include "tests/replay/event_hash.hpp"

#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace kds::replay {

/// A scene, and what must give one and the same log of it.
struct Replay {
  struct Way {
    std::string name;
    std::function<void(EventHash&)> run;
  };
  std::string name;
  std::vector<Way> ways;
};

inline std::string line_of(const Replay& replay, const Replay::Way& way) {
  EventHash hash(false);
  way.run(hash);
  char text[64];
  std::snprintf(text, sizeof text, " %" PRIu64 " %016" PRIx64, hash.records(), hash.value());
  return replay.name + text;
}

inline int compare(const std::vector<Replay>& replays, const char* file) {
  std::ifstream golden(file);
  if (!golden) throw std::runtime_error(std::string(file) + " cannot be read");
  std::string expected;
  int differences = 0;
  for (const Replay& replay : replays) {
    if (!std::getline(golden, expected)) expected = "(nothing)";
    for (const Replay::Way& way : replay.ways) {
      const std::string found = line_of(replay, way);
      if (found == expected) continue;
      ++differences;
      std::printf("differs: %s, %s\n golden: %s\n", found.c_str(), way.name.c_str(), expected.c_str());
    }
  }
  for (; std::getline(golden, expected); ++differences) std::printf("not run: %s\n", expected.c_str());
  std::printf("%d differences from %s\n", differences, file);
  return differences == 0 ? 0 : 1;
}

inline int print_log(const std::vector<Replay>& replays, std::string_view name, std::string_view way_name) {
  for (const Replay& replay : replays) {
    for (const Replay::Way& way : replay.ways) {
      if (replay.name != name || way.name != way_name) continue;
      EventHash hash(true);
      way.run(hash);
      return 0;
    }
  }
  throw std::runtime_error("there is no scene of this name, or no such way to run it");
}

inline void print_lines(const std::vector<Replay>& replays) {
  for (const Replay& replay : replays) {
    const std::string line = line_of(replay, replay.ways.front());
    for (const Replay::Way& way : replay.ways) {
      if (line_of(replay, way) != line) throw std::runtime_error(replay.name + ": " + way.name + " disagrees");
    }
    std::printf("%s\n", line.c_str());
  }
}

/// The program that makes the replays of `all_replays()`.
inline int main_of(int argc, char** argv, std::vector<Replay> (*all_replays)()) {
  try {
    if (argc == 2) return compare(all_replays(), argv[1]);
    if (argc == 4 && std::string_view(argv[1]) == "--log") return print_log(all_replays(), argv[2], argv[3]);
    if (argc != 1) throw std::runtime_error("usage: [GOLDEN | --log NAME WAY]");
    print_lines(all_replays());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}

}  // namespace kds::replay
