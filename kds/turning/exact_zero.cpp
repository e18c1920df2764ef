#include "kds/turning/exact_zero.hpp"

#include <cstdlib>

namespace kds {

namespace {

AngleRelation relation(const Exact& squared_rate_a, const Exact& squared_rate_b, const Exact& time_a,
                       const Exact& time_b) {
  AngleRelation r;
  r.first_zero = squared_rate_a.sign() == 0 || time_a.sign() == 0;
  r.second_zero = squared_rate_b.sign() == 0 || time_b.sign() == 0;
  r.first_time = time_a;
  r.second_time = time_b;
  r.first_squared_rate = squared_rate_a;
  if (r.first_zero || r.second_zero) return r;
  const Exact first = squared_rate_a * time_a * time_a;
  const Exact second = squared_rate_b * time_b * time_b;
  if (first == second) {
    r.first_multiple = r.second_multiple = 1;
  } else if (first == scaled(second, 2)) {
    r.first_multiple = 2;
    r.second_multiple = 1;
  } else if (scaled(first, 2) == second) {
    r.first_multiple = 1;
    r.second_multiple = 2;
  }
  return r;
}

/// A sum of cos(m c) and sin(m c), m = 0 ... 3, for an angle c that is not zero.
struct Harmonics {
  std::array<Exact, 4> cosines, sines;

  void add_cosine(int m, const Exact& x) { add(cosines, std::abs(m), x); }
  void add_sine(int m, const Exact& x) { m < 0 ? add(sines, -m, -x) : add(sines, m, x); }

  bool vanishes() const {
    bool zero = cosines[0].sign() == 0;
    for (std::size_t m = 1; m < 4; ++m) zero = zero && cosines[m].sign() == 0 && sines[m].sign() == 0;
    return zero;
  }

 private:
  static void add(std::array<Exact, 4>& sums, int m, const Exact& x) {
    sums[static_cast<std::size_t>(m)] = sums[static_cast<std::size_t>(m)] + x;
  }
};

/// The nine terms as harmonics of the common angle c: a = m c, b = n c, n of the sign that b has relative to a.
///
/// Of the rates w, v the angles are w s and v t, so v = w g / h with g = n s, h = m t. Terms with a cosine or with two
/// sines (w v = w^2 g / h) are multiplied by 2 h, those with one sine by 2 h / w: so no quotient and no root is left.
bool vanish_related(const TurningCoefficients& p, const AngleRelation& r) {
  const int m = r.first_multiple;
  const int n = r.first_time.sign() == r.second_time.sign() ? r.second_multiple : -r.second_multiple;
  const Exact g = r.first_time * Exact(static_cast<double>(n));
  const Exact h = r.second_time * Exact(static_cast<double>(m));
  Harmonics sum;
  sum.add_cosine(0, scaled(p[0][0] * h, 1));
  sum.add_cosine(m, scaled(p[1][0] * h, 1));
  sum.add_cosine(n, scaled(p[0][1] * h, 1));
  const Exact cosines = p[1][1] * h;
  const Exact sines = p[2][2] * r.first_squared_rate * g;
  sum.add_cosine(m - n, cosines + sines);
  sum.add_cosine(m + n, cosines - sines);
  sum.add_sine(m, scaled(p[2][0] * h, 1));
  sum.add_sine(n, scaled(p[0][2] * g, 1));
  const Exact first = p[2][1] * h;
  const Exact second = p[1][2] * g;
  sum.add_sine(m + n, first + second);
  sum.add_sine(m - n, first - second);
  return sum.vanishes();
}

}  // namespace

AngleRelation relation_at(const Spin& a, const Spin& b, double t) {
  return relation(a.squared_rate<Exact>(), b.squared_rate<Exact>(), Exact(t) - Exact(a.start),
                  Exact(t) - Exact(b.start));
}

AngleRelation relation_throughout(const Spin& a, const Spin& b) {
  AngleRelation r = relation(a.squared_rate<Exact>(), b.squared_rate<Exact>(), Exact(1.0), Exact(1.0));
  if (a.start != b.start) r.first_multiple = r.second_multiple = 0;
  return r;
}

bool vanishes(const TurningCoefficients& p, const AngleRelation& relation) {
  if (relation.first_multiple != 0) return vanish_related(p, relation);
  TurningCoefficients q = p;
  if (relation.first_zero) {  // cosine 1, sine 0
    for (std::size_t j = 0; j < 3; ++j) {
      q[0][j] = q[0][j] + q[1][j];
      q[1][j] = q[2][j] = Exact();
    }
  }
  if (relation.second_zero) {
    for (auto& row : q) {
      row[0] = row[0] + row[1];
      row[1] = row[2] = Exact();
    }
  }
  for (const auto& row : q) {
    for (const Exact& x : row) {
      if (x.sign() != 0) return false;
    }
  }
  return true;
}

}  // namespace kds
