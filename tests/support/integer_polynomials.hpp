// Polynomials with integer coefficients: the arithmetic behind exact roots.
#pragma once

#include "tests/support/exact_algebra.hpp"

#include <utility>
#include <vector>

namespace oracle::integer {

using Integers = std::vector<Integer>;  ///< a polynomial, constant first, its last coefficient not zero

void trim(Integers& p);
/// Divides by the greatest common divisor of the coefficients, which is positive.
void make_primitive(Integers& p);
/// A positive multiple with integer coefficients.
Integers integers(const Polynomial& p);
/// x = first / second, in integers; second is positive.
std::pair<Integer, Integer> fraction(const Rational& x);
Integers derivative(const Integers& p);
/// A positive multiple of the remainder of a by b.
Integers remainder(Integers a, const Integers& b);
/// a / b up to a positive or negative constant. Precondition: b divides a.
Integers quotient(Integers a, const Integers& b);
Integers common_divisor(Integers a, Integers b);
/// Sign of p at x, without a division.
int sign_at(const Integers& p, const Rational& x);
Integers square_free(const Integers& p);
Integers product(const Integers& a, const Integers& b);
/// [Collins76] The rule of Descartes for the open interval (low, high): the number of roots, counted with multiplicity,
/// is this or less by an even number. Changes of sign in the coefficients of (1 + x)^n p((low + high x) / (1 + x)).
int sign_changes(const Integers& p, const Rational& low, const Rational& high);
/// A power of two above the absolute value of every root: Cauchy's bound 1 + max |c_i / c_n|.
Rational root_bound(const Integers& p);

/// The chain of Sturm.
class Sturm {
 public:
  explicit Sturm(const Integers& p) : chain_{p, derivative(p)} {
    make_primitive(chain_.back());
    while (chain_.back().size() > 1) {
      Integers next = remainder(chain_[chain_.size() - 2], chain_.back());
      if (next.empty()) break;
      for (Integer& c : next) c = -c;
      chain_.push_back(std::move(next));
    }
  }

  /// Distinct roots in (a, b] are changes(a) - changes(b), if neither is a multiple root.
  int changes(const Rational& x) const {
    int count = 0;
    int before = 0;
    for (const Integers& p : chain_) {
      const int now = sign_at(p, x);
      if (now != 0 && before != 0 && now != before) ++count;
      if (now != 0) before = now;
    }
    return count;
  }

 private:
  std::vector<Integers> chain_;
};

}  // namespace oracle::integer
