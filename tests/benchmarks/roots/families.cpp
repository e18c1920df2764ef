#include "tests/benchmarks/roots/families.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bench_roots {

Coefficients product(const Coefficients& a, const Coefficients& b) {
  Coefficients c(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  }
  return c;
}

namespace {

using kds::tests::Random;

Coefficients root(double r) { return {-r, 1}; }
Coefficients complex_pair(double real, double imaginary) { return {real * real + imaginary * imaginary, -2 * real, 1}; }
int degree_of(const Coefficients& c) { return static_cast<int>(c.size()) - 1; }

/// Positive just after 0, all but one in eight.
Coefficients starting_positive(Random& random, Coefficients c) {
  const auto first = std::find_if(c.begin(), c.end(), [](double x) { return x != 0; });
  if (first != c.end() && *first < 0 && !random.one_in(8)) {
    for (double& x : c) x = -x;
  }
  return c;
}

/// Times simple roots of ordinary size, ahead, behind and complex, up to the degree.
Coefficients filled(Random& random, Coefficients c, int degree) {
  while (degree_of(c) < degree) {
    const std::size_t kind = random.below(4);
    if (kind == 0 && degree_of(c) + 2 <= degree) {
      c = product(c, complex_pair(random.between(-3, 3), random.between(0.2, 2)));
    } else {
      c = product(c, root(kind == 1 ? random.between(-4, -0.1) : random.between(0.1, 4)));
    }
  }
  return starting_positive(random, c);
}

/// A number of few bits in (0, 4]: products of eight such roots are exact.
double coarse_root(Random& random) { return random.integer(1, 64) * 0x1p-4; }

Coefficients coarsely_filled(Random& random, Coefficients c, int degree) {
  while (degree_of(c) < degree) c = product(c, root(random.one_in(3) ? -coarse_root(random) : coarse_root(random)));
  return starting_positive(random, c);
}

Coefficients uniform(Random& random, int degree) {
  Coefficients c(static_cast<std::size_t>(degree) + 1);
  for (double& x : c) x = random.between(-1, 1);
  return starting_positive(random, c);
}

Coefficients separated(Random& random, int degree) { return filled(random, {1}, degree); }

/// Two to four roots within 10^-Digits of each other, relative to their size.
template <int Digits>
Coefficients clustered(Random& random, int degree) {
  const double centre = random.between(0.1, 4);
  const double width = std::pow(10, -Digits);
  Coefficients c{1};
  const int members = std::min(degree, random.integer(2, 4));
  for (int i = 0; i < members; ++i) c = product(c, root(centre * (1 + width * random.between(-0.5, 0.5))));
  return filled(random, c, degree);
}

Coefficients double_root(Random& random, int degree) {
  const double r = coarse_root(random);
  return coarsely_filled(random, {r * r, -2 * r, 1}, degree);
}

Coefficients almost_double_root(Random& random, int degree) {
  Coefficients c = double_root(random, degree);
  double& x = c[random.below(c.size())];
  const double aim = random.one_in(2) ? HUGE_VAL : -HUGE_VAL;
  for (int steps = random.integer(1, 3); steps > 0; --steps) x = std::nextafter(x, aim);
  return c;
}

Coefficients triple_root(Random& random, int degree) {
  const Coefficients r = root(coarse_root(random));
  return coarsely_filled(random, product(r, product(r, r)), degree);
}

Coefficients degenerate_leading(Random& random, int degree) {
  Coefficients c = degree > 1 ? filled(random, {1}, degree - 1) : Coefficients{random.between(0.1, 4)};
  const double tiny = std::pow(10, -random.integer(10, 300));
  c.push_back(random.one_in(4) ? 0 : random.one_in(2) ? tiny : -tiny);
  return c;
}

/// All coefficients, or the unit of time, times a power of two as far out as doubles go.
Coefficients extreme_scale(Random& random, int degree) {
  Coefficients c = filled(random, {1}, degree);
  const bool time = random.one_in(2);
  const int share = time ? degree : 1;  // the last coefficient is scaled `degree` times
  const int exponent = random.integer(300 / share, 900 / share) * (random.one_in(2) ? 1 : -1);
  for (std::size_t i = 0; i < c.size(); ++i) c[i] = std::ldexp(c[i], time ? exponent * static_cast<int>(i) : exponent);
  return c;
}

Coefficients mixed_scales(Random& random, int degree) {
  const int range = random.one_in(2) ? 60 : 300;
  Coefficients c(static_cast<std::size_t>(degree) + 1);
  for (double& x : c) x = random.scaled(-range, range);
  return starting_positive(random, c);
}

Coefficients at_now(Random& random, int degree) {
  Coefficients c = uniform(random, degree);
  c[0] = 0;
  if (degree > 1 && random.one_in(2)) c[1] = 0;
  return starting_positive(random, c);
}

Coefficients just_before_now(Random& random, int degree) {
  return filled(random, root(-std::ldexp(1 + random.unit(), -random.integer(20, 300))), degree);
}

Coefficients just_after_now(Random& random, int degree) {
  return filled(random, root(std::ldexp(1 + random.unit(), -random.integer(20, 300))), degree);
}

/// [Wilkinson59]: equally spaced roots, of which the coefficients, once rounded, know little.
Coefficients wilkinson(Random& random, int degree) {
  const double step = random.one_in(2) ? random.between(0.1, 2) : random.one_in(2) ? 1 : 0.1;
  Coefficients c{1};
  for (int i = 1; i <= degree; ++i) c = product(c, root(i * step));
  return starting_positive(random, c);
}

/// Complex pairs ahead with imaginary parts of about 10^-low to 10^-high; an odd degree has a root behind as well.
Coefficients without_roots(Random& random, int degree, int low, int high) {
  Coefficients c{1};
  while (degree_of(c) + 2 <= degree) {
    const double imaginary = std::pow(10, -random.integer(low, high)) * random.between(0.3, 3);
    c = product(c, complex_pair(random.between(0.1, 4), imaginary));
  }
  return degree_of(c) < degree ? product(c, root(-random.between(0.1, 4))) : c;
}

Coefficients no_roots(Random& random, int degree) { return without_roots(random, degree, 0, 3); }
Coefficients almost_touching(Random& random, int degree) { return without_roots(random, degree, 5, 9); }

constexpr std::array all{
    Family{"random", "coefficients uniform in [-1, 1]", 1, true, uniform},
    Family{"separated", "simple roots ahead, behind and complex, of size 0.1 to 4", 1, true, separated},
    Family{"cluster-1e-3", "two to four roots within 1e-3 of their size", 2, false, clustered<3>},
    Family{"cluster-1e-6", "within 1e-6", 2, false, clustered<6>},
    Family{"cluster-1e-9", "within 1e-9", 2, false, clustered<9>},
    Family{"cluster-1e-12", "within 1e-12", 2, false, clustered<12>},
    Family{"double", "an exact double root, others simple", 2, false, double_root},
    Family{"almost-double", "the same, one coefficient 1 to 3 steps off", 2, false, almost_double_root},
    Family{"triple", "an exact triple root", 3, false, triple_root},
    Family{"leading-near-0", "leading coefficient 1e-10 to 1e-300, or zero", 1, false, degenerate_leading},
    Family{"extreme-scale", "coefficients or time scaled, by up to 2^900 or 2^-900", 1, false, extreme_scale},
    Family{"mixed-scales", "each coefficient of a size of its own, 2^-300 to 2^300", 1, false, mixed_scales},
    Family{"at-now", "zero at now, half of them with a zero slope too", 1, false, at_now},
    Family{"before-now", "a root 2^-20 to 2^-300 before now", 1, false, just_before_now},
    Family{"after-now", "a root 2^-20 to 2^-300 after now", 1, false, just_after_now},
    Family{"wilkinson", "equally spaced roots", 2, false, wilkinson},
    Family{"no-roots", "no root ahead, complex pairs 1 to 1e-3 off the axis", 1, false, no_roots},
    Family{"almost-touching", "complex pairs 1e-5 to 1e-9 off the axis", 2, false, almost_touching},
};

}  // namespace

std::span<const Family> families() { return all; }

}  // namespace bench_roots
