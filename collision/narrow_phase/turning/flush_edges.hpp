// Edges that lie in the plane of a face of another solid at all times: when surfaces enter solids there.
#pragma once

#include "certificates/turning/turned_vector.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "collision/narrow_phase/turning/node_pairs.hpp"
#include "collision/narrow_phase/turning/turning_triangles.hpp"
#include "kds/arithmetic/exact.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace kds::collision {

/// A triangle, `beside`, and a triangle of another body, `face`, in whose plane an edge of the former lies at all
/// times: the edge is *flush* with the face. Just after a time the surface of one of the two bodies may enter the solid
/// that the other bounds there, though the two triangles only touch:
///
/// `through_face`: the triangle beside the edge is on the inner side of the face, and the edge shares a point with it.
/// Both without their ends: if they are not separated by a line of their plane.
///
/// `at_edge`: the face shares more than a point with the edge, and goes from there towards one of its corners between
/// the two triangles along the edge, in the solid that these bound.
///
/// What makes this false are 7 ways, as WaysApart has them. 0, 1: the third corner of the triangle is not beyond the
/// face; or the corner of the face is not in the wedge: it is on the outer side of either triangle along the edge, of
/// both if the solid fills more than a half around the edge. 2, 3: all corners of the face are on either side of the
/// edge, as the plane of the triangle tells. 4 to 6: both ends of the edge are beyond an edge of the face, as a plane
/// along that edge tells, which leans over to an axis of the body: for what is in the plane of the face it does not
/// matter how a plane across it leans. If an edge of the face lies along this edge, that does not separate them
/// `at_edge`.
template <int Degree>
class FlushEntry {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;
  using Corners = std::array<Eigen::Vector3d, 3>;
  using Separation = certificates::VertexFaceSeparation<Degree>;

  /// A triangle of a body that moves so, counter-clockwise seen from outside. Refers to the motion.
  struct Side {
    const RigidMotion& motion;
    Corners corners;
  };

  /// The edge is that between the corners 0 and 1 of `beside`.
  static FlushEntry through_face(const Side& face, const Side& beside) { return {face, beside}; }

  /// Towards corner `towards` of the face. `across`: the third corner of the other triangle along the edge, `fills`:
  /// whether the solid fills more than a half around it; `along`: which edge of the face lies along the edge at all
  /// times, or -1.
  static FlushEntry at_edge(const Side& face, const Side& beside, const Eigen::Vector3d& across, bool fills,
                            std::size_t towards, int along) {
    FlushEntry entry(face, beside);
    entry.at_edge_ = true, entry.fills_ = fills, entry.towards_ = face.corners[towards];
    entry.other_ = {beside.corners[1], beside.corners[0], across};
    if (!fills) entry.needless_ &= ~2u;
    if (along >= 0) entry.needless_ |= 12u | 16u << along;
    return entry;
  }

  const RigidMotion& of_face() const { return face_.motion; }
  /// Of the face, in the coordinates of its body; its length is rounded.
  Eigen::Vector3d normal() const {
    return cross(face_.corners[1] - face_.corners[0], face_.corners[2] - face_.corners[0]);
  }

  // What WaysApart asks. Nothing of it is told in doubles: exact signs decide all.
  static constexpr int ways = 7;
  using Conditions = std::uint32_t;
  /// What is known in doubles: the time alone.
  struct Frame {
    double time;
  };
  static constexpr Conditions all(int) { return ~Conditions{0}; }
  static constexpr Conditions unsure(const Frame&, int way, double) { return all(way); }
  bool known_to_separate_nothing(int way) const { return (needless_ >> way & 1) != 0; }
  template <class Vanishes>
  bool separates_nothing(int way, const Vanishes&) const {
    return known_to_separate_nothing(way);
  }
  static Frame frame(double t) { return {t}; }
  static double gaps(const Frame&, std::array<double, std::size_t{ways}>& gap) {
    gap.fill(0);
    return never;
  }
  static double fastest(const Frame&, double) { return 0; }
  static double apart_until(double t, double) { return t; }
  double time_of_turning() const {
    const double rates = norm(face_.motion.angular_velocity) + norm(beside_.motion.angular_velocity);
    return rates > 0 ? 0.5 / rates : never;
  }

  /// Calls test(certificate) for the conditions of a way until it returns false.
  template <class Test>
  bool every_condition(int way, Conditions, const Test& test) const {
    const RigidMotion &of_face = face_.motion, &of_edge = beside_.motion;
    if (way < 2) {
      if (!at_edge_) return test(Separation{of_edge, of_face, beside_.corners[2], face_.corners});
      const auto outside = [&](const Corners& of) { return test(Separation{of_face, of_edge, towards_, of}); };
      if (fills_) return outside(beside_.corners) && outside(other_);
      return outside(way == 0 ? beside_.corners : other_);
    }
    if (way < 4) {
      const Corners plane = way == 2 ? beside_.corners : turned_over(beside_.corners);
      return std::all_of(face_.corners.begin(), face_.corners.end(), [&](const Eigen::Vector3d& x) {
        return test(Separation{of_face, of_edge, x, plane});
      });
    }
    const Corners plane = across(static_cast<std::size_t>(way - 4));
    return test(Separation{of_edge, of_face, beside_.corners[0], plane}) &&
           test(Separation{of_edge, of_face, beside_.corners[1], plane});
  }

 private:
  FlushEntry(const Side& face, const Side& beside) : face_(face), beside_(beside) {}

  /// A plane along edge i of the face, with its normal away from the face, and along the axis that is the nearest to
  /// the face's normal n. With v the edge and s e the way from its first corner to the third of the plane, e the axis
  /// and s of the sign of n . e, (v x s e) . (v x n) = |v|^2 s n . e > 0, as v . n = 0.
  Corners across(std::size_t i) const {
    const Corners& x = face_.corners;
    const Eigen::Vector3d n = normal();
    int axis = 0;
    for (int d = 1; d < 3; ++d) axis = std::abs(n[d]) > std::abs(n[axis]) ? d : axis;
    Corners plane{x[i], x[(i + 1) % 3], x[i]};
    const double far = std::abs(x[i][axis]) + norm(x[1] - x[0]);  // so that it is another double
    plane[2][axis] += n[axis] > 0 ? far : -far;
    return plane;
  }

  Side face_, beside_;
  bool at_edge_ = false, fills_ = false;
  Eigen::Vector3d towards_ = Eigen::Vector3d::Zero();
  Corners other_{};        ///< the other triangle along the edge
  unsigned needless_ = 2;  ///< bits of ways that separate nothing
};

/// Bits of the points of one body that lie in the plane of a triangle of another at all times. `near`: bits of those
/// that may be in it at t.
template <int Degree, class Signs>
unsigned always_in_plane(const typename FlushEntry<Degree>::Side& points,
                         const typename FlushEntry<Degree>::Side& plane, unsigned near, double t, Signs& signs) {
  unsigned in_plane = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(near >> i & 1)) continue;
    const certificates::VertexFaceSeparation<Degree> height{points.motion, plane.motion, points.corners[i],
                                                            plane.corners};
    if (signs.sign_after(height, t) == 0) in_plane |= 1u << i;
  }
  return in_plane;
}

/// The number of the corner that is not among two; -1 unless there are two.
inline int third_corner(unsigned two) { return std::popcount(two) == 2 ? std::countr_zero(~two & 7u) : -1; }

/// Whether a point is on the side of a triangle to which its normal points. Exact.
inline bool is_above(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& point) {
  using certificates::difference_of;
  const auto normal = certificates::cross(difference_of<Exact>(triangle[0], triangle[1]),
                                          difference_of<Exact>(triangle[0], triangle[2]));
  return certificates::dot(normal, difference_of<Exact>(triangle[0], point)).sign() > 0;
}

/// Calls visit(of_face, number, entry) for what may enter where an edge of a triangle is flush with a face, but not all
/// of it in its plane: `of_face`, whether into the solid behind the face or else that of the edge. `near_face`,
/// `near_other`: bits of the corners that may be in the plane of the other triangle at t. across(i): the third corner
/// of the other triangle along edge i, if there is exactly one.
template <int Degree, class Signs, class Across, class Visit>
void every_flush_entry(const typename FlushEntry<Degree>::Side& face, unsigned near_other,
                       const typename FlushEntry<Degree>::Side& other, unsigned near_face, double t, Signs& signs,
                       const Across& across, const Visit& visit) {
  using Entry = FlushEntry<Degree>;
  if (std::popcount(near_face) < 2) return;
  const int third = third_corner(always_in_plane<Degree>(other, face, near_face, t, signs));
  if (third < 0) return;
  const auto k = static_cast<std::size_t>(third);
  const typename Entry::Side beside{other.motion,
                                    {other.corners[(k + 1) % 3], other.corners[(k + 2) % 3], other.corners[k]}};
  const unsigned on_line = always_in_plane<Degree>(face, beside, near_other, t, signs);
  const int off_line = third_corner(on_line);
  if (off_line < 0) visit(true, 0, Entry::through_face(face, beside));
  const std::optional<Eigen::Vector3d> beyond = across((k + 1) % 3);
  if (!beyond) return;
  const bool fills = is_above(beside.corners, *beyond);
  for (std::size_t towards = 0; towards < 3; ++towards) {
    if (on_line >> towards & 1) continue;
    const int along = off_line < 0 ? -1 : (off_line + 1) % 3;
    visit(false, 1 + static_cast<int>(towards), Entry::at_edge(face, beside, *beyond, fills, towards, along));
  }
}

/// Into which of two solids the surface of the other enters.
enum class Into : std::uint8_t { a, b };

/// From when to when the surfaces of two solids enter the other one at flush edges, as far as that is known.
class FlushEntries {
 public:
  /// Which entry it is.
  struct Place {
    NodePair leaves;
    Into into;
    int number;  ///< of those of the pair into this solid
    friend bool operator==(const Place&, const Place&) = default;
  };

  /// Times before `now` are not asked for from now on. There is an entry at all doubles in [from, to), from not before
  /// now; it goes on with one at the same place that lasts beyond `from`. Calls both(t) for the times from which on
  /// there are entries into both solids because of it.
  template <class Both>
  void note(double now, const Place& place, double from, double to, const Both& both) {
    std::erase_if(entries_, [&](const Entry& entry) { return entry.to <= now; });
    const auto same = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
      return entry.place == place && entry.from < from && from < entry.to;
    });
    const double begins = same == entries_.end() ? from : same->from;
    for (const Entry& other : entries_) {
      const double first = std::max(begins, other.from);
      if (other.place.into != place.into && first >= from && first < std::min(to, other.to)) both(first);
    }
    if (same == entries_.end()) {
      entries_.push_back({place, from, to});
    } else {
      same->to = to;
    }
  }

  /// Whether there are entries into both just after t.
  bool both_at(double t) const {
    const auto any = [&](Into into) {
      return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
        return entry.place.into == into && entry.from <= t && t < entry.to;
      });
    };
    return any(Into::a) && any(Into::b);
  }

 private:
  struct Entry {
    Place place;
    double from, to;
  };
  std::vector<Entry> entries_;
};

}  // namespace kds::collision
