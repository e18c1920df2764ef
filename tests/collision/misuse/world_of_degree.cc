// Worlds of some degrees, of which there are two, and with splines five; and of motions of which there are none.
#include "certificates/turning/rigid_motion.hpp"
#include "collision/world.hpp"

/// All that a motion needs; but the library is not compiled for it.
struct Mine {
  static constexpr int degree = 1;
  kds::certificates::PointMotion<1> path;

  bool finite() const { return path.finite(); }
  Mine restarted(double t) const { return {path.restarted(t)}; }
  bool operator==(const Mine&) const = default;
  friend const kds::certificates::PointMotion<1>& path_of(const Mine& motion) { return motion.path; }
  template <class Archive>
  friend void archive_members(Archive& archive, Mine& motion) {
    archive(motion.path);
  }
};
static_assert(kds::collision::BodyMotion<Mine>);

template <class Motion>
void run() {
  kds::collision::BasicWorld<Motion> world({});
  world.advance_to(1);
}

template <int... Degrees>
void run_all() {
  (run<kds::certificates::PointMotion<Degrees>>(), ...);
  run<Mine>();
  run<kds::certificates::RigidMotion<2>>();
}
template void run_all<DEGREES>();
