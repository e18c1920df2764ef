#include "collision/quaternion_alignment.hpp"

namespace kds::collision {

template <>
const char QuaternionsAlignedTo<alignof(Eigen::Quaterniond)>::as_the_library = 1;

}  // namespace kds::collision
