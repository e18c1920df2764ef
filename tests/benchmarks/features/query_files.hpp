// The files of the published benchmark of continuous collision queries.
#pragma once

#include "tests/certificates/exact_features.hpp"
#include "tests/support/exact_rational.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::benchmarks {

/// Four points on straight paths from time 0 to time 1, and whether they touch.
struct StepQuery {
  tests::Features kind;
  std::array<std::array<Eigen::Vector3d, 4>, 2> ends;
  std::optional<bool> touches;
  const char* family = "";
};

/// A coordinate "numerator,denominator" as a double; `exact` says whether it is one.
inline double coordinate(const std::string& numerator, const std::string& denominator, bool& exact) {
  const oracle::Integer below(denominator);
  if (below == 0) throw std::invalid_argument("denominator 0");
  const oracle::Rational value(oracle::Integer(numerator), below);
  const double rounded = oracle::approximate(value);
  exact = exact && oracle::rational(rounded) == value;
  return rounded;
}

/// Reads all CSV files below a folder. Format: eight lines a query, the four points at time 0, then at time 1; a line
/// holds numerator and denominator of x, y and z, and 1 if the query is a contact, else 0. Files with "vertex-face" in
/// their path hold vertex and face, those with "edge-edge" edge and edge; others are left alone. Queries whose
/// coordinates are no doubles are counted and left out, since their truth is about other numbers.
/// Paper: [Wang21].
inline std::vector<StepQuery> read_queries(const std::filesystem::path& folder, std::size_t& left_out) {
  std::vector<StepQuery> queries;
  left_out = 0;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() == ".csv") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    const std::string name = file.string();
    const bool face = name.find("vertex-face") != std::string::npos;
    if (!face && name.find("edge-edge") == std::string::npos) continue;
    std::ifstream in(file);
    StepQuery query{face ? tests::Features::vertex_face : tests::Features::edge_edge, {}, {}, "file"};
    bool exact = true;
    std::size_t point = 0;
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      const auto wrong = [&](const char* what) {
        throw std::invalid_argument(name + ":" + std::to_string(number) + ": " + what);
      };
      std::vector<std::string> cells;
      std::stringstream cells_of(line);
      for (std::string cell; std::getline(cells_of, cell, ',');) {
        cell.erase(std::remove_if(cell.begin(), cell.end(), [](char c) { return c == ' ' || c == '\r' || c == '\t'; }),
                   cell.end());
        cells.push_back(cell);
      }
      if (cells.size() != 7) wrong("seven numbers expected");
      try {
        for (std::size_t d = 0; d < 3; ++d) {
          query.ends[point / 4][point % 4][static_cast<int>(d)] = coordinate(cells[2 * d], cells[2 * d + 1], exact);
        }
      } catch (const std::exception& e) {
        wrong(e.what());
      }
      if (cells[6] != "0" && cells[6] != "1") wrong("the last number must be 0 or 1");
      query.touches = cells[6] == "1";
      if (++point == 8) {
        if (exact) queries.push_back(query);
        left_out += !exact;
        point = 0;
        exact = true;
      }
    }
    if (point != 0) throw std::invalid_argument(name + ": ends within a query");
  }
  return queries;
}

}  // namespace kds::benchmarks
