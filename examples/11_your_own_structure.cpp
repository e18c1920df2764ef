// You learn: to write a kinetic structure of your own, step by step.
// How to run: build/dev/examples/11_your_own_structure, then open the page that it names
// What you see: 13 crossings
#include "examples/course/facts.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"

#include <array>
#include <iostream>
#include <string>
#include <vector>

using namespace kds;

// The question: which of the moving values are in the band from low to high?
//
// Step 1: which facts prove the answer? For each value and each border, on which side it is. A fact is a certificate: a
// polynomial that is >= 0 while it holds. This one is about one value and a border at rest.
struct Side {
  static constexpr int degree = 2;
  const Motion<2>& x;
  double border;
  bool above;

  template <class Number>
  auto polynomial(double epoch) const {
    const auto height = about<Number>(x, epoch) - constant<Number>(border);
    return above ? height : -height;
  }
};

// Step 2: the rule. It has a state, here which side each value is on, and numbers its certificates: slot 2 i is about
// value i and the lower border, slot 2 i + 1 about the upper one.
struct BandRule {
  using Element = Motion<2>;
  static constexpr const char* name = "Band";
  std::array<double, 2> borders;
  std::vector<std::array<bool, 2>> above;

  bool inside(Id id) const { return above[id][0] && !above[id][1]; }

  // Step 3: give the certificate of a slot now, and the elements that it is about.
  Side certificate(Slot slot, const MovingSet<Element>& x) const {
    return {x[slot / 2], borders[slot % 2], above[slot / 2][slot % 2]};
  }
  std::array<Id, 1> members(Slot slot) const { return {slot / 2}; }

  // Step 4: when it fails, repair the state. Its slot is certified anew automatically; others that change would be
  // marked with repair.certify(slot), or repair.retire(slot) if they are given up. Why do repairs end? Each removes the
  // contradiction between one sign and one bit, and makes no other.
  Effect repair(Slot slot, Repair<Element>&) {
    above[slot / 2][slot % 2] = !above[slot / 2][slot % 2];
    return Effect::external;  // the answer has changed, and not only its proof
  }

  // Step 5: insert an element, remove one. Signs are exact, and those of the instant after now.
  void insert(Id id, Repair<Element>& repair) {
    if (above.size() <= id) above.resize(id + std::size_t{1});
    for (const Slot border : {0u, 1u}) {
      above[id][border] = repair.sign(Side{repair[id], borders[border], true}) >= 0;
      repair.certify(2 * id + border);
    }
  }
  void remove(Id id, Repair<Element>& repair) {
    repair.retire(2 * id);
    repair.retire(2 * id + 1);
  }
};

/// For the page only: the name of a certificate.
template <class Name>
std::string fact(const Side& side, const Name& name) {
  return name(side.x) + (side.above ? " is above " : " is below ") + (side.border == 3 ? "low" : "high");
}

// Step 6: hand it to the framework, which does the rest: failure times, the queue, edits, audits, measures.
int main(int argc, char** argv) {
  const double end = 8;
  course::Page page(course::View::line, "11 Your own structure",
                    "Which values are in the band? A structure in thirty lines: for each value and border a "
                    "certificate of the side it is on. Exercise: keep the smallest gap; 12 is a solution.", 0, end);
  page.legend.event = "a border is crossed";
  page.legend.marked = "in the band";

  MovingSet<Motion<2>> values;
  const Motion<2> motions[] = {
      {{{1, 2.6, -0.3}}, 0}, {{{7, -2.9, 0.37}}, 0}, {{{4, 0.1, 0.02}}, 0}, {{{0, 0.9, 0}}, 0}, {{{5.5, 1, -0.2}}, 0}};
  for (const auto& motion : motions) {
    const Id id = values.add(motion, 0);
    page.element(id, std::string(1, static_cast<char>('a' + id)));
    page.moves(id, motion, 0);
  }
  const BandRule band{{3, 5}, {}};
  page.element(5, "low"), page.moves(5, Motion<0>{{{band.borders[0]}}, 0}, 0);
  page.element(6, "high"), page.moves(6, Motion<0>{{{band.borders[1]}}, 0}, 0);

  int crossings = 0;
  const auto known = [&](const BandRule& rule, double now) {
    course::State state{.certificates = course::certificates_of(rule, 2 * values.end_id(), values, now, page)};
    for (const Id id : values.ids()) {
      if (rule.inside(id)) state.marked.push_back(id);
    }
    state.text = "In the band: " + page.names(state.marked);
    return state;
  };
  const auto crossed = [&](const BandRule& rule, const KineticEvent& event) {
    const Id id = event.slot / 2;
    ++crossings;
    const std::string text = page.name(id) + (rule.inside(id) ? " comes in" : " goes out");
    page.event(event.time, text, {id}, known(rule, event.time));
  };
  Kinetic<BandRule, decltype(crossed)> structure(values, 0, band, crossed);
  Simulator simulator(0, structure);
  page.starts(known(structure.rule(), 0));
  while (simulator.step(end)) simulator.audit();
  std::cout << crossings << " crossings, and at the end " << known(structure.rule(), end).marked.size()
            << " are in the band\n";
  page.standings = {course::standing::band(structure.measures())};
  page.write(argc, argv, "11_your_own_structure");
}
