// The definition of an event time, word by word, over exact numbers; in two ways that share nothing but the numbers.
#pragma once

#include "tests/support/exact_algebra.hpp"

#include <limits>
#include <vector>

namespace oracle {

/// The first double t in [now, horizon] just after which c[0] + c[1] (t - start) + ... < 0; infinity if there is none.
///
/// Halves [now, horizon] on the lattice of doubles, the earlier part first, and passes over a part only if the rule of
/// Descartes says that it holds no root; so it looks at every double that could be the answer.
double failure_time(const std::vector<Rational>& c, const Rational& start, double now,
                    double horizon = std::numeric_limits<double>::infinity());
double failure_time(const Polynomial& p, double now, double horizon = std::numeric_limits<double>::infinity());

/// Sign of c[0] + c[1] (t - start) + ... just after t.
int sign_after(const std::vector<Rational>& c, const Rational& start, double t);

/// The first double t in [now, horizon] just after which the condition holds; infinity if there is none.
///
/// It isolates all stretches in which the condition holds and takes the first one that owns a double: a stretch that
/// ends before the next double is never seen by a clock made of doubles.
double first_double(const Condition& condition, double now, double horizon = std::numeric_limits<double>::infinity());

}  // namespace oracle
