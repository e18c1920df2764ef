#include "kds/roots/failure_time.hpp"

namespace kds {

KDS_COMPILED_ONCE_OF_ALL_DEGREES(template);

}  // namespace kds
