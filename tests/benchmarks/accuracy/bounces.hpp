// A light ball between a heavy one and a fixed one, on a line: the bounces that count the digits of pi [Galperin03].
#pragma once

#include "collision/world.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace accuracy {

/// With a mass ratio of 100^k there are floor(10^k pi) contacts: 3141 at 1e6. Radii are 1; the light ball rests at 3,
/// the heavy one comes from 10 at speed 1, and all but the fixed one leave.
class Bounces final : private kds::collision::WorldListener<1> {
 public:
  explicit Bounces(double mass_ratio) : world_(options(), this) {
    using kds::collision::BodyDescription;
    using kds::collision::Sphere;
    const auto ball = [](double x, double speed, double mass) {
      BodyDescription<1> body;
      body.shape = Sphere{1};
      body.motion = {{{Eigen::Vector3d(x, 0, 0), Eigen::Vector3d(speed, 0, 0)}, 0}};
      body.mass = mass;
      return body;
    };
    auto fixed = ball(0, 0, 1);
    fixed.fixed = true;
    world_.add_body(fixed);
    world_.add_body(ball(3, 0, 1));
    world_.add_body(ball(10, -1, mass_ratio));
    while (world_.step()) {}
  }

  const std::vector<double>& times() const { return times_; }
  double heavy_speed() const { return world_.motion(2).coefficients[1][0]; }
  double light_speed() const { return world_.motion(1).coefficients[1][0]; }
  std::uint64_t rebounds_suppressed() const { return world_.counters().rebounds_suppressed; }

 private:
  static kds::collision::WorldOptions options() {
    kds::collision::WorldOptions o;
    o.response = kds::collision::Response::elastic;
    return o;
  }
  void contact(kds::collision::World<1>&, const kds::collision::PairEvent& e) override {
    times_.push_back(e.contact.time);
  }

  std::vector<double> times_;
  kds::collision::World<1> world_;
};

/// The same with a hundred digits.
inline std::vector<double> exact_bounces(double mass_ratio) {
  using Number = boost::multiprecision::cpp_bin_float_100;
  const Number m = mass_ratio;
  Number now = 0, light = 3, heavy = 10, light_speed = 0, heavy_speed = -1;
  std::vector<double> times;
  for (;;) {
    Number to_fixed = -1, to_heavy = -1;
    if (light_speed < 0) to_fixed = (light - 2) / -light_speed;
    if (light_speed > heavy_speed) to_heavy = (heavy - light - 2) / (light_speed - heavy_speed);
    if (to_fixed < 0 && to_heavy < 0) return times;
    const bool fixed = to_heavy < 0 || (to_fixed >= 0 && to_fixed < to_heavy);
    const Number wait = fixed ? to_fixed : to_heavy;
    now += wait;
    light += wait * light_speed;
    heavy += wait * heavy_speed;
    if (fixed) {
      light_speed = -light_speed;
    } else {
      const Number centre = (light_speed + m * heavy_speed) / (1 + m);
      light_speed = 2 * centre - light_speed;
      heavy_speed = 2 * centre - heavy_speed;
    }
    times.push_back(now.convert_to<double>());
  }
}

}  // namespace accuracy
