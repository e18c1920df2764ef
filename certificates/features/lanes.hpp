// The four edges or corners of a patch side by side.
#pragma once

#include "kds/simd/four_doubles.hpp"

namespace kds::certificates {

using Lanes = FourDoubles;

}  // namespace kds::certificates
