// When slow bodies come to rest.
#include "collision/motions.hpp"
#include "collision/vectors.hpp"
#include "collision/world/resting/cluster_rules.hpp"
#include "collision/world/resting/resting_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::collision {

using Eigen::Vector3d;
using namespace cluster;

/// The time at which the bodies come to rest if they go on like this, `never` if they do not: they do if something at
/// rest carries them, no contact is perfectly elastic, all have met others that are free (a body that slides alone on a
/// plane slides on), and all have been slow for long enough.
template <class Motion>
double RestingContacts<Motion>::comes_to_rest(const Island& island, const std::vector<Vector3d>& velocities) {
  const bool carried = std::any_of(island.contacts.begin(), island.contacts.end(), [this](Slot slot) {
    const Contact& contact = contacts_[slot];
    return contact.push > 0 && (contact.b == no_body || bodies_.fixed(contact.a) || bodies_.fixed(contact.b));
  });
  const bool moves = std::any_of(velocities.begin() + static_cast<std::ptrdiff_t>(island.free), velocities.end(),
                                 [](const Vector3d& velocity) { return !velocity.isZero(0); });
  double energy = 0;
  double least_energy = 0;
  for (std::size_t i = 0; i < island.free; ++i) {
    const auto& body = bodies_[island.bodies[i]];
    energy += body.mass * squared_norm(velocities[i]);
    least_energy += body.mass * norm(acceleration(island.bodies[i])) * body.bounding_radius;
  }
  const bool calm_in_all = carried && !moves && energy <= calm_speed * calm_speed * least_energy;
  double rests = calm_in_all ? clock_.now : never;
  for (std::size_t i = 0; i < island.free; ++i) {
    const BodySlot id = island.bodies[i];
    const double a = norm(acceleration(id));
    const double size = bodies_[id].bounding_radius;
    const double fastest = fastest_calm * calm_speed;
    double& since = of_[id].calm_since;
    const bool calm = calm_in_all && of_[id].met && bodies_[id].restitution < 1 &&
                      squared_norm(velocities[i]) <= fastest * fastest * a * size;
    since = calm ? std::min(since, clock_.now) : never;
    rests = std::max(rests, since < never && a > 0 ? since + calm_time * std::sqrt(size / a) : never);
  }
  return rests;
}

/// Bodies that slide on slowly, and are not accelerated, come to rest after a while.
template <class Motion>
void RestingContacts<Motion>::watch(const Island& island, std::vector<Motion>& motions) {
  bool slides = false;
  std::vector<Vector3d> velocities;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const auto& terms = motions[i].coefficients;
    velocities.push_back(terms[1]);
    slides = slides || (i < island.free && !terms[1].isZero(0));
    if (i >= island.free || std::all_of(terms.begin() + 2, terms.end(), [](const Vector3d& x) { return x.isZero(0); }))
      continue;
    of_[island.bodies[i]].calm_since = never;
    return;
  }
  const double rests = comes_to_rest(island, velocities);
  if (!slides || rests == never) return;
  if (rests > clock_.now) return set_span(island.bodies.front(), rests);
  for (std::size_t i = 0; i < island.free; ++i) motions[i].coefficients[1] = Vector3d::Zero();
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class RestingContacts<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
