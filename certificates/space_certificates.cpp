#include "certificates/space_certificates.hpp"

namespace kds {

KDS_COMPILED_ONCE(template, certificates::InSphere<certificates::PointMotion<1>>);
KDS_COMPILED_ONCE(template, certificates::SpaceOrientation<certificates::PointMotion<1>>);
KDS_COMPILED_ONCE(template, certificates::NormalDirection<certificates::PointMotion<1>>);
KDS_COMPILED_ONCE(template, certificates::InSphere<certificates::PointMotion<2>>);
KDS_COMPILED_ONCE(template, certificates::SpaceOrientation<certificates::PointMotion<2>>);
KDS_COMPILED_ONCE(template, certificates::NormalDirection<certificates::PointMotion<2>>);

}  // namespace kds
