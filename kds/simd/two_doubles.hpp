// Two doubles at a time.
#pragma once

#include "kds/simd/target.hpp"
#include "kds/simd/vectors.hpp"

#include <cstdint>
#include <limits>

namespace kds {

inline Two both(double x) { return Two{x, x}; }
inline TwoBits bits(Two x) { return reinterpret_cast<TwoBits>(x); }
inline Two number(TwoBits x) { return reinterpret_cast<Two>(x); }

inline Two magnitude(Two x) { return number(bits(x) & std::numeric_limits<std::int64_t>::max()); }

/// Lane by lane; where one is not a number the second.
inline Two lesser(Two x, Two y) { return simd::target::lesser(x, y); }
inline Two greater(Two x, Two y) { return simd::target::greater(x, y); }

inline Two square_root(Two x) { return simd::target::square_root(x); }

/// Bit i if a comparison holds in lane i.
inline unsigned set_of_two(TwoBits x) { return simd::target::set_of_two(x); }

}  // namespace kds
