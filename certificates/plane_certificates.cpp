#include "certificates/plane_certificates.hpp"

namespace kds {

KDS_COMPILED_ONCE(template, certificates::InCircle<certificates::PlaneMotion<1>>);
KDS_COMPILED_ONCE(template, certificates::Orientation<certificates::PlaneMotion<1>>);
KDS_COMPILED_ONCE(template, certificates::DirectionOrder<certificates::PlaneMotion<1>, 2>);
KDS_COMPILED_ONCE(template, certificates::DistanceOrder<certificates::PlaneMotion<1>>);
KDS_COMPILED_ONCE(template, certificates::InCircle<certificates::PlaneMotion<2>>);
KDS_COMPILED_ONCE(template, certificates::Orientation<certificates::PlaneMotion<2>>);
KDS_COMPILED_ONCE(template, certificates::DirectionOrder<certificates::PlaneMotion<2>, 2>);
KDS_COMPILED_ONCE(template, certificates::DistanceOrder<certificates::PlaneMotion<2>>);
KDS_COMPILED_ONCE(template, certificates::InCircle<certificates::PathCopy<certificates::PlaneMotion<1>>>);
KDS_COMPILED_ONCE(template, certificates::Orientation<certificates::PathCopy<certificates::PlaneMotion<1>>>);
KDS_COMPILED_ONCE(template, certificates::DistanceOrder<certificates::PathCopy<certificates::PlaneMotion<1>>>);
KDS_COMPILED_ONCE(template, certificates::InCircle<certificates::PathCopy<certificates::PlaneMotion<2>>>);
KDS_COMPILED_ONCE(template, certificates::Orientation<certificates::PathCopy<certificates::PlaneMotion<2>>>);
KDS_COMPILED_ONCE(template, certificates::DistanceOrder<certificates::PathCopy<certificates::PlaneMotion<2>>>);

}  // namespace kds
