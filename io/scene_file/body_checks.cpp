#include "io/scene_file/body_checks.hpp"

#include "collision/world.hpp"
#include "io/scene_file/json_document.hpp"
#include "io/scene_file/number_rules.hpp"
#include "io/scene_world.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kds::io {
namespace {

std::string position_of(const MemberPath& path, std::size_t piece) {
  return path("motion[" + std::to_string(piece) + "].position");
}

/// A half-space reaches beyond all walls, and meets none.
void check_inside_walls(const SceneBody& body, const Domain& domain, const MemberPath& path) {
  if (kds::collision::unbounded(body.shape)) return;
  const double radius = kds::collision::place(body.shape, body.orientation).bounding_radius;
  for (std::size_t p = 0; p < body.motion.size(); ++p) {
    const Eigen::Vector3d& at = body.motion[p].path.coefficients[0];
    for (int d = 0; d < 3; ++d) {
      if (at[d] - domain.min[d] >= radius && domain.max[d] - at[d] >= radius) continue;
      throw JsonError(position_of(path, p), std::string("begins outside the reflecting walls: ") + "xyz"[d] + " = " +
                                                number_text(at[d]) + " with a bounding radius of " +
                                                rounded_text(radius) + ", between " + number_text(domain.min[d]) +
                                                " and " + number_text(domain.max[d]));
    }
  }
}

/// By the sum of the terms.
void check_range(const SceneBody& body, const Scene& scene, const MemberPath& path) {
  for (std::size_t p = 0; p < body.motion.size(); ++p) {
    const kds::certificates::PointMotion<2>& piece = body.motion[p].path;
    const bool last = p + 1 == body.motion.size();
    const double end = last ? scene.end_time : std::min(body.motion[p + 1].start(), scene.end_time);
    const double elapsed = std::max(0.0, end - piece.start);
    for (int d = 0; d < 3; ++d) {
      const auto& c = piece.coefficients;
      const double largest = std::abs(c[0][d]) + elapsed * (std::abs(c[1][d]) + elapsed * std::abs(c[2][d]));
      if (largest <= largest_number) continue;
      throw JsonError(position_of(path, p), "may reach a magnitude of " + rounded_text(largest) +
                                                " by t = " + rounded_text(end) + "; at most " +
                                                number_text(largest_number) + " is supported");
    }
  }
}

}  // namespace

void check_fixed(const SceneBody& body, const MemberPath& path) {
  if (body.fixed || !kds::collision::unbounded(body.shape)) return;
  throw JsonError(path("fixed"), "a half-space has no mass: it has to be fixed");
}

void check_motion(const SceneBody& body, const Scene& scene, const MemberPath& path) {
  check_range(body, scene, path);
  if (scene.domain && scene.domain->reflects && !body.sensor) {
    check_inside_walls(body, *scene.domain, path);
  }
}

struct TurningCheck::World {
  kds::collision::BasicWorld<MotionPiece> of;
};

TurningCheck::TurningCheck(const Scene& scene)
    : world_(new World{kds::collision::BasicWorld<MotionPiece>({.response = scene.response})}) {}
TurningCheck::~TurningCheck() = default;

void TurningCheck::check(const SceneBody& body, const MemberPath& path) {
  try {
    world_->of.remove_body(world_->of.add_body(describe<MotionPiece>(body)));
  } catch (const std::invalid_argument& error) {  // The message begins with the member that is wrong.
    const std::string what = error.what();
    const std::size_t colon = what.find(": ");
    if (colon == std::string::npos) throw JsonError(path(""), what);
    const std::string member = what.substr(0, colon);
    throw JsonError(path(member == "mass_properties" ? "shape" : member),  // which is no solid
                    what.substr(colon + 2));
  }
}

}  // namespace kds::io
