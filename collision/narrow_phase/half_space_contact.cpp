#include "collision/narrow_phase/half_space_contact.hpp"

#include "collision/narrow_phase/lowest_place.hpp"
#include "collision/shapes/half_space.hpp"
#include "collision/vectors.hpp"

namespace kds::collision {

template <int Degree>
Contact half_space_contact(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t) {
  Contact contact;
  contact.time = t;
  contact.normal = normalized(placed_half_space(a.shape).normal);
  const SupportingFeature lowest = lowest_feature(b.shape, contact.normal);
  contact.feature_b = lowest.feature;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : lowest.vertices) sum += vertex;
  contact.point = b.motion.position(t) + sum / static_cast<double>(lowest.vertices.size());
  return contact;
}

#define KDS_INSTANTIATE(degree) \
  template Contact half_space_contact(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double);
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
