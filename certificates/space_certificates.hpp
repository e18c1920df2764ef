// Certificates of points of space whose failure times are compiled into the library.
#pragma once

#include "certificates/direction_order.hpp"
#include "certificates/in_sphere.hpp"
#include "certificates/point_motion.hpp"
#include "certificates/space_orientation.hpp"
#include "certificates/weighted_point.hpp"
#include "kds/roots/failure_time.hpp"

namespace kds {

KDS_COMPILED_ONCE(extern template, certificates::InSphere<certificates::PointMotion<1>>);
KDS_COMPILED_ONCE(extern template, certificates::SpaceOrientation<certificates::PointMotion<1>>);
KDS_COMPILED_ONCE(extern template, certificates::NormalDirection<certificates::PointMotion<1>>);
KDS_COMPILED_ONCE(extern template, certificates::InSphere<certificates::PointMotion<2>>);
KDS_COMPILED_ONCE(extern template, certificates::SpaceOrientation<certificates::PointMotion<2>>);
KDS_COMPILED_ONCE(extern template, certificates::NormalDirection<certificates::PointMotion<2>>);

}  // namespace kds
