#include "kds/turning/turning_failure_time.hpp"

namespace kds {

#define KDS_TURNING_FAILURE_TIMES_HERE(...) KDS_TURNING_FAILURE_TIMES(template, __VA_ARGS__)
KDS_FOR_EACH_TURNING_SUM(KDS_TURNING_FAILURE_TIMES_HERE)

}  // namespace kds
