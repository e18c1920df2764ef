// What forms of the motion of one body relative to another cost that are written apart from the plain one.
//
//     bench_relative_motion [DIRECTORY]      -> relative_motion.csv; ten seconds
//
// The plain form is relative_motion() of certificates/point_motion.hpp, in arithmetic that carries a bound along with
// each number. Each row compares what is made with a form of its own with the same made by the plain one. (QuickMotion
// bounds its errors until a horizon as well, which the plain form beside it does not.) Nanoseconds of CPU time of one
// thread for a pair of bodies, the least of some rounds over 1 000 random pairs.

#include "certificates/along_axis.hpp"
#include "certificates/ball_separation.hpp"
#include "certificates/point_motion.hpp"
#include "certificates/positive_parabola.hpp"
#include "collision/narrow_phase/quick_motion.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <vector>

namespace {

using namespace kds;
using namespace kds::certificates;
using kds::benchmarks::tell;
using kds::tests::Random;

constexpr std::size_t pairs = 1000;
constexpr int rounds = 50;
constexpr double now = 0.75, horizon = 1.5;

template <int Degree>
struct Pair {
  PointMotion<Degree> a, b;
  Eigen::Vector3d axis;
};

template <int Degree>
std::vector<Pair<Degree>> random_pairs() {
  Random random(7);
  const auto vector = [&](double size) {
    return Eigen::Vector3d(random.between(-size, size), random.between(-size, size), random.between(-size, size));
  };
  std::vector<Pair<Degree>> result(pairs);
  for (Pair<Degree>& pair : result) {
    for (PointMotion<Degree>* const path : {&pair.a, &pair.b}) {
      path->start = random.between(0, now);
      for (auto& c : path->coefficients) c = vector(4);
    }
    if constexpr (Degree == 2) pair.a.coefficients[2] = pair.b.coefficients[2];  // gravity
    pair.axis = vector(1).normalized();
  }
  return result;
}

/// Keeps what is computed from being left out.
double kept = 0;

template <int Degree, class Own, class Plain>
void row(std::ofstream& file, const char* what, const Own& own, const Plain& plain) {
  const auto all = random_pairs<Degree>();
  const auto nanoseconds = [&](const auto& make) {
    return 1e9 / pairs * benchmarks::seconds_of_call(rounds, [&] {
             for (const Pair<Degree>& pair : all) kept += make(pair);
           });
  };
  const double of_own = nanoseconds(own), of_plain = nanoseconds(plain);
  tell(file, "%s,%d,%.1f,%.1f,%.2f\n", what, Degree, of_own, of_plain, of_own / of_plain);
}

/// The coefficients of the plain form as vectors, and the sums of their bounds.
template <int Degree>
struct Plain {
  Plain(const Pair<Degree>& pair, double t) {
    const auto r = relative_motion<Ball<double>>(pair.a, pair.b, t);
    for (std::size_t i = 0; i <= Degree; ++i) {
      c[i] = Eigen::Vector3d(r[0].c[i].middle, r[1].c[i].middle, r[2].c[i].middle);
      bound[i] = r[0].c[i].radius + r[1].c[i].radius + r[2].c[i].radius;
    }
  }
  std::array<Eigen::Vector3d, std::size_t{Degree} + 1> c;
  std::array<double, std::size_t{Degree} + 1> bound;
};

/// BallSeparation::apart_until() by the plain form, but for the roundings of what comes after it.
template <int Degree>
double apart_until(const Pair<Degree>& pair, double radii) {
  const Plain<Degree> r(pair, now);
  const double distance = r.c[0].norm();
  const double c0 = distance - radii - r.bound[0];
  const double c1 = r.c[0].dot(r.c[1]) / distance - r.bound[1];
  const double c2 = Degree == 2 ? r.c[0].dot(r.c[Degree]) / distance - r.bound[Degree] : 0;
  const double wait = positive_for(c0, c1, c2);
  return wait > 0 && wait < never ? next_down(now + wait) : now + wait;
}

/// BallSeparation::plane_between() in the same way.
template <int Degree>
bool plane_between(const Pair<Degree>& pair, double radii, double from, double to) {
  const double half = 0.5 * (to - from);
  const Plain<Degree> r(pair, from + half);
  const double speeds = r.c[1].dot(r.c[1]);
  const double nearest = speeds > 0 ? std::clamp(-r.c[0].dot(r.c[1]) / speeds, -half, half) : 0;
  const Eigen::Vector3d n = r.c[0] + nearest * r.c[1];
  double bend = 0;
  for (std::size_t i = Degree; i >= 2; --i) bend = (bend + r.c[i].cwiseAbs().sum() + r.bound[i]) * half;
  const double along = n.dot(r.c[0]) - std::abs(n.dot(r.c[1])) * half;
  return along > n.norm() * (radii + bend * half + r.bound[0] + r.bound[1] * half);
}

template <int Degree>
void rows(std::ofstream& file) {
  using Balls = BallSeparation<Degree>;
  if constexpr (Degree <= 2) {
    row<Degree>(
        file, "square of the gap of balls along a line (RelativeLine)",
        [](const Pair<Degree>& pair) {
          const certificates::detail::RelativeLine<double> line(certificates::detail::numbers_of(pair.a),
                                                                certificates::detail::numbers_of(pair.b), 0.5, now);
          const auto f = certificates::detail::square_gap(line);
          return f.c[0].middle + f.c[1].radius + f.c[2].middle;
        },
        [](const Pair<Degree>& pair) {
          const auto f = Balls{pair.a, pair.b, 0.25, 0.25}.template polynomial<Ball<double>>(now);
          return f.c[0].middle + f.c[1].radius + f.c[2].middle;
        });
    row<Degree>(
        file, "a time until which balls are apart (apart_until)",
        [](const Pair<Degree>& pair) {
          return Balls{pair.a, pair.b, 0.25, 0.25}.apart_until(now);
        },
        [](const Pair<Degree>& pair) { return apart_until(pair, 0.5); });
    row<Degree>(
        file, "along an axis (along_axis)",
        [](const Pair<Degree>& pair) {
          const auto f = along_axis(pair.a, pair.b, pair.axis, now);
          return f.c[0].middle + f.c[1].radius;
        },
        [](const Pair<Degree>& pair) {
          const auto r = relative_motion<Ball<double>>(pair.a, pair.b, now);
          const auto f = r[0] * pair.axis[0] + r[1] * pair.axis[1] + r[2] * pair.axis[2];
          return f.c[0].middle + f.c[1].radius;
        });
  }
  if constexpr (Degree == 1) {
    row<Degree>(
        file, "square of the gap of balls at a time in double-doubles (extended_square_gap)",
        [](const Pair<Degree>& pair) {
          return Balls{pair.a, pair.b, 0.25, 0.25}.extended_value(horizon).middle.high;
        },
        [](const Pair<Degree>& pair) {
          const Ball<DoubleDouble> radii = Ball<DoubleDouble>(0.25) + 0.25;
          Ball<DoubleDouble> f = -(radii * radii);
          for (int d = 0; d < 3; ++d) {
            const Ball<DoubleDouble> r = extended_difference(pair.b.axis(d), pair.a.axis(d), horizon);
            f = f + r * r;
          }
          return f.middle.high;
        });
  }
  if constexpr (Degree >= 3) {
    row<Degree>(
        file, "whether a plane is between balls (plane_between)",
        [](const Pair<Degree>& pair) {
          return Balls{pair.a, pair.b, 0.25, 0.25}.plane_between(now, horizon) ? 1.0 : 0.0;
        },
        [](const Pair<Degree>& pair) { return plane_between(pair, 0.5, now, horizon) ? 1.0 : 0.0; });
  }
  row<Degree>(
      file, "along three axes for a filter (QuickMotion)",
      [](const Pair<Degree>& pair) {
        const collision::QuickMotion<Degree> motion(pair.a, pair.b, now, horizon, 1);
        double sum = motion.error();
        for (int d = 0; d < 3; ++d) sum += motion.along(pair.axis + Eigen::Vector3d::Unit(d))[1];
        return sum;
      },
      [](const Pair<Degree>& pair) {
        const auto motion = collision::relative_to(pair.a, pair.b);
        double sum = motion.uncertainty[0];
        for (int d = 0; d < 3; ++d) sum += motion.coefficients[1].dot(pair.axis + Eigen::Vector3d::Unit(d));
        return sum;
      });
}

}  // namespace

int main(int count, char** arguments) try {
  std::ofstream file = benchmarks::open_csv(count > 1 ? arguments[1] : ".", "relative_motion.csv");
  tell(file, "what,degree,ns,ns by the plain form,ratio\n");
  rows<1>(file);
  rows<2>(file);
  rows<3>(file);
  return std::isnan(kept) ? EXIT_FAILURE : EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_relative_motion: %s\n", error.what());
  return EXIT_FAILURE;
}
