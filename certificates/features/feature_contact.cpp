#include "certificates/features/feature_contact.hpp"

#include "certificates/features/closest_point.hpp"
#include "certificates/features/crossing.hpp"
#include "certificates/features/fixed_axis.hpp"
#include "certificates/features/patch_paths.hpp"
#include "certificates/features/turning_axis.hpp"
#include "certificates/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

// All of a query in one function saves a sixth of its time. Sanitizers would make more of that than a compiler can
// take.
#if defined(__SANITIZE_ADDRESS__)
#define KDS_FLATTEN
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define KDS_FLATTEN
#endif
#endif
#ifndef KDS_FLATTEN
#define KDS_FLATTEN [[gnu::flatten]]
#endif

namespace kds::certificates {

namespace {

/// In so many first steps the normal of the patch is the only axis that turns: most queries end before.
constexpr int plane_steps = 5;
/// After so many the direction is extrapolated as well, from the last two steps.
constexpr int extrapolated_steps = 10;
/// A query that has not ended after so many is undecided. At the default tolerance no more than 8 have been seen.
constexpr int most_steps = 256;
/// Least tolerance, as a part of the size: hundreds of margins (fixed_axis.hpp).
constexpr double least_tolerance = 0x1p-38;
/// Products of up to eight coordinates must neither overflow nor underflow: other sizes are scaled.
constexpr double least_size = 0x1p-100;
constexpr double greatest_size = 0x1p100;
/// Units of length: more than is lost where the coefficients of a patch and the bound on their error are no normal
/// numbers, a rounding of 2^-1075 for each power of the duration, and one for the bound.
constexpr double underflow = 0x1p-1072;

template <Patch kind, int Degree>
class Search {
 public:
  /// `paths` makes the paths, in their place.
  template <class Paths>
  Search(const Paths& paths, const ContactTolerance& tolerance, double t0, double t1, double from)
      : paths_(paths()), t0_(t0), t1_(t1), from_(from) {
    // Three roundings, downward: never after the time meant.
    if (from > t0) begin_ = std::min((from - t0) / (t1 - t0) * (1 - 0x1p-50), 1.0);
    if (!(tolerance.thickness >= 0 && tolerance.thickness < std::numeric_limits<double>::infinity())) {
      throw std::invalid_argument("feature contact: the thickness must be finite and >= 0");
    }
    if (paths_.size > 0 && !(paths_.size > least_size && paths_.size < greatest_size)) rescale();
    thickness_ = tolerance.thickness * scale_;
    // Features are never farther apart than twice their size: a greater thickness is as good, and does not overflow.
    if (scale_ != 1 && thickness_ > 4 * paths_.size) thickness_ = 4 * paths_.size;
    margin_ = axis_margin(paths_, thickness_);
    tolerance_ = std::max(std::min(tolerance.absolute * scale_, tolerance.relative * paths_.size),
                          std::max(least_tolerance * (paths_.size + thickness_), 8 * margin_));
    // The points of the patch meant are within sqrt(3) paths.error of those computed, up to a few roundings.
    const double inner = thickness_ + tolerance_ - 5 * margin_;
    inner2_ = inner * inner;
  }

  KDS_FLATTEN FeatureContact run() {
    result_.tolerance = tolerance_ * unscale_;
    if (boxes_apart(paths_, margin_ + thickness_)) return result_;
    double s = begin_;
    for (;; ++result_.steps) {
      const PlacedPatch<kind> patch(paths_.at(s));
      const PatchPoint point = patch.closest();
      if (!(point.squared_distance > inner2_) && touches(patch, point, s)) return result_;
      const double until = free_until(patch, point, s);
      if (until >= 1) return result_;
      if (!(until > s) || result_.steps == most_steps) {
        const auto w = patch.weights(point);
        describe(patch, w, patch.position(w), s, FeatureContactStatus::undecided);
        return result_;
      }
      axis_ = point.position;
      axis_time_ = s;
      s = until;
    }
  }

 private:
  double free_until(const PlacedPatch<kind>& patch, const PatchPoint& point, double s) {
    double until = separated_until(paths_, margin_, thickness_, point.position, s);
    if (until >= 1) return until;
    if (!turning_) turning_.emplace(paths_, thickness_);
    const int steps = result_.steps;
    until = std::max(until,
                     steps < plane_steps ? turning_->separated_by_plane_until(s) : turning_->separated_until(point, s));
    if (steps >= extrapolated_steps && until < 1) {
      until =
          std::max(until, turning_->separated_turning_on(normalized(axis_), axis_time_, normalized(point.position), s));
    }
    if (!(until > s)) {
      for (const auto& axis : patch.careful_axes()) {
        until = std::max(until, separated_until(paths_, margin_, thickness_, axis, s));
      }
    }
    return until;
  }

  bool touches(const PlacedPatch<kind>& patch, const PatchPoint& point, double s) {
    const auto w = patch.weights(point);
    const Eigen::Vector3d p = patch.position(w);
    if (squared_norm(p) > inner2_) return false;
    if (s == begin_) {
      describe(patch, w, p, s, FeatureContactStatus::at_start);
      return true;
    }
    describe(patch, w, p, s, FeatureContactStatus::undecided);
    if (point.part == PatchPart::interior && thickness_ == 0) {
      if (const auto end = Crossing<kind, Degree>(paths_, *turning_, patch, s).until(w)) {
        result_.status = FeatureContactStatus::contact;
        result_.latest = std::min(clock(*end, 1), t1_);
      }
    }
    return true;
  }

  void describe(const PlacedPatch<kind>& patch, const std::array<double, 4>& w, const Eigen::Vector3d& p, double s,
                FeatureContactStatus status) {
    result_.status = status;
    result_.time = s > begin_ ? std::max(clock(s, -1), from_) : from_;
    // While the clock is rounded (see clock()) a corner moves on: by sqrt(3) 2 size a unit of s at most.
    const double rounding = s > 0 ? 0x1p-50 * (std::abs(result_.time) / (t1_ - t0_) + s) : 0;
    const double distance = norm(p);
    result_.distance = (distance + 3 * margin_ + 4 * paths_.size * rounding) * unscale_;
    if constexpr (kind == Patch::triangle) {
      result_.weights = {1, w[0] + w[3], w[1], w[2]};
    } else {
      result_.weights = {w[0] + w[3], w[1] + w[2], w[0] + w[1], w[2] + w[3]};
    }
    result_.normal = distance > 64 * margin_ ? Eigen::Vector3d(p / distance) : normal(patch, s);
  }

  /// The way from the one feature to the other, where it is longer than its error; else the last axis that separated
  /// them; else, at the start, the normal of the patch, against its motion; else any.
  Eigen::Vector3d normal(const PlacedPatch<kind>& patch, double s) const {
    if (squared_norm(axis_) > 0) return normalized(axis_);
    Eigen::Vector3d n = patch.normal();
    const Corners v = paths_.velocity(s);
    const Eigen::Vector3d velocity = detail::weighted(v, {0.25, 0.25, 0.25, 0.25});
    if (!(squared_norm(n) > 0)) n = -velocity;
    if (!(squared_norm(n) > 0)) return Eigen::Vector3d::UnitZ();
    return normalized(dot(n, velocity) > 0 ? -n : n);
  }

  /// The time at s, rounded down or up by more than all its roundings: those of the duration, the product and the sum.
  double clock(double s, double direction) const {
    const double elapsed = s * (t1_ - t0_);
    const double t = t0_ + elapsed;
    return t + direction * 0x1p-51 * (std::abs(t) + elapsed);
  }

  void rescale() {
    const int exponent = -std::ilogb(paths_.size);
    scale_ = std::ldexp(1.0, std::clamp(exponent, -1000, 1000));
    unscale_ = 1 / scale_;
    for (auto& c : paths_.c) {
      for (auto& lanes : c) lanes = lanes * Lanes(scale_);
    }
    paths_.size *= scale_;
    paths_.error = (paths_.error + underflow) * scale_;
  }

  PatchPaths<Degree> paths_;
  std::optional<TurningAxis<kind, Degree>> turning_;  // once a fixed axis has failed: before any s > 0
  double t0_;
  double t1_;
  double from_;
  double begin_ = 0;  // s at that time
  double scale_ = 1;  // a power of two
  double unscale_ = 1;
  double thickness_;
  double margin_;
  double tolerance_;
  double inner2_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();  // the last one that separated, and when it was taken
  double axis_time_ = 0;
  FeatureContact result_;
};

template <Patch kind, int Degree>
FeatureContact search(const std::array<const PointMotion<Degree>*, 4>& points, double t0, double t1,
                      const ContactTolerance& tolerance) {
  const auto paths = [&] { return patch_paths<kind, Degree>(points, t0, t1); };
  return Search<kind, Degree>(paths, tolerance, t0, t1, t0).run();
}

template <Patch kind, int Degree>
FeatureContact search(const ControlPoints<Degree>& control, double t0, double t1, double from,
                      const ContactTolerance& tolerance) {
  return Search<kind, Degree>([&] { return patch_paths<kind, Degree>(control); }, tolerance, t0, t1, from).run();
}

}  // namespace

template <int Degree>
FeatureContact vertex_face_contact(const PointMotion<Degree>& vertex, const PointMotion<Degree>& a,
                                   const PointMotion<Degree>& b, const PointMotion<Degree>& c, double t0, double t1,
                                   const ContactTolerance& tolerance) {
  return search<Patch::triangle, Degree>({&vertex, &a, &b, &c}, t0, t1, tolerance);
}

template <int Degree>
FeatureContact edge_edge_contact(const PointMotion<Degree>& a, const PointMotion<Degree>& b,
                                 const PointMotion<Degree>& c, const PointMotion<Degree>& d, double t0, double t1,
                                 const ContactTolerance& tolerance) {
  return search<Patch::parallelogram, Degree>({&a, &b, &c, &d}, t0, t1, tolerance);
}

template <int Degree>
FeatureContact vertex_face_contact(const ControlPoints<Degree>& control, double t0, double t1, double from,
                                   const ContactTolerance& tolerance) {
  return search<Patch::triangle, Degree>(control, t0, t1, from, tolerance);
}

template <int Degree>
FeatureContact edge_edge_contact(const ControlPoints<Degree>& control, double t0, double t1, double from,
                                 const ContactTolerance& tolerance) {
  return search<Patch::parallelogram, Degree>(control, t0, t1, from, tolerance);
}

FeatureContact vertex_face_contact(const std::array<Eigen::Vector3d, 4>& begin,
                                   const std::array<Eigen::Vector3d, 4>& end, const ContactTolerance& tolerance) {
  return vertex_face_contact<1>({begin, end}, 0, 1, 0, tolerance);
}

FeatureContact edge_edge_contact(const std::array<Eigen::Vector3d, 4>& begin, const std::array<Eigen::Vector3d, 4>& end,
                                 const ContactTolerance& tolerance) {
  return edge_edge_contact<1>({begin, end}, 0, 1, 0, tolerance);
}

#define KDS_INSTANTIATE(name, degree)                                                                              \
  template FeatureContact name(const PointMotion<degree>&, const PointMotion<degree>&, const PointMotion<degree>&, \
                               const PointMotion<degree>&, double, double, const ContactTolerance&);               \
  template FeatureContact name<degree>(const ControlPoints<degree>&, double, double, double, const ContactTolerance&);
KDS_INSTANTIATE(vertex_face_contact, 1)
KDS_INSTANTIATE(vertex_face_contact, 2)
KDS_INSTANTIATE(edge_edge_contact, 1)
KDS_INSTANTIATE(edge_edge_contact, 2)
#undef KDS_INSTANTIATE

}  // namespace kds::certificates

#undef KDS_FLATTEN
