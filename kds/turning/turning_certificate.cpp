#include "kds/turning/turning_certificate.hpp"

namespace kds {

#define KDS_TURNING_SIGNS_HERE(...) KDS_TURNING_SIGNS(template, __VA_ARGS__)
KDS_FOR_EACH_TURNING_SUM(KDS_TURNING_SIGNS_HERE)

}  // namespace kds
