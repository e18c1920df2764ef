#include "collision/response/joint_impulse.hpp"

#include "collision/response/least_norm.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// What a unit impulse along the normal of a place does to the two bodies.
struct Lever {
  Vector3d turns_a, turns_b;
  double yields;  ///< the rate of parting that it makes
};

void give(JointBody& body, double push, const JointPlace& at, const Vector3d& arm, const Vector3d& turns) {
  body.velocity.velocity += (push * body.mobility.inverse_mass) * at.normal;
  body.velocity.angular_velocity += push * turns;
  body.angular_impulse += push * cross(arm, at.normal);
}

Vector3d rate(const JointBody& body, const Vector3d& arm) {
  return body.velocity.velocity + cross(body.velocity.angular_velocity, arm);
}

/// Where sweeps converge slowly, since heavy bodies lie on light ones: the places that push are found one by one, each
/// time solving for those that do ([Lawson74], chapter 23). Unknowns are pushes times the root of what they yield,
/// which makes the matrix symmetric with a diagonal of ones. `lacks`: how much faster each place is to part without
/// pushes. Returns the pushes; they are a solution if there is one.
class JointActiveSet {
 public:
  static constexpr std::size_t most_places = 64;  ///< each step solves for all that push

  JointActiveSet(std::span<const JointPlace> places, std::span<const Lever> levers, std::span<const JointBody> bodies,
                 std::span<const double> lacks)
      : size_(places.size()), matrix_(size_ * size_), x_(size_), active_(size_) {
    for (std::size_t i = 0; i < size_; ++i) {
      roots_.push_back(std::sqrt(levers[i].yields));
      wanted_.push_back(lacks[i] / roots_[i]);
      least_.push_back(places[i].least / roots_[i]);
    }
    for (std::size_t i = 0; i < size_; ++i) {
      matrix_[i * size_ + i] = 1;
      for (std::size_t j = 0; j < i; ++j) {
        const double rate = coupling(places[i], places[j], levers[j], bodies) / (roots_[i] * roots_[j]);
        matrix_[i * size_ + j] = matrix_[j * size_ + i] = rate;
      }
    }
  }

  std::vector<double> pushes() {
    constexpr double tolerance = 0x1p-6;  // of the least rate
    for (std::size_t step = 0; step < 3 * size_; ++step) {
      std::size_t next = size_;
      for (std::size_t i = 0; i < size_; ++i) {
        if (active_[i] || !(lack(i) > tolerance * least_[i])) continue;
        if (next == size_ || lack(i) > lack(next)) next = i;
      }
      if (next == size_) break;
      active_[next] = true;
      improve();
    }
    std::vector<double> result;
    for (std::size_t i = 0; i < size_; ++i) result.push_back(x_[i] / roots_[i]);
    return result;
  }

 private:
  /// The rate of parting at x that a unit impulse at y makes.
  static double coupling(const JointPlace& x, const JointPlace& y, const Lever& lever,
                         std::span<const JointBody> bodies) {
    const auto moves = [&](std::uint32_t body, const Vector3d& arm) {
      double rate = 0;
      const auto add = [&](double sign, const Vector3d& turns) {
        rate +=
            sign * (bodies[body].mobility.inverse_mass * dot(x.normal, y.normal) + dot(x.normal, cross(turns, arm)));
      };
      if (body == y.a) add(-1, lever.turns_a);
      if (body == y.b) add(1, lever.turns_b);
      return rate;
    };
    return moves(x.b, x.arm_b) - moves(x.a, x.arm_a);
  }

  double lack(std::size_t i) const {
    double result = wanted_[i];
    for (std::size_t j = 0; j < size_; ++j) result -= matrix_[i * size_ + j] * x_[j];
    return result;
  }

  /// Solves for the active places, as far as no push becomes a pull; removes those that would, and repeats.
  void improve() {
    for (std::size_t round = 0; round <= size_; ++round) {
      std::vector<std::size_t> places;
      for (std::size_t i = 0; i < size_; ++i) {
        if (active_[i]) places.push_back(i);
      }
      std::vector<double> matrix, sides;
      for (const std::size_t i : places) {
        sides.push_back(wanted_[i]);
        for (const std::size_t j : places) matrix.push_back(matrix_[i * size_ + j]);
      }
      const std::vector<double> aims = least_norm_solution(matrix, sides);
      double part = 1;
      std::size_t first = size_;
      for (std::size_t k = 0; k < places.size(); ++k) {
        const double x = x_[places[k]];
        if (x + part * (aims[k] - x) >= 0) continue;
        part = x / (x - aims[k]);
        first = places[k];
      }
      for (std::size_t k = 0; k < places.size(); ++k) {
        double& x = x_[places[k]];
        x = std::max(x + part * (aims[k] - x), 0.0);
      }
      if (first == size_) return;
      x_[first] = 0, active_[first] = false;
    }
  }

  std::size_t size_;
  std::vector<double> matrix_;  ///< row by row
  std::vector<double> roots_, wanted_, least_, x_;
  std::vector<bool> active_;
};

}  // namespace

bool part_jointly(std::span<JointBody> bodies, std::span<JointPlace> places) {
  constexpr double tolerance = 0x1p-3;  // of the least rate
  std::vector<JointBody> moved(bodies.begin(), bodies.end());
  std::vector<Lever> levers;
  for (JointPlace& at : places) {
    at.push = 0;
    const auto turned = [&](std::uint32_t i, const Vector3d& arm) {
      return moved[i].mobility.turned_by(cross(arm, at.normal));
    };
    Lever lever{turned(at.a, at.arm_a), turned(at.b, at.arm_b), 0};
    lever.yields = moved[at.a].mobility.inverse_mass + moved[at.b].mobility.inverse_mass +
                   dot(cross(at.arm_a, at.normal), lever.turns_a) + dot(cross(at.arm_b, at.normal), lever.turns_b);
    levers.push_back(lever);
  }
  const auto missing = [&](const JointPlace& at) {
    return at.least - dot(at.normal, rate(moved[at.b], at.arm_b) - rate(moved[at.a], at.arm_a));
  };
  const auto solved = [&] {
    return std::all_of(places.begin(), places.end(), [&](const JointPlace& at) {
      const double lacks = missing(at), most = tolerance * at.least;
      return lacks <= most && (at.push == 0 || lacks >= -most);
    });
  };
  std::vector<double> lacks;
  for (const JointPlace& at : places) lacks.push_back(missing(at));
  for (int sweep = 0; sweep < joint_sweeps; ++sweep) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      JointPlace& at = places[i];
      const double push = std::max(at.push + missing(at) / levers[i].yields, 0.0);
      const double more = push - at.push;
      at.push = push;
      give(moved[at.a], -more, at, at.arm_a, levers[i].turns_a);
      give(moved[at.b], more, at, at.arm_b, levers[i].turns_b);
    }
    if (!solved()) continue;
    std::copy(moved.begin(), moved.end(), bodies.begin());
    return true;
  }
  if (places.size() > JointActiveSet::most_places) return false;
  std::copy(bodies.begin(), bodies.end(), moved.begin());
  const std::vector<double> pushes = JointActiveSet(places, levers, bodies, lacks).pushes();
  for (std::size_t i = 0; i < places.size(); ++i) {
    JointPlace& at = places[i];
    at.push = pushes[i];
    give(moved[at.a], -at.push, at, at.arm_a, levers[i].turns_a);
    give(moved[at.b], at.push, at, at.arm_b, levers[i].turns_b);
  }
  if (!solved()) return false;
  std::copy(moved.begin(), moved.end(), bodies.begin());
  return true;
}

}  // namespace kds::collision
