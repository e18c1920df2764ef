#include "tests/benchmarks/roots/report.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace bench_roots {
namespace {

template <class... Arguments>
std::string text(const char* format, Arguments... arguments) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, arguments...);
  return buffer;
}

std::ofstream opened(const std::filesystem::path& file) {
  std::ofstream out(file);
  if (!out) throw std::runtime_error("cannot write " + file.string());
  return out;
}

void finish(std::ofstream& out, const std::filesystem::path& file) {
  out.flush();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

/// 0.5, 1.7, 4 200, 1.3e8: as much as a reader of a table wants to know.
std::string short_number(double x) {
  if (x < 9.95) return text("%.1f", x);
  if (x < 99'999) return text("%.0f", x);
  std::string s = text("%.0e", x);  // 1e+08
  s.erase(std::remove(s.begin(), s.end(), '+'), s.end());
  if (const auto zero = s.find("e0"); zero != std::string::npos) s.erase(zero + 1, 1);
  return s;
}

std::vector<std::string> solver_names(const std::vector<Cell>& cells) {
  std::vector<std::string> names;
  for (const Cell& cell : cells) {
    if (std::find(names.begin(), names.end(), cell.solver) == names.end()) names.push_back(cell.solver);
  }
  return names;
}

void mark_front(std::vector<Summary>& rows) {
  const auto dominates = [](const Summary& a, const Summary& b) {
    const bool no_worse = a.ordinary_ns <= b.ordinary_ns && a.tally.wrong() <= b.tally.wrong();
    return no_worse && (a.ordinary_ns < b.ordinary_ns || a.tally.wrong() < b.tally.wrong());
  };
  for (Summary& row : rows) {
    row.front = std::none_of(rows.begin(), rows.end(),
                             [&](const Summary& other) { return other.degree == row.degree && dominates(other, row); });
  }
}

}  // namespace

std::vector<Summary> summarise(const std::vector<Cell>& cells) {
  struct Count {
    int ordinary = 0, hostile = 0;
  };
  std::vector<Summary> rows;
  std::vector<Count> counts;
  for (const Cell& cell : cells) {
    auto row = std::find_if(rows.begin(), rows.end(),
                            [&](const Summary& r) { return r.degree == cell.degree && r.solver == cell.solver; });
    if (row == rows.end()) {
      rows.push_back({cell.degree, cell.solver, cell.certified, 0, 0, 0, {}, {}});
      counts.push_back({});
      row = rows.end() - 1;
    }
    if (cell.horizon == Horizon::edge) {
      row->edge.add(cell.tally);
      continue;
    }
    row->tally.add(cell.tally);
    row->slowest_ns = std::max(row->slowest_ns, cell.nanoseconds);
    Count& count = counts[static_cast<std::size_t>(row - rows.begin())];
    double& mean = cell.family->ordinary ? row->ordinary_ns : row->hostile_ns;
    int& n = cell.family->ordinary ? count.ordinary : count.hostile;
    mean += (cell.nanoseconds - mean) / ++n;
  }
  mark_front(rows);
  return rows;
}

void write_cells(const std::filesystem::path& file, const std::vector<Cell>& cells) {
  std::ofstream out = opened(file);
  out << "degree,family,horizon,solver,certified,polynomials,crossings,ns,ulps_max,ulps_999,missed,phantom,"
         "wrong_crossing,early,unenclosed\n";
  for (const Cell& cell : cells) {
    const Tally& t = cell.tally;
    out << text("%d,%s,%s,%s,%d,%zu,%zu,%.2f,%.4g,%.4g,%zu,%zu,%zu,%zu,%zu\n", cell.degree, cell.family->name,
                horizon_names[static_cast<std::size_t>(cell.horizon)], cell.solver.c_str(), cell.certified ? 1 : 0,
                t.count, t.crossings, cell.nanoseconds, t.ulps_max(), t.ulps_999(), t.missed, t.phantom,
                t.wrong_crossing, t.early, t.unenclosed);
  }
  finish(out, file);
}

void write_summary(const std::filesystem::path& file, const std::vector<Summary>& rows) {
  std::ofstream out = opened(file);
  out << "degree,solver,certified,front,ordinary_ns,hostile_ns,slowest_ns,polynomials,wrong,missed,phantom,wrong_"
         "crossing,"
         "ulps_max,ulps_999,early,crossings,edge_polynomials,edge_wrong,unenclosed\n";
  for (const Summary& r : rows) {
    const Tally& t = r.tally;
    out << text("%d,%s,%d,%d,%.2f,%.2f,%.2f,%zu,%zu,%zu,%zu,%zu,%.4g,%.4g,%zu,%zu,%zu,%zu,%zu\n", r.degree,
                r.solver.c_str(), r.certified ? 1 : 0, r.front ? 1 : 0, r.ordinary_ns, r.hostile_ns, r.slowest_ns,
                t.count, t.wrong(), t.missed, t.phantom, t.wrong_crossing, t.ulps_max(), t.ulps_999(), t.early,
                t.crossings, r.edge.count, r.edge.wrong(), t.unenclosed + r.edge.unenclosed);
  }
  finish(out, file);
}

void write_tables(const std::filesystem::path& file, const std::vector<Summary>& rows) {
  std::ofstream out = opened(file);
  for (std::size_t first = 0; first < rows.size();) {
    const int degree = rows[first].degree;
    std::size_t last = first;
    const Summary* reference = nullptr;
    for (; last < rows.size() && rows[last].degree == degree; ++last) {
      if (rows[last].solver == "GSL") reference = &rows[last];
    }
    out << text("\n**Degree %d**: %zu questions, and %zu with the horizon at the crossing\n\n", degree,
                rows[first].tally.count, rows[first].edge.count);
    out << "| solver | ns | to GSL | ns, hostile | to GSL | wrong | missed, phantom, other | ulps 99.9 % | max | early "
           "| "
           "wrong at the edge |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (std::size_t i = first; i < last; ++i) {
      const Summary& r = rows[i];
      const Tally& t = r.tally;
      const auto ratio = [&](double Summary::*ns) { return reference ? text("%.2f", r.*ns / (reference->*ns)) : "-"; };
      const char* bold = r.certified ? "**" : "";
      const char* front = r.front ? " *" : "";
      out << text(
          "| %s%s%s%s | %s | %s | %s | %s | %zu | %zu, %zu, %zu | %s | %s | %.0f %% | %zu |\n", bold, r.solver.c_str(),
          bold, front, short_number(r.ordinary_ns).c_str(), ratio(&Summary::ordinary_ns).c_str(),
          short_number(r.hostile_ns).c_str(), ratio(&Summary::hostile_ns).c_str(), t.wrong(), t.missed, t.phantom,
          t.wrong_crossing, short_number(t.ulps_999()).c_str(), short_number(t.ulps_max()).c_str(),
          t.crossings ? 100.0 * static_cast<double>(t.early) / static_cast<double>(t.crossings) : 0.0, r.edge.wrong());
    }
    first = last;
  }
  finish(out, file);
}

void write_families(const std::filesystem::path& file, const std::vector<Cell>& cells) {
  std::ofstream out = opened(file);
  const std::vector<std::string> solvers = solver_names(cells);
  out << "| family |";
  for (const std::string& solver : solvers) out << ' ' << solver << " |";
  out << "\n|---|";
  for (std::size_t i = 0; i < solvers.size(); ++i) out << "---|";
  out << '\n';
  for (const Family& family : families()) {
    out << "| " << family.name << ": " << family.what << " |";
    for (const std::string& solver : solvers) {
      std::size_t wrong = 0;
      std::size_t count = 0;
      for (const Cell& cell : cells) {
        if (cell.family != &family || cell.solver != solver || cell.horizon == Horizon::edge) continue;
        wrong += cell.tally.wrong();
        count += cell.tally.count;
      }
      out << (count == 0 ? " - |"
                         : text(" %.3g %% |", 100.0 * static_cast<double>(wrong) / static_cast<double>(count)));
    }
    out << '\n';
  }
  finish(out, file);
}

}  // namespace bench_roots
