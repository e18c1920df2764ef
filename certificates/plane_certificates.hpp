// Certificates of points of the plane whose failure times are compiled into the library.
#pragma once

#include "certificates/direction_order.hpp"
#include "certificates/distance_order.hpp"
#include "certificates/in_circle.hpp"
#include "certificates/orientation.hpp"
#include "certificates/path_copy.hpp"
#include "certificates/plane_motion.hpp"
#include "kds/roots/failure_time.hpp"

namespace kds {

KDS_COMPILED_ONCE(extern template, certificates::InCircle<certificates::PlaneMotion<1>>);
KDS_COMPILED_ONCE(extern template, certificates::Orientation<certificates::PlaneMotion<1>>);
KDS_COMPILED_ONCE(extern template, certificates::DirectionOrder<certificates::PlaneMotion<1>, 2>);
KDS_COMPILED_ONCE(extern template, certificates::DistanceOrder<certificates::PlaneMotion<1>>);
KDS_COMPILED_ONCE(extern template, certificates::InCircle<certificates::PlaneMotion<2>>);
KDS_COMPILED_ONCE(extern template, certificates::Orientation<certificates::PlaneMotion<2>>);
KDS_COMPILED_ONCE(extern template, certificates::DirectionOrder<certificates::PlaneMotion<2>, 2>);
KDS_COMPILED_ONCE(extern template, certificates::DistanceOrder<certificates::PlaneMotion<2>>);
KDS_COMPILED_ONCE(extern template, certificates::InCircle<certificates::PathCopy<certificates::PlaneMotion<1>>>);
KDS_COMPILED_ONCE(extern template, certificates::Orientation<certificates::PathCopy<certificates::PlaneMotion<1>>>);
KDS_COMPILED_ONCE(extern template, certificates::DistanceOrder<certificates::PathCopy<certificates::PlaneMotion<1>>>);
KDS_COMPILED_ONCE(extern template, certificates::InCircle<certificates::PathCopy<certificates::PlaneMotion<2>>>);
KDS_COMPILED_ONCE(extern template, certificates::Orientation<certificates::PathCopy<certificates::PlaneMotion<2>>>);
KDS_COMPILED_ONCE(extern template, certificates::DistanceOrder<certificates::PathCopy<certificates::PlaneMotion<2>>>);

}  // namespace kds
