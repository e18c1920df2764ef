// Instructions of the target processor, where they are faster than portable code: kds::simd::target has the functions
// of portable.hpp. Only the lane types of this folder include it; all other code includes the lane types.
#pragma once

#ifdef __SSE2__
#include "kds/simd/x86.hpp"
#else
#include "kds/simd/portable.hpp"
#endif

namespace kds::simd {

#ifdef __SSE2__
namespace target = x86;
#else
namespace target = portable;
#endif

}  // namespace kds::simd
