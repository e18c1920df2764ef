#include "tests/fuzz/random_worlds/make_scenario.hpp"

#include <array>
#include <cstddef>

namespace kds::fuzz {
namespace {

/// How many bodies a scenario has: mostly few, since a run then takes a fraction of a millisecond.
enum class Size { few, many, lattice };

Size draw_size_of_scenario(Random& random) {
  if (random.one_in(4000)) return Size::lattice;
  return random.one_in(60) ? Size::many : Size::few;
}

void add(Scenario& scenario, const BodyPlan& body) {
  scenario.calls.push_back({.kind = Call::Kind::add, .body = scenario.bodies.size()});
  scenario.bodies.push_back(body);
}

std::size_t any_body(Random& random, const Scenario& scenario) { return random.below(scenario.bodies.size()); }

/// What is done from outside between two advances.
void edit(Random& random, const Style& style, Size size, Scenario& scenario) {
  if (size == Size::few) {
    if (random.one_in(3)) add(scenario, draw_body(random, style));
    if (style.sensors && random.one_in(3)) {
      scenario.bodies.push_back(draw_body(random, style));
      scenario.calls.push_back(
          {.kind = Call::Kind::attach, .body = scenario.bodies.size() - 1, .other = any_body(random, scenario)});
    }
    if (random.one_in(3)) scenario.calls.push_back(draw_call(random, style, scenario.bodies.size()));
    if (random.one_in(6)) {  // an id that is given again at once
      scenario.calls.push_back({.kind = Call::Kind::remove, .body = any_body(random, scenario)});
      add(scenario, draw_body(random, style));
    }
    return;
  }
  for (int k = random.one_in(3) ? random.integer(5, 40) : 0; k > 0; --k) add(scenario, draw_body(random, style));
  for (int k = random.one_in(3) ? random.integer(5, 60) : 0; k > 0; --k) {
    scenario.calls.push_back({.kind = Call::Kind::remove, .body = any_body(random, scenario)});
  }
}

/// Bodies at the points of a lattice, of few velocities: thousands of contacts happen at one instant.
void add_lattice(Random& random, const Style& style, Scenario& scenario) {
  BodyPlan body = draw_body(random, style);
  const int side = body.shape == ShapeKind::mesh ? 4 : random.integer(5, 7);  // meshes take ten times as long
  if (body.shape == ShapeKind::half_space) body.shape = ShapeKind::ball;
  body.size = Vector3d::Constant(0.25 * random.integer(1, 2));
  body.orientation = Eigen::Quaterniond::Identity();
  body.fixed = false;
  body.pieces = {Path{}};
  body.box_function = false;
  const Vector3d one = 0.5 * Vector3d(random.integer(-2, 2), random.integer(-2, 2), random.integer(-2, 2));
  for (int i = 0; i < side * side * side; ++i) {
    const Vector3d cell(i % side, i / side % side, i / (side * side));
    const bool odd = (static_cast<int>(cell.sum()) & 1) != 0;
    body.pieces.front().place = 1.5 * cell - Vector3d::Constant(0.75 * side);
    body.pieces.front().velocity = odd ? one : Vector3d(-one);
    add(scenario, body);
  }
}

void draw_options(Random& random, const Style& style, Scenario& scenario) {
  constexpr std::array restitutions{1.0, 0.5, 0.0, 0x1p-30};
  constexpr std::array units{1.0, 1.0, 1.0, 1.0, 0x1p-20, 0x1p30, 1e-3, 1e5};
  constexpr std::array starts{0.0, 0.0, 0.0, 0.0, 1.0, -3.5, 1000.0, 1e6 + 0.1, 1e9};
  constexpr std::array intervals{1e-9, 1e-9, 1e-3, 0.25, 0.0};
  constexpr std::array contacts{100u, 100u, 5u, 1u};
  scenario.walls = random.one_in(2);
  scenario.wall = {style.half_side + 2, restitutions[random.below(restitutions.size())]};
  scenario.report_pairs = random.one_in(3);
  scenario.report_pieces = random.one_in(2);
  scenario.unit = units[random.below(units.size())];
  scenario.start_time = starts[random.below(starts.size())];
  scenario.zeno_interval = intervals[random.below(intervals.size())];
  scenario.zeno_contacts = contacts[random.below(contacts.size())];
  scenario.may_be_saved = !style.box_functions;
  scenario.fixed_bodies_move = style.fixed_bodies_move;
  const bool callbacks_edit = scenario.response == Response::callback || random.one_in(2);
  if (callbacks_edit) scenario.reaction_rate = static_cast<std::size_t>(random.integer(1, 8));
}

}  // namespace

DrawnScenario make_scenario(std::uint64_t seed) {
  // Neighbouring seeds of the generator are unlike each other only if they are mixed first.
  Random random(seed * 0x9e3779b97f4a7c15u + 1);
  DrawnScenario result;
  Scenario& scenario = result.scenario;
  scenario.seed = seed;
  scenario.degree = random.integer(1, 2);
  constexpr std::array responses{Response::none, Response::elastic, Response::callback};
  scenario.response = responses[random.below(responses.size())];
  Style& style = result.style = draw_style(random, scenario.response);
  draw_options(random, style, scenario);

  const Size size = draw_size_of_scenario(random);
  if (size != Size::few) scenario.most_alive = 400, scenario.most_events = 2000;
  if (size == Size::many) style.half_side += 3;
  if (size == Size::lattice) {
    scenario.report_pairs = false;
    style.half_side += 4;
    add_lattice(random, style, scenario);
  }
  scenario.wall.half_side = style.half_side + 2;
  int bodies = size == Size::few ? random.integer(2, random.one_in(2) ? 5 : 10) : 0;
  if (size == Size::many) bodies = random.integer(20, 90);
  for (; bodies > 0; --bodies) add(scenario, draw_body(random, style));
  for (int advances = random.integer(1, 10); advances > 0; --advances) {
    scenario.calls.push_back({.kind = Call::Kind::advance, .seconds = draw_seconds(random, style)});
    if (random.one_in(2)) edit(random, style, size, scenario);
  }
  scenario.calls.push_back({.kind = Call::Kind::advance, .seconds = 1});
  return result;
}

}  // namespace kds::fuzz
