// Stretches of time in which surfaces touch, looked for piece by piece.
#pragma once

#include "kds/arithmetic/lattice.hpp"

#include <algorithm>

namespace kds::collision {

/// A stretch of time in which two surfaces, or parts of one, are in contact.
struct TouchSpan {
  double begin = never;
  double end = never;
};

/// The first stretch that ends after t, if it begins by the horizon. Of one that begins at t or later the end is left
/// out, unless it is asked for.
///
/// Contacts and separations follow each other from the begin of each piece, so that they do not depend on t. `course`
/// has the pieces of the time and the surfaces: `first_begin(t)`, a time in the first piece; `piece(t)`, the one that
/// holds t; `over(t)`, whether nothing changes any more in a piece that begins at t; `near(t)`, a time from t on before
/// which nothing touches; `touching(begin, end)`, a SurfaceTouching over a piece, to which the others then refer;
/// `first_contact(from)`.
template <class Course>
TouchSpan touch_after(Course& course, double t, double horizon, bool with_end) {
  constexpr double longest_stride = 0x1p-10;
  TouchSpan touch;
  bool open = false;
  const auto is_told = [&course](double at) {
    const auto contact = course.first_contact(at);
    return contact && !(contact->contact.time > at);
  };
  for (double begin = course.first_begin(t); begin <= horizon;) {
    const auto [w0, w1] = course.piece(begin);
    if (!(begin < w1) || course.over(w0)) break;
    begin = w1;
    if (!open) {
      const double near = course.near(w0);
      if (near > horizon || near == never) break;
      if (near > w1) {
        begin = near;
        continue;
      }
    }
    const auto touching = course.touching(w0, w1);
    double now = w0;
    bool touches = touching.touches(w0);
    if (open && !touches && !is_told(w0)) {
      touch.end = w0;
      if (touch.end > t) return touch;
      open = false;
    }
    for (;;) {
      if (!open) {
        if (!touches) {
          const auto contact = course.first_contact(now);
          if (!contact) break;
          now = contact->contact.time;
        }
        touch = {now, never};
        open = true;
        if (now > horizon) return {};
      }
      if (touch.begin >= t && !with_end) return touch;
      // Where the doubles of the clock are far apart a contact is told some of them before the two touch, and a
      // separation before they have parted. What is told or touches at the end of a contact goes on with it: there is
      // no gap that a double sees. So that this ends where surfaces stay at the edge of the tolerance, where roundings
      // decide, each such stretch is at least twice as long as the one before, up to 2^-10 of the piece, as in
      // SurfaceTouching::parts_at().
      double stride = 0;
      for (;;) {
        const double parts = touching.parts_at(now);
        touch.end = parts == never ? never : std::max({parts, next_up(now), now + stride});
        if (!(touch.end < w1) || !(touching.touches(touch.end) || is_told(touch.end))) break;
        stride = std::min(std::max(2 * stride, next_up(touch.end) - touch.end), longest_stride * (w1 - w0));
        now = touch.end;
      }
      if (!(touch.end < w1)) break;  // the next piece tells whether it goes on there
      if (touch.end > t) return touch;
      now = touch.end;
      open = touches = false;
    }
  }
  return open ? TouchSpan{touch.begin, never} : TouchSpan{};
}

/// The first time in [t, horizon] at which they are in contact, or `never`.
template <class Course>
double first_touch(Course& course, double t, double horizon) {
  if (!(t <= horizon)) return never;
  const double begin = touch_after(course, t, horizon, false).begin;
  return begin <= horizon ? std::max(begin, t) : never;
}

/// Whether they are in contact at t.
template <class Course>
bool touch_at(Course& course, double t) {
  return touch_after(course, t, t, false).begin <= t;
}

/// The first time in [t, horizon] at which they are not in contact, or `never`.
template <class Course>
double first_apart(Course& course, double t, double horizon) {
  if (!(t <= horizon)) return never;
  const TouchSpan touch = touch_after(course, t, horizon, true);
  if (!(touch.begin <= t)) return t;
  return touch.end <= horizon ? touch.end : never;
}

}  // namespace kds::collision
