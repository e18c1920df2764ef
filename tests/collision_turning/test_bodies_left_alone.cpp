// Worlds without a listener leave bodies alone that precess far from others: nothing tells.
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"

#include "collision/queries/casts.hpp"
#include "tests/collision/sample_compounds.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

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

template <int Degree>
using Turning = BasicWorld<RigidMotion<Degree>>;

Vector3d random_vector(Random& random) {
  const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-1, 1);
  return {x, y, z};
}

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
    options_.broad_phase = broad_phase;
    if (seed % 2 == 0) options_.walls = Walls{Vector3d::Constant(-room_ - 1), Vector3d::Constant(room_ + 1)};
    if (seed % 5 == 0) options_.window = 0.4;
    make_world();
    const std::size_t bodies = 3 + random_.below(12);
    for (std::size_t i = 0; i < bodies; ++i) add();
  }

  Turning<Degree>& world() { return *world_; }
  const std::vector<BodyId>& ids() const { return ids_; }

  /// Goes on for a while, and changes something.
  void go_on() {
    world_->advance_to(world_->now() + random_.between(0, 1.5));
    if (random_.one_in(2)) edit();
  }

 private:
  void make_world() { world_.emplace(options_, heard_ ? &hears_ : nullptr); }

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
    switch (random_.below(6)) {
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
      default:
        return world_->audit();
    }
  }

  Random random_;
  double room_;
  bool heard_;
  typename Turning<Degree>::Listener hears_;
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
    heard.go_on(), unheard.go_on();
    check_same(heard, unheard);
    unheard.world().audit();
  }
  const std::uint64_t with = heard.world().counters().pair_tests, without = unheard.world().counters().pair_tests;
  return with > without ? with - without : 0;
}

}  // namespace

TEST_CASE("worlds that nobody listens to go on as others do, bit for bit", "[turning]") {
  constexpr std::uint64_t seeds = 16;
  std::uint64_t saved = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) saved += tests_saved<1>(seed) + tests_saved<2>(seed);
  CHECK(saved > 20 * seeds);
}

}  // namespace test_bodies_left_alone
