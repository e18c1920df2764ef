// For how long two boxes that turn stay apart by one of their axes.
#pragma once

#include "collision/narrow_phase/turning/turning_boxes.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// Along the direction that a way has now, and between the origins.
template <int Degree>
double TurningBoxes<Degree>::revolving_apart_for(const PairFrame<Degree>& frame, int way) const {
  const auto corners = [](const Eigen::Matrix3d& axes, const AlignedBox& box) {
    return [&axes, &box](const auto& take) {
      for (int signs = 0; signs < 8; ++signs) take(Eigen::Vector3d(axes * corner(box, signs)));
    };
  };
  const auto of_a = corners(frame.matrix_a, box_a_.exact), of_b = corners(frame.matrix_b, box_b_.exact);
  const auto along = [&](const Eigen::Vector3d& n) {
    const double covered = revolving_extent(n, frame.spin_a, of_a) + revolving_extent(-n, frame.spin_b, of_b);
    return collision::revolving_apart_for(frame, n, covered);
  };
  const Eigen::Vector3d u = way < 6    ? frame.axis_a(way / 2)
                            : way < 12 ? frame.axis_b((way - 6) / 2)
                                       : cross(frame.axis_a((way - 12) / 6), frame.axis_b((way - 12) / 2 % 3));
  return std::max(along(normalized(frame.way.value)), along((way % 2 != 0 ? 1 : -1) * normalized(u)));
}

/// Calls visit(number, f, bounds) with the function of each condition of a way, less what rounding can make of
/// it during the stretch, until it returns false. f is n . (way + vertices of b - vertices of a) less what does not
/// turn.
template <int Degree>
template <class Visit>
void TurningBoxes<Degree>::every_jet(const PairFrame<Degree>& frame, int way, double stretch,
                                     const Visit& visit) const {
  std::array<VectorJet, 4>
      half;  // of edges: a condition adds each of them, or takes it away, by the bits of its number
  std::size_t count = 0;
  double of_a = 0, of_b = 0, rate = 0, offset = 0;
  VectorJet n;
  VectorJet between = frame.way;
  const auto turned_axis = [&](bool from_a, int axis) {
    return from_a ? turning(frame.axis_a(axis), frame.spin_a) : turning(frame.axis_b(axis), frame.spin_b);
  };
  const auto add = [&](bool from_a, int axis, int sign) {
    const double length = (from_a ? box_a_ : box_b_).half[axis];
    half[count++] = sign * length * turned_axis(from_a, axis);
    (from_a ? of_a : of_b) += length;
  };
  const auto add_centre = [&](bool from_a) {
    const Eigen::Vector3d& centre = (from_a ? box_a_ : box_b_).centre;
    if (centre.isZero(0)) return;
    if (from_a) {
      between = between - turning(frame.matrix_a * centre, frame.spin_a);
    } else {
      between = between + turning(frame.matrix_b * centre, frame.spin_b);
    }
    (from_a ? of_a : of_b) += norm(centre) * (1 + PairFrame<Degree>::rounding);
  };
  if (way < 12) {
    const bool of_face_a = way < 6;
    const int axis = (way % 6) / 2;
    n = turned_axis(of_face_a, axis);
    rate = of_face_a ? frame.rate_a : frame.rate_b;
    // What the box of the face covers along its own normal does not turn.
    const AlignedBox& box = (of_face_a ? box_a_ : box_b_).exact;
    const bool upper = (way % 2 != 0) == of_face_a;
    offset = upper ? box.high[axis] : -box.low[axis];
    for (int k = 0; k < 3; ++k) add(!of_face_a, k, of_face_a ? 1 : -1);
    add_centre(!of_face_a);
  } else {
    const int i = (way - 12) / 6, j = (way - 12) / 2 % 3;
    n = cross(turned_axis(true, i), turned_axis(false, j));
    rate = frame.rate_a + frame.rate_b;
    add(false, (j + 1) % 3, -1), add(false, (j + 2) % 3, -1);
    add(true, (i + 1) % 3, 1), add(true, (i + 2) % 3, 1);
    add_centre(true), add_centre(false);
  }
  if (way % 2 == 0) n = -1.0 * n;
  const TurningBounds bounds(frame, rate, of_a, of_b, stretch);
  Jet base = dot(n, between);
  base.value -= offset + bounds.rounding + PairFrame<Degree>::rounding * std::abs(offset);
  std::array<Jet, 4> width;
  for (std::size_t k = 0; k < count; ++k) {
    width[k] = dot(n, half[k]);
    base = base - width[k];
  }
  for (int number = 0; number < 1 << count; ++number) {
    Jet f = base;
    for (std::size_t k = 0; k < count; ++k) {
      if (number >> k & 1) f = f + 2.0 * width[k];
    }
    if (!visit(number, f, bounds)) return;
  }
}

/// How long a way is surely open: all of its conditions hold.
template <int Degree>
double TurningBoxes<Degree>::open_for(const PairFrame<Degree>& frame, int way, double stretch) const {
  double wait = stretch;
  every_jet(frame, way, stretch, [&](int, const Jet& f, const TurningBounds& bounds) {
    wait = std::min(wait, positive_for(f, bounds.third, wait));
    return wait > 0;
  });
  return wait;
}

/// every_jet() takes away no more than `rounding`, and no more is lost in computing f: the condition is at most f + 2
/// rounding.
template <int Degree>
double TurningBoxes<Degree>::closed_wait(const PairFrame<Degree>& frame, int way, double stretch) const {
  if (!frame.certain) return 0;
  double wait = 0;
  every_jet(frame, way, stretch, [&](int, const Jet& f, const TurningBounds& bounds) {
    const double rounding = bounds.rounding + PairFrame<Degree>::rounding * (box_a_.lengths() + box_b_.lengths());
    const Jet broken{-(f.value + 2 * rounding), -f.rate, -f.bend};
    wait = std::max(wait, positive_for(broken, bounds.third, stretch));
    return wait < stretch;
  });
  return wait;
}

template <int Degree>
std::array<double, 16> TurningBoxes<Degree>::waits(const PairFrame<Degree>& frame, int way, double stretch) const {
  std::array<double, 16> waits;
  waits.fill(never);
  if (!frame.certain) {
    std::fill_n(waits.begin(), way < 12 ? 8 : 16, 0.0);
    return waits;
  }
  every_jet(frame, way, stretch, [&](int number, const Jet& f, const TurningBounds& bounds) {
    waits[static_cast<std::size_t>(number)] =
        positive_after(f, bounds.rate_rounding, bounds.bend_rounding, bounds.third, stretch);
    return true;
  });
  return waits;
}

}  // namespace kds::collision
