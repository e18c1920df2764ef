// What bodies of a scene must keep to, whichever kind of file they come from.
#pragma once

#include "io/scene.hpp"
#include "kds/number_text.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <functional>
#include <memory>
#include <string>

namespace kds::io {

/// The path in the scene of a member of a body: of "shape", of "motion[1].position".
using MemberPath = std::function<std::string(const std::string& member)>;

/// A quaternion whose norm is 1 up to orientation_tolerance, normalised; fail(what) is called for another.
template <class Fail>
Eigen::Quaterniond unit_quaternion(const Eigen::Quaterniond& q, const Fail& fail) {
  const double norm = q.norm();
  if (!(std::abs(norm - 1) <= orientation_tolerance))
    fail("must be a unit quaternion; its norm is " + rounded_text(norm));
  return q.normalized();
}

/// What has no bounds is fixed. Throws JsonError.
void check_fixed(const SceneBody& body, const MemberPath& path);

/// Every piece of the motion stays within the largest number while it holds and, where walls reflect, begins inside
/// them. Throws JsonError.
void check_motion(const SceneBody& body, const Scene& scene, const MemberPath& path);

/// Whether bodies can turn, which is for a world to say.
class TurningCheck {
 public:
  explicit TurningCheck(const Scene& scene);
  ~TurningCheck();
  TurningCheck(const TurningCheck&) = delete;
  TurningCheck& operator=(const TurningCheck&) = delete;

  /// Throws JsonError where this one cannot.
  void check(const SceneBody& body, const MemberPath& path);

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace kds::io
