// What every certificate must be: the polynomial it says it is, in all number types, with its signs and failure times.
#pragma once

#include "certificates/point_motion.hpp"
#include "kds/roots/failure_time.hpp"
#include "tests/support/exact_failure_time.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/same_number.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <sstream>
#include <string>
#include <vector>

namespace kds::tests {

template <int Degree>
oracle::Polynomial exact(const Motion<Degree>& motion) {
  return oracle::Polynomial::motion({motion.position.c.begin(), motion.position.c.end()}, motion.start);
}

/// The coordinates of a path as functions of the clock.
template <int Degree>
std::array<oracle::Polynomial, 3> exact(const certificates::PointMotion<Degree>& path) {
  return {exact(path.axis(0)), exact(path.axis(1)), exact(path.axis(2))};
}

inline oracle::Polynomial exact(double value) { return oracle::Polynomial(oracle::rational(value)); }

/// A path of coarse numbers, whose certificates often touch zero, or of numbers with all their bits.
template <int Degree>
certificates::PointMotion<Degree> random_path(Random& random, bool coarse, double start) {
  certificates::PointMotion<Degree> path;
  for (auto& c : path.coefficients) {
    for (int d = 0; d < 3; ++d) c[d] = coarse ? random.integer(-4, 4) / 2.0 : random.between(-2, 2);
  }
  path.start = start;
  return path;
}

inline double random_start(Random& random, bool coarse) {
  return coarse ? random.integer(-2, 2) : random.between(-2, 2);
}

inline Eigen::Vector3d random_point(Random& random, bool coarse) {
  Eigen::Vector3d v;
  for (int d = 0; d < 3; ++d) v[d] = coarse ? random.integer(-4, 4) / 2.0 : random.between(-2, 2);
  return v;
}

/// A time of the kind at which things happen: coarse, or with all its bits.
inline double random_time(Random& random) {
  return random.one_in(2) ? random.integer(-8, 8) / 4.0 : random.between(-2, 2);
}

/// Compares a certificate with the polynomial of the clock that it should be; the number of things that were wrong.
template <Certificate C>
int mistakes(const C& certificate, const oracle::Polynomial& expected, Random& random) {
  int wrong = 0;
  const double epoch = random_time(random);
  const auto f = certificate.template polynomial<Exact>(epoch);
  const auto balls = certificate.template polynomial<Ball<double>>(epoch);
  const auto extended = certificate.template polynomial<Ball<DoubleDouble>>(epoch);
  for (int i = 0; i < C::degree + 2; ++i) {
    const double x = random.integer(-9, 9) * 0.37;
    wrong += !oracle::same(f(Exact(x)), expected(oracle::rational(epoch) + oracle::rational(x)));
  }
  for (std::size_t i = 0; i <= C::degree; ++i) {
    const Exact from_double = f.c[i] - Exact(balls.c[i].middle);
    const Exact from_extended = f.c[i] - Exact(extended.c[i].middle.high) - Exact(extended.c[i].middle.low);
    const Exact double_radius(balls.c[i].radius * Ball<double>::slack);
    const Exact extended_radius(extended.c[i].radius * Ball<DoubleDouble>::slack);
    wrong += (from_double - double_radius).sign() > 0 || (from_double + double_radius).sign() < 0;
    wrong += (from_extended - extended_radius).sign() > 0 || (from_extended + extended_radius).sign() < 0;
  }
  for (int i = 0; i < 4; ++i) {
    const double t = random_time(random);
    wrong += sign_after(certificate, t) != expected.sign_after(oracle::rational(t));
    const double horizon = random.one_in(2) ? never : t + random.between(0, 3);
    const double failure = oracle::failure_time(expected, t, horizon);
    wrong += failure_time(certificate, t, horizon) != failure;
    if (failure != never) wrong += sign_after(certificate, failure) != -1;
  }
  return wrong;
}

}  // namespace kds::tests
