// Sine and cosine to any number of digits.
#pragma once

#include "kds/arithmetic/enclosure.hpp"
#include "kds/arithmetic/sine_cosine.hpp"

namespace kds {

/// Sine and cosine of an angle (rad) of any size: each radius is at most 2^-bits, besides that of the angle.
///
/// Cost: some 7 us for 200 bits, growing slightly faster than (bits + log2 |angle|)^2. Precondition: bits >= 0, and
/// bits + log2 |angle| below 2^23.
SineCosine<Enclosure> enclosed_sine_cosine(const Enclosure& angle, int bits);

}  // namespace kds
