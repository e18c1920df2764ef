// The gaps between bodies that rest on each other.
#pragma once

#include "collision/motions.hpp"
#include "collision/narrow_phase/surface_gap.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/resting/resting_contact.hpp"
#include "collision/world_options.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <optional>

namespace kds::collision {

/// Gaps and normals of resting contacts, at clock.now, to some roundings of the coordinates. It has no state of its
/// own.
template <class Motion>
class ContactGaps {
 public:
  using Contact = detail::RestingContact;

  ContactGaps(const Bodies<Motion>& bodies, const std::optional<Walls>& walls, const Clock& clock)
      : bodies_(bodies), walls_(walls), clock_(clock) {}

  bool any_walls() const { return walls_.has_value(); }

  /// The bounding radius of the smaller of the two.
  double size(const Contact& contact) const;
  /// Whether one of the two is a wall or a half-space: the normal is the same everywhere, and nothing slides off.
  bool on_plane(const Contact& contact) const;
  /// Whether one of the two is a mesh or a compound, not on a plane, whose surface is known only where it touches.
  bool concave(const Contact& contact) const;
  /// Whether its normal turns while the two slide over each other: one is round, and the other is concave(), or is not
  /// touched at a face.
  bool turns(const Contact& contact) const;
  /// turns(), and not concave(): so the normal is known at other places too.
  bool bends(const Contact& contact) const { return !concave(contact) && turns(contact); }
  /// Whether a round body touches a face of one that is concave(), where its normal does not turn.
  bool on_face(const Contact& contact) const;

  /// The rate at which the two part along the normal.
  double parting(const Contact& contact) const;
  /// Rates along the normal up to this part of the speeds are errors. On a mesh it is not known where in the contact
  /// gap a body lies: one that it meets meets it along a line that is off by that gap over its size.
  double rate_error(const Contact& contact) const;
  /// The gap along the normal. If concave(), the gap at contact.since plus the displacement since then. Precondition:
  /// they have not changed their motions since.
  double along_normal(const Contact& contact) const;
  /// The gap; the normal becomes that of the places where the two are nearest.
  double nearest(Contact& contact) const;
  /// The same when b will have moved relative to a. Precondition: turns(), and not concave().
  SurfaceGap after(const Contact& contact, const Eigen::Vector3d& displacement) const;
  /// Recomputes gap and normal. False if the contact has ended.
  bool renew(Contact& contact) const;

  /// How much farther apart along a normal the two are after `span` seconds for the terms above the second degree that
  /// fixed bodies move by: bodies of a cluster have none.
  double beyond_parabola(const Contact& contact, const Eigen::Vector3d& normal, double span) const;

  /// Whether a plane across the normal certainly stays between the two for `span` seconds, in which they part at a rate
  /// and with half an acceleration: there is a gap now, and the parabola of the gap is above zero at the end. Where a
  /// fixed body moves by higher terms the Bernstein coefficients of the gap in that time are above zero.
  bool proven(const Contact& contact, double rate, double half, double span) const;

  /// How far the two overlap; 0 if concave(), where it is not known.
  double overlap(Contact contact) const { return concave(contact) ? 0 : -nearest(contact); }
  /// Whether the two overlap by more than `by`. Boxes that have slid off each other overlap only along the normal.
  bool deeper(const Contact& contact, double by) const;
  /// By how much more they may overlap than when the contact began: by a billionth of the smaller size, and by the
  /// rounding of motions at this clock.
  double deepest_overlap(const Contact& contact) const;

 private:
  /// Where the two touch.
  struct Place {
    collision::Contact touch;
    Eigen::Vector3d nearer;  ///< by which b was moved for them to touch
  };
  /// Where bodies touch of which one is concave, or has faces that may have slid off the other: first the nearest
  /// places are found, then those that are near. Nothing if none is.
  std::optional<Place> place(const Contact& contact, double gap) const;
  /// The terms of beyond_parabola() by their order, each times its power of the span.
  std::array<double, Motion::degree + std::size_t{1}> higher_terms(const Contact& contact,
                                                                   const Eigen::Vector3d& normal, double span) const;
  /// Most contacts are of two balls, for which a tenth of the work suffices.
  bool balls(const Contact& contact) const;

  const Bodies<Motion>& bodies_;
  const std::optional<Walls>& walls_;
  const Clock& clock_;
};

#define KDS_DECLARE(motion) extern template class ContactGaps<motion>;
KDS_FOR_ALL_PATHS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
