#include "tests/support/exact_elastic.hpp"

#include "tests/support/exact_meeting.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>
#include <utility>
#include <variant>

namespace oracle {
namespace {

using namespace meeting;

struct Pair {
  std::size_t a, b;
  Between<Rational> exact;
  Between<double> rough;
  bool passes = false;   ///< let pass until they are apart
  double since = 0;      ///< when it got its present motion, or began to pass
  double allowance = 0;  ///< how deep they may be in each other by rounding while they part
  double next = never;

  Pair(std::size_t first, std::size_t second, const Shape& shape_a, const Shape& shape_b)
      : a(first), b(second), exact(shape_a, shape_b), rough(shape_a, shape_b) {}
};

struct Wrong {
  std::string what;
};

template <class... Parts>
[[noreturn]] void wrong(const Parts&... parts) {
  std::ostringstream out;
  out.precision(17);
  (out << ... << parts);
  throw Wrong{out.str()};
}

/// A few roundings of numbers of this size: what an impulse may be off by.
constexpr double impulse_rounding = 0x1p-48;
/// One rounding, of a coordinate or a speed that is computed by one operation or as good as that.
constexpr double one_rounding = 0x1p-52;
/// At the start an overlap of less than this part of the coordinates is a touch, of more than the second a true one;
/// what is between them is for no test.
constexpr double touch = 0x1p-41;
constexpr double true_overlap = 0x1p-38;

/// Coordinate i of a path at t, its rate, and what of them is rounded when they are computed.
struct Place {
  Rational x, v, x_parts, v_parts;
};

Place place_on(const Piece& path, std::size_t i, double t) {
  const Rational elapsed = rational(t) - rational(path.start);
  const auto c = [&](std::size_t k) {
    return k < path.coefficients.size() ? rational(path.coefficients[k][i]) : Rational(0);
  };
  const Rational way = c(1) * elapsed, bend = c(2) * elapsed, curve = bend * elapsed;
  return {c(0) + way + curve, c(1) + bend + bend, abs(c(0)) + 2 * abs(way) + 4 * abs(curve), abs(c(1)) + 4 * abs(bend)};
}

Vector velocity(const Piece& path, double t) {
  return {place_on(path, 0, t).v, place_on(path, 1, t).v, place_on(path, 2, t).v};
}

class Proof {
 public:
  explicit Proof(const ElasticRun& run) : run_(run), now_(run.start) {
    for (const ElasticBody& body : run.bodies) {
      motions_.push_back(body.motion);
      check_radius(body);
    }
    for (std::size_t a = 0; a < motions_.size(); ++a) {
      for (std::size_t b = a + 1; b < motions_.size(); ++b) {
        pairs_.emplace_back(a, b, run.bodies[a].shape, run.bodies[b].shape);
        moved(pairs_.back());
      }
    }
    next_walls_.assign(motions_.size() * 6, never);
    for (std::size_t id = 0; id < motions_.size(); ++id) look_at_walls(id);
  }

  void check() {
    auto event = run_.events.begin();
    for (Pair& pair : pairs_) {
      if (!overlaps_at_start(pair)) continue;
      if (event == run_.events.end() || event->kind != ElasticEvent::Kind::overlap || event->a != pair.a ||
          event->b != pair.b || event->time != run_.start) {
        wrong("bodies ", pair.a, " and ", pair.b, " overlap at the start, which is not told");
      }
      pair.passes = true;
      ++event;
    }
    for (Pair& pair : pairs_) predict(pair);
    for (; event != run_.events.end(); ++event) check(*event);
    const Next next = next_before({run_.end, Kind::contact, run_.bodies.size(), 0});
    if (next.time < run_.end || (next.time == run_.end && !run_.cut)) {
      wrong(next.text(), ", which the log does not have");
    }
  }

  std::size_t grazes() const { return grazes_; }

 private:
  using Kind = ElasticEvent::Kind;

  struct Next {
    double time = never;
    Kind kind = Kind::wall;
    std::size_t a = 0, b = 0;

    bool operator<(const Next& other) const {
      const bool pair = kind == Kind::contact, other_pair = other.kind == Kind::contact;
      return std::tie(time, pair, a, b) < std::tie(other.time, other_pair, other.a, other.b);
    }
    std::string text() const {
      std::ostringstream out;
      out.precision(17);
      out << "body " << a << (kind == Kind::wall ? " reaches wall " : " meets body ") << b << " at " << time;
      return out.str();
    }
  };

  const ElasticBody& body(std::size_t id) const { return run_.bodies[id]; }

  static void check_radius(const ElasticBody& body) {
    Rational square(0);
    if (const auto* ball = std::get_if<Sphere>(&body.shape)) {
      square = oracle::square(rational(ball->radius));
    } else {
      for (const double h : std::get<Box>(body.shape).half_extents) square += oracle::square(rational(h));
    }
    const Rational given = oracle::square(rational(body.bounding_radius));
    if (given < square || given > square * rational(1 + 0x1p-40)) wrong("a bounding ball that does not hold its shape");
  }

  // --- what comes next

  Next next_event() const {
    Next next;
    for (std::size_t id = 0; id < motions_.size(); ++id) {
      for (std::size_t wall = 0; wall < 6; ++wall)
        next = std::min(next, Next{next_walls_[6 * id + wall], Kind::wall, id, wall});
    }
    for (const Pair& pair : pairs_) next = std::min(next, Next{pair.next, Kind::contact, pair.a, pair.b});
    return next;
  }

  /// The same without the grazes that would come before this one: they are left out.
  Next next_before(const Next& claimed) {
    for (;;) {
      const Next next = next_event();
      if (!(next < claimed) || next.kind == Kind::wall) return next;
      Pair& pair = pair_of(next.a, next.b);
      if (!grazes(pair, next.time)) return next;
      pair.next = never;
      ++grazes_;
    }
  }

  Pair& pair_of(std::size_t a, std::size_t b) {
    return *std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& pair) { return pair.a == a && pair.b == b; });
  }

  /// Whether a pair that comes to penetrate at a time is never in each other by more than is rounded.
  bool grazes(const Pair& pair, double t) const {
    const double depth = pair.allowance + roundings(pair, t);
    return only_graze(pair.exact, pair.rough, t, rational(depth));
  }

  bool is_graze(const ElasticEvent& event) {
    if (event.a >= event.b || event.b >= motions_.size()) return false;
    const Pair& pair = pair_of(event.a, event.b);
    return !pair.passes && pair.exact.just_after(event.time).penetrate && grazes(pair, event.time);
  }

  /// What one motion that begins at t may bring two bodies nearer by, because coordinates and times are rounded.
  double roundings(const Pair& pair, double t) const {
    return 2 * (spacing(largest(pair.a)) + spacing(largest(pair.b))) + 2 * spacing(t) * fastest_of(pair);
  }

  void moved(Pair& pair) {
    pair.exact.move(motions_[pair.a], motions_[pair.b]);
    pair.rough.move(motions_[pair.a], motions_[pair.b]);
    pair.since = now_;
  }

  void predict(Pair& pair) const {
    double from = now_;
    if (pair.passes) from = first_apart(pair.exact, now_, run_.end);
    pair.next = from == never ? never : first_meeting(pair.exact, pair.rough, from, run_.end);
  }

  void look_at_walls(std::size_t id) {
    if (!run_.walls) return;
    for (std::size_t wall = 0; wall < 6; ++wall) {
      const std::size_t axis = wall / 2;
      const double out = wall % 2 != 0 ? 1 : -1;
      const double limit = out > 0 ? run_.walls->max[axis] : run_.walls->min[axis];
      next_walls_[6 * id + wall] =
          first_beyond(motions_[id], axis, out, limit, body(id).bounding_radius, now_, run_.end);
    }
  }

  bool overlaps_at_start(const Pair& pair) const {
    const Rational size = rational(largest(pair.a) + largest(pair.b));
    if (pair.exact.no_deeper(rational(run_.start), size * rational(touch))) return false;
    if (pair.exact.no_deeper(rational(run_.start), size * rational(true_overlap)))
      wrong("an overlap too small for a test");
    return true;
  }

  double largest(std::size_t id) const {
    double result = body(id).bounding_radius;
    for (std::size_t i = 0; i < 3; ++i) {
      result = std::max(result, approximate(place_on(motions_[id], i, now_).x_parts));
    }
    return result;
  }
  double fastest(const Piece& path) const {
    double result = 0;
    for (std::size_t i = 0; i < 3; ++i) result = std::max(result, approximate(place_on(path, i, now_).v_parts));
    return result;
  }

  // --- what has happened

  void check(const ElasticEvent& event) {
    const Next claimed{event.time, event.kind, event.a, event.b};
    const Next next = next_before(claimed);
    if (event.kind == Kind::overlap) wrong("an overlap of ", event.a, " and ", event.b, " that is none");
    if (claimed < next && event.kind == Kind::contact && event.time >= now_ && is_graze(event)) {
      ++grazes_;
    } else if (claimed < next) {
      wrong(claimed.text(), " in the log, but comes later or never; next ", next.text());
    } else if (next < claimed) {
      wrong(next.text(), ", which the log does not have: it has ", claimed.text());
    }
    now_ = event.time;
    const std::vector<Piece> old = motions_;
    motions_ = event.motions;
    if (motions_.size() != old.size()) wrong("motions missing");
    const bool walls = event.kind == Kind::wall;
    std::vector<bool> changed(old.size());
    for (std::size_t id = 0; id < old.size(); ++id) {
      const bool concerned = id == event.a || (id == event.b && !walls);
      const bool fixed = body(id).fixed && !walls;
      if (concerned && !fixed) {
        check_continuous(id, old[id], motions_[id]);
        changed[id] = true;
      } else if (motions_[id].start != old[id].start || motions_[id].coefficients != old[id].coefficients) {
        wrong("the motion of body ", id, " has changed at ", now_, ", which has no part in ", next.text());
      }
    }
    if (walls) {
      check_wall(event, old[event.a]);
    } else {
      check_contact(event, old);
    }
    for (std::size_t id = 0; id < old.size(); ++id) {
      if (changed[id]) look_at_walls(id);
    }
    for (Pair& pair : pairs_) {
      if (changed[pair.a] || changed[pair.b]) change(pair);
      const bool this_one = !walls && pair.a == event.a && pair.b == event.b;
      if (this_one && body(event.a).fixed && body(event.b).fixed) {
        pair.passes = true;
        pair.since = now_;
        predict(pair);
      }
    }
  }

  void check_continuous(std::size_t id, const Piece& old, const Piece& piece) const {
    if (piece.start != now_) wrong("the motion of body ", id, " begins at ", piece.start, ", not at ", now_);
    for (std::size_t i = 0; i < 3; ++i) {
      const Place place = place_on(old, i, now_);
      // The time since the start, the products with it, and the sums are each rounded.
      if (abs(rational(piece.coefficients[0][i]) - place.x) > rational(one_rounding) * place.x_parts) {
        wrong("body ", id, " jumps at ", now_);
      }
    }
    for (std::size_t k = 2; k < old.coefficients.size(); ++k) {
      if (piece.coefficients[k] != old.coefficients[k]) wrong("the acceleration of body ", id, " changes at ", now_);
    }
  }

  void check_wall(const ElasticEvent& event, const Piece& old) const {
    const std::size_t axis = event.b / 2;
    const double restitution = std::min(run_.walls->restitution, body(event.a).restitution);
    for (std::size_t i = 0; i < 3; ++i) {
      const Place was = place_on(old, i, now_);
      const double is = motions_[event.a].coefficients[1][i];
      const Rational right = was.v * (i == axis ? -rational(restitution) : Rational(1));
      if (abs(rational(is) - right) > rational(one_rounding) * was.v_parts) {
        wrong("body ", event.a, " goes on with speed ", is, " from wall ", event.b, " at ", now_, ", not ",
              approximate(right));
      }
    }
  }

  void check_contact(const ElasticEvent& event, const std::vector<Piece>& old) {
    const std::size_t a = event.a, b = event.b;
    const ElasticBody& body_a = body(a);
    const ElasticBody& body_b = body(b);
    const Vector n = exact(event.normal);
    if (abs(dot(n, n) - 1) > rational(8 * one_rounding)) wrong("a normal that is no unit vector at ", now_);
    // The plane between them.
    Between<Rational> between(body_a.shape, body_b.shape);
    between.move(old[a], old[b]);
    Rational gap = dot(n, between.at(rational(now_))) - between.radius;
    for (std::size_t i = 0; i < 3; ++i) gap += -(abs(n[i]) * between.half_widths[i]);
    const Pair& pair = pair_of(a, b);
    if (gap < -rational(pair.allowance + roundings(pair, now_))) {
      wrong("the normal of ", a, " and ", b, " at ", now_, " separates nothing: the gap along it is ",
            approximate(gap));
    }
    if (body_a.fixed && body_b.fixed) return;
    const double fast = std::max({fastest(motions_[a]), fastest(motions_[b]), fastest(old[a]), fastest(old[b])});
    const Rational off = rational(impulse_rounding * fast);
    const auto minus = [](const Vector& x, const Vector& y) { return Vector{x[0] - y[0], x[1] - y[1], x[2] - y[2]}; };
    const Rational was = dot(n, minus(velocity(old[b], now_), velocity(old[a], now_)));
    const Rational is = dot(n, minus(velocity(motions_[b], now_), velocity(motions_[a], now_)));
    const Rational kept = rational(std::min(body_a.restitution, body_b.restitution));
    if (was > off) wrong("bodies ", a, " and ", b, " part along their normal at ", now_, " and yet meet");
    if (abs(is + kept * was) > off) {
      wrong("bodies ", a, " and ", b, " approach at ", approximate(-was), " and part at ", approximate(is));
    }
    const Vector gain_a = minus(velocity(motions_[a], now_), velocity(old[a], now_));
    const Vector gain_b = minus(velocity(motions_[b], now_), velocity(old[b], now_));
    const Rational along_a = dot(n, gain_a), along_b = dot(n, gain_b);
    for (std::size_t i = 0; i < 3; ++i) {
      if (abs(gain_a[i] - along_a * n[i]) > off || abs(gain_b[i] - along_b * n[i]) > off) {
        wrong("the impulse on ", a, " and ", b, " at ", now_, " is not along the normal");
      }
    }
    if (body_a.fixed || body_b.fixed) return;
    const Rational mass_a = rational(body_a.mass), mass_b = rational(body_b.mass);
    if (abs(mass_a * along_a + mass_b * along_b) > off * (mass_a + mass_b)) {
      wrong("momentum of ", a, " and ", b, " is lost at ", now_);
    }
  }

  /// One of the two has another motion.
  void change(Pair& pair) {
    // Until this instant, with the motions before.
    if (pair.passes && pair.since < now_ && first_apart(pair.exact, pair.since, before(now_)) != never) {
      pair.passes = false;
    }
    const double before_it = roundings(pair, now_);
    moved(pair);
    const Lie lie = pair.exact.just_after(now_);
    if (!lie.penetrate) {
      pair.passes = false;
      pair.allowance = 0;
    } else if (!pair.passes) {
      pair.allowance += before_it + roundings(pair, now_);
      if (!pair.exact.no_deeper(rational(now_), rational(pair.allowance))) {
        wrong("bodies ", pair.a, " and ", pair.b, " are in each other by more than ", pair.allowance, " at ", now_);
      }
    }
    predict(pair);
  }

  double fastest_of(const Pair& pair) const {
    double result = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      result = std::max(result, std::abs(pair.rough.c[1][i]) + 2 * std::abs(pair.rough.c[2][i] * now_));
    }
    return result;
  }

  const ElasticRun& run_;
  double now_;
  std::vector<Piece> motions_;
  std::vector<Pair> pairs_;
  std::vector<double> next_walls_;
  std::size_t grazes_ = 0;
};

}  // namespace

Verdict prove(const ElasticRun& run) {
  try {
    Proof proof(run);
    proof.check();
    return {{}, proof.grazes()};
  } catch (const Wrong& found) {
    return {found.what};
  }
}

}  // namespace oracle
