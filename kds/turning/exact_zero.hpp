// Whether a sum of sines and cosines is zero: decided by its coefficients.
#pragma once

#include "kds/arithmetic/exact.hpp"
#include "kds/turning/spin.hpp"
#include "kds/turning/turning_sum.hpp"

#include <array>
#include <cstddef>

namespace kds {

/// How the angles a and b of two spins are related, as far as sums k a + l b with |k|, |l| <= harmonics can tell.
struct AngleRelation {
  bool first_zero = false;   ///< a = 0
  bool second_zero = false;  ///< b = 0
  /// |a| and |b| are these multiples of one angle, up to 2 harmonics and without a common divisor, neither being zero;
  /// both 0 where they are of no such kind.
  int first_multiple = 0, second_multiple = 0;
  /// Times from the starts of the spins, of which the angles are made.
  Exact first_time, second_time;
  /// Squares of the rates.
  Exact first_squared_rate;
};

/// At a time.
AngleRelation relation_at(const Spin& a, const Spin& b, double t, int harmonics = 1);

/// The one that holds at all times.
AngleRelation relation_throughout(const Spin& a, const Spin& b, int harmonics = 1);

/// The coefficients of 1, cos a, w sin a, cos 2 a ... (rows) times 1, cos b, v sin b, cos 2 b ... (columns).
template <std::size_t Size>
using TurningCoefficients = std::array<std::array<Exact, Size>, Size>;

/// Whether the sum with these coefficients is zero for angles that are so related, to as many harmonics. Exact.
///
/// The angles are square roots of rational numbers times rational numbers, and so algebraic. By the theorem of
/// Lindemann and Weierstrass the numbers exp(i c) for different algebraic c are linearly independent over the algebraic
/// numbers: so a sum of them is zero only if the coefficients of each vanish. Where k a + l b are different for all k,
/// l the coefficients have to be zero; where some coincide (an angle is zero, or k a = l b for some k, l up to 2
/// harmonics) they are added up first. Paper: [Baker75] theorem 1.4.
template <std::size_t Size>
bool vanishes(const TurningCoefficients<Size>& p, const AngleRelation& relation);

extern template bool vanishes(const TurningCoefficients<3>&, const AngleRelation&);
extern template bool vanishes(const TurningCoefficients<5>&, const AngleRelation&);

/// The coefficients of f that belong to one power of the time.
template <int Degree, int Harmonics>
auto coefficients_of(const TurningSum<Degree, Exact, Harmonics>& f, std::size_t power) {
  TurningCoefficients<TurningSum<Degree, Exact, Harmonics>::size> p;
  for (std::size_t i = 0; i < f.size; ++i) {
    for (std::size_t j = 0; j < f.size; ++j) p[i][j] = f.p[i][j].c[power];
  }
  return p;
}

/// Whether f is zero at its epoch, where the angles are so related.
template <int Degree, int Harmonics>
bool vanishes_at_epoch(const TurningSum<Degree, Exact, Harmonics>& f, const AngleRelation& relation) {
  return vanishes(coefficients_of(f, 0), relation);
}

/// Whether f is zero at all times.
///
/// Frequencies k w + l v are grouped in place of angles. Where the spins start together that is the relation of their
/// angles at all times. Where they do not, two terms of one frequency differ by a phase that is algebraic and not zero
/// (by a multiple of v times the difference of the starts), so that the same theorem forbids them to cancel: nothing is
/// to be grouped but what does not turn at all.
template <int Degree, int Harmonics>
bool vanishes_throughout(const TurningSum<Degree, Exact, Harmonics>& f, const Spin& a, const Spin& b) {
  const AngleRelation relation = relation_throughout(a, b, Harmonics);
  for (std::size_t power = 0; power <= Degree; ++power) {
    if (!vanishes(coefficients_of(f, power), relation)) return false;
  }
  return true;
}

}  // namespace kds
