// Worlds whose listener hears no pieces leave bodies alone that precess far from others: nothing tells.
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"

#include "collision/queries/casts.hpp"
#include "tests/collision/sample_compounds.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace test_bodies_left_alone {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::Random;
using kds::tests::random_vector;

template <int Degree>
using Turning = BasicWorld<RigidMotion<Degree>>;

Shape random_shape(Random& random) {
  switch (random.below(6)) {
    case 0:
      return MeshShape{samples::torus(8, 4), 0.5};
    case 1:
      return Capsule{0.1, 0.4};
    case 2:
      return Box{Vector3d(0.5, 0.4, 0.1)};
    case 3:
      return Box{Vector3d(0.1, 0.1, 0.6)};
    case 4:
      return Sphere{0.3};
    default:
      return kds::collision::tests::cut_box(Vector3d(0.5, 0.2, 0.1), 0.4);
  }
}

template <int Degree>
struct HearsPieces final : Turning<Degree>::Listener {
  bool hears_pieces() const override { return true; }
};

/// A world that is told of everything or of nothing, and the calls that a seed makes.
template <int Degree>
class Scene {
 public:
  Scene(std::uint64_t seed, BroadPhaseKind broad_phase, bool heard)
      : random_(seed),
        room_(seed % 4 == 0   ? 1.5
              : seed % 4 == 1 ? 20
                              : 5),
        heard_(heard) {
    options_.response = Response::elastic;
    options_.orientation_error = seed % 3 == 0 ? 0.1 : 1e-3;
    options_.broad_phase = broad_phase;
    if (seed % 2 == 0) options_.walls = Walls{Vector3d::Constant(-room_ - 1), Vector3d::Constant(room_ + 1)};
    if (seed % 5 == 0) options_.window = 0.4;
    make_world();
    const std::size_t bodies = 3 + random_.below(12);
    for (std::size_t i = 0; i < bodies; ++i) add();
  }

  Turning<Degree>& world() { return *world_; }
  const std::vector<BodyId>& ids() const { return ids_; }

  /// Goes on for a while, at once or in frames, and reads or changes something. Returns what it has read.
  std::vector<RigidMotion<Degree>> go_on() {
    std::vector<RigidMotion<Degree>> seen;
    const double end = world_->now() + random_.between(0, 1.5);
    const bool in_frames = random_.one_in(2);
    for (int left = in_frames ? 20 : 1; left > 0; --left) {
      world_->advance_to(world_->now() + std::max(0.0, end - world_->now()) / left);
      if (in_frames && random_.one_in(3)) seen.push_back(world_->motion(ids_[random_.below(ids_.size())]));
      if (in_frames && random_.one_in(15)) edit();
    }
    if (random_.one_in(2)) edit();
    return seen;
  }

 private:
  void make_world() {
    typename Turning<Degree>::Listener* const deaf = random_.one_in(2) ? &deaf_ : nullptr;
    world_.emplace(options_, heard_ ? &hears_ : deaf);
  }

  RigidMotion<Degree> random_motion(double start) {
    RigidMotion<Degree> motion{{{room_ * random_vector(random_), random_vector(random_)}}};
    if constexpr (Degree == 2) motion.path.coefficients[2] = Vector3d(0, 0, -0.05 * random_.unit());
    motion.path.start = start;
    motion.angular_velocity = std::exp2(random_.between(-2, 3)) * random_vector(random_);
    const Vector3d q = random_vector(random_);
    motion.orientation = Quaterniond(1, q[0], q[1], q[2]);
    return motion;
  }

  void add() {
    typename Turning<Degree>::Description body{.shape = random_shape(random_)};
    body.motion = {random_motion(world_->now())};
    if (random_.one_in(6)) body.inertia = 0.1;  // the same about all axes
    if (random_.one_in(8)) body.sensor = true;
    if (random_.one_in(4)) body.friction = 0.3;
    if (random_.one_in(6)) body.motion.push_back(random_motion(world_->now() + random_.between(0.1, 2)));
    ids_.push_back(world_->add_body(body));
  }

  void edit() {
    const std::size_t which = random_.below(ids_.size());
    const BodyId id = ids_[which];
    switch (random_.below(8)) {
      case 0:
        world_->remove_body(id);
        ids_.erase(ids_.begin() + static_cast<std::ptrdiff_t>(which));
        return add();
      case 1:
        return world_->update_motion(id, random_motion(world_->now()));
      case 2: {
        RigidMotion<Degree> motion = world_->motion(id).restarted(world_->now());
        motion.path.coefficients[1] = random_vector(random_);
        return world_->update_motion(id, motion);
      }
      case 3:
        return world_->set_mass(id, random_.between(0.5, 2));
      case 4: {
        const Snapshot snapshot = save(*world_);
        make_world();
        return restore(snapshot, *world_);
      }
      case 5:
        for (const double end = world_->now() + 0.25; world_->step(end);) {
        }
        return;
      case 6:
        world_->extend_horizon(world_->now(), world_->now() + 1);
        return void(world_->next_time());
      default:
        return world_->audit();
    }
  }

  Random random_;
  double room_;
  bool heard_;
  HearsPieces<Degree> hears_;
  typename Turning<Degree>::Listener deaf_;
  WorldOptions options_;
  std::optional<Turning<Degree>> world_;
  std::vector<BodyId> ids_;
};

template <int Degree>
void check_same(Scene<Degree>& heard, Scene<Degree>& unheard) {
  const WorldCounters a = heard.world().counters(), b = unheard.world().counters();
  REQUIRE(a.contacts == b.contacts);
  REQUIRE(a.wall_contacts == b.wall_contacts);
  REQUIRE(a.overlaps == b.overlaps);
  REQUIRE(a.separations == b.separations);
  REQUIRE(a.motion_updates == b.motion_updates);
  REQUIRE(a.rotation_pieces == b.rotation_pieces);
  REQUIRE(a.orientation_resets == b.orientation_resets);
  REQUIRE(heard.ids() == unheard.ids());
  for (const BodyId id : heard.ids()) {
    CAPTURE(id);
    REQUIRE(heard.world().motion(id) == unheard.world().motion(id));
  }
  const Ray ray{Vector3d(-9, 0.1, 0), Vector3d(9, 0, 0.1)};
  const auto hit = cast(heard.world(), ray), same_hit = cast(unheard.world(), ray);
  REQUIRE(hit.has_value() == same_hit.has_value());
  if (hit) REQUIRE((hit->body == same_hit->body && hit->contact.time == same_hit->contact.time));
}

template <int Degree>
std::uint64_t tests_saved(std::uint64_t seed) {
  constexpr BroadPhaseKind kinds[] = {BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap,
                                      BroadPhaseKind::all_pairs};
  CAPTURE(Degree, seed);
  Scene<Degree> heard(seed, BroadPhaseKind::automatic, true), unheard(seed, kinds[seed / 4 % 4], false);
  for (int i = 0; i < 8; ++i) {
    REQUIRE(heard.go_on() == unheard.go_on());
    check_same(heard, unheard);
    unheard.world().audit();
  }
  const std::uint64_t with = heard.world().counters().pair_tests, without = unheard.world().counters().pair_tests;
  return with > without ? with - without : 0;
}

/// What a callback throws.
struct Stop {};

/// Looks at bodies, and changes them, from within callbacks: the same calls for the same events.
template <int Degree>
class Meddler final : public BasicWorldListener<RigidMotion<Degree>> {
 public:
  using World = Turning<Degree>;

  Meddler(std::uint64_t seed, bool hears_pieces) : random_(seed), hears_pieces_(hears_pieces) {}

  void contact(World& world, const PairEvent& event) override {
    note(event.contact.time), note(static_cast<double>(event.a)), note(static_cast<double>(event.b));
    meddle(world);
  }
  void wall(World& world, const WallEvent& event) override {
    note(event.contact.time), note(static_cast<double>(event.body));
    meddle(world);
  }
  bool hears_pieces() const override { return hears_pieces_; }

  const std::vector<double>& seen() const { return seen_; }

 private:
  void note(double value) { seen_.push_back(value); }
  void note(const RigidMotion<Degree>& motion) {
    note(motion.path.start);
    for (const auto& c : motion.path.coefficients) note(c[0]), note(c[1]), note(c[2]);
    for (int i = 0; i < 4; ++i) note(motion.orientation.coeffs()[i]);
    for (int i = 0; i < 3; ++i) note(motion.angular_velocity[i]);
  }

  void meddle(World& world) {
    if (!random_.one_in(3)) return;
    std::vector<BodyId> ids;
    world.visit_bodies([&](BodyId id) { ids.push_back(id); });
    if (ids.empty()) return;
    const BodyId id = ids[random_.below(ids.size())];
    switch (random_.below(9)) {
      case 0:
        return note(world.motion(id));
      case 1:
        return note(static_cast<double>(world.counters().rotation_pieces));
      case 2: {
        const Vector3d corner = 4 * random_vector(random_);
        world.visit_overlapping(corner, corner + Vector3d::Constant(2),
                                [&](BodyId other) { note(static_cast<double>(other)); });
        return;
      }
      case 3: {
        RigidMotion<Degree> motion = world.motion(id).restarted(world.now());
        motion.path.coefficients[1] = random_vector(random_);
        return world.update_motion(id, motion);
      }
      case 4:
        return ids.size() > 3 ? world.remove_body(id) : void();
      case 5: {
        typename World::Description body{.shape = random_shape(random_)};
        RigidMotion<Degree> motion{{{4 * random_vector(random_), random_vector(random_)}}};
        motion.path.start = world.now();
        motion.angular_velocity = 4 * random_vector(random_);
        body.motion = {motion};
        world.add_body(body);
        return;
      }
      case 6:
        return world.set_mass(id, random_.between(0.5, 2));
      case 7: {
        const Ray ray{world.motion(id).path.position(world.now()), Vector3d(9, 0, 0.1)};
        const auto hit = cast(world, ray);
        return note(hit ? hit->contact.time : -1);
      }
      default:
        throw Stop{};
    }
  }

  Random random_;
  bool hears_pieces_;
  std::vector<double> seen_;
};

/// Runs a scene on when its listener has thrown.
template <int Degree>
void advance(Turning<Degree>& world, double t) {
  for (;;) {
    try {
      return world.advance_to(t);
    } catch (const Stop&) {
      world.audit();
    }
  }
}

template <int Degree>
std::uint64_t check_meddled(std::uint64_t seed) {
  CAPTURE(Degree, seed);
  Random random(seed);
  WorldOptions options{.response = Response::elastic};
  if (random.one_in(2)) options.walls = Walls{Vector3d::Constant(-5), Vector3d::Constant(5)};
  Meddler<Degree> hears(seed, true), deaf(seed, false);
  Turning<Degree> told(options, &hears), untold(options, &deaf);
  const std::size_t bodies = 4 + random.below(12);
  for (std::size_t i = 0; i < bodies; ++i) {
    typename Turning<Degree>::Description body{.shape = random_shape(random)};
    RigidMotion<Degree> motion{{{4 * random_vector(random), random_vector(random)}}};
    motion.angular_velocity = 4 * random_vector(random);
    body.motion = {motion};
    told.add_body(body), untold.add_body(body);
  }
  for (int i = 1; i <= 6; ++i) {
    const double t = 2 * i;
    advance<Degree>(told, t), advance<Degree>(untold, t);
    REQUIRE(hears.seen() == deaf.seen());
    untold.audit();
    REQUIRE(told.counters().rotation_pieces == untold.counters().rotation_pieces);
    told.visit_bodies([&](BodyId id) { REQUIRE(told.motion(id) == untold.motion(id)); });
  }
  const std::uint64_t with = told.counters().pair_tests, without = untold.counters().pair_tests;
  return with > without ? with - without : 0;
}

}  // namespace

TEST_CASE("worlds that nobody listens to go on as others do, bit for bit", "[turning]") {
  constexpr std::uint64_t seeds = 16;
  std::uint64_t saved = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) saved += tests_saved<1>(seed) + tests_saved<2>(seed);
  CHECK(saved > 20 * seeds);
}

TEST_CASE("bodies whose balls overlap are left alone while a plane is between them", "[turning]") {
  const auto run = [](bool heard, double strikes) {
    HearsPieces<1> hears;
    Turning<1> world({.response = Response::elastic, .orientation_error = 1e-4}, heard ? &hears : nullptr);
    BodyId last{};
    for (const double side : {-1.0, 1.0}) {  // they pass each other at a distance of 2.5, and reach 1.36 each
      RigidMotion<1> motion{{{side * Vector3d(1.25, -1, 0), side * Vector3d(0, 0.2, 0)}}};
      motion.angular_velocity = Vector3d(0.8, 0.6 * side, 0.3);
      last = world.add_body({.shape = Box{Vector3d(1, 0.9, 0.2)}, .motion = {motion}});
    }
    world.advance_to(strikes);
    if (strikes < 10) {  // what was proven of their paths does not hold any more
      RigidMotion<1> motion = world.motion(last).restarted(strikes);
      motion.path.coefficients[1] = -30 * motion.path.position(strikes).normalized();
      world.update_motion(last, motion);
    }
    world.advance_to(10);
    return world.counters();
  };
  const WorldCounters heard = run(true, 10), unheard = run(false, 10);
  CHECK(heard.contacts == 0);
  CHECK(unheard.contacts == 0);
  CHECK(heard.rotation_pieces == unheard.rotation_pieces);
  CHECK(heard.rotation_pieces > 100);
  CHECK(unheard.pair_tests * 5 < heard.pair_tests);
  for (int i = 0; i < 8; ++i) {
    const double strikes = 4 + 0.25 * i;
    CAPTURE(strikes);
    const WorldCounters struck = run(true, strikes), same = run(false, strikes);
    CHECK(struck.contacts > 0);
    CHECK(struck.contacts == same.contacts);
    CHECK(struck.rotation_pieces == same.rotation_pieces);
  }
}

TEST_CASE("listeners that hear no pieces see and change the same world from within callbacks", "[turning]") {
  std::uint64_t saved = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) saved += check_meddled<1>(seed) + check_meddled<2>(seed);
  CHECK(saved > 0);
}

}  // namespace test_bodies_left_alone
