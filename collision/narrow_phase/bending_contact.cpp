#include "collision/narrow_phase/bending_contact.hpp"

#include "collision/deforming/surface_contact.hpp"
#include "collision/deforming/surface_touching.hpp"
#include "collision/motions.hpp"
#include "collision/narrow_phase/bending_pieces.hpp"
#include "collision/narrow_phase/equal_parts.hpp"
#include "collision/narrow_phase/piece_surface.hpp"
#include "collision/narrow_phase/touch_spans.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

namespace kds::collision {
namespace {

/// Of the radius of the mesh: in a piece the two go no farther than this. Half of the tolerance is then several times
/// 2^-38 of the size of a query, the least that counts (ContactTolerance).
constexpr double longest_way = 0x1p8;

/// Of the tolerance: what the paths of points that turn are off, at most, in the parts of a piece. Smaller takes more
/// parts, larger reports contacts earlier.
constexpr double turning_error = 0x1p-4;

/// Two bodies of which the first bends. What turns is looked at in parts of the pieces, some 300 a radian where it is
/// as large as the mesh; that nothing is near is proved for as many of these at a time as can be.
template <class Motion>
class BendingPair {
 public:
  using Body = MovingShape<Motion>;
  using Piece = typename BendingPieces<Motion::degree>::Piece;
  static constexpr int degree = PieceSurface<Motion>::degree;
  using Touching = SurfaceTouching<degree>;

  /// Nothing after the horizon is asked for.
  BendingPair(const Body& a, const Body& b, double horizon)
      : a_(a),
        b_(b),
        horizon_(horizon),
        tolerance_(bending_tolerance * script_of(a.shape.shape)->bounding_radius()),
        pieces_(path_of(a.motion), path_of(b.motion), turning_speed(a) + turning_speed(b), keyframes_of(a, b),
                std::min(a.shape.bounding_radius, b.shape.bounding_radius),
                longest_way * script_of(a.shape.shape)->bounding_radius()) {
    query_ = {.tolerance = 1, .absolute_tolerance = tolerance_, .overlaps = false};
    if (turning_speed(b) > 0) longest_ = surface_b().longest_piece(turning_error * tolerance_);
  }

  // A course, for touch_after().
  /// A time in the piece with which a search from t on begins.
  double first_begin(double t) const {
    return pieces_.together() && t > pieces_.last() ? pieces_.last() : std::max(t, pieces_.start());
  }
  Piece piece(double t) const {
    const Piece whole = pieces_.at(t);
    if (longest_ == never || !(whole.begin < whole.end)) return whole;
    const EqualParts parts(whole.begin, whole.end, longest_);
    const auto i = parts.at(t);
    return {parts.bound(i), parts.bound(i + 1)};
  }
  bool over(double begin) const { return pieces_.together() && begin > pieces_.last(); }
  double near(double t) {
    const double meet = balls_meet(t);
    return longest_ == never || meet == never ? meet : apart_until(std::max(t, meet));
  }
  Touching touching(double t0, double t1) {
    a_over_ = &surface_a().over(t0, t1);
    b_over_ = &surface_b().over(t0, t1);
    return Touching(*a_over_, *b_over_, query_);
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
      const auto [w0, w1] = piece(begin);
      if (!(begin < w1) || over(w0)) break;
      const double near = this->near(w0);
      if (near > horizon || near == never) break;
      begin = near > w1 ? near : w1;
      if (near > w1) continue;
      const Touching touching = this->touching(w0, w1);
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
        // A contact before t has been left unresolved, so the two pass through each other: the search goes on when they
        // have parted.
        now = !contact ? query.until : time < w1 ? std::max(touching.parts_at(time), next_up(time)) : w1;
        now = std::max(now, std::min(query.from + stride, t));
      }
    }
    return never;
  }

  Contact contact_at(double t) {
    const auto [w0, w1] = piece(t);
    const Touching touching = this->touching(w0, w1);
    // What has just parted is a little farther apart; what touches in no piece may be asked about, too.
    const double farthest = 4 * (a_.shape.bounding_radius + b_.shape.bounding_radius +
                                 norm(path_of(b_.motion).position(t) - path_of(a_.motion).position(t)));
    for (double distance = 4 * query_.absolute_tolerance;; distance *= 64) {
      if (const auto found = touching.closest(t, distance)) {
        Contact contact = found->contact;
        contact.time = t;
        if (const Polytope* const hull = polytope_of(b_.shape.shape)) {
          contact.feature_b = hull->feature_of(contact.feature_b);
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
    using Ball = TranslatingShape<Motion::degree>;
    return collision::first_contact(Ball{ball_a, path_of(a_.motion)}, Ball{ball_b, path_of(b_.motion)}, t, never,
                                    ContactMode::transparent);
  }

 private:
  /// How fast a point of a body goes, at most, because it turns.
  static double turning_speed(const Body& body) {
    if constexpr (turns<Motion>) {
      const bool counts = !bends(body.shape.shape) && ball_radius(body.shape.shape) == 0;
      return counts ? turning_rate(body.motion) * body.shape.bounding_radius : 0;
    }
    return 0;
  }

  /// A time from t on before which nothing touches; the begin of a part, when the balls around the two overlap next, or
  /// later than the horizon. Many parts are looked at as one, with coarser paths, as long as that is enough.
  double apart_until(double t) {
    constexpr double coarsest = 256;  // times as long as a part: there paths are off by 2^-6 of the mesh
    std::uint64_t most = 1;
    while (t <= horizon_) {
      const Piece whole = pieces_.at(t);
      if (!(t < whole.end)) return t;
      const EqualParts parts(whole.begin, whole.end, longest_);
      for (std::uint64_t i = parts.at(t); i < parts.count();) {
        const std::uint64_t count = std::min(most, parts.count() - i);
        const double touch = touch_within(parts.bound(i), parts.bound(i + count));
        if (touch == never) {
          i += count;
          if (static_cast<double>(most) < coarsest) most *= 2;
        } else if (count == 1) {
          return std::max(t, parts.bound(i));
        } else {
          i = std::max(i, parts.at(touch));
          most = count / 2;
        }
      }
      t = whole.end;
      if (const double meet = balls_meet(t); meet > t) return meet;
    }
    return t;
  }
  /// Before it nothing of the two is within twice the tolerance; or `never`, if that holds for all of [t0, t1].
  double touch_within(double t0, double t1) {
    const auto& a = surface_a().over(t0, t1, tolerance_);
    const auto& b = surface_b().over(t0, t1, tolerance_);
    const auto contact = collision::first_contact(a, b, {.tolerance = 1, .absolute_tolerance = tolerance_});
    return contact ? contact->contact.time : never;
  }

  static std::vector<double> keyframes_of(const Body& a, const Body& b) {
    std::vector<double> times;
    for (const MeshScript* const script : {script_of(a.shape.shape), script_of(b.shape.shape)}) {
      if (!script) continue;
      for (const auto& keyframe : script->keyframes()) times.push_back(keyframe.time);
    }
    return times;
  }
  PieceSurface<Motion>& surface_a() { return made(surface_a_, a_); }
  PieceSurface<Motion>& surface_b() { return made(surface_b_, b_); }
  static PieceSurface<Motion>& made(std::optional<PieceSurface<Motion>>& surface, const Body& body) {
    if (!surface) surface.emplace(body);
    return *surface;
  }

  const Body& a_;
  const Body& b_;
  double horizon_;
  double tolerance_;
  BendingPieces<Motion::degree> pieces_;
  double longest_ = never;  ///< s; of a part
  SurfaceQuery query_;
  std::optional<PieceSurface<Motion>> surface_a_, surface_b_;
  const MovingSurface<degree>* a_over_ = nullptr;  ///< as they are in the piece that is looked at
  const MovingSurface<degree>* b_over_ = nullptr;
};

}  // namespace

template <class Motion>
double BendingContact<Motion>::first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                                             FoundTouch*) {
  if (!(t0 <= horizon)) return never;
  BendingPair<Motion> pair(a, b, horizon);
  if (mode == ContactMode::resolved) return pair.meeting_after(t0, horizon);
  return first_touch(pair, t0, horizon);
}

template <class Motion>
double BendingContact<Motion>::apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&) {
  if (!(t0 <= horizon)) return never;
  return BendingPair<Motion>(a, b, horizon).balls_meet(t0);
}

template <class Motion>
bool BendingContact<Motion>::in_contact(const Body& a, const Body& b, double t) {
  BendingPair<Motion> pair(a, b, t);
  return touch_at(pair, t);
}

template <class Motion>
double BendingContact<Motion>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  if (!(t0 <= horizon)) return never;
  BendingPair<Motion> pair(a, b, horizon);
  return first_apart(pair, t0, horizon);
}

template <class Motion>
Contact BendingContact<Motion>::contact_at(const Body& a, const Body& b, double t, const FoundTouch&) {
  return BendingPair<Motion>(a, b, t).contact_at(t);
}

#define KDS_INSTANTIATE(motion) template struct BendingContact<motion>;
KDS_FOR_EACH_QUADRATIC(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
