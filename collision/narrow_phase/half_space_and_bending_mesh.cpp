#include "collision/narrow_phase/half_space_and_bending_mesh.hpp"

#include "collision/body_motion.hpp"
#include "collision/motions.hpp"
#include "collision/narrow_phase/half_space_of.hpp"
#include "collision/narrow_phase/kept_rotation.hpp"
#include "collision/narrow_phase/piece_surface.hpp"
#include "collision/narrow_phase/touch_spans.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/vectors.hpp"
#include "kds/polynomial.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// The first x in [from, end] at which a polynomial is not positive, or `never`; rounded.
template <int Degree>
double first_not_positive(const Polynomial<Degree>& p, double from, double end) {
  const double c = p(from);
  if (!(c > 0)) return from;
  const double b = derivative(p)(from);
  double a = 0;
  if constexpr (Degree == 2) a = p.c[2];
  double wait = never;
  const double discriminant = b * b - 4 * a * c;
  if (discriminant >= 0) {
    const double root = std::sqrt(discriminant);
    if (b < 0) {
      wait = 2 * c / (root - b);
    } else if (a < 0) {
      wait = (root + b) / (-2 * a);
    }
  }
  return from + wait <= end ? from + wait : never;
}

/// The heights of vertices above a plane in a piece of time: each a polynomial of the time since the piece began. A
/// vertex touches while it is no higher than the tolerance, and what its height may be off; it goes on to until it is
/// higher by a third of that.
template <int Degree>
class Heights {
 public:
  using Height = Polynomial<Degree>;
  struct Touch {
    Contact contact;  ///< its time alone
  };

  Heights(double begin, double end, double tolerance) : begin_(begin), length_(end - begin), tolerance_(tolerance) {}

  /// `terms`: of what size the numbers are of which each coefficient is the sum.
  void add(const Height& height, const Height& terms) {
    // Some tens of roundings, which grow with time as the terms do; and an eighth of the tolerance, far more than
    // roundings of roots are worth in height.
    Height above = height - terms * 0x1p-46;
    above.c[0] -= 1.125 * tolerance_;
    heights_.push_back({height, above});
  }

  bool touches(double t) const {
    return std::any_of(heights_.begin(), heights_.end(), [&](const auto& v) { return is_near(v, t - begin_); });
  }

  /// The first time from a time on at which a vertex touches: never late.
  std::optional<Touch> first_touch(double from) const {
    double first = never;
    for (const auto& v : heights_) first = std::min(first, first_not_positive(v.above, from - begin_, length_));
    if (first == never) return std::nullopt;
    return Touch{{.time = std::max(from, next_down(begin_ + first))}};
  }

  /// The first time from t on at which none touches, or `never`. Precondition: they touch at t.
  double parts_at(double t) const {
    for (double x = t - begin_; x < length_;) {
      double until = -1;
      for (const auto& v : heights_) {
        if (!is_near(v, x)) continue;
        Height room = -v.above;
        room.c[0] += 0.375 * tolerance_;
        until = std::max(until, first_not_positive(room, x, length_));
      }
      if (until < 0) return std::max(begin_ + x, t);
      x = std::max(until, next_up(x));
    }
    return never;
  }

  std::size_t lowest(double t) const {
    const auto lower = [x = t - begin_](const auto& v, const auto& w) { return v.height(x) < w.height(x); };
    return static_cast<std::size_t>(std::min_element(heights_.begin(), heights_.end(), lower) - heights_.begin());
  }

 private:
  struct OfVertex {
    Height height;
    Height above;  ///< not positive: it touches
  };
  /// Also just before a time that first_touch() has told.
  bool is_near(const OfVertex& v, double x) const { return v.above(x) <= 0.125 * tolerance_; }

  double begin_, length_, tolerance_;
  std::vector<OfVertex> heights_;
};

/// A half-space and a mesh over one piece after the other: a course, for touch_after(). Pieces are from keyframe to
/// keyframe; the last has no end.
template <class Motion>
class PlaneAndMesh {
 public:
  using Body = MovingShape<Motion>;
  static constexpr int degree = Motion::degree;
  struct Piece {
    double begin, end;
  };

  PlaneAndMesh(const Body& plane, const Body& mesh)
      : plane_(plane),
        mesh_(mesh),
        half_space_(half_space_of(plane.shape, plane.motion)),
        rotation_(kept_rotation(mesh.shape, mesh.motion)),
        start_(std::max(path_of(plane.motion).start, path_of(mesh.motion).start)) {}

  double first_begin(double t) const { return std::max(t, start_); }
  Piece piece(double t) const {
    const auto keyframes = script().keyframes();
    const std::size_t next = script().keyframes_until(t);
    return {next == 0 ? start_ : std::max(start_, keyframes[next - 1].time),
            next < keyframes.size() ? keyframes[next].time : never};
  }
  bool over(double) const { return false; }
  /// When the ball around the mesh reaches the plane.
  double near(double t) const {
    const PlacedShape ball = placed_ball(mesh_.shape.bounding_radius * (1 + 0x1p-20));
    const PlacedShape plane = placed_plane(plane_.shape, plane_.motion);
    using Still = TranslatingShape<degree>;
    return collision::first_contact(Still{plane, path_of(plane_.motion)}, Still{ball, path_of(mesh_.motion)}, t, never,
                                    ContactMode::transparent);
  }
  const Heights<degree>& touching(double t0, double t1) { return heights_.emplace(heights(t0, t1)); }
  auto first_contact(double from) const { return heights_->first_touch(from); }

  Contact contact_at(double t) {
    const auto [begin, end] = piece(t);
    const auto vertex = static_cast<std::uint32_t>(heights(begin, end).lowest(t));
    Contact contact;
    contact.time = t;
    contact.normal = normalized(half_space_.normal);
    contact.feature_b = Feature::vertex(vertex);
    contact.point = path_of(mesh_.motion).position(t) + placed_vertex(rotation_, 1, script().position(vertex, t));
    return contact;
  }

 private:
  const MeshScript& script() const { return *script_of(mesh_.shape.shape); }

  Heights<degree> heights(double t0, double t1) const {
    const auto plane = path_of(plane_.motion).restarted(t0), mesh = path_of(mesh_.motion).restarted(t0);
    const Vector3d& n = half_space_.normal;
    Polynomial<degree> centre{}, of_centre{};
    for (std::size_t i = 0; i <= degree; ++i) {
      centre.c[i] = dot(n, mesh.coefficients[i] - plane.coefficients[i]);
      of_centre.c[i] = norm(mesh.coefficients[i]) + norm(plane.coefficients[i]);
    }
    centre.c[0] -= half_space_.offset;
    of_centre.c[0] += std::abs(half_space_.offset);
    // What restarted() rounds is a part of the terms that it adds up.
    for (const auto* path : {&path_of(plane_.motion), &path_of(mesh_.motion)}) {
      double terms = 0;
      for (std::size_t i = degree + 1; i-- > 0;) terms = terms * (t0 - path->start) + norm(path->coefficients[i]);
      of_centre.c[0] += terms;
    }
    Heights<degree> result(t0, t1, bending_tolerance * script().bounding_radius());
    for (std::size_t v = 0; v < script().vertices(); ++v) {
      const Vector3d offset = placed_vertex(rotation_, 1, script().position(v, t0));
      const Vector3d rate = placed_vertex(rotation_, 1, script().velocity(v, t0));
      Polynomial<degree> height = centre, terms = of_centre;
      height.c[0] += dot(n, offset), terms.c[0] += norm(offset);
      height.c[1] += dot(n, rate), terms.c[1] += norm(rate);
      result.add(height, terms);
    }
    return result;
  }

  const Body& plane_;
  const Body& mesh_;
  HalfSpace half_space_;
  Eigen::Matrix3d rotation_;
  double start_;
  std::optional<Heights<degree>> heights_;
};

}  // namespace

/// Both are driven, or the mesh is a sensor: whatever the mode, nothing turns them back.
template <class Motion>
double HalfSpaceAndBendingMesh<Motion>::first_contact(const Body& a, const Body& b, double t0, double horizon,
                                                      ContactMode, FoundTouch*) {
  PlaneAndMesh<Motion> pair(a, b);
  return first_touch(pair, t0, horizon);
}

template <class Motion>
double HalfSpaceAndBendingMesh<Motion>::apart_until(const Body& a, const Body& b, double t0, double horizon,
                                                    PairMemory&) {
  return t0 <= horizon ? PlaneAndMesh<Motion>(a, b).near(t0) : never;
}

template <class Motion>
bool HalfSpaceAndBendingMesh<Motion>::in_contact(const Body& a, const Body& b, double t) {
  PlaneAndMesh<Motion> pair(a, b);
  return touch_at(pair, t);
}

template <class Motion>
double HalfSpaceAndBendingMesh<Motion>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  PlaneAndMesh<Motion> pair(a, b);
  return first_apart(pair, t0, horizon);
}

template <class Motion>
Contact HalfSpaceAndBendingMesh<Motion>::contact_at(const Body& a, const Body& b, double t, const FoundTouch&) {
  return PlaneAndMesh<Motion>(a, b).contact_at(t);
}

#define KDS_INSTANTIATE(motion) template struct HalfSpaceAndBendingMesh<motion>;
KDS_FOR_EACH_QUADRATIC(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
