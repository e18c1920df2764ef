#include "kds/turning/exact_zero.hpp"

#include <cstdlib>
#include <numeric>

namespace kds {

namespace {

AngleRelation relation(const Exact& squared_rate_a, const Exact& squared_rate_b, const Exact& time_a,
                       const Exact& time_b, int harmonics) {
  AngleRelation r;
  r.first_zero = squared_rate_a.sign() == 0 || time_a.sign() == 0;
  r.second_zero = squared_rate_b.sign() == 0 || time_b.sign() == 0;
  r.first_time = time_a;
  r.second_time = time_b;
  r.first_squared_rate = squared_rate_a;
  if (r.first_zero || r.second_zero) return r;
  const Exact first = squared_rate_a * time_a * time_a;
  const Exact second = squared_rate_b * time_b * time_b;
  const int most = 2 * harmonics;
  for (int m = 1; m <= most; ++m) {
    for (int n = 1; n <= most; ++n) {
      if (std::gcd(m, n) != 1) continue;
      if (!(first * Exact(static_cast<double>(n * n)) == second * Exact(static_cast<double>(m * m)))) continue;
      r.first_multiple = m;
      r.second_multiple = n;
      return r;
    }
  }
  return r;
}

/// A sum of cos(m c) and sin(m c), m = 0 ... Most, for an angle c that is not zero.
template <int Most>
struct AngleSum {
  std::array<Exact, Most + 1> cosines, sines;

  void add_cosine(int m, const Exact& x) { add(cosines, std::abs(m), x); }
  void add_sine(int m, const Exact& x) { m < 0 ? add(sines, -m, -x) : add(sines, m, x); }

  bool vanishes() const {
    bool zero = cosines[0].sign() == 0;
    for (std::size_t m = 1; m <= Most; ++m) zero = zero && cosines[m].sign() == 0 && sines[m].sign() == 0;
    return zero;
  }

 private:
  static void add(std::array<Exact, Most + 1>& sums, int m, const Exact& x) {
    sums[static_cast<std::size_t>(m)] = sums[static_cast<std::size_t>(m)] + x;
  }
};

/// The terms as multiples of the common angle c: a = m c, b = n c, n of the sign that b has relative to a.
///
/// Of the rates w, v the angles are w s and v t, so v = w g / h with g = n s, h = m t. Terms without a sine or with two
/// (w v = w^2 g / h) are multiplied by 2 h, those with one by 2 h / w: so no quotient and no root is left.
template <std::size_t Size>
bool vanish_related(const TurningCoefficients<Size>& p, const AngleRelation& r) {
  constexpr int harmonics = (static_cast<int>(Size) - 1) / 2;
  const int m = r.first_multiple;
  const int n = r.first_time.sign() == r.second_time.sign() ? r.second_multiple : -r.second_multiple;
  const Exact g = r.first_time * Exact(static_cast<double>(n));
  const Exact h = r.second_time * Exact(static_cast<double>(m));
  AngleSum<harmonics*(4 * harmonics - 1)> sum;  // the multiples of a and b are different, or both 1
  for (int k = 0; k <= harmonics; ++k) {
    for (int l = 0; l <= harmonics; ++l) {
      const std::size_t i = k == 0 ? 0 : static_cast<std::size_t>(2 * k - 1);  // the sines are next, if there are any
      const std::size_t j = l == 0 ? 0 : static_cast<std::size_t>(2 * l - 1);
      const int ma = k * m, nb = l * n;
      const Exact cosines = p[i][j] * h;
      const Exact sines = k > 0 && l > 0 ? p[i + 1][j + 1] * r.first_squared_rate * g : Exact();
      sum.add_cosine(ma - nb, cosines + sines);
      sum.add_cosine(ma + nb, cosines - sines);
      const Exact first = k > 0 ? p[i + 1][j] * h : Exact();
      const Exact second = l > 0 ? p[i][j + 1] * g : Exact();
      sum.add_sine(ma + nb, first + second);
      sum.add_sine(ma - nb, first - second);
    }
  }
  return sum.vanishes();
}

/// What a spin of the angle 0 adds up: its cosines are 1, its sines 0.
template <std::size_t Size, class At>
void add_up_cosines(const At& at) {
  for (std::size_t i = 1; i < Size; ++i) {
    if (!is_sine(i)) at(0) = at(0) + at(i);
    at(i) = Exact();
  }
}

}  // namespace

AngleRelation relation_at(const Spin& a, const Spin& b, double t, int harmonics) {
  return relation(a.squared_rate<Exact>(), b.squared_rate<Exact>(), Exact(t) - Exact(a.start),
                  Exact(t) - Exact(b.start), harmonics);
}

AngleRelation relation_throughout(const Spin& a, const Spin& b, int harmonics) {
  AngleRelation r = relation(a.squared_rate<Exact>(), b.squared_rate<Exact>(), Exact(1.0), Exact(1.0), harmonics);
  if (a.start != b.start) r.first_multiple = r.second_multiple = 0;
  return r;
}

template <std::size_t Size>
bool vanishes(const TurningCoefficients<Size>& p, const AngleRelation& relation) {
  if (relation.first_multiple != 0) return vanish_related(p, relation);
  TurningCoefficients<Size> q = p;
  for (std::size_t k = 0; k < Size; ++k) {
    if (relation.first_zero) add_up_cosines<Size>([&](std::size_t i) -> Exact& { return q[i][k]; });
  }
  for (std::size_t k = 0; k < Size; ++k) {
    if (relation.second_zero) add_up_cosines<Size>([&](std::size_t j) -> Exact& { return q[k][j]; });
  }
  for (const auto& row : q) {
    for (const Exact& x : row) {
      if (x.sign() != 0) return false;
    }
  }
  return true;
}

template bool vanishes(const TurningCoefficients<3>&, const AngleRelation&);
template bool vanishes(const TurningCoefficients<5>&, const AngleRelation&);

}  // namespace kds
