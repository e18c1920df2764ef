#include "tests/fuzz/random_worlds/differences.hpp"

#include "tests/fuzz/random_worlds/player.hpp"

#include <algorithm>
#include <memory>

namespace kds::fuzz {
namespace {

std::unique_ptr<Reactor> reactor(const DrawnScenario& drawn) {
  if (drawn.scenario.reactions_are_written_down) return std::make_unique<WrittenReactor>(drawn.scenario);
  return std::make_unique<RandomReactor>(drawn.scenario, drawn.style);
}

std::vector<Line> run(const DrawnScenario& drawn, const Way& way) { return play(drawn.scenario, way, *reactor(drawn)); }

/// A call that must be refused and was not.
Difference accepted(const std::vector<Line>& lines) {
  Difference result;
  for (std::size_t i = 0; i < lines.size() && !result.any; ++i) {
    if (lines[i].kind != Line::Kind::thrown || lines[i].text != not_refused) continue;
    result = {true, i, "accepted where it must be refused", "  " + shown(lines[i]) + "\n"};
  }
  return result;
}

std::string shapes_of(const Scenario& scenario) {
  std::string result;
  const auto has = [&](ShapeKind kind, const char* name) {
    const auto is = [kind](const BodyPlan& body) { return body.shape == kind; };
    if (std::any_of(scenario.bodies.begin(), scenario.bodies.end(), is)) result += name;
  };
  has(ShapeKind::ball, " balls");
  has(ShapeKind::box, " boxes");
  has(ShapeKind::capsule, " capsules");
  has(ShapeKind::hull, " hulls");
  has(ShapeKind::compound, " compounds");
  has(ShapeKind::mesh, " meshes");
  has(ShapeKind::half_space, " half-spaces");
  return result;
}

}  // namespace

std::string kind_of(const Scenario& scenario, const WayThatDiffers& found) {
  constexpr std::array responses{"none", "elastic", "callback"};
  std::string result = found.difference.what + " |" + shapes_of(scenario) + " | ";
  result += responses[static_cast<std::size_t>(scenario.response)];
  result += " | ";
  result += found.way.window != never                                    ? "window"
            : found.way.save_every != 0 || found.way.saves_between_calls ? "saved"
            : found.way.stops != 0                                       ? "stops"
            : found.way.kdop != 6                                        ? "k-DOP"
                                                                         : "plain";
  return result;
}

std::vector<WayThatDiffers> differences(const DrawnScenario& drawn, std::size_t* lines) {
  const Scenario& scenario = drawn.scenario;
  const std::vector<Line> expected = run(drawn, reference_way(scenario));
  if (lines) *lines = expected.size();
  std::vector<WayThatDiffers> result;
  if (const Difference found = accepted(expected); found.any) result.push_back({reference_way(scenario), found});
  for (const Way& way : ways_of(scenario)) {
    const Difference found = compare(run(drawn, way), expected, scenario.most_events);
    if (found.any) result.push_back({way, found});
  }
  return result;
}

Difference difference(const DrawnScenario& drawn, const Way& way) {
  const Scenario& scenario = drawn.scenario;
  const std::vector<Line> expected = run(drawn, reference_way(scenario));
  if (way.name() == reference_way(scenario).name()) return accepted(expected);
  return compare(run(drawn, way), expected, scenario.most_events);
}

Scenario written_down(const DrawnScenario& drawn, const Way& way) {
  const auto write = [&](const Way& which) {
    const auto random = reactor(drawn);
    WritingReactor writing(*random);
    play(drawn.scenario, which, writing);
    return writing.written(drawn.scenario);
  };
  Scenario reference = write(reference_way(drawn.scenario));
  Scenario other = write(way);
  // Behind the difference the callbacks may do other things; the run that knows more of them is kept.
  return other.reactions.size() > reference.reactions.size() ? other : reference;
}

}  // namespace kds::fuzz
