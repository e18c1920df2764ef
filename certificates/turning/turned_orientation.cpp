#include "certificates/turning/turned_orientation.hpp"

#include "kds/arithmetic/rounded_sine_cosine.hpp"

#include <algorithm>
#include <cmath>

namespace kds::certificates {

namespace {

struct HalfTurn {
  double cosine, sine, rate;
};

HalfTurn half_turn(const Spin& spin, const Ball<DoubleDouble>& rate, double t) {
  const Ball<DoubleDouble> angle = spin.angle(rate, t) * 0.5;
  if (angle.radius <= 0x1p-70 && std::abs(angle.middle.high) <= greatest_angle) {
    const auto a = rounded_sine_cosine(angle);
    return {a.cosine, a.sine, rate.middle.high};
  }
  constexpr int bits = 100;  // where double-doubles do not do
  const Exact time = Exact(t) - Exact(spin.start);
  const Exact square = spin.squared_rate<Exact>();
  const int magnitude = square.magnitude_bits();
  const Enclosure root = enclosed_square_root(square, bits + std::max(0, time.magnitude_bits()) + std::abs(magnitude));
  const Enclosure half = root * Enclosure(scaled(time, -1));
  const auto b = enclosed_sine_cosine(half, bits);
  return {b.cosine.middle.approximate(), b.sine.middle.approximate(), root.middle.approximate()};
}

}  // namespace

Eigen::Quaterniond turned_orientation(const Eigen::Quaterniond& q, const Spin& spin, double t) {
  if (spin.still() || t == spin.start) return q;
  return turned_orientation(q, spin, spin.rate(), t);
}

Eigen::Quaterniond turned_orientation(const Eigen::Quaterniond& q, const Spin& spin, const Ball<DoubleDouble>& rate,
                                      double t) {
  if (spin.still() || t == spin.start) return q;
  const HalfTurn half = half_turn(spin, rate, t);
  const double w = half.cosine;
  const double factor = half.sine / half.rate;
  const double x = factor * spin.velocity[0];
  const double y = factor * spin.velocity[1];
  const double z = factor * spin.velocity[2];
  return {(w * q.w() - x * q.x()) - (y * q.y() + z * q.z()), (w * q.x() + x * q.w()) + (y * q.z() - z * q.y()),
          (w * q.y() + y * q.w()) + (z * q.x() - x * q.z()), (w * q.z() + z * q.w()) + (x * q.y() - y * q.x())};
}

}  // namespace kds::certificates
