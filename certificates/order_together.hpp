// The failure times of two pairs of straight motions, computed together.
#pragma once

#include "kds/arithmetic/lattice.hpp"
#include "kds/arithmetic/two_double_doubles.hpp"
#include "kds/certificate_hooks.hpp"
#include "kds/motion.hpp"

#include <cstdint>
#include <limits>

namespace kds::certificates {

/// What failure_time() gives for two pairs in order, bit for bit, or a NaN where that needs the general methods; a NaN
/// for both, unless the motions of each pair have a common start. Precondition: now <= horizon.
///
/// Two lanes do what Order::quick_failure_time() does for one pair, but without early exits, since processors cannot
/// predict whether values will meet. Error bounds are derived in failure_time_known_line.hpp, except that of the gap,
/// with u = 2^-53: gap, fall and the time since the start are rounded by u each, so their run is known to 3 u, and the
/// sum to 4 u (|gap| + |run|). Charged are 8 u, as in Order.
TwoTimes quick_failure_times(const Motion<1>& lower_1, const Motion<1>& upper_1, const Motion<1>& lower_2,
                             const Motion<1>& upper_2, double now, double horizon);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// See first_double_after_line(); a NaN where that does not decide.
[[gnu::always_inline]] inline Two first_doubles_after_lines(TwoDoubleDoubles g, TwoDoubleDoubles r, Two epoch) {
  constexpr std::int64_t first_26_bits = ~((std::int64_t{1} << 27) - 1);
  constexpr std::int64_t exponent = 0x7ff0000000000000;
  const Two inverse = 1.0 / r.high;
  const Two x = -g.high * inverse;
  const Two c = number(bits(x) & first_26_bits);
  const Two r_c = number(bits(r.high) & first_26_bits);
  const Two v = ((g.high + c * r_c) + c * (r.high - r_c)) + (g.low + c * r.low);
  const Two d = -v * inverse;

  const TwoDoubleDoubles place = two_sum(epoch, c);
  const Two low = place.low + d;
  const Two half_spacing = number((bits(place.high) & exponent) - (std::int64_t{53} << 52));
  const Two t = place.high + (d + (place.low + half_spacing));
  const Two before = t - 0x1.0000000000001p-53 * magnitude(t);
  const Two margin = lesser((t - place.high) - low, low - (before - place.high));
  const Two error = 0x1p-72 * magnitude(x) + 0x1p-98 * magnitude(place.high);

  const Two size_g = magnitude(g.high);
  const Two size_r = magnitude(r.high);
  const TwoBits told =
      (margin > error) & (size_g > 0x1p-450) & (size_r > 0x1p-450) & (size_g < 0x1p450) & (size_r < 0x1p450);
  return told ? t : both(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace detail

[[gnu::always_inline]] inline TwoTimes quick_failure_times(const Motion<1>& lower_1, const Motion<1>& upper_1,
                                                           const Motion<1>& lower_2, const Motion<1>& upper_2,
                                                           double now, double horizon) {
  constexpr double undecided = std::numeric_limits<double>::quiet_NaN();
  if (lower_1.start != upper_1.start || lower_2.start != upper_2.start) return {undecided, undecided};
  const Two low{lower_1.position.c[0], lower_2.position.c[0]};
  const Two low_rate{lower_1.position.c[1], lower_2.position.c[1]};
  const Two high{upper_1.position.c[0], upper_2.position.c[0]};
  const Two high_rate{upper_1.position.c[1], upper_2.position.c[1]};
  const Two start{lower_1.start, lower_2.start};

  const Two fall = low_rate - high_rate;
  const Two run = fall * (now - start);
  const Two gap = (high - low) - run;
  const Two surely = gap - (0x1p-50 * (magnitude(high - low) + magnitude(run)) + 0x1p-1000);
  const auto in_order = surely > 0.0;
  const auto apart = (fall <= 0.0) | (surely > fall * ((horizon - now) * (1 + 0x1p-50)));

  const Two t = detail::first_doubles_after_lines(two_sum(high, -low), two_sum(high_rate, -low_rate), start);
  Two result = (apart | (t > horizon)) ? both(never) : t;
  result = in_order ? result : both(undecided);
  return {result[0], result[1]};
}

}  // namespace kds::certificates
