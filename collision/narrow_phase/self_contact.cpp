#include "collision/narrow_phase/self_contact.hpp"

#include "collision/deforming/surface_contact.hpp"
#include "collision/deforming/surface_touching.hpp"
#include "collision/narrow_phase/touch_spans.hpp"
#include "collision/shapes/bending_mesh.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace kds::collision {
namespace {

/// The surface from keyframe to keyframe, whose positions are exact.
class Course {
 public:
  explicit Course(const MeshScript& script) : script_(script), surface_(script.tree()) {
    const double tolerance = bending_tolerance * script.bounding_radius();
    query_ = {.tolerance = 1, .absolute_tolerance = tolerance, .overlaps = false};
  }

  struct Piece {
    double begin, end;
  };

  double first_begin(double t) const { return t; }
  /// It stands still before the first keyframe, for which the second before that stands, and after the last.
  Piece piece(double t) const {
    const auto keyframes = script_.keyframes();
    const std::size_t next = script_.keyframes_until(t);
    if (next == keyframes.size()) return {keyframes.back().time, std::max(keyframes.back().time, t) + 1};
    return {next == 0 ? std::min(t, keyframes[0].time - 1) : keyframes[next - 1].time, keyframes[next].time};
  }
  bool over(double) {
    const bool was_over = last_;
    return was_over;
  }
  double near(double t) const { return t; }

  SurfaceTouching<1> touching(double t0, double t1) {
    for (const std::size_t i : {0, 1}) {
      const double t = i == 0 ? t0 : t1;
      const auto points = surface_.change_control_points(i);
      for (std::size_t v = 0; v < points.size(); ++v) points[v] = script_.position(v, t);
    }
    surface_.refit(t0, t1);
    last_ = t0 >= script_.keyframes().back().time;
    return SurfaceTouching<1>(surface_, query_);
  }
  std::optional<SurfaceContact> first_contact(double from) const {
    SurfaceQuery query = query_;
    query.from = from;
    return collision::first_self_contact(surface_, query);
  }

  double tolerance() const { return query_.absolute_tolerance; }

 private:
  const MeshScript& script_;
  MovingSurface<1> surface_;
  SurfaceQuery query_;
  bool last_ = false;  ///< nothing changes after the piece that was looked at
};

}  // namespace

double first_self_contact(const MeshScript& script, double t0, double horizon) {
  Course course(script);
  return first_touch(course, t0, horizon);
}

bool in_self_contact(const MeshScript& script, double t) {
  Course course(script);
  return touch_at(course, t);
}

double first_self_separation(const MeshScript& script, double t0, double horizon) {
  Course course(script);
  return first_apart(course, t0, horizon);
}

Contact self_contact_at(const MeshScript& script, double t) {
  Course course(script);
  const auto [w0, w1] = course.piece(t);
  const auto touching = course.touching(w0, w1);
  for (double distance = 4 * course.tolerance();; distance *= 64) {
    if (const auto found = touching.closest(t, distance)) {
      Contact contact = found->contact;
      contact.time = t;
      return contact;
    }
    if (distance > 8 * script.bounding_radius()) throw std::logic_error("self_contact_at: a mesh of one feature");
  }
}

}  // namespace kds::collision
