// You learn: kinetic sweep and prune with boxes of your own: which pairs overlap, from when until when.
// How to run: build/dev/examples/09_sweep_and_prune, then open the page that it names
// What you see: 10 pairs have overlapped; 117 swaps
#include "collision/broad_phase/box_overlap.hpp"
#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "examples/course/arcs.hpp"
#include "examples/course/facts.hpp"
#include "examples/course/structure_drawings.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <set>
#include <string>
#include <vector>

using namespace kds;
using namespace kds::collision;
using Path = certificates::PointMotion<2>;

/// Receives pairs, and passes them on to the page.
class Teller final : public PairListener {
 public:
  Teller(course::Page& page, const std::vector<KineticBox<2>>& boxes) : page_(page), boxes_(boxes) {}

  void pair_began(BodySlot a, BodySlot b, double t) override {
    pairs_.insert({a, b});
    all_.insert({a, b});
    tell(a, b, t, " begin to overlap");
  }
  void pair_ended(BodySlot a, BodySlot b, double t) override {
    pairs_.erase({a, b});
    tell(a, b, t, " cease to overlap");
  }
  /// From here on pairs are events; pairs reported before overlap from the start.
  void start() {
    page_.starts(known(0));
    started_ = true;
  }
  std::size_t all() const { return all_.size(); }

 private:
  course::State known(double t) const {
    std::string text;
    for (const auto& [a, b] : pairs_) text += (text.empty() ? "" : ", ") + page_.name(a) + page_.name(b);
    return {.text = "Overlapping pairs: " + (text.empty() ? "none" : text),
            .edges = {pairs_.begin(), pairs_.end()},
            .certificates = certificates(t)};
  }
  /// The time until which each pair overlaps: two boxes do as long as no side of one is beyond the other's opposite
  /// side.
  std::vector<course::Held> certificates(double t) const {
    std::vector<course::Held> all;
    for (const auto& [a, b] : pairs_) {
      course::Held held;
      const BoxOverlap<2> overlap(boxes_[a], boxes_[b]);
      for (const auto& apart : overlap.separations()) {
        const double until = recovery_time(apart, t);
        const certificates::Order<2> beyond{apart.upper, apart.lower};  // holds until then
        if (until < held.fails) held = course::held("", {a, b}, beyond, until, 0, "upper end \u2212 lower end");
      }
      held.fact = page_.name(a) + " and " + page_.name(b) + " overlap";
      all.push_back(std::move(held));
    }
    return all;
  }
  void tell(BodySlot a, BodySlot b, double t, const char* what) {
    if (!started_) return;
    std::cout << "t = " << t << ": " << page_.name(a) << " and " << page_.name(b) << what << '\n';
    page_.event(t, page_.name(a) + " and " + page_.name(b) + what, {a, b}, known(t));
  }

  course::Page& page_;
  const std::vector<KineticBox<2>>& boxes_;
  std::set<std::array<Id, 2>> pairs_, all_;
  bool started_ = false;
};

int main(int argc, char** argv) {
  const double end = 10;
  course::Page page(course::View::plane, "09 Sweep and prune",
                    "Boxes throw shadows on the axes; two overlap while their shadows overlap on both. The ends of "
                    "shadows stand in sorted lists, and only a swap of a left with a right end can change a pair.",
                    0, end);
  page.legend.edges = "a pair";
  page.edge_style = "pair";
  page.intervals = true;
  page.play_time = 20;

  // A box is a lower and an upper corner, each with a motion: it may grow as well. These only move; flat in z.
  std::vector<KineticBox<2>> boxes;
  std::vector<KineticSweepAndPrune<2>::Entry> entries;
  const auto arcs = page.motions(argc, argv, course::arcs(6, 9, end));
  for (Id id = 0; id < arcs.size(); ++id) {
    const std::array<double, 2> half{0.06 + 0.015 * (id % 6), 0.15 - 0.015 * (id % 6)};
    Path path;
    const auto& [x, y] = arcs[id].coordinate;
    for (std::size_t i = 0; i <= 2; ++i) path.coefficients[i] = {x.c[i], y.c[i], 0};
    path.start = arcs[id].start;
    boxes.push_back(box_around<2>(path, {-half[0], -half[1], -1}, {half[0], half[1], 1}));
    page.box(id, std::string(1, static_cast<char>('a' + id)), half);
    page.moves(id, path, 0);
  }
  for (Id id = 0; id < boxes.size(); ++id) entries.push_back({id, &boxes[id]});

  for (const int axis : {0, 1}) course::draw_ends(page, boxes, axis, end);
  Teller teller(page, boxes);
  KineticSweepAndPrune<2> sweep(0, {.listed = ListedAxes::all});
  sweep.insert(entries, 0, teller);
  teller.start();
  std::uint64_t changes = 0;
  while (sweep.advance(end, teller)) ++changes;  // returns after each change of a pair
  sweep.audit(end);
  const auto counters = sweep.counters();
  std::cout << teller.all() << " pairs have overlapped; " << counters.swaps << " swaps, " << counters.certificates
            << " certificates\n";
  page.standings = {course::standing::sweep_and_prune(counters.swaps, changes)};
  page.write(argc, argv, "09_sweep_and_prune");
}
