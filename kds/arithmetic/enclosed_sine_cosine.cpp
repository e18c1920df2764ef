#include "kds/arithmetic/enclosed_sine_cosine.hpp"

#include <algorithm>
#include <utility>

namespace kds {

// The angle is halved until it is small, Taylor's series is summed there, and cosine + i sine is squared as many times
// as the angle was halved. So pi is not needed, and large angles need no special treatment.
//
// Error bound. All numbers are multiples of e = 2^-w. The small angle y, below 2^-8, is truncated: e. In the series
// each term is the one before times y / n, truncated twice: it is off by x_n <= x_(n-1) / 512 + 1.5 e < 2 e for n >= 2,
// and exact before. The first term that is 0, the N-th, is in truth below 2 e, and all after it below that over 255. So
// the complex number z, of the length 1, begins with an error E_0 <= (2 N + 4) e. A square, truncated in both parts, is
// off by E_(k+1) <= 2 E_k + E_k^2 + 2 e; so F_k = E_k + 2 e grows by 2 (1 + E_k / 2) at most. After m squares that is
// F_m <= 2^m F_0 exp(E_0 + ... + E_(m-1)) <= 1.5 * 2^m (2 N + 6) e, the sum of the E_k being at most 2 E_m < 0.4: this
// holds for (3 N + 9) 2^(m - w) < 0.2, as w = m + bits + 24 makes sure of as long as N < 2^20, which w < 2^23 does.
SineCosine<Enclosure> enclosed_sine_cosine(const Enclosure& angle, int bits) {
  if (angle.middle.sign() == 0) {
    return {{Exact(0.0), angle.radius}, {Exact(1.0), angle.radius}};
  }
  constexpr int small = 8;
  const int squares = std::max(0, angle.middle.magnitude_bits() + small);
  const int w = squares + bits + 24;
  const Exact y = truncated(scaled(angle.middle, -squares), w);
  Exact sine;
  Exact cosine(1.0);
  Exact term(1.0);
  int terms = 1;
  for (;; ++terms) {
    term = truncated_quotient(truncated(term * y, w), Exact(static_cast<double>(terms)), w);
    if (term.sign() == 0) break;
    Exact& part = terms % 2 == 1 ? sine : cosine;
    part = terms % 4 < 2 ? part + term : part - term;
  }
  for (int k = 0; k < squares; ++k) {
    const Exact next = truncated((cosine + sine) * (cosine - sine), w);
    sine = truncated(scaled(cosine * sine, 1), w);
    cosine = next;
  }
  const Exact error = scaled(Exact(3.0 * terms + 9), squares - w) + angle.radius;
  return {{std::move(sine), error}, {std::move(cosine), error}};
}

}  // namespace kds
