// Random vertex-face and edge-edge queries of the kinds that go wrong: for tests and for the benchmark.
#pragma once

#include "tests/certificates/exact_features.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>

namespace kds::tests {

/// How the features meet, or miss, at a time in [0, 1].
enum class Encounter {
  random,         ///< anything in a cube: a few touch
  inside,         ///< inside both features
  rim,            ///< on a rim or a corner of one of them or of both
  near_rim,       ///< next to a rim, on either side of it
  at_end,         ///< at time 0 or 1 exactly, or next to it
  grazing,        ///< the velocity at the time of least distance is along the features; a tiny gap, or none
  turning,        ///< a face or an edge that turns beside the other feature at a small distance, without meeting it
  coplanar,       ///< all in one plane all the time
  degenerate,     ///< a face without area, an edge without length, parallel edges, points that coincide
  resting,        ///< no relative motion, touching or a tiny gap apart
  near_parallel,  ///< motion along each other, but for a little
};
inline constexpr int encounters = 11;

inline const char* name(Encounter encounter) {
  constexpr std::array names{"random",  "inside",   "rim",        "near rim", "at end",       "grazing",
                             "turning", "coplanar", "degenerate", "resting",  "near parallel"};
  return names[static_cast<std::size_t>(encounter)];
}

/// Point k moves on c[k][0] + c[k][1] t + c[k][2] t^2 for t in [0, 1].
struct FeatureQuery {
  Features kind;
  std::array<std::array<Eigen::Vector3d, 3>, 4> c;
};

class FeatureQueries {
 public:
  /// `bend`: size of the accelerations; 0 for linear paths. `scale`: unit of length. `offset`: of the whole query.
  FeatureQueries(std::uint64_t seed, double bend, double scale, double offset)
      : random_(seed), bend_(bend), scale_(scale), offset_(offset) {}

  FeatureQuery operator()(Encounter encounter, Features kind) {
    coarse_ = random_.one_in(3);
    std::array<Eigen::Vector3d, 4> x = {vector(), vector(), vector(), vector()};
    std::array<Eigen::Vector3d, 4> v = {vector(), vector(), vector(), vector()};
    if (random_.one_in(3)) slow_down(kind, v);
    double time = coarse_ ? random_.integer(0, 8) / 8.0 : random_.unit();
    if (encounter == Encounter::degenerate) degenerate(kind, x, v);
    if (encounter == Encounter::coplanar) {
      for (auto& p : x) p[2] = 0;
      for (auto& p : v) p[2] = 0;
    }
    std::array<double, 2> w = weights(encounter, kind);
    if (encounter != Encounter::random) meet(kind, x, w, 0);
    const double tiny = std::pow(10.0, random_.between(-12, -2));
    switch (encounter) {
      case Encounter::at_end:
        time = random_.one_in(2) ? 0 : 1;
        if (random_.one_in(3)) time += (random_.one_in(2) ? 1 : -1) * std::pow(10.0, random_.between(-16, -6));
        break;
      case Encounter::grazing:
        along(kind, x, v);
        if (!random_.one_in(4)) meet(kind, x, w, random_.one_in(2) ? tiny : -tiny);
        break;
      case Encounter::near_parallel:
        along(kind, x, v);
        v[0] += vector() * tiny;
        v[2] += vector() * tiny;
        break;
      case Encounter::turning:
        turn(kind, x, v, w, std::max(tiny, 1e-6));
        break;
      case Encounter::resting:
        v = {v[0], v[0], v[0], v[0]};
        if (!random_.one_in(3)) meet(kind, x, w, tiny);
        break;
      default:
        break;
    }
    return placed(kind, x, v, time, encounter == Encounter::coplanar, encounter == Encounter::resting);
  }

  Random& random() { return random_; }

 private:
  Eigen::Vector3d vector() {
    Eigen::Vector3d v;
    for (int d = 0; d < 3; ++d) v[d] = coarse_ ? random_.integer(-8, 8) / 4.0 : random_.between(-2, 2);
    return v;
  }

  /// Features that keep their shapes, nearly: what a small step of a simulator does.
  void slow_down(Features kind, std::array<Eigen::Vector3d, 4>& v) {
    const Eigen::Vector3d first = vector() * 0.5;
    const Eigen::Vector3d second = vector() * 0.5;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool of_first = k == 0 || (k == 1 && kind == Features::edge_edge);
      v[k] = (of_first ? first : second) + v[k] * 0.0625;
    }
  }

  std::array<double, 2> weights(Encounter encounter, Features kind) {
    std::array<double, 2> w;
    for (double& x : w) x = coarse_ ? random_.integer(0, 4) / 4.0 : random_.unit();
    if (kind == Features::vertex_face && w[0] + w[1] > 1) w = {1 - w[0], 1 - w[1]};
    if (encounter == Encounter::rim || encounter == Encounter::near_rim) {
      w[random_.below(2)] = random_.integer(0, 1);
      if (random_.one_in(3)) w = {random_.one_in(2) ? 1.0 : 0.0, 0};
      if (encounter == Encounter::near_rim) w[random_.below(2)] += random_.scaled(-50, -3);
    }
    return w;
  }

  /// Moves the first feature so that the points with the given weights meet, or have a gap across both features.
  void meet(Features kind, std::array<Eigen::Vector3d, 4>& x, const std::array<double, 2>& w, double gap) {
    Eigen::Vector3d normal = across(kind, x);
    if (normal.norm() > 0) normal.normalize();
    if (kind == Features::vertex_face) {
      x[0] = x[1] + (x[2] - x[1]) * w[0] + (x[3] - x[1]) * w[1] + normal * gap;
    } else {
      const Eigen::Vector3d shift = x[2] + (x[3] - x[2]) * w[1] - (x[0] + (x[1] - x[0]) * w[0]) + normal * gap;
      x[0] += shift;
      x[1] += shift;
    }
  }

  static Eigen::Vector3d across(Features kind, const std::array<Eigen::Vector3d, 4>& x) {
    return kind == Features::vertex_face ? (x[2] - x[1]).cross(x[3] - x[1]) : (x[1] - x[0]).cross(x[3] - x[2]);
  }

  /// Velocities without a part across the features.
  static void along(Features kind, const std::array<Eigen::Vector3d, 4>& x, std::array<Eigen::Vector3d, 4>& v) {
    const Eigen::Vector3d n = across(kind, x);
    if (!(n.norm() > 0)) return;
    for (auto& u : v) u -= n * (n.dot(u) / n.dot(n));
  }

  /// The second feature turns about the point of contact, at a distance that hardly changes.
  void turn(Features kind, std::array<Eigen::Vector3d, 4>& x, std::array<Eigen::Vector3d, 4>& v,
            const std::array<double, 2>& w, double gap) {
    meet(kind, x, w, random_.one_in(2) ? gap : -gap);
    const bool face = kind == Features::vertex_face;
    const Eigen::Vector3d foot = face ? x[0] : Eigen::Vector3d(x[2] + (x[3] - x[2]) * w[1]);
    const Eigen::Vector3d spin = vector();
    const std::size_t first = face ? 1 : 2;
    for (std::size_t k = 0; k < first; ++k) v[k].setZero();
    for (std::size_t k = first; k < 4; ++k) v[k] = spin.cross(x[k] - foot);
  }

  void degenerate(Features kind, std::array<Eigen::Vector3d, 4>& x, std::array<Eigen::Vector3d, 4>& v) {
    const bool always = random_.one_in(2);
    switch (random_.below(4)) {
      case 0:  // A point of a face or an edge.
        x[3] = x[2];
        if (always) v[3] = v[2];
        break;
      case 1:  // In a line; parallel edges.
        if (kind == Features::vertex_face) {
          x[3] = x[1] + (x[2] - x[1]) * 0.5;
          if (always) v[3] = v[1] + (v[2] - v[1]) * 0.5;
        } else {
          x[3] = x[2] + (x[1] - x[0]) * (random_.one_in(2) ? -2.0 : 0.5);
          if (always) v[3] = v[2] + (v[1] - v[0]) * 0.5;
        }
        break;
      case 2:  // All of a feature in one point.
        x[2] = x[3] = x[1];
        if (always) v[2] = v[3] = v[1];
        break;
      default:  // Nearly in a line.
        x[3] = x[1] + (x[2] - x[1]) * 1.25 + vector() * std::pow(10.0, random_.between(-15, -6));
        if (always) v[3] = v[2];
    }
  }

  FeatureQuery placed(Features kind, const std::array<Eigen::Vector3d, 4>& x, const std::array<Eigen::Vector3d, 4>& v,
                      double time, bool flat, bool together) {
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    if (offset_ != 0) shift = Eigen::Vector3d(offset_, -offset_, 0.5 * offset_);
    if (flat) shift[2] = 0;
    const Eigen::Vector3d common = bend_ * vector();
    FeatureQuery query{kind, {}};
    for (std::size_t k = 0; k < 4; ++k) {
      Eigen::Vector3d a = together ? common : Eigen::Vector3d(bend_ * vector());
      if (flat) a[2] = 0;
      query.c[k][0] = (x[k] - time * v[k] + time * time * a) * scale_ + shift;
      query.c[k][1] = (v[k] - 2 * time * a) * scale_;
      query.c[k][2] = a * scale_;
    }
    return query;
  }

  Random random_;
  double bend_;
  double scale_;
  double offset_;
  bool coarse_ = false;
};

/// The points at time 0 and at time 1 of a query with linear paths: numbers of their own, which its other form only
/// approximates.
inline std::array<std::array<Eigen::Vector3d, 4>, 2> ends(const FeatureQuery& query) {
  std::array<std::array<Eigen::Vector3d, 4>, 2> result;
  for (std::size_t k = 0; k < 4; ++k) {
    result[0][k] = query.c[k][0];
    result[1][k] = query.c[k][0] + query.c[k][1];
  }
  return result;
}

}  // namespace kds::tests
