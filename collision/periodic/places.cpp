// Where the bodies of a periodic world are in their box, and the images that they need there.
#include "collision/periodic/periodic_world.hpp"
#include "collision/shapes/shape.hpp"
#include "kds/audit.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

/// Ends::slack: more makes wraps rarer and images last longer, and there are more of them. Half and twice as much cost
/// less than 1 % more instructions a contact.
constexpr double slack_in_radii = 0.25;
/// The least slack, in units of the ends of the box: far above the roundings of the coordinates.
constexpr double least_slack = 0x1p-34;
/// An image is made at a double just after its body has come near: by this part of that distance sooner.
constexpr double sooner = 0x1p-20;

Offset along(int axis, std::int64_t periods) {
  Offset offset{};
  offset[static_cast<std::size_t>(axis)] = periods;
  return offset;
}

}  // namespace

template <int Degree>
Ends PeriodicWorld<Degree>::ends(const Real& body, int which) const {
  const int axis = which == layer_above ? 0 : which;
  const double near = (body.radius + greatest_radius_ + slack_) * (1 + sooner);
  return {options_.min[axis], options_.max[axis], slack_, near};
}

template <int Degree>
bool PeriodicWorld<Degree>::follows(const Real& body, int which) const {
  return which == layer_above ? lattice_.slides() && body.zones[1].low : lattice_.periodic(which);
}

template <int Degree>
kds::Motion<Degree> PeriodicWorld<Degree>::coordinate(const Real& body, const Motion& motion, int which) const {
  return which == layer_above ? lattice_.moved(motion, {body.shift, 1, 0}).axis(0) : motion.axis(which);
}

/// How many periods x has to be moved to lie in the box.
template <int Degree>
std::int64_t PeriodicWorld<Degree>::periods_into_box(double x, int axis) const {
  if (!lattice_.periodic(axis)) return 0;
  const double periods = std::floor((x - options_.min[axis]) / lattice_.period(axis));
  if (!(std::abs(periods) < 0x1p31)) {
    throw std::invalid_argument("motion: the body is more than 2^31 periods away from the box");
  }
  return -static_cast<std::int64_t>(periods);
}

template <int Degree>
Offset PeriodicWorld<Degree>::way_into_box(const Motion& motion) const {
  const Eigen::Vector3d x = motion.position(now());
  Offset way = along(1, periods_into_box(x[1], 1)) + along(2, periods_into_box(x[2], 2));
  way[0] = periods_into_box(lattice_.moved(motion, way).position(now())[0], 0);
  return way;
}

/// Throws std::invalid_argument unless the box has room for bodies of this radius.
template <int Degree>
void PeriodicWorld<Degree>::require_room(double radius) const {
  for (int axis = 0; axis < 3; ++axis) {
    if (!lattice_.periodic(axis)) continue;
    const double spare = (lattice_.period(axis) - 2 * radius) / 4;
    const double least = least_slack * std::max(std::abs(options_.min[axis]), std::abs(options_.max[axis]));
    const auto refuse = [&](const std::string& why) {
      throw std::invalid_argument("shape: a bounding radius of " + number_text(radius) + " is " + why + " along " +
                                  "xyz"[axis] + ", " + number_text(lattice_.period(axis)));
    };
    if (!(slack_in_radii * radius > least)) refuse("too small for the coordinates of a box of the period");
    if (!(spare > least)) refuse("not below half the period");
  }
}

/// Ends::slack. Precondition: there is room for bodies of this radius.
template <int Degree>
double PeriodicWorld<Degree>::slack_of(double greatest_radius) const {
  double slack = slack_in_radii * greatest_radius;
  for (int axis = 0; axis < 3; ++axis) {
    if (lattice_.periodic(axis)) slack = std::min(slack, (lattice_.period(axis) - 2 * greatest_radius) / 4);
  }
  return slack;
}

/// There is a body that is larger than all before it: all need their images sooner. Precondition: there is room for it.
template <int Degree>
void PeriodicWorld<Degree>::note_largest(double radius) {
  greatest_radius_ = radius;
  slack_ = slack_of(radius);
  for (Real& body : reals_) {
    if (!body.alive) continue;
    find_zones(body);
    update_place(body);
  }
}

/// Finds the zones up to roundings, which update_place() corrects.
template <int Degree>
void PeriodicWorld<Degree>::find_zones(Real& body) {
  const Eigen::Vector3d x = world_.motion(body.in_world).position(now());
  for (int axis = 0; axis < 3; ++axis) {
    body.zones[static_cast<std::size_t>(axis)] = lattice_.periodic(axis) ? zone_at(x[axis], ends(body, axis)) : Zone{};
  }
  find_layer_above(body);
}

template <int Degree>
void PeriodicWorld<Degree>::find_layer_above(Real& body) {
  body.shift = 0;
  if (!follows(body, layer_above)) return;
  const Motion& motion = world_.motion(body.in_world);
  body.shift = periods_into_box(lattice_.moved(motion, along(1, 1)).position(now())[0], 0);
  const double x = lattice_.moved(motion, {body.shift, 1, 0}).position(now())[0];
  body.zones[layer_above] = zone_at(x, ends(body, layer_above));
}

/// Changes what is not right any more of where a coordinate is, by one step; false if all is right. The distances
/// between the places at which something changes and changes back are the slack, so roundings repeat nothing.
template <int Degree>
bool PeriodicWorld<Degree>::correct(Real& body, int which) {
  using Within = certificates::WithinLimit<kds::Motion<Degree>>;
  const auto x = coordinate(body, world_.motion(body.in_world), which);
  const auto side = outside(x, span(body, which), now());
  if (!side) return false;
  const Ends e = ends(body, which);
  Zone& zone = body.zones[static_cast<std::size_t>(which)];
  const bool low = *side < 0;
  bool& near = low ? zone.low : zone.high;
  bool& near_other = low ? zone.high : zone.low;
  const double far_from_other = low ? e.max - e.far() : e.min + e.far();
  if (near_other && sign_after(Within{x, far_from_other, double(*side)}, now()) < 0) {
    near_other = false;
  } else if (!near) {
    near = true;
    if (which == 1 && low) find_layer_above(body);
  } else {
    leave(body, which, *side);
  }
  return true;
}

/// The same of a coordinate that is beyond an end, -1 the lower one: by one at least. A body may be faster than a
/// period in the time between two doubles.
template <int Degree>
std::int64_t PeriodicWorld<Degree>::periods_to_go(double x, int axis, int side) const {
  const std::int64_t periods = periods_into_box(x, axis);
  return side < 0 ? std::max<std::int64_t>(periods, 1) : std::min<std::int64_t>(periods, -1);
}

/// A body has left the box at an end, or its image in the layer above has.
template <int Degree>
void PeriodicWorld<Degree>::leave(Real& body, int which, int side) {
  if (which == layer_above) {
    const double before = coordinate(body, world_.motion(body.in_world), which)(now());
    body.shift += periods_to_go(before, 0, side);
    const double x = coordinate(body, world_.motion(body.in_world), which)(now());
    body.zones[layer_above] = zone_at(x, ends(body, which));
    return;
  }
  const Motion before = world_.motion(body.in_world);
  Offset by = along(which, periods_to_go(before.axis(which)(now()), which, side));
  if (which == 1 && lattice_.slides()) by[0] = periods_into_box(lattice_.moved(before, by).position(now())[0], 0);
  world_.update_motion(body.in_world, lattice_.moved(before, by));
  ++counters_.wraps;
  body.crossings = body.crossings + -by;
  // Images stay where they are, and are that many periods away from where the body is.
  for (Image& image : body.images) {
    image.offset = image.offset + -by;
    set_role(image.id, slot_of(body), image.offset);
  }
  const Eigen::Vector3d x = world_.motion(body.in_world).position(now());
  for (int axis = 0; axis < 3; ++axis) {
    if (by[static_cast<std::size_t>(axis)] == 0) continue;
    body.zones[static_cast<std::size_t>(axis)] = zone_at(x[axis], ends(body, axis));
  }
  if (which != 2) find_layer_above(body);
}

/// In the half of all directions that has images: up in y; in the same layer, up in x; or up in z.
template <int Degree>
std::vector<Offset> PeriodicWorld<Degree>::needed_images(const Real& body) const {
  std::vector<Offset> needed;
  // An end that is near needs an image at the other.
  const auto each = [](const Zone& zone, std::int64_t shift, const auto& visit) {
    visit(shift);
    if (zone.low) visit(shift + 1);
    if (zone.high) visit(shift - 1);
  };
  for (std::int64_t y = 0; y <= (body.zones[1].low ? 1 : 0); ++y) {
    const bool layer = y == 1 && lattice_.slides();
    each(body.zones[layer ? layer_above : 0], layer ? body.shift : 0, [&](std::int64_t x) {
      each(body.zones[2], 0, [&](std::int64_t z) {
        if (y > 0 || x > 0 || (x == 0 && z > 0)) needed.push_back({x, y, z});
      });
    });
  }
  return needed;
}

/// Brings the body into the box, gives it the images that it needs there, and finds out when that changes.
template <int Degree>
void PeriodicWorld<Degree>::update_place(Real& body) {
  for (bool again = true; again;) {
    again = false;
    for (int which = 0; which <= layer_above; ++which) again |= follows(body, which) && correct(body, which);
  }
  match_images(body);
  schedule(body);
}

template <int Degree>
void PeriodicWorld<Degree>::match_images(Real& body) {
  const std::vector<Offset> needed = needed_images(body);
  const auto is_needed = [&](const Image& image) {
    return std::find(needed.begin(), needed.end(), image.offset) != needed.end();
  };
  const auto rest = std::stable_partition(body.images.begin(), body.images.end(), is_needed);
  std::for_each(rest, body.images.end(), [&](const Image& image) { end_image(image); });
  body.images.erase(rest, body.images.end());
  for (const Offset& offset : needed) {
    const bool there =
        std::any_of(body.images.begin(), body.images.end(), [&](const Image& image) { return image.offset == offset; });
    if (!there) add_image(body, offset);
  }
}

template <int Degree>
void PeriodicWorld<Degree>::add_image(Real& body, const Offset& offset) {
  Description image{.shape = world_.shape(body.in_world).shape};
  const auto& [x, y, z, w] = body.orientation;
  image.orientation = Eigen::Quaterniond(w, x, y, z);
  image.motion = {lattice_.moved(world_.motion(body.in_world), offset)};
  image.mass = world_.mass(body.in_world);
  image.fixed = body.inverse_mass == 0;
  image.restitution = body.restitution;
  image.category = world_.category(body.in_world) << image_bits;
  image.collides_with = world_.collides_with(body.in_world) >> image_bits;
  image.group = world_.group(body.in_world);
  image.user_data = world_.user_data(body.in_world);
  const BodyId id = world_.add_body(image);
  set_role(id, slot_of(body), offset);
  body.images.push_back({offset, id});
  ++counters_.images_made;
}

template <int Degree>
void PeriodicWorld<Degree>::end_image(const Image& image) {
  world_.remove_body(image.id);
  set_role(image.id, no_body, {});
  ++counters_.images_ended;
}

template <int Degree>
void PeriodicWorld<Degree>::schedule(Real& body) {
  const Motion& motion = world_.motion(body.in_world);
  const double t = now();
  double first = never;
  for (int which = 0; which <= layer_above; ++which) {
    if (!follows(body, which)) continue;
    first = std::min(first, earliest_exit(coordinate(body, motion, which), span(body, which), t));
  }
  leaving_.set(slot_of(body), first);
  body.certain = false;
}

/// What is due next in the queue: a time that is only a bound becomes exact; otherwise the body has left a zone.
template <int Degree>
void PeriodicWorld<Degree>::cross() {
  Real& body = reals_[leaving_.top().slot];
  if (!body.certain) {
    const Motion& motion = world_.motion(body.in_world);
    double first = never;
    for (int which = 0; which <= layer_above; ++which) {
      if (!follows(body, which)) continue;
      first = std::min(first, exit_time(coordinate(body, motion, which), span(body, which), now()));
    }
    leaving_.set(slot_of(body), first);
    body.certain = true;
    return;
  }
  const BodyId id = id_of(slot_of(body));
  const Offset before = body.crossings;
  update_place(body);
  const Offset crossed = body.crossings + -before;
  if (crossed != Offset{}) listener_->wrapped(*this, id, crossed);
}

template <int Degree>
void PeriodicWorld<Degree>::audit() const {
  world_.audit();
  std::size_t images = 0;
  for (const Real& body : reals_) {
    if (!body.alive) continue;
    const auto require = [&](bool right, const char* what) {
      if (!right) throw AuditFailure("PeriodicWorld: body " + std::to_string(id_of(slot_of(body))) + " " + what);
    };
    const Motion& motion = world_.motion(body.in_world);
    for (int which = 0; which <= layer_above; ++which) {
      if (!follows(body, which)) continue;
      require(!outside(coordinate(body, motion, which), span(body, which), now()), "is not where it is taken to be");
    }
    std::vector<Offset> needed = needed_images(body), there;
    for (const Image& image : body.images) {
      there.push_back(image.offset);
      require(
          world_.contains(image.id) && role(image.id).owner == slot_of(body) && role(image.id).offset == image.offset,
          "has an image that is none");
      const Eigen::Vector3d off =
          world_.motion(image.id).position(now()) - lattice_.moved(motion, image.offset).position(now());
      require(off.cwiseAbs().maxCoeff() <= slack_ * 0x1p-8, "has an image that does not follow it");
    }
    images += there.size();
    std::sort(needed.begin(), needed.end());
    std::sort(there.begin(), there.end());
    require(needed == there, "has not just the images that it needs");
  }
  if (world_.size() != size_ + images) throw AuditFailure("PeriodicWorld: there is an image of no body");
}

#define KDS_INSTANTIATE(degree) KDS_TEMPLATE_PART class PeriodicWorld<degree>;
KDS_INSTANTIATE(1)
KDS_INSTANTIATE(2)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
