// A program of someone else's that has a world answer: what is where, what will happen, who is watched, what is on the
// way, how long it may take, and a page of it all. It uses what is installed only, and says what is wrong.
#include "collision/drawing/draw_world.hpp"
#include "collision/fwd.hpp"
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/near_pairs.hpp"
#include "collision/queries/nearest.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/heightfield.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/world.hpp"
#include "io/world_recorder.hpp"

#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace kds::collision;
using Eigen::Vector3d;
using Line = kds::certificates::PointMotion<1>;

int answers = 0;

void expect(bool right, const char* what) {
  ++answers;
  if (!right) throw std::runtime_error(what);
}

/// Up to roundings.
bool nearly(double x, double y) { return std::abs(x - y) < 1e-12; }

BodyDescription<1> body(const Shape& shape, const Vector3d& at, const Vector3d& velocity = Vector3d::Zero()) {
  BodyDescription<1> description;
  description.shape = shape;
  description.motion = {Line::line(at, velocity)};
  return description;
}

PlacedShape upright(const Shape& shape) { return place(shape, Eigen::Quaterniond::Identity()); }

/// A ball that comes, a crate, and one that crosses.
struct Yard {
  World<1> world{WorldOptions{}};
  BodyId ball = world.add_body(body(Sphere{0.5}, {0, 0, 0}, {1, 0, 0}));
  BodyId crate = world.add_body(body(Box{{1, 1, 1}}, {8, 0, 0}));
  BodyId crossing = world.add_body(body(Sphere{0.5}, {4, -6, 0}, {0, 1, 0}));
};

void now() {
  Yard yard;
  const World<1>& world = yard.world;
  const auto hit = cast(world, Ray{{-2, 0, 0}, {18, 0, 0}});
  expect(hit && hit->body == yard.ball && nearly(hit->contact.time, 0.075), "a ray");
  const auto all = cast_all(world, Ray{{-2, 0, 0}, {18, 0, 0}});
  expect(all.size() == 2 && all[1].body == yard.crate && nearly(all[1].contact.time, 0.45), "all that a ray meets");
  const auto filtered = cast(world, Ray{{-2, 0, 0}, {18, 0, 0}}, [&](BodyId id) { return id != yard.ball; });
  expect(filtered && filtered->body == yard.crate, "a ray with a filter");
  const auto swept = cast(world, upright(Sphere{1}), Ray{{0, 9, 0}, {16, -7, 0}});
  expect(swept && swept->body == yard.crate, "a shape that is cast");
  expect(overlapping(world, upright(Box{{2, 2, 2}}), {9, 0, 0}) == std::vector{yard.crate}, "what overlaps a box");
  expect(overlapping(world, upright(Sphere{3}), {2, 0, 0}) == std::vector{yard.ball}, "what overlaps a ball");
  const auto found = nearest(world, Vector3d(4, 0, 0), 2);
  expect(found.size() == 2 && found[0].body == yard.crate && nearly(found[0].distance, 3) &&
             nearly(found[1].distance, 3.5),
         "the nearest to a point");
  const auto near_shape = nearest(world, upright(Box{{1, 1, 1}}), {4, 0, 0}, 1);
  expect(near_shape.size() == 1 && near_shape[0].distance == 2, "the nearest to a shape");
  expect(distance_between(world, yard.ball, yard.crate).distance == 6.5, "how far apart two are");
  std::vector<BodyId> ids;
  world.visit_bodies([&](BodyId id) { ids.push_back(id); });
  expect(ids == std::vector{yard.ball, yard.crate, yard.crossing}, "all bodies");
  expect(contact_pairs(world).empty(), "no pairs in contact");
  yard.world.advance_to(7);
  expect(contact_pairs(world) == std::vector{BodyPair{yard.ball, yard.crate}}, "pairs in contact");
  std::vector<BodyId> partners;
  world.visit_partners(yard.crate, [&](BodyId id) { partners.push_back(id); });
  expect(partners == std::vector{yard.ball} && world.touching(yard.ball, yard.crate), "the partners of a body");
}

/// The surface of a wavy field: 6 050 triangles.
std::shared_ptr<const Mesh> hills() {
  constexpr std::size_t side = 56;
  std::vector<double> heights;
  for (std::size_t i = 0; i < side * side; ++i) {
    heights.push_back(0.5 * static_cast<double>((i % side) % 3 + (i / side) % 4));
  }
  return std::make_shared<const Mesh>(heightfield(heights, side, 1, 1));
}

void shapes() {
  World<1> world(WorldOptions{});
  const std::vector<Vector3d> corners{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const std::array<CompoundPart, 2> parts{CompoundPart{Box{{0.5, 0.5, 1}}}, {Box{{1, 0.25, 0.25}}, {0, 0, 0.75}}};
  const std::array<Shape, 5> list{Capsule{0.5, 0.5}, convex_hull(corners), Box{{1, 1, 1}}, compound(parts), Sphere{1}};
  for (std::size_t i = 0; i < list.size(); ++i) world.add_body(body(list[i], {10.0 * static_cast<double>(i), 0, 0}));
  for (std::size_t i = 0; i < list.size(); ++i) {
    const double x = 10 * static_cast<double>(i);
    const auto hit = cast(world, Ray{{x, 0, 5}, {x, 0, -5}});
    expect(hit && hit->body == i && std::abs(hit->contact.time - 0.4) < 1e-12, "a ray from above, on a shape");
  }
  BodyDescription<1> floor = body(HalfSpace{{0, 0, 1}, -1}, {0, 0, 0});
  floor.fixed = true;
  const BodyId ground = world.add_body(floor);
  expect(cast(world, Ray{{1e9, 0, 1}, {1e9, 0, -3}})->body == ground, "a floor without end");
  const auto mesh = hills();
  BodyDescription<1> terrain = body(MeshShape{mesh}, {0, 1000, 0});
  terrain.fixed = true;
  const BodyId field = world.add_body(terrain);
  expect(mesh->triangles().size() == 6050, "the triangles of a heightfield");
  const auto drop = next_contact(world, upright(Sphere{0.25}), Line::line({0, 1000, 20}, {0, 0, -1}), 100);
  expect(drop && drop->body == field, "a ball above a mesh");
  const auto hit = cast(world, Ray{{0.25, 1000.25, 5}, {0.25, 1000.25, -0.5}});
  expect(hit && hit->body == field, "a ray at a mesh");
}

void future() {
  Yard yard;
  const World<1>& world = yard.world;
  const auto next = next_contact_of(world, yard.ball, 100);
  expect(next && next->body == yard.crate && next->contact.time == 6.5, "the next contact of a body");
  const auto pair = next_contact_between(world, yard.ball, yard.crate, 100);
  expect(pair && pair->time == 6.5, "the next contact of two");
  expect(!next_contact_between(world, yard.crossing, yard.crate, 100), "two that never meet");
  const auto bullet = next_contact(world, upright(Sphere{0.25}), Line::line({4, 0, 0}, {0, -2, 0}), 100);
  expect(bullet && bullet->body == yard.crossing && bullet->contact.time == 1.75, "a shape that is in no world");
  const auto entering = next_contacts(world, upright(Box{{1, 1, 1}}), Line::line({4, 0, 0}, {0, 0, 0}), 10);
  expect(entering.size() == 2 && entering[0].body == yard.ball && entering[0].contact.time == 2.5 &&
             entering[1].body == yard.crossing && entering[1].contact.time == 4.5,
         "who enters a place");
  const Approach approach = closest_approach(world, yard.ball, yard.crossing, 100);
  expect(approach.time == 5 && std::abs(approach.distance - std::sqrt(2.0)) < 1e-15, "the closest approach");
  const auto near = pairs_nearer_than(world, 2, 5.5);
  expect(near.size() == 1 && near[0].pair == BodyPair{yard.ball, yard.crossing} && near[0].approach.time == 5,
         "all pairs that come near");
  expect(world.now() == 0 && world.counters().contacts == 0, "questions change nothing");
  yard.world.advance_to(6.5);
  expect(world.touching(yard.ball, yard.crate), "what was foretold");
}

struct Log final : WorldListener<1> {
  std::vector<std::pair<char, double>> told;
  std::vector<std::uint64_t> user_data;
  std::vector<TimerId> timers;
  void contact(World<1>&, const PairEvent& event) override {
    told.emplace_back('c', event.contact.time);
    user_data.push_back(event.user_data_b);
  }
  void separation(World<1>&, const PairEvent& event) override { told.emplace_back('s', event.contact.time); }
  void overlap(World<1>&, const PairEvent& event) override { told.emplace_back('o', event.contact.time); }
  void piece(World<1>& world, BodyId) override { told.emplace_back('p', world.now()); }
  void timer(World<1>& world, TimerId timer) override {
    told.emplace_back('t', world.now());
    timers.push_back(timer);
    world.set_mass(0, 7);
  }
};
using Told = std::vector<std::pair<char, double>>;

void sensors() {
  Log log;
  World<1> world({.response = Response::elastic}, &log);
  BodyDescription<1> gate = body(Box{{1, 1, 1}}, {5, 0, 0});
  gate.sensor = true;
  world.add_body(gate);
  BodyDescription<1> guest = body(Sphere{0.5}, {0, 0, 0}, {1, 0, 0});
  guest.user_data = 0x123456789abcdef0;
  const BodyId visitor = world.add_body(guest);
  world.advance_to(10);
  expect(log.told == Told{{'c', 3.5}, {'s', 6.5}}, "a sensor tells of both ends");
  expect(log.user_data == std::vector<std::uint64_t>{0x123456789abcdef0}, "events carry user data");
  world.update_motion(visitor, Line::line({5, 0, 0}, {0, 0, 0}, 10));
  world.advance_to(11);
  world.set_filter(visitor, 2, 0);
  world.advance_to(12);
  world.set_filter(visitor, 2, ~0u);
  world.advance_to(13);
  world.remove_body(visitor);
  world.advance_to(14);
  expect(log.told == Told{{'c', 3.5}, {'s', 6.5}, {'c', 10}, {'s', 11}, {'o', 12}, {'s', 13}},
         "also at jumps, changes of a filter, and removal");
  BodyDescription<1> halo;
  halo.shape = Sphere{2};
  halo.sensor = true;
  halo.attached_to = world.add_body(body(Sphere{1}, {0, 50, 0}, {1, 0, 0}));
  world.add_body(halo);
  world.add_body(body(Sphere{1}, {30, 50, 0}));
  log.told.clear();
  world.advance_to(27.5);
  expect(log.told == Told{{'c', 27}}, "an alarm that moves with a body");
}

void scripts() {
  Log log;
  World<1> world({.report_pieces = true}, &log);
  BodyDescription<1> drone = body(Sphere{0.5}, {0, 0, 0}, {1, 0, 0});
  drone.motion.push_back(Line::line({2, 0, 0}, {0, 1, 0}, 2));
  const BodyId id = world.add_body(drone);
  const std::array<Line, 1> more{Line::line({2, 2, 0}, {0, 0, 1}, 4)};
  world.append_motion(id, more);
  const TimerId timer = world.set_timer(3), cancelled = world.set_timer(3.5);
  expect(world.cancel_timer(cancelled) && !world.cancel_timer(cancelled), "a timer that is cancelled");
  world.advance_to(6);
  expect(log.told == Told{{'p', 2}, {'t', 3}, {'p', 4}}, "pieces and timers, at their times");
  expect(log.timers == std::vector{timer} && world.mass(id) == 7, "a timer changes a mass");
  expect(world.motion(id).position(6) == Vector3d(2, 2, 2), "where a script leads");
}

/// Bodies that come while it runs, in parts.
void budgets() {
  struct Times final : WorldListener<1> {
    std::vector<double> contacts;
    void contact(World<1>&, const PairEvent& event) override { contacts.push_back(event.contact.time); }
  } whole, divided;
  int calls = 0;
  for (Times* times : {&whole, &divided}) {
    World<1> world({.response = Response::elastic, .walls = Walls{{0, 0, 0}, {21, 21, 21}}}, times);
    world.reserve(1000);
    for (int i = 0; i < 1000; ++i) {
      const Vector3d place(1 + 2 * (i % 10), 1 + 2 * (i / 10 % 10), 1 + 2 * (i / 100));
      world.add_body(body(Sphere{0.75}, place, {0.5 * (i % 7 - 3), 0.5 * (i % 5 - 2), 0.5 * (i % 3 - 1)}));
    }
    if (times == &whole) {
      world.advance_to(1);
    } else {
      while (!world.advance_for(0, 1)) ++calls;
    }
  }
  expect(whole.contacts.size() > 100 && divided.contacts == whole.contacts, "the log does not depend on budgets");
  expect(calls > 1000 / 64, "bodies enter in parts");
}

void pictures() {
  const WorldOptions options{.response = Response::elastic};
  kds::io::WorldRecorder<Line> recorder(options);
  World<1> world(options, &recorder);
  world.add_body(body(Sphere{1}, {0, 0, 0}, {1, 0, 0}));
  world.add_body(body(Box{{1, 1, 1}}, {4, 0, 0}));
  world.advance_to(5);
  const std::string data = recorder.to_json(world, "a ball and a box");
  expect(data.find("\"touches\":[[2,0,0,1,3,0,0,1,") != std::string::npos, "a record has the contact");
  expect(recorder.gltf(world, "a ball and a box").find("\"body 1\"") != std::string::npos, "an animation");
  int edges = 0;
  draw(world, [&](const Vector3d&, const Vector3d&, Drawn) { ++edges; }, {.bodies = [](BodyId id) { return id == 1; }});
  expect(edges == 12, "a box as lines");
}

}  // namespace

int main() {
  try {
    now();
    shapes();
    future();
    sensors();
    scripts();
    budgets();
    pictures();
  } catch (const std::exception& error) {
    std::cerr << "not as expected: " << error.what() << "\n";
    return 1;
  }
  std::cout << "all " << answers << " answers are right\n";
}
