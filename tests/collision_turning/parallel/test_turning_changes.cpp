// A listener that changes a scene of bodies that turn, in domains, makes the events that it makes of one world, bit for
// bit.
#include "tests/collision/parallel/stagings.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>

namespace kds::collision::test_turning_changes {
namespace {

using certificates::RigidMotion;
using Eigen::Vector3d;
using kds::tests::random_vector;
using tests::Event;
using tests::Random;

/// At the k-th event a body comes or goes, jumps, turns otherwise, is given another motion, or a timer is set.
template <int Degree>
void change(TurningWorld<Degree>& world, std::uint64_t seed, std::size_t k) {
  Random random(seed * 1000 + k);
  const double now = world.now();
  RigidMotion<Degree> motion{};
  motion.path.start = now;
  motion.path.coefficients.fill(Vector3d::Zero());
  motion.path.coefficients[0] = Vector3d::Constant(3) + random_vector(random, 3);
  motion.path.coefficients[1] = random_vector(random, 2);
  motion.angular_velocity = random_vector(random, 3);
  const int what = random.integer(0, 5);
  if (what == 0) {
    typename TurningWorld<Degree>::Description added{.shape = Box{{0.5, 0.25, 0.125}}};
    added.motion = {motion};
    world.add_body(added);
  }
  if (what == 1) world.set_timer(now + random.between(0, 0.3));
  const BodyId id = random.below(world.size() + 3);
  if (!world.contains(id)) return;
  if (what == 2) world.remove_body(id);
  if (what == 3) world.set_restitution(id, 1);
  if (what < 4 || world.attached_to(id)) return;
  const RigidMotion<Degree> before = world.motion(id).restarted(now);
  if (what == 4) motion.path.coefficients[0] = before.path.coefficients[0];
  if (random.one_in(2)) motion.orientation = before.orientation;
  world.update_motion(id, motion);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Domains of bodies that turn: a listener that changes the scene has the events of one world",
                       "[parallel]", ((int Degree), Degree), 1, 2) {
  using Motion = RigidMotion<Degree>;
  std::uint64_t events = 0, asked = 0, steps = 0, cut = 0;
  tests::each_seed("KDS_TURNING_EDIT_SEEDS", {{1, 16, 6}}, [&](std::uint64_t seed, std::size_t most_domains) {
    tests::StageMaker<Motion> maker(seed);
    const tests::Staging<Motion> scene = maker.scene();
    const std::uint64_t one_in = seed % 3 == 0 ? 3 : 12;
    const auto changes_at = [=](std::size_t k) { return Random(seed + 77 * k).one_in(one_in); };
    tests::WholeLog<Motion> right;
    TurningWorld<Degree> one(scene.options, &right);
    scene.fill(one);
    right.then = [&](TurningWorld<Degree>& world) {
      if (const std::size_t k = right.events.size(); changes_at(k)) change<Degree>(world, seed, k);
    };
    one.advance_to(scene.end_time);

    const tests::Manner manner = maker.manner(most_domains);
    tests::DividedLog log;
    BasicParallelWorld<Motion> divided(scene.options, manner.parallel, &log);
    scene.fill(divided.whole());
    log.then = [&](const Event&) {
      const std::size_t k = log.events.size();
      if (!changes_at(k)) return;
      ++asked;
      divided.change([=](TurningWorld<Degree>& world) { change<Degree>(world, seed, k); });
    };
    for (std::size_t poll = 1; poll < manner.polls; ++poll) {
      divided.advance_to(scene.end_time * static_cast<double>(poll) / static_cast<double>(manner.polls));
    }
    divided.advance_to(scene.end_time);
    tests::require_same(right.events, log.events, scene.what);
    auto& whole = divided.whole();
    whole.audit();
    REQUIRE(whole.size() == one.size());
    const ParallelCounters counters = divided.counters();
    REQUIRE(counters.contacts == one.counters().contacts);
    REQUIRE(counters.separations == one.counters().separations);
    events += right.events.size(), steps += counters.steps, cut += counters.windows_failed;
  });
  INFO("events " << events << ", changes " << asked << ", steps " << steps << ", windows failed " << cut);
  CHECK(events > 300);
  CHECK(asked > 40);
  CHECK(steps > 40);
  CHECK(cut > 10);
}

}  // namespace kds::collision::test_turning_changes
