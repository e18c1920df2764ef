// You learn: to divide a square by segments that grow until they meet, and to take one in on the way.
// How to run: build/dev/examples/growing_segments [picture.svg]
// What you see: 61 segments divide the square into 62 cells, of which the largest is 4.85273 % of it
#include "structures/growing_segments.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/growing_cells.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <vector>

using namespace kds;
using structures::GrowingEnd;
using structures::GrowingSegmentsRule;

int main(int arguments, char** argument) {
  MovingSet<GrowingEnd> ends;
  Kinetic<GrowingSegmentsRule> segments(ends, 0);
  Simulator simulator(0, segments);

  std::uint32_t dice = 7;
  const auto random = [&dice](double low, double high) {
    dice = dice * 1664525u + 1013904223u;
    return low + (high - low) * (dice * 0x1p-32);
  };
  // An end that begins at (x, y) at `start`, and one that grows the other way.
  const auto plant = [&](double x, double y, double vx, double vy, double start) {
    ends.add({{{Polynomial<1>{{x, vx}}, Polynomial<1>{{y, vy}}}, start}}, start);
    ends.add({{{Polynomial<1>{{x, -vx}}, Polynomial<1>{{y, -vy}}}, start}}, start);
  };
  for (int i = 0; i < 60; ++i) {
    const double x = random(0, 10), y = random(0, 10), vx = random(-1, 1), vy = random(-1, 1);
    plant(x, y, vx, vy, 0);
  }
  // The sides of the square are lines that are there from the beginning.
  for (const double side : {0.0, 10.0}) {
    ends.add({{{Polynomial<1>{{side, 0}}, Polynomial<1>{{0, 1}}}, 0}, true}, 0);
    ends.add({{{Polynomial<1>{{0, 1}}, Polynomial<1>{{side, 0}}}, 0}, true}, 0);
  }

  simulator.advance_to(1);
  plant(5, 5, 0.3, -0.4, 1);  // born while the others grow: it stops those only that have not come by yet
  while (simulator.step(1e6)) {
  }

  // Cell 0 is what is outside of the square.
  const GrowingSegmentsRule& rule = segments.rule();
  const structures::PlaneCells cells = structures::cells_of(rule, ends, simulator.now());
  double largest = 0;
  for (std::uint32_t cell = 1; cell < cells.size(); ++cell) {
    largest = std::max(largest, cells.area(cell, 60).approximate());
  }
  std::size_t stopped = 0;
  std::vector<std::array<double, 4>> tracks;
  for (const Id id : ends.ids()) {
    if (ends[id].whole) continue;
    stopped += rule.stopped_by(id) != nobody;
    const auto from = ends[id].path(ends[id].path.start), to = rule.tip(ends[id], id, simulator.now());
    tracks.push_back({from[0], from[1], to[0], to[1]});
  }
  std::cout << stopped / 2 << " segments divide the square into " << cells.size() - 1
            << " cells, of which the largest is " << largest << " % of it\n"
            << segments.measures().events << " events, of which " << segments.measures().external
            << " stopped an end\n";

  if (arguments < 2) return 0;
  std::ofstream picture(argument[1]);
  picture << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-0.2 -0.2 10.4 10.4\" width=\"520\" height=\"520\">\n"
          << "<rect x=\"-0.2\" y=\"-0.2\" width=\"10.4\" height=\"10.4\" fill=\"#ffffff\"/>\n"
          << "<g fill-opacity=\"0.25\">\n";
  const std::array colours{"#e9c46a", "#2a9d8f", "#f4a261", "#8ab17d", "#a8c5e2"};
  for (std::uint32_t cell = 1; cell < cells.size(); ++cell) {
    picture << "<path fill=\"" << colours[cell % colours.size()] << "\" d=\"M";
    for (const std::uint32_t side : cells.loop(cells.loops(cell)[0])) {
      const auto [x, y] = cells.vertices()[cells.half_edges()[side].from].truncated(40);
      picture << x.approximate() << " " << y.approximate() << " ";
    }
    picture << "Z\"/>\n";
  }
  picture << "</g>\n<g stroke=\"#1b6ca8\" stroke-width=\"0.05\" stroke-linecap=\"round\" fill=\"none\">\n"
          << "<rect width=\"10\" height=\"10\" stroke=\"#333333\"/>\n";
  for (const auto& [x, y, to_x, to_y] : tracks)
    picture << "<path d=\"M" << x << " " << y << "L" << to_x << " " << to_y << "\"/>\n";
  picture << "</g>\n<g fill=\"#d1495b\">\n";
  for (std::size_t i = 0; i < tracks.size(); i += 2) {
    picture << "<circle cx=\"" << tracks[i][0] << "\" cy=\"" << tracks[i][1] << "\" r=\"0.07\"/>\n";
  }
  picture << "</g>\n</svg>\n";
  if (!picture.flush()) {
    std::cerr << argument[1] << ": cannot be written\n";
    return 1;
  }
}
