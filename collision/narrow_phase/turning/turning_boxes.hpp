// Two boxes that turn: by which of their axes they are apart; turning_boxes_ahead.hpp has for how long.
#pragma once

#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "collision/narrow_phase/turning/pair_frame.hpp"
#include "collision/shapes/aligned_box.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kds::collision {

/// Two boxes are apart while one of 15 axes separates them [Gottschalk96]: a normal of a face of either, or across an
/// edge of each. An axis with a sense, from a to b, is a *way* of being apart: numbers 0 to 5 are the faces of a, 6 to
/// 11 those of b, 12 to 29 pairs of edges.
///
/// A way says that all vertices of one box are beyond a face of the other (8 conditions), or that all edges of one
/// direction pass on one side of all those of another direction (16 conditions). Each is a turning certificate, so that
/// it is decided exactly. Two directions that are parallel at all times separate nothing: all of their conditions are
/// zero then, and only then.
template <int Degree>
class TurningBoxes {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;
  static constexpr int ways = 30;

  /// The boxes are in the coordinates of their bodies, and may be anywhere.
  TurningBoxes(const RigidMotion& a, const AlignedBox& of_a, const RigidMotion& b, const AlignedBox& of_b)
      : a_(a), b_(b), box_a_(of_a), box_b_(of_b), turned_alike_(turned_alike(a, b)) {}

  /// Whether a way certainly separates nothing, at hardly any cost: boxes that are turned alike at all times, as in a
  /// lattice, have parallel edges.
  bool known_to_separate_nothing(int way) const { return turned_alike_ && way >= 12 && (way - 12) / 2 % 4 == 0; }

  /// Numbers of conditions of a way, as bits.
  using Conditions = std::uint32_t;
  static constexpr Conditions all(int way) { return way < 12 ? 0xff : 0xffff; }

  /// Calls test(certificate) for some conditions of a way, or all, until it returns false. Vertices are numbered by
  /// their signs, pairs of edges by the number of the first, times four, and that of the second.
  template <class Test>
  bool every_condition(int way, Conditions which, const Test& test) const {
    if (way < 6) return every_vertex(a_, box_a_.exact, b_, box_b_.exact, way, which, test);
    if (way < 12) return every_vertex(b_, box_b_.exact, a_, box_a_.exact, (way - 6) ^ 1, which, test);
    const int pair = (way - 12) / 2;
    for (int k = 0; k < 4; ++k) {
      for (int l = 0; l < 4; ++l) {
        if (!(which >> (4 * k + l) & 1)) continue;
        // (u x v) . (a - b) >= 0: the product of the edges has to point from b to a.
        const auto u = edge(box_a_.exact, pair / 3, k, way % 2 != 0);
        const auto v = edge(box_b_.exact, pair % 3, l, false);
        if (!test(certificates::EdgeEdgeSeparation<Degree>{a_, b_, u, v})) return false;
      }
    }
    return true;
  }

  /// The pair as it is at t, in doubles.
  PairFrame<Degree> frame(double t) const { return {a_, b_, t}; }

  /// How wide the gap is along each way, in doubles; returns a bound on the errors. For ways that cross edges it is the
  /// gap times the sine of their angle.
  double gaps(const PairFrame<Degree>& frame, std::array<double, ways>& gap) const;

  /// The conditions of a way that are not known to stay positive for the stretch from now on. (Most do: they are of the
  /// vertices and edges on the far side.)
  Conditions unsure(const PairFrame<Degree>& frame, int way, double stretch) const {
    if (!frame.certain || !(stretch <= frame.stretch(box_a_.radius + box_b_.radius, stretch))) return all(way);
    Conditions unsure = 0;
    every_jet(frame, way, stretch, [&](int number, const Jet& f, const TurningBounds& bounds) {
      if (!(positive_for(f, bounds.third, stretch) >= stretch && f.value > 0)) unsure |= Conditions{1} << number;
      return true;
    });
    return unsure;
  }

  /// A bound on how fast these widths change in such a time.
  double fastest(const PairFrame<Degree>& frame, double stretch) const {
    return frame.fastest(box_a_.lengths(), box_b_.lengths(), stretch);
  }

  /// A time from t on until which the boxes are apart; t where doubles do not tell, or where it would be hardly later.
  double apart_until(double t, double horizon) const {
    t = balls_apart_until(a_, b_, box_a_.radius, box_b_.radius, t, horizon);
    if (t == never) return never;
    const PairFrame<Degree> frame = this->frame(t);
    std::array<double, ways> gap;
    const double error = gaps(frame, gap);
    const int way = widest(frame, gap);
    if (!(gap[static_cast<std::size_t>(way)] > error)) return t;
    const double all = (horizon - t) * (1 + 0x1p-40);
    const double stretch = frame.stretch(box_a_.radius + box_b_.radius, all);
    const double wait = open_for(frame, way, stretch);
    if (stretch == all || time_of_turning() == never) return after_wait(t, wait, stretch);
    return after_wait(t, std::max(wait, revolving_apart_for(frame, way)), stretch);
  }

  /// How far to look ahead, s; and for how much of that each condition of a way that is open just after the time of the
  /// frame is positive for certain, however narrow the way is then.
  double stretch(const PairFrame<Degree>& frame, double longest) const {
    return frame.certain ? frame.stretch(box_a_.radius + box_b_.radius, longest) : longest;
  }
  std::array<double, 16> waits(const PairFrame<Degree>& frame, int way, double stretch) const;
  double open_wait(const PairFrame<Degree>& frame, int way, double stretch) const {
    const auto waits = this->waits(frame, way, stretch);
    return *std::min_element(waits.begin(), waits.end());
  }
  /// For how much of a stretch a condition of a way is broken for certain, all the time.
  double closed_wait(const PairFrame<Degree>& frame, int way, double stretch) const;

  /// How deep the two are in each other at t, in doubles: along the way that is the least blocked.
  double depth(double t) const;

  /// Whether it crosses two edges that are parallel but for 2^-10.
  static bool is_thin(const PairFrame<Degree>& frame, int way) { return way >= 12 && !(sine(frame, way) > 0x1p-10); }

  /// Whether all conditions of a way are zero at all times: that is whether the edges it crosses, u and v, are
  /// parallel. Three tell. If (u x v) . (a - b) vanishes for one edge of b and three edges of a, u x v is at right
  /// angles to two other edges of a, and it is to u.
  template <class Vanishes>
  bool separates_nothing(int way, const Vanishes& vanishes) const {
    if (way < 12) return false;
    const int pair = (way - 12) / 2;
    const auto v = edge(box_b_.exact, pair % 3, 0, false);
    for (int k = 0; k < 3; ++k) {
      const auto u = edge(box_a_.exact, pair / 3, k, false);
      if (!vanishes(certificates::EdgeEdgeSeparation<Degree>{a_, b_, u, v})) return false;
    }
    return true;
  }

  /// The same pair with its first box smaller by `margin` on each side; none where nothing of it is left.
  std::optional<TurningBoxes> smaller(double margin) const {
    if (!(box_a_.half.minCoeff() > margin)) return std::nullopt;
    const Eigen::Vector3d side = Eigen::Vector3d::Constant(margin);
    return TurningBoxes(a_, {box_a_.exact.low + side, box_a_.exact.high - side}, b_, box_b_.exact);
  }

  /// The time in which the directions of the two change by about half a radian.
  double time_of_turning() const {
    const double rates = norm(a_.angular_velocity) + norm(b_.angular_velocity);
    return rates > 0 ? 0.5 / rates : never;
  }

 private:
  /// A box, and what doubles make of it.
  struct SeenBox {
    explicit SeenBox(const AlignedBox& box)
        : exact(box),
          centre(0.5 * box.low + 0.5 * box.high),
          half(0.5 * box.high - 0.5 * box.low),
          radius(norm(box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs())) * (1 + 0x1p-50)) {}

    /// Of vectors that add up to any of its corners.
    double lengths() const { return certificates::magnitude_sum(centre) + certificates::magnitude_sum(half); }

    AlignedBox exact;
    Eigen::Vector3d centre, half;  ///< rounded
    double radius;                 ///< no corner is farther from the origin of the body
  };

  static bool turned_alike(const RigidMotion& a, const RigidMotion& b) {
    return a.orientation.coeffs() == b.orientation.coeffs() && a.angular_velocity == b.angular_velocity &&
           (a.spin().still() || a.path.start == b.path.start);
  }

  static Eigen::Vector3d corner(const AlignedBox& box, int signs) {
    return {(signs & 1 ? box.high : box.low)[0], (signs & 2 ? box.high : box.low)[1],
            (signs & 4 ? box.high : box.low)[2]};
  }
  /// Number 0 to 3 of the edges along an axis, forwards or backwards.
  static std::array<Eigen::Vector3d, 2> edge(const AlignedBox& box, int axis, int number, bool backwards) {
    Eigen::Vector3d from = box.high;
    const int second = (axis + 1) % 3, third = (axis + 2) % 3;
    if (number & 1) from[second] = box.low[second];
    if (number & 2) from[third] = box.low[third];
    Eigen::Vector3d to = from;
    (backwards ? to : from)[axis] = box.low[axis];
    return {from, to};
  }
  /// Three corners of a face, counter-clockwise from outside: 0 is -x, 1 is +x, 2 is -y ...
  static std::array<Eigen::Vector3d, 3> face(const AlignedBox& box, int number) {
    const int axis = number / 2;
    const bool upper = number % 2 != 0;
    Eigen::Vector3d first = box.low;
    if (upper) first[axis] = box.high[axis];
    Eigen::Vector3d second = first, third = first;
    const int towards_second = (axis + (upper ? 1 : 2)) % 3, towards_third = (axis + (upper ? 2 : 1)) % 3;
    second[towards_second] = box.high[towards_second];
    third[towards_third] = box.high[towards_third];
    return {first, second, third};
  }
  template <class Test>
  static bool every_vertex(const RigidMotion& of_face, const AlignedBox& box_of_face, const RigidMotion& of_vertex,
                           const AlignedBox& box_of_vertex, int number, Conditions which, const Test& test) {
    const auto corners = face(box_of_face, number);
    for (int signs = 0; signs < 8; ++signs) {
      if (!(which >> signs & 1)) continue;
      if (!test(
              certificates::VertexFaceSeparation<Degree>{of_vertex, of_face, corner(box_of_vertex, signs), corners})) {
        return false;
      }
    }
    return true;
  }

  template <class Visit>
  void every_jet(const PairFrame<Degree>& frame, int way, double stretch, const Visit& visit) const;
  /// Of the angle between the two edges that a way crosses.
  static double sine(const PairFrame<Degree>& frame, int way) {
    return norm(cross(frame.axis_a((way - 12) / 6), frame.axis_b((way - 12) / 2 % 3)));
  }
  double revolving_apart_for(const PairFrame<Degree>& frame, int way) const;
  int widest(const PairFrame<Degree>& frame, const std::array<double, ways>& gap) const;
  double open_for(const PairFrame<Degree>& frame, int way, double stretch) const;

  const RigidMotion& a_;
  const RigidMotion& b_;
  SeenBox box_a_, box_b_;
  bool turned_alike_;
};

// ---------------------------------------------------------------------------------------------------------------------

template <int Degree>
double TurningBoxes<Degree>::gaps(const PairFrame<Degree>& frame, std::array<double, ways>& gap) const {
  std::array<Eigen::Vector3d, 3> u, v;
  for (int i = 0; i < 3; ++i) {
    u[static_cast<std::size_t>(i)] = frame.axis_a(i);
    v[static_cast<std::size_t>(i)] = frame.axis_b(i);
  }
  const Eigen::Vector3d between = frame.way.value + frame.matrix_b * box_b_.centre - frame.matrix_a * box_a_.centre;
  const auto note = [&](std::size_t way, double distance, double size) {
    gap[way] = -distance - size;  // towards the negative side of the axis, then towards the positive one
    gap[way + 1] = distance - size;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    double of_a = box_a_.half[static_cast<Eigen::Index>(i)], of_b = box_b_.half[static_cast<Eigen::Index>(i)];
    for (std::size_t k = 0; k < 3; ++k) {
      of_a += box_b_.half[static_cast<Eigen::Index>(k)] * std::abs(dot(u[i], v[k]));
      of_b += box_a_.half[static_cast<Eigen::Index>(k)] * std::abs(dot(u[k], v[i]));
    }
    note(2 * i, dot(u[i], between), of_a);
    note(6 + 2 * i, dot(v[i], between), of_b);
    for (std::size_t j = 0; j < 3; ++j) {
      const Eigen::Vector3d n = cross(u[i], v[j]);
      double size = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        if (k != i) size += box_a_.half[static_cast<Eigen::Index>(k)] * std::abs(dot(n, u[k]));
        if (k != j) size += box_b_.half[static_cast<Eigen::Index>(k)] * std::abs(dot(n, v[k]));
      }
      note(12 + 2 * (3 * i + j), dot(n, between), size);
    }
  }
  if (!frame.certain) return never;
  return frame.way_error + PairFrame<Degree>::rounding * (box_a_.lengths() + box_b_.lengths());
}

/// The way along which the gap is widest, but for edges that are nearly parallel.
template <int Degree>
int TurningBoxes<Degree>::widest(const PairFrame<Degree>& frame, const std::array<double, ways>& gap) const {
  int best = 0;
  double widest = -never;
  for (int way = 0; way < ways; ++way) {
    double width = gap[static_cast<std::size_t>(way)];
    if (way >= 12 && width > 0) width = is_thin(frame, way) ? -never : width / sine(frame, way);
    if (width > widest) widest = width, best = way;
  }
  return best;
}

/// For ways that cross edges the gap is multiplied by the sine of their angle: where they are nearly parallel it tells
/// nothing.
template <int Degree>
double TurningBoxes<Degree>::depth(double t) const {
  const PairFrame<Degree> frame(a_, b_, t);
  std::array<double, ways> gap;
  gaps(frame, gap);
  double least = never;
  for (int way = 0; way < ways; ++way) {
    const double sine = way < 12 ? 1 : this->sine(frame, way);
    if (sine > 0x1p-20) least = std::min(least, -gap[static_cast<std::size_t>(way)] / sine);
  }
  return std::max(0.0, least);
}

}  // namespace kds::collision

#include "collision/narrow_phase/turning/turning_boxes_ahead.hpp"
