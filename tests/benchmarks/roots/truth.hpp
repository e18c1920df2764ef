// The truth about a polynomial ahead of now = 0, from exact arithmetic.
#pragma once

#include <span>
#include <vector>

namespace bench_roots {

/// A real root t >= 0: the real number high + low, to 2^-100 of itself. `high` is next to it among the doubles, and the
/// sign of `low` is exact, so comparing it with a double is too.
struct ExactRoot {
  double high = 0;
  double low = 0;
  int before = 0;  ///< sign of the polynomial just before; 0 for a root at 0, before which nobody looks
  int after = 0;   ///< and just after

  bool falling() const { return before >= 0 && after < 0; }

  /// Exact: -1, 0, 1 as the root is before, at or after t.
  int compare(double t) const;
  /// The first double not before the root.
  double ceiling() const;
  /// t - root.
  double distance_to(double t) const;
  /// Distance of the two doubles around the root; from it to the next, if it is one.
  double spacing() const;
};

/// All there is to know of c[0] + c[1] t + c[2] t^2 + ... for t >= 0.
struct Truth {
  int sign_after_now = 0;        ///< just after 0
  std::vector<ExactRoot> roots;  ///< distinct, rising, up to the largest double

  /// Whether some double sees that the polynomial is negative after the falling root number i. A dip that begins and
  /// ends between two neighbouring doubles is none that a clock made of doubles can stand in.
  bool seen(std::size_t i) const;

  /// Number of the root at which the polynomial first turns negative, seen by a double of [0, horizon]; -1 if none. A
  /// polynomial that is negative at once turns at root_at_now.
  int first_failure(double horizon) const;

  static constexpr int root_at_now = -2;
};

/// Method: isolating intervals by the rule of Descartes over integers of any length, halved until they are narrow
/// enough (tests/support/exact_algebra), between them exact signs. Throws std::invalid_argument if a coefficient is not
/// finite.
///
/// Cost: 0.1 to some milliseconds.
Truth exact_truth(std::span<const double> c);

}  // namespace bench_roots
