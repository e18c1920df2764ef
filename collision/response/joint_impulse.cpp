#include "collision/response/joint_impulse.hpp"

#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// What a unit impulse along the normal of a place does to the two bodies.
struct Lever {
  Vector3d turns_a, turns_b;
  double yields;  ///< the rate of parting that it makes
};

void give(JointBody& body, double push, const JointPlace& at, const Vector3d& arm, const Vector3d& turns) {
  body.velocity.velocity += (push * body.mobility.inverse_mass) * at.normal;
  body.velocity.angular_velocity += push * turns;
  body.angular_impulse += push * cross(arm, at.normal);
}

Vector3d rate(const JointBody& body, const Vector3d& arm) {
  return body.velocity.velocity + cross(body.velocity.angular_velocity, arm);
}

}  // namespace

bool part_jointly(std::span<JointBody> bodies, std::span<JointPlace> places) {
  constexpr double tolerance = 0x1p-3;  // of the least rate
  std::vector<JointBody> moved(bodies.begin(), bodies.end());
  std::vector<Lever> levers;
  for (JointPlace& at : places) {
    at.push = 0;
    const auto turned = [&](std::uint32_t i, const Vector3d& arm) {
      return moved[i].mobility.turned_by(cross(arm, at.normal));
    };
    Lever lever{turned(at.a, at.arm_a), turned(at.b, at.arm_b), 0};
    lever.yields = moved[at.a].mobility.inverse_mass + moved[at.b].mobility.inverse_mass +
                   dot(cross(at.arm_a, at.normal), lever.turns_a) + dot(cross(at.arm_b, at.normal), lever.turns_b);
    levers.push_back(lever);
  }
  const auto missing = [&](const JointPlace& at) {
    return at.least - dot(at.normal, rate(moved[at.b], at.arm_b) - rate(moved[at.a], at.arm_a));
  };
  const auto solved = [&] {
    return std::all_of(places.begin(), places.end(), [&](const JointPlace& at) {
      const double lacks = missing(at), most = tolerance * at.least;
      return lacks <= most && (at.push == 0 || lacks >= -most);
    });
  };
  for (int sweep = 0; sweep < joint_sweeps; ++sweep) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      JointPlace& at = places[i];
      const double push = std::max(at.push + missing(at) / levers[i].yields, 0.0);
      const double more = push - at.push;
      at.push = push;
      give(moved[at.a], -more, at, at.arm_a, levers[i].turns_a);
      give(moved[at.b], more, at, at.arm_b, levers[i].turns_b);
    }
    if (!solved()) continue;
    std::copy(moved.begin(), moved.end(), bodies.begin());
    return true;
  }
  return false;
}

}  // namespace kds::collision
