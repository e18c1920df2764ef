// What was measured, as files.
#pragma once

#include "tests/benchmarks/roots/cell.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace bench_roots {

/// A contender at one degree, over all families.
struct Summary {
  int degree;
  std::string solver;
  bool certified;
  double ordinary_ns = 0;  ///< mean over the ordinary families, horizons infinite and finite
  double hostile_ns = 0;   ///< the same over the others
  double slowest_ns = 0;   ///< of any family
  Tally tally;             ///< horizons infinite and finite
  Tally edge;              ///< horizons at the crossing
  bool front =
      true;  ///< no other contender is at least as fast on ordinary families and as often right, and better at one
};

/// In the order in which contenders appear.
std::vector<Summary> summarise(const std::vector<Cell>& cells);

/// roots.csv: a row a cell.
void write_cells(const std::filesystem::path& file, const std::vector<Cell>& cells);
/// roots-summary.csv: a row a degree and contender. roots.md: the same as tables, with ratios to the GSL.
void write_summary(const std::filesystem::path& file, const std::vector<Summary>& rows);
void write_tables(const std::filesystem::path& file, const std::vector<Summary>& rows);
/// roots-families.md: wrong answers by family, summed over the degrees; a column a contender.
void write_families(const std::filesystem::path& file, const std::vector<Cell>& cells);

}  // namespace bench_roots
