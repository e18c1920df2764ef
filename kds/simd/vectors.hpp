// The compiler's own vectors: some numbers in a register of the processor.
#pragma once

#include "kds/arithmetic/strict.hpp"

#include <cstdint>

namespace kds {

/// An SSE or NEON register, or as many numbers where there is none. Each lane is computed as a number alone would be.
using Two = double __attribute__((vector_size(16)));
using FourFloats = float __attribute__((vector_size(16)));

/// The result of comparing them, lane by lane: all bits set, or none.
using TwoBits = std::int64_t __attribute__((vector_size(16)));
using FourFloatsBits = std::int32_t __attribute__((vector_size(16)));

/// Eight signed bytes, the first one lowest.
using EightBytes = std::uint64_t;

/// The least of some times, and whose it is: two bits each, in their order.
struct LeastOfEight {
  double value;
  unsigned who;
};

}  // namespace kds
