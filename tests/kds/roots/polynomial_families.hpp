// Families of certificates on which solvers go wrong: random ones, and those near every kind of degeneracy.
#pragma once

#include "kds/arithmetic/lattice.hpp"
#include "kds/motion.hpp"
#include "kds/roots/failure_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace kds::tests {

/// One question: when does value fail?
template <int Degree>
struct FailureCase {
  Motion<Degree> value;
  double now = 0;
  double horizon = never;
};

enum class Family {
  random,              // coefficients in [-1, 1]
  from_roots,          // real roots and complex pairs about unit scale
  clustered_1e3,       // roots within 1e-3 of each other, and others
  clustered_1e6,
  clustered_1e9,
  clustered_1e12,
  double_root,         // exactly
  triple_root,
  nearly_double_root,  // a coefficient one unit in the last place off
  vanishing_lead,      // leading coefficients zero, or of size 1e-9 ... 1e-324
  common_scale,        // all of one size between 2^-900 and 2^900
  mixed_scales,        // between 2^-90 and 2^90
  root_after_now,      // the clock 2^-60 ... 2^-20 before a root
  clock_at_root,       // the clock at a failure time, or next to it
  wilkinson,           // roots 1, 2, 3 ...
  few_bits,            // small fractions: roots and signs coincide exactly
  count
};

inline std::string name(Family family) {
  static const std::array<const char*, static_cast<std::size_t>(Family::count)> names{
      "random",          "from roots",     "clustered 1e-3", "clustered 1e-6", "clustered 1e-9",   "clustered 1e-12",
      "double root",     "triple root",    "nearly double",  "vanishing lead", "common scale",     "mixed scales",
      "root after now",  "clock at root",  "Wilkinson",      "few bits"};
  return names[static_cast<std::size_t>(family)];
}

/// leading (t - roots[0]) (t - roots[1]) ..., about `start`, its coefficients rounded as they come.
template <int Degree>
Motion<Degree> polynomial_from_roots(const std::array<double, Degree>& roots, double leading, double start) {
  Motion<Degree> f;
  f.start = start;
  f.position.c[0] = leading;
  for (std::size_t n = 0; n < Degree; ++n) {
    const double root = roots[n] - start;
    for (std::size_t i = n + 1; i > 0; --i) f.position.c[i] = f.position.c[i - 1] - root * f.position.c[i];
    f.position.c[0] *= -root;
  }
  return f;
}

/// Linear and quadratic factors, the latter with complex roots.
template <int Degree>
Motion<Degree> polynomial_from_factors(Random& random) {
  Motion<Degree> f;
  auto& c = f.position.c;
  c[0] = 1;
  for (std::size_t n = 0; n < Degree;) {
    const double a = random.between(-2, 2);
    const bool pair = n + 2 <= Degree && random.one_in(2);
    const double b = pair ? random.between(0.2, 1) : 0;
    for (std::size_t i = n + (pair ? 3 : 2); i-- > 0;) {
      const double below = i >= 1 ? c[i - 1] : 0;
      const double second = i >= 2 ? c[i - 2] : 0;
      c[i] = pair ? (a * a + b * b) * c[i] - 2 * a * below + second : below - a * c[i];
    }
    n += pair ? 2 : 1;
  }
  return f;
}

template <int Degree>
Motion<Degree> with_multiple_root(Random& random, std::size_t multiplicity, double leading) {
  std::array<double, Degree> roots;
  for (double& root : roots) root = random.integer(-16, 16) / 8.0;
  roots[0] = random.integer(1, 16) / 8.0;
  for (std::size_t i = 1; i < std::min<std::size_t>(Degree, multiplicity); ++i) roots[i] = roots[0];
  return polynomial_from_roots<Degree>(roots, leading, 0);
}

template <int Degree>
Motion<Degree> with_cluster(Random& random, double spread, double leading) {
  const double middle = random.between(0.2, 2);
  std::array<double, Degree> roots;
  for (double& root : roots) root = random.one_in(3) ? random.between(-2, 2) : middle + spread * random.between(-1, 1);
  return polynomial_from_roots<Degree>(roots, leading, random.one_in(3) ? middle : 0);
}

/// The next case of the family. Most hold at `now`; horizons are infinite in every second one.
template <int Degree>
FailureCase<Degree> next_case(Family family, Random& random) {
  FailureCase<Degree> result;
  auto& c = result.value.position.c;
  const double leading = random.one_in(2) ? 1 : -1;
  bool turn = true;  // so that it holds
  switch (family) {
    case Family::random:
      for (double& x : c) x = random.between(-1, 1);
      result.value.start = random.one_in(2) ? 0 : random.between(-1, 0);
      break;
    case Family::from_roots: result.value = polynomial_from_factors<Degree>(random); break;
    case Family::clustered_1e3: result.value = with_cluster<Degree>(random, 1e-3, leading); break;
    case Family::clustered_1e6: result.value = with_cluster<Degree>(random, 1e-6, leading); break;
    case Family::clustered_1e9: result.value = with_cluster<Degree>(random, 1e-9, leading); break;
    case Family::clustered_1e12: result.value = with_cluster<Degree>(random, 1e-12, leading); break;
    case Family::double_root: result.value = with_multiple_root<Degree>(random, 2, leading); break;
    case Family::triple_root: result.value = with_multiple_root<Degree>(random, 3, leading); break;
    case Family::nearly_double_root: {
      result.value = with_multiple_root<Degree>(random, 2, leading);
      double& x = c[random.below(Degree + 1)];
      x = random.one_in(2) ? next_up(x) : next_down(x);
      break;
    }
    case Family::vanishing_lead: {
      for (double& x : c) x = random.between(-1, 1);
      const std::array<double, 5> small{0.0, 1e-9, 1e-20, 1e-300, std::numeric_limits<double>::denorm_min()};
      for (std::size_t i = Degree - random.below(Degree); i <= Degree; ++i) c[i] *= small[random.below(small.size())];
      break;
    }
    case Family::common_scale: {
      const int scale = random.integer(-900, 900);
      for (double& x : c) x = random.scaled(scale - 2, scale + 2);
      break;
    }
    case Family::mixed_scales:
      for (double& x : c) x = random.scaled(-90, 90);
      break;
    case Family::root_after_now: {
      std::array<double, Degree> roots;
      for (double& root : roots) root = random.between(-2, 2);
      roots[0] = std::abs(random.scaled(-60, -20));
      result.value = polynomial_from_roots<Degree>(roots, leading, random.one_in(2) ? 0 : random.between(-1, 0));
      break;
    }
    case Family::clock_at_root: {
      for (double& x : c) x = random.between(-1, 1);
      const double t = failure_time(PolynomialCertificate<Degree>{result.value}, -1);
      if (t != never) result.now = std::array<double, 3>{next_down(t), t, next_up(t)}[random.below(3)];
      turn = false;
      break;
    }
    case Family::wilkinson: {
      std::array<double, Degree> roots;
      for (std::size_t i = 0; i < Degree; ++i) roots[i] = static_cast<double>(i + 1);
      result.value = polynomial_from_roots<Degree>(roots, leading, random.one_in(2) ? 0 : Degree / 2.0);
      result.now = random.between(0, Degree + 1);
      turn = false;
      break;
    }
    case Family::few_bits:
      for (double& x : c) x = random.coarse();
      result.value.start = random.integer(-2, 2);
      result.now = random.integer(-3, 3);
      turn = false;
      break;
    case Family::count: break;
  }
  if (turn && sign_after(PolynomialCertificate<Degree>{result.value}, result.now) < 0) {
    result.value.position = -result.value.position;
  }
  if (random.one_in(2)) result.horizon = result.now + random.between(0.5, 2);
  return result;
}

}  // namespace kds::tests
