// Tests of convex shapes that penetrate in pieces of the space of their relative positions.
#pragma once

#include "certificates/plane_separation.hpp"
#include "collision/narrow_phase/gap_conditions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/vectors.hpp"
#include "kds/certificate.hpp"
#include "kds/roots/failure_time.hpp"

#include <algorithm>

namespace kds::collision {

/// Whether bodies part along a normal, and when they cease to, is decided exactly where doubles do not tell, by the
/// derivative of their distance along it: so it does not depend on when it is asked. For degree 3 and above always. (In
/// doubles the speed of a path that comes to rest would be lost in the roundings of its terms.)
template <int Degree>
DerivativeCertificate<certificates::PlaneSeparation<Degree>> parting(const Contact& contact,
                                                                     const TranslatingShape<Degree>& a,
                                                                     const TranslatingShape<Degree>& b) {
  return {{a.motion, b.motion, contact.normal, 1.0, {}, {}}};
}

/// Whether b moves towards a along the normal just after t.
template <int Degree>
bool approaching(const Contact& contact, const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b) {
  if constexpr (Degree <= 2) {
    const double rate = dot(contact.normal, b.motion.velocity(contact.time) - a.motion.velocity(contact.time));
    constexpr double rounding = 0x1p-49;  // of the terms of a velocity, and of the product
    const auto terms = [&](const auto& motion) {
      double sum = motion.coefficients[1].cwiseAbs().sum();
      if constexpr (Degree == 2)
        sum += 2 * motion.coefficients[2].cwiseAbs().sum() * std::abs(contact.time - motion.start);
      return sum;
    };
    if (std::abs(rate) > rounding * (terms(a.motion) + terms(b.motion))) return rate < 0;
  }
  return sign_after(parting(contact, a, b), contact.time) < 0;
}

/// When bodies that move apart along the contact's normal will turn towards each other.
template <int Degree>
double turning_time(const Contact& contact, const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b) {
  return Degree == 1 ? never : std::max(next_up(contact.time), failure_time(parting(contact, a, b), contact.time));
}

/// The time from which to search for a contact that counts, not before t0: later if the bodies have just been in
/// contact, do not approach, and part before they turn. This saves exact signs, which would be needed to decide whether
/// they overlap by a rounding, and until when.
template <class P, int Degree, class Where>
double after_contact(const P& piece, const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t0,
                     const Where& where) {
  const double opened = opened_after_touch(piece, t0);
  if (opened == t0) return t0;
  const Contact contact = where(t0);
  return !approaching(contact, a, b) && turning_time(contact, a, b) > opened ? opened : t0;
}

/// First contact of one piece. `resolved` counts only the times at which the bodies approach.
template <class P, int Degree, class Where>
double first_piece_contact(const P& piece, const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b,
                           double t0, double horizon, ContactMode mode, Where&& where) {
  for (double t = mode == ContactMode::resolved ? after_contact(piece, a, b, t0, where) : t0;;) {
    t = piece.first_inside(t, horizon);
    if (t == never || mode == ContactMode::transparent) return t;
    const Contact contact = where(t);
    if (approaching(contact, a, b)) return t;
    // Overlapping by rounding and moving apart: searches again from when they have parted, or turn before that.
    t = std::min(piece.first_outside(t, horizon), turning_time(contact, a, b));
    if (t == never || t > horizon) return never;
  }
}

/// The tests (see pair_tests.hpp) of a pair whose relative positions in contact are a union of convex pieces.
///
/// `Pieces`: made of (a, b, now, horizon); `every_piece` and `earliest_pieces` of it are as those of BoxAndBall, and
/// its pieces have `earliest`, `inside`, `first_inside` and `first_outside`. `where`: contact_at.
template <int Degree, class Pieces,
          Contact (*where)(const TranslatingShape<Degree>&, const TranslatingShape<Degree>&, double)>
struct PiecewiseContact {
  using Body = TranslatingShape<Degree>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode, FoundTouch*) {
    if (!(t0 <= horizon)) return never;
    double first = never;
    Pieces(a, b, t0, horizon).earliest_pieces(horizon, [&](const auto& piece) {
      const auto contact = [&](double t) { return where(a, b, t); };
      first = std::min(first, first_piece_contact(piece, a, b, t0, std::min(horizon, first), mode, contact));
      return first;
    });
    return first;
  }

  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&) {
    if (!(t0 <= horizon)) return never;
    double first = never;
    Pieces(a, b, t0, horizon).earliest_pieces(horizon, [&](const auto& piece) {
      return first = std::min(first, piece.earliest());
    });
    return first;
  }

  static bool in_contact(const Body& a, const Body& b, double t) {
    bool inside = false;
    Pieces(a, b, t, t).every_piece([&](const auto& piece) { return !(inside = piece.inside(t)); });
    return inside;
  }

  /// The end of one piece may lie in another: repeat until no piece contains them.
  static double first_separation(const Body& a, const Body& b, double t0, double horizon) {
    const Pieces pair(a, b, t0, horizon);
    double t = t0;
    for (bool moved = true; moved && t != never;) {
      moved = false;
      pair.every_piece([&](const auto& piece) {
        if (!piece.inside(t)) return true;
        t = piece.first_outside(t, horizon);
        moved = true;
        return t != never;
      });
    }
    return t;
  }

  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch&) { return where(a, b, t); }
};

}  // namespace kds::collision
