#include "collision/narrow_phase/bending_contact.hpp"

#include "certificates/ball_separation.hpp"
#include "collision/deforming/rigid_surface.hpp"
#include "collision/deforming/surface_contact.hpp"
#include "collision/deforming/surface_touching.hpp"
#include "collision/narrow_phase/bending_pieces.hpp"
#include "collision/narrow_phase/touch_spans.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

namespace kds::collision {
namespace {

template <int Degree>
using Body = TranslatingShape<Degree>;

const MeshScript* script_of(const PlacedShape& shape) {
  const auto* const bending = std::get_if<BendingMesh>(&shape.shape);
  return bending ? bending->script.get() : nullptr;
}

/// The surface of one of the two, over one piece after the other.
template <int Degree>
class PieceSurface {
 public:
  explicit PieceSurface(const Body<Degree>& body) : body_(body), script_(script_of(body.shape)) {
    if (script_) {
      bent_.emplace(script_->tree());
    } else {
      rigid_.emplace(body.shape);
    }
  }

  const MovingSurface<Degree>& over(double t0, double t1) {
    if (rigid_) {
      rigid_->move(body_.motion, t0, t1);
      return rigid_->surface();
    }
    const PathControls<Degree> path(body_.motion, t0, t1);
    double farthest = 0;
    for (std::size_t i = 0; i <= Degree; ++i) {
      const auto points = bent_->change_control_points(i);
      for (std::size_t v = 0; v < points.size(); ++v) {
        points[v] = path.points[i] + placed_vertex(body_.shape.rotation, 1, offset(v, i, t0, t1));
        farthest = std::max(farthest, points[v].cwiseAbs().maxCoeff());
      }
    }
    // Roundings: three of a position between keyframes or of an average, five of its turn, one of the sum.
    bent_->set_uncertainty(path.error + 0x1p-49 * (farthest + script_->bounding_radius()));
    bent_->refit(t0, t1);
    return *bent_;
  }

 private:
  /// Control point i of a vertex, on its straight way, about the centre.
  Eigen::Vector3d offset(std::size_t v, std::size_t i, double t0, double t1) const {
    if (i == 0) return script_->position(v, t0);
    if (i == Degree) return script_->position(v, t1);
    return 0.5 * (script_->position(v, t0) + script_->position(v, t1));
  }

  const Body<Degree>& body_;
  const MeshScript* script_;
  std::optional<RigidSurface<Degree>> rigid_;
  std::optional<MovingSurface<Degree>> bent_;
};

/// Of the radius of the mesh: in a piece the two go no farther than this. Half of the tolerance is then several times
/// 2^-38 of the size of a query, the least that counts (ContactTolerance).
constexpr double longest_way = 0x1p8;

template <int Degree>
class BendingPair {
 public:
  BendingPair(const Body<Degree>& a, const Body<Degree>& b)
      : a_(a),
        b_(b),
        pieces_(a.motion, b.motion, keyframes_of(a, b), std::min(a.shape.bounding_radius, b.shape.bounding_radius),
                longest_way * script_of(a.shape)->bounding_radius()) {
    const double radius = script_of(a.shape)->bounding_radius();
    query_ = {.tolerance = 1, .absolute_tolerance = bending_tolerance * radius, .overlaps = false};
  }

  // A course, for touch_after().
  /// A time in the piece with which a search from t on begins.
  double first_begin(double t) const {
    return pieces_.together() && t > pieces_.last() ? pieces_.last() : std::max(t, pieces_.start());
  }
  auto piece(double t) const { return pieces_.at(t); }
  bool over(double begin) const { return pieces_.together() && begin > pieces_.last(); }
  double near(double t) const { return balls_meet(t); }
  SurfaceTouching<Degree> touching(double t0, double t1) {
    a_over_ = &surface_a().over(t0, t1);
    b_over_ = &surface_b().over(t0, t1);
    return SurfaceTouching<Degree>(*a_over_, *b_over_, query_);
  }
  std::optional<SurfaceContact> first_contact(double from) const {
    SurfaceQuery query = query_;
    query.from = from;
    return collision::first_contact(*a_over_, *b_over_, query);
  }

  /// Searches of one piece, each until all has parted that is near at its begin. At a late clock, with coarse doubles,
  /// surfaces part and meet by roundings alone, double by double: after so many searches each covers at least twice the
  /// time of the one before. Larger takes longer there; smaller may, before the time that is asked about, take two
  /// contacts for one, and after it resolve a contact of what is still near.
  static constexpr int most_searches = 64;

  /// The first contact that has to be resolved, in [t, horizon].
  double meeting_after(double t, double horizon) {
    SurfaceQuery query = query_;
    query.approaching = true;
    for (double begin = first_begin(t); begin <= horizon;) {
      const auto [w0, w1] = pieces_.at(begin);
      if (!(begin < w1) || over(w0)) break;
      const double near = balls_meet(w0);
      if (near > horizon || near == never) break;
      begin = near > w1 ? near : w1;
      if (near > w1) continue;
      const SurfaceTouching<Degree> touching = this->touching(w0, w1);
      double stride = 0;
      int searches = 0;
      for (double now = w0; now < w1;) {
        if (++searches > most_searches) stride = std::max(2 * stride, next_up(now) - now);
        // What is near stays below the levels of those that come from outside until all have parted.
        const double parts = touching.touches(now) ? std::min(touching.parts_at(now), w1) : w1;
        query.from = now;
        query.until = std::max(parts, std::min(now + stride, w1));
        const auto contact = collision::first_contact(*a_over_, *b_over_, query);
        const double time = contact ? contact->contact.time : never;
        if (time < w1 && time >= t) return time <= horizon ? time : never;
        // One before t was passed over, and they go through each other.
        now = !contact ? query.until : time < w1 ? std::max(touching.parts_at(time), next_up(time)) : w1;
        now = std::max(now, std::min(query.from + stride, t));
      }
    }
    return never;
  }

  Contact contact_at(double t) {
    const auto [w0, w1] = pieces_.at(t);
    const SurfaceTouching<Degree> touching = this->touching(w0, w1);
    // What has just parted is a little farther apart; what touches in no piece may be asked about, too.
    const double farthest =
        4 * (a_.shape.bounding_radius + b_.shape.bounding_radius + norm(b_.motion.position(t) - a_.motion.position(t)));
    for (double distance = 4 * query_.absolute_tolerance;; distance *= 64) {
      if (const auto found = touching.closest(t, distance)) {
        Contact contact = found->contact;
        contact.time = t;
        if (const auto* const hull = std::get_if<ConvexHull>(&b_.shape.shape)) {
          contact.feature_b = hull->polytope->feature_of(contact.feature_b);
        }
        return contact;
      }
      if (distance > farthest) throw std::logic_error("BendingContact: two surfaces without features");
    }
  }

  /// When the balls around the two overlap next.
  double balls_meet(double t) const {
    const auto ball = [](double radius) { return radius * (1 + 0x1p-20); };
    const double of_a = ball(a_.shape.bounding_radius), of_b = ball(b_.shape.bounding_radius);
    const PlacedShape ball_a = placed_ball(of_a), ball_b = placed_ball(of_b);
    return collision::first_contact(Body<Degree>{ball_a, a_.motion}, Body<Degree>{ball_b, b_.motion}, t, never,
                                    ContactMode::transparent);
  }

 private:
  static std::vector<double> keyframes_of(const Body<Degree>& a, const Body<Degree>& b) {
    std::vector<double> times;
    for (const MeshScript* const script : {script_of(a.shape), script_of(b.shape)}) {
      if (!script) continue;
      for (const auto& keyframe : script->keyframes()) times.push_back(keyframe.time);
    }
    return times;
  }
  PieceSurface<Degree>& surface_a() { return made(surface_a_, a_); }
  PieceSurface<Degree>& surface_b() { return made(surface_b_, b_); }
  static PieceSurface<Degree>& made(std::optional<PieceSurface<Degree>>& surface, const Body<Degree>& body) {
    if (!surface) surface.emplace(body);
    return *surface;
  }

  const Body<Degree>& a_;
  const Body<Degree>& b_;
  BendingPieces<Degree> pieces_;
  SurfaceQuery query_;
  std::optional<PieceSurface<Degree>> surface_a_, surface_b_;
  const MovingSurface<Degree>* a_over_ = nullptr;  ///< as they are in the piece that is looked at
  const MovingSurface<Degree>* b_over_ = nullptr;
};

}  // namespace

template <int Degree>
double BendingContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                                             FoundTouch*) {
  if (!(t0 <= horizon)) return never;
  BendingPair<Degree> pair(a, b);
  if (mode == ContactMode::resolved) return pair.meeting_after(t0, horizon);
  const double begin = touch_after(pair, t0, horizon, false).begin;
  return begin <= horizon ? std::max(begin, t0) : never;
}

template <int Degree>
double BendingContact<Degree>::apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&) {
  if (!(t0 <= horizon)) return never;
  return BendingPair<Degree>(a, b).balls_meet(t0);
}

template <int Degree>
bool BendingContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  BendingPair<Degree> pair(a, b);
  return touch_after(pair, t, t, false).begin <= t;
}

template <int Degree>
double BendingContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  if (!(t0 <= horizon)) return never;
  BendingPair<Degree> pair(a, b);
  const TouchSpan touch = touch_after(pair, t0, horizon, true);
  if (!(touch.begin <= t0)) return t0;
  return touch.end <= horizon ? touch.end : never;
}

template <int Degree>
Contact BendingContact<Degree>::contact_at(const Body& a, const Body& b, double t, const FoundTouch&) {
  return BendingPair<Degree>(a, b).contact_at(t);
}

template struct BendingContact<1>;
template struct BendingContact<2>;

namespace {

/// The weights of the corners of a triangle that make up a point of it.
std::array<double, 3> weights_in(const std::array<Eigen::Vector3d, 3>& corner, const Eigen::Vector3d& point) {
  const Eigen::Vector3d u = corner[1] - corner[0], v = corner[2] - corner[0], on = point - corner[0];
  const Eigen::Vector3d n = cross(u, v);
  const double area = squared_norm(n);
  if (!(area > 0)) return {1.0 / 3, 1.0 / 3, 1.0 / 3};
  const double wb = std::clamp(dot(n, cross(on, v)) / area, 0.0, 1.0);
  const double wc = std::clamp(dot(n, cross(u, on)) / area, 0.0, 1 - wb);
  return {1 - wb - wc, wb, wc};
}

}  // namespace

SurfaceRate surface_rate(const PlacedShape& shape, const Feature& feature, const Eigen::Vector3d& point,
                         const Eigen::Vector3d& normal, double t) {
  const MeshScript* const script = script_of(shape);
  if (!script || feature.kind == Feature::Kind::none) return {};
  const auto place = [&](std::size_t v) { return placed_vertex(shape.rotation, 1, script->position(v, t)); };
  const auto velocity = [&](std::size_t v) { return placed_vertex(shape.rotation, 1, script->velocity(v, t)); };
  if (feature.kind == Feature::Kind::vertex) return {velocity(feature.first), Eigen::Vector3d::Zero()};
  if (feature.kind == Feature::Kind::edge) {
    const Eigen::Vector3d a = place(feature.first), along = place(feature.second) - a;
    const Eigen::Vector3d of_a = velocity(feature.first), turns = velocity(feature.second) - of_a;
    const double squared = squared_norm(along);
    if (!(squared > 0)) return {of_a, Eigen::Vector3d::Zero()};
    const double part = std::clamp(dot(point - a, along) / squared, 0.0, 1.0);
    return {of_a + part * turns, -(dot(normal, turns) / squared) * along};  // it stays across the edge
  }
  const Mesh::Triangle& face = script->triangles()[feature.first];
  const std::array<Eigen::Vector3d, 3> p{place(face[0]), place(face[1]), place(face[2])};
  const std::array<Eigen::Vector3d, 3> rate{velocity(face[0]), velocity(face[1]), velocity(face[2])};
  const auto w = weights_in(p, point);
  const Eigen::Vector3d u = p[1] - p[0], v = p[2] - p[0];
  const Eigen::Vector3d across = cross(u, v);
  const Eigen::Vector3d turns = cross(rate[1] - rate[0], v) + cross(u, rate[2] - rate[0]);
  SurfaceRate result{w[0] * rate[0] + w[1] * rate[1] + w[2] * rate[2], Eigen::Vector3d::Zero()};
  const double squared = squared_norm(across);
  if (!(squared > 0)) return result;
  const Eigen::Vector3d unit_turns = (turns - (dot(across, turns) / squared) * across) / std::sqrt(squared);
  result.normal_rate = dot(across, normal) < 0 ? Eigen::Vector3d(-unit_turns) : unit_turns;
  return result;
}

}  // namespace kds::collision
