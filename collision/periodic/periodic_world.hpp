// A world in a periodic box: what leaves it at one end comes in at the other.
#pragma once

#include "collision/body_description.hpp"
#include "collision/body_id.hpp"
#include "collision/degrees.hpp"
#include "collision/periodic/period_lattice.hpp"
#include "collision/periodic/periodic_listener.hpp"
#include "collision/periodic/periodic_options.hpp"
#include "collision/periodic/thermal_velocities.hpp"
#include "collision/periodic/zone.hpp"
#include "collision/world.hpp"
#include "collision/world/body_keys.hpp"
#include "kds/events/calendar_queue.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace kds::collision {

/// What a periodic world has done so far.
struct PeriodicCounters {
  std::uint64_t contacts = 0;
  std::uint64_t wraps = 0;         ///< bodies that have left the box and come in at the other side
  std::uint64_t images_made = 0;   ///< so far
  std::uint64_t images_ended = 0;  ///< the difference is how many there are

  friend bool operator==(const PeriodicCounters&, const PeriodicCounters&) = default;
};

/// Bodies that keep their orientation, on straight paths (degree 1) or parabolas (degree 2), in a box that is periodic
/// along some axes or all, at rest or sheared (Lees-Edwards). Contacts are answered by impulses, with the bodies'
/// restitution.
///
/// It is made of a World and its public functions alone. Bodies near an end have *images* in that world: further bodies
/// a period away, that follow them. An image exists before anything can touch it, and only in copies of the box in one
/// half of all directions (positive y; or, in the same layer, positive x; or positive z); images meet bodies and no
/// images. So each contact of two bodies across an end is there once, as one of a body and an image, and is answered by
/// changing the motions of the two bodies, which their images follow.
///
/// Laws:
/// 1. *Exact.* A contact is at the first double just after which the body and the image, or the two bodies, penetrate,
///    and none is missed. Images are made, and bodies brought back into the box, at the first double just after which
///    that is due; events are told in order. The events are the same bits for each broad phase and compiler.
/// 2. *Rounded.* The place of an image, and that of a body that is brought back, are rounded once from that of the body
///    (and the velocity, under shear): so two bodies in contact across an end may overlap or be apart by a rounding of
///    their coordinates. Periods and places that are multiples of a power of two lose nothing.
/// 3. *Response.* As in mode `elastic` of a World, the same bits where no image takes part, but there is no rest of two
///    bodies on each other: contacts that pile up in time are to be ended by PeriodicOptions::elastic_within. Bodies
///    bounce off walls, and rest at them, as in any World.
/// 4. *Where bodies are.* Centres lie in the box, or up to the slack beyond it, which is at most a quarter of the
///    greatest radius (Ends::slack); crossings() counts the periods.
/// 5. *When.* Functions that change bodies may be called between steps and in callbacks; others that run the world only
///    between steps. What a World says of exceptions is true of this too.
///
/// Cost: an image is a body, and a body that is within two radii or so of an end has one: of N balls at a packing of a
/// quarter there are some 3 N^(2/3). Moving them, and finding out when bodies cross an end, takes 20 to 40 % more
/// instructions than a World with walls needs for a contact (docs/granular_gas.md).
///
/// An id that was never given, or whose body was removed, throws std::out_of_range.
template <int Degree>
class PeriodicWorld final : private WorldListener<Degree> {
  static_assert(Degree == 1 || Degree == 2, "PeriodicWorld: bodies move on lines (1) or parabolas (2)");

 public:
  using Motion = certificates::PointMotion<Degree>;
  using Description = BodyDescription<Degree>;
  using Listener = PeriodicListener<Degree>;

  /// Throws what validate() and the constructor of a World throw. The listener, if there is one, must outlive the
  /// world.
  explicit PeriodicWorld(const PeriodicOptions& options, Listener* listener = nullptr);
  PeriodicWorld(const PeriodicWorld&) = delete;
  PeriodicWorld& operator=(const PeriodicWorld&) = delete;

  /// Adds a body, wherever its copy in the box is, and returns its id: 0, 1, 2, ... as long as none has been removed
  /// (body_id.hpp). Throws std::invalid_argument, naming the member that is wrong, as World::add_body, and also for
  /// more than one piece of motion, a start after now(), a sensor, a box function, a mesh that bends, a category beyond
  /// 16 bits (of `collides_with` only these count), a bounding radius that is not below half of each period, or is too
  /// small for the coordinates (2^-32 of the ends of the box), and a place more than 2^31 periods away.
  BodyId add_body(const Description& description);
  void remove_body(BodyId id);
  /// Replaces the motion from now() on. Throws as World::update_motion, and then changes nothing.
  void update_motion(BodyId id, const Motion& motion);
  /// Counts from the next contact on. Throws std::invalid_argument unless in [0, 1].
  void set_restitution(BodyId id, double restitution);
  void reserve(std::size_t bodies);

  /// Processes everything up to and including t. Throws as World::advance_to.
  void advance_to(double t);
  /// Processes the next event that is told, other than `wrapped`, if there is one not later than the limit, which must
  /// be finite: bodies cross the ends for ever.
  bool step(double limit);

  double now() const { return world_.now(); }
  std::size_t size() const { return size_; }
  bool contains(BodyId id) const;
  const Motion& motion(BodyId id) const;
  /// Rounded; see law 4.
  Eigen::Vector3d position(BodyId id) const { return motion(id).position(now()); }
  /// Rounded; under shear that in the box, which moves less in layers below.
  Eigen::Vector3d velocity(BodyId id) const { return motion(id).velocity(now()); }
  /// The periods between where the body would be, had it never been brought back, and where it is. That place is
  /// position() plus lattice().displacement(crossings(), now()), its velocity velocity() plus
  /// lattice().velocity(crossings()).
  Offset crossings(BodyId id) const { return real(id).crossings; }
  const PeriodLattice& lattice() const { return lattice_; }

  /// Bodies and images, for queries. It has ids of its own: owner() says which body is meant, or which body's image.
  const World<Degree>& world() const { return world_; }
  BodyId in_world(BodyId id) const { return real(id).in_world; }
  /// The body that an id of world() means, or that it means an image of.
  struct Owner {
    BodyId body;
    Offset offset;  ///< of the image; 0 of a body itself
  };
  Owner owner(BodyId in_world) const;

  PeriodicCounters counters() const { return counters_; }

  /// Checks the world, that each body is where law 4 says, and that it has just the images that it needs, where they
  /// belong; throws AuditFailure. O(n^2).
  void audit() const;

  /// Saves or loads all that decides later events: see kds/framework/snapshot.hpp. The options must be the same, except
  /// the seed and those that may differ in a World.
  template <class Archive>
  void archive(Archive& archive);

 private:
  struct Image {
    Offset offset;
    BodyId id;

    template <class Archive>
    void archive(Archive& to) {
      to(offset, id);
    }
  };
  /// A body of the caller's, or a place for one.
  struct alignas(64) Real {
    // What each contact needs is in one cache line ...
    BodyId in_world = 0;
    double inverse_mass = 0;
    double restitution = 1;
    double radius = 0;             ///< of its bounding ball
    double last_contact = -never;  ///< s
    std::int64_t shift = 0;        ///< under shear: periods in x of its image in the layer above
    std::array<Zone, 4> zones{};   ///< of x, y, z, and of the image's x in the layer above
    bool alive = false;
    bool certain = false;  ///< whether its time in the queue is exact
    // ... and what few need is not.
    std::vector<Image> images{};  ///< none unless x, y or z is near an end
    double placed_at = -never;    ///< s: when the caller put it where it is
    Offset crossings{};
    std::array<double, 4> orientation{};  ///< of its shape: x, y, z, w

    bool near_an_end() const { return zones[0] != Zone{} || zones[1] != Zone{} || zones[2] != Zone{}; }

    template <class Archive>
    void archive(Archive& to) {
      to(alive, in_world, inverse_mass, restitution, radius, orientation, last_contact, placed_at, crossings, shift);
      for (Zone& zone : zones) to(zone.low, zone.high);
      to(images);
    }
  };
  /// What a slot of the world is: a body, or an image of one.
  struct Role {
    BodySlot owner = no_body;  ///< a place in reals_
    Offset offset{};

    template <class Archive>
    void archive(Archive& to) {
      to(owner, offset);
    }
  };
  /// Categories and masks of the caller have 16 bits. In the world those of bodies are the lower bits, and images have
  /// the same this much higher, which no mask of an image contains: so images meet bodies, and no images.
  static constexpr int image_bits = 16;
  static constexpr int layer_above = 3;  ///< the coordinate after x, y, z: see Real::zones

  // periodic_world.cpp: what callers do, and contacts
  const Real& real(BodyId id) const;
  Real& real(BodyId id) { return const_cast<Real&>(std::as_const(*this).real(id)); }
  BodySlot slot_of(const Real& body) const { return static_cast<BodySlot>(&body - reals_.data()); }
  BodyId id_of(BodySlot slot) const { return keys_.id(slot); }
  const Role& role(BodyId in_world) const { return roles_[body_slot(in_world)]; }
  void set_role(BodyId in_world, BodySlot owner, const Offset& offset);
  void take_up(Real& body, const Motion& motion);
  void follow(Real& body);
  void move_images(Real& body);
  PeriodicEvent event_of(const PairEvent& pair) const;
  void strike(PeriodicEvent& event);
  void contact(World<Degree>&, const PairEvent& pair) override;
  void overlap(World<Degree>&, const PairEvent& pair) override;
  void passes(World<Degree>&, const PairEvent& pair) override;
  void wall(World<Degree>&, const WallEvent& event) override;
  void moved(World<Degree>&, BodyId id) override;

  // periodic_snapshot.cpp: what has been loaded is what a periodic world can have saved
  void check_loaded() const;
  void check_loaded(const Real& body) const;

  // places.cpp: ends of the box and images
  Ends ends(const Real& body, int coordinate) const;
  bool follows(const Real& body, int coordinate) const;
  kds::Motion<Degree> coordinate(const Real& body, const Motion& motion, int which) const;
  Span span(const Real& body, int which) const { return span_of(body.zones[std::size_t(which)], ends(body, which)); }
  std::int64_t periods_into_box(double x, int axis) const;
  std::int64_t periods_to_go(double x, int axis, int side) const;
  Offset way_into_box(const Motion& motion) const;
  void require_room(double radius) const;
  double slack_of(double greatest_radius) const;
  void note_largest(double radius);
  void find_zones(Real& body);
  void find_layer_above(Real& body);
  bool correct(Real& body, int which);
  void leave(Real& body, int which, int side);
  std::vector<Offset> needed_images(const Real& body) const;
  void update_place(Real& body);
  void match_images(Real& body);
  void add_image(Real& body, const Offset& offset);
  void end_image(const Image& image);
  void schedule(Real& body);
  void cross();

  PeriodicOptions options_;
  PeriodLattice lattice_;
  Listener silent_;
  Listener* listener_;
  World<Degree> world_;
  std::vector<Real> reals_;     ///< by slot of the bodies' ids
  BodyKeys keys_;               ///< of reals_
  std::vector<BodySlot> free_;  ///< places in reals_, the last that became free at the end
  std::vector<Role> roles_;     ///< by slot of the world
  std::size_t size_ = 0;
  double greatest_radius_ = 0;
  double slack_ = 0;   ///< Ends::slack
  bool told_ = false;  ///< an event has been told since the step began
  /// When a coordinate of a body leaves its zone, or a time before.
  CalendarQueue<BodyRank> leaving_{BodyRank{&keys_}};
  ThermalVelocities thermal_;
  PeriodicCounters counters_;
};

#define KDS_DECLARE(degree) extern template class PeriodicWorld<degree>;
KDS_DECLARE(1)
KDS_DECLARE(2)
#undef KDS_DECLARE

}  // namespace kds::collision
