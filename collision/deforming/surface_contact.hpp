// When surfaces whose vertices move meet: two of them, or one with itself.
#pragma once

#include "certificates/features/feature_contact.hpp"
#include "collision/deforming/moving_surface.hpp"
#include "collision/narrow_phase/contact.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace kds::collision {

/// How near surfaces count as touching, and in which part of the stretch to look.
struct SurfaceQuery {
  double from = -std::numeric_limits<double>::infinity();  ///< s; not before the stretch
  double until = std::numeric_limits<double>::infinity();  ///< s; not after it
  /// Of the size of a pair of features (ContactTolerance::relative, which says what is possible and what it costs):
  /// they may be reported while they are so much farther apart than their radii.
  double tolerance = 1e-7;
  double absolute_tolerance = std::numeric_limits<double>::infinity();  ///< units of length; the lesser counts
  /// Whether an overlap at `from` that is not one of features is looked for: an edge through a face, or parts inside a
  /// solid. A caller who knows that there is none, as after a step without contacts, saves the time.
  bool overlaps = true;
  /// For surfaces that impulses turn back: features that are within the tolerance at `from` count only if they approach
  /// there, or come nearer by another part of the tolerance (SurfaceSearch). Others count between one half of the
  /// tolerance and all of it, so that what has been turned back there is still apart. With a finite
  /// `absolute_tolerance`, and without `overlaps`.
  bool approaching = false;
};

/// Two features in contact. Those of a are what it says; `contact.point` is on the surface of a.
struct SurfaceContact {
  /// Which features they are.
  enum class Kind : std::uint8_t {
    vertex_face,  ///< a vertex of a and a face of b
    face_vertex,
    edge_edge,
    inside  ///< a vertex of one lies inside the other, a solid, at the start; its contact has no other feature
  };

  Contact contact;
  /// `at_start`: they touch, or the surfaces go through each other, when the query begins.
  certificates::FeatureContactStatus status = certificates::FeatureContactStatus::none;
  double latest = std::numeric_limits<double>::infinity();  ///< s; of `contact`: they do touch by then
  double distance = 0;  ///< at the time of the contact, at most: radii included; units of length
  Kind kind = Kind::edge_edge;
  /// The vertices of the two features, first those of a, and the weights that make up the two points that are closest:
  /// a vertex has one, an edge two, a face three, and the weights of each sum to 1. It is what an impulse is shared by.
  std::array<std::uint32_t, 4> vertices{};
  std::array<double, 4> weights{};

  std::size_t vertices_of_a() const { return kind == Kind::face_vertex ? 3 : (kind == Kind::edge_edge ? 2 : 1); }
};

/// The first contact of two surfaces over the same stretch of time, or nothing.
///
/// Surfaces touch where a vertex of one and a face of the other, or two edges, are as near as the sum of their radii.
///
/// Laws. (1) Nothing is missed, (2) nothing is late: if two features touch at a time in [from, until], a contact is
/// reported, and its time is not after that. (3) At the time reported the two features are no farther apart than
/// `distance`, at most the radii and the tolerance. (4) What is `contact` is certified. (5) Which pair of nodes is
/// looked at when makes no difference: of contacts at one time the one with the lowest features of a, then of b, is
/// reported. All of this is about the exact paths of the vertices, with what is uncertain of them added to the radii.
/// An overlap at `from` is reported as `at_start` at that time.
///
/// A surface has no inside, but balls, capsules (that is their radius) and solids do (MovingSurface::solid).
///
/// Method. Boxes whose sides are polynomials overlap in an interval of time (by straight lines around the control
/// polygon of their distance). Pairs of nodes wait in a queue by when that begins, and are split as their time comes;
/// pairs of leaves are tested exactly (certificates/features). So the first contact is found without a look at what
/// comes later. Cost: 100 ns or so a pair of nodes, and what is near.
///
/// Throws std::invalid_argument unless the stretches of time are the same, and `from` <= `until` are in them.
template <int Degree>
std::optional<SurfaceContact> first_contact(const MovingSurface<Degree>& a, const MovingSurface<Degree>& b,
                                            const SurfaceQuery& query = {});

/// Of each pair of features the first contact, by (time, features of a, features of b). Overlaps at `from` that are not
/// of features come first, one for each edge that goes through a face.
template <int Degree>
std::vector<SurfaceContact> all_contacts(const MovingSurface<Degree>& a, const MovingSurface<Degree>& b,
                                         const SurfaceQuery& query = {});

/// Of a surface with itself: all pairs of features but a vertex and a face of which it is a corner, and two edges with
/// a common vertex. Those count from a distance of twice the radius, so edges have to be longer than that.
template <int Degree>
std::optional<SurfaceContact> first_self_contact(const MovingSurface<Degree>& surface, const SurfaceQuery& query = {});
template <int Degree>
std::vector<SurfaceContact> all_self_contacts(const MovingSurface<Degree>& surface, const SurfaceQuery& query = {});

#define KDS_DECLARE(degree)                                                                                            \
  extern template std::optional<SurfaceContact> first_contact(const MovingSurface<degree>&,                            \
                                                              const MovingSurface<degree>&, const SurfaceQuery&);      \
  extern template std::vector<SurfaceContact> all_contacts(const MovingSurface<degree>&, const MovingSurface<degree>&, \
                                                           const SurfaceQuery&);                                       \
  extern template std::optional<SurfaceContact> first_self_contact(const MovingSurface<degree>&, const SurfaceQuery&); \
  extern template std::vector<SurfaceContact> all_self_contacts(const MovingSurface<degree>&, const SurfaceQuery&);
KDS_DECLARE(1)
KDS_DECLARE(2)
#undef KDS_DECLARE

}  // namespace kds::collision
