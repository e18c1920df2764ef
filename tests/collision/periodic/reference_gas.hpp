// A straightforward simulation of balls in a periodic box, sheared or not, that shares no code with the library: places
// are never wrapped, and after each contact all pairs are tested with all copies that are near enough, in long doubles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace reference {

using Real = long double;
using Vector = std::array<Real, 3>;

struct Ball {
  Vector x;  ///< at the time of the gas
  Vector v;
  Real radius, mass, restitution;
};

struct Meeting {
  Real time = std::numeric_limits<Real>::infinity();
  std::size_t a = 0, b = 0;
  std::array<long, 3> copy{};  ///< b, moved by so many periods, meets a
  Real impulse = 0;
};

class Gas {
 public:
  /// A period of 0 stands for an axis that is not periodic. Sheared: the copy above in y moves at `sliding` in x, and
  /// is in line with the box at time 0.
  Gas(std::vector<Ball> balls, Vector period, Real sliding, Real time)
      : balls_(std::move(balls)), period_(period), sliding_(sliding), time_(time) {}

  const std::vector<Ball>& balls() const { return balls_; }

  /// Goes on to the next contact, and makes its impulse.
  Meeting next() {
    for (;;) {
      // So short that no two come nearer than by a quarter of a period: then copies next to the nearest are enough.
      Real fastest = std::abs(sliding_);
      for (const Ball& ball : balls_) fastest = std::max(fastest, std::sqrt(dot(ball.v, ball.v)));
      Real shortest = std::numeric_limits<Real>::infinity();
      for (const Real period : period_) {
        if (period > 0) shortest = std::min(shortest, period);
      }
      const Real step = shortest / (16 * fastest);
      const Meeting first = earliest(step);
      const Real until = std::min(first.time, time_ + step);
      for (Ball& ball : balls_) ball.x = sum(ball.x, ball.v, until - time_);
      time_ = until;
      if (first.time < std::numeric_limits<Real>::infinity()) return strike(first);
    }
  }

 private:
  static Real dot(const Vector& p, const Vector& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
  static Vector sum(const Vector& p, const Vector& q, Real factor) {
    return {p[0] + factor * q[0], p[1] + factor * q[1], p[2] + factor * q[2]};
  }

  Meeting earliest(Real step) const {
    Meeting first;
    for (std::size_t a = 0; a < balls_.size(); ++a) {
      for (std::size_t b = a + 1; b < balls_.size(); ++b) {
        const Vector apart = sum(balls_[b].x, balls_[a].x, -1);
        const auto around = [&](int axis, Real distance) {
          return period_[axis] > 0 ? std::lround(-distance / period_[axis]) : 0L;
        };
        const auto images = [&](int axis) { return period_[axis] > 0 ? 1L : 0L; };
        for (long y = around(1, apart[1]) - images(1); y <= around(1, apart[1]) + images(1); ++y) {
          const Real slid = y * sliding_ * time_;
          for (long x = around(0, apart[0] + slid) - images(0); x <= around(0, apart[0] + slid) + images(0); ++x) {
            for (long z = around(2, apart[2]) - images(2); z <= around(2, apart[2]) + images(2); ++z) {
              const Vector to{apart[0] + x * period_[0] + slid, apart[1] + y * period_[1], apart[2] + z * period_[2]};
              Vector speed = sum(balls_[b].v, balls_[a].v, -1);
              speed[0] += y * sliding_;
              const Real time = time_ + wait(to, speed, balls_[a].radius + balls_[b].radius);
              if (time < first.time && time <= time_ + step) first = {time, a, b, {x, y, z}, 0};
            }
          }
        }
      }
    }
    return first;
  }

  /// Until two that part or approach are this far apart; at once if they are nearer and approach.
  static Real wait(const Vector& to, const Vector& speed, Real distance) {
    const Real half = dot(to, speed), square = dot(speed, speed), gap = dot(to, to) - distance * distance;
    if (half >= 0) return std::numeric_limits<Real>::infinity();
    if (gap <= 0) return 0;
    const Real discriminant = half * half - square * gap;
    if (discriminant <= 0) return std::numeric_limits<Real>::infinity();
    return gap / (std::sqrt(discriminant) - half);
  }

  Meeting strike(Meeting meeting) {
    Ball &a = balls_[meeting.a], &b = balls_[meeting.b];
    Vector normal = sum(b.x, a.x, -1), speed = sum(b.v, a.v, -1);
    for (std::size_t d = 0; d < 3; ++d) normal[d] += meeting.copy[d] * period_[d];
    normal[0] += meeting.copy[1] * sliding_ * time_;
    speed[0] += meeting.copy[1] * sliding_;
    const Real length = std::sqrt(dot(normal, normal));
    for (Real& n : normal) n /= length;
    meeting.impulse = -(1 + std::min(a.restitution, b.restitution)) * dot(normal, speed) / (1 / a.mass + 1 / b.mass);
    a.v = sum(a.v, normal, -meeting.impulse / a.mass);
    b.v = sum(b.v, normal, meeting.impulse / b.mass);
    return meeting;
  }

  std::vector<Ball> balls_;
  Vector period_;
  Real sliding_;
  Real time_;
};

}  // namespace reference
