// Periodic worlds saved, and loaded again.
#include "collision/periodic/periodic_world.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/queue_room.hpp"
#include "kds/framework/snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision {
namespace {

/// Of numbers of periods: far more than a body crosses, and sums of two of them are numbers of 64 bits.
constexpr std::int64_t most_periods = std::int64_t{1} << 60;
/// Of the norm of an orientation: what a world takes.
constexpr double unit_tolerance = 1e-6;

/// What decides events and is not among the options of the world inside, which compares its own. The seed only begins
/// what thermostats draw, and the state of that is saved.
template <class Archive>
void archive_periodic_options(Archive& archive, const PeriodicOptions& options) {
  const auto same = [&](const char* what, auto value) {
    auto found = value;
    archive(found);
    if (found != value) image::fail(std::string("it is of a periodic world with other options: ") + what);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    same("boundaries", static_cast<std::uint32_t>(options.boundaries[axis]));
    if (options.boundaries[axis] == Boundary::open) continue;
    same("min", options.min[static_cast<int>(axis)]), same("max", options.max[static_cast<int>(axis)]);
  }
  same("shear_rate", options.shear_rate);
  if (options.shear_rate != 0) same("world.start_time, when the layers are in line", options.world.start_time);
  for (const double temperature : options.wall_temperatures) same("wall_temperatures", temperature);
  same("elastic_within", options.elastic_within);
}

bool few_periods(const Offset& offset) {
  return std::all_of(offset.begin(), offset.end(), [](std::int64_t n) { return std::abs(n / 2) <= most_periods / 2; });
}

}  // namespace

/// A body is the one that the world has, and has just the images that it needs where it is.
template <int Degree>
void PeriodicWorld<Degree>::check_loaded(const Real& body) const {
  const auto require = [&](bool right, const char* what) { image::require(right, "bodies", slot_of(body), what); };
  const auto is = [&](BodyId in_world, const Offset& offset) {
    return world_.contains(in_world) && body_slot(in_world) < roles_.size() && role(in_world).owner == slot_of(body) &&
           role(in_world).offset == offset;
  };
  require(is(body.in_world, {}), "it is not in the world");
  require(body.radius == world_.shape(body.in_world).bounding_radius, "its radius is not that of its shape");
  require(body.radius <= greatest_radius_, "its radius is beyond the greatest");
  require(body.inverse_mass == (world_.fixed(body.in_world) ? 0 : 1 / world_.mass(body.in_world)),
          "its inverse mass is not that of its mass");
  require(body.restitution == world_.restitution(body.in_world), "its restitution is not that in the world");
  require(image::is_past(body.last_contact, now()) && image::is_past(body.placed_at, now()),
          "it knows of what is to come");
  require(few_periods(body.crossings) && few_periods({body.shift}), "it is too many periods away");
  const auto& [x, y, z, w] = body.orientation;
  require(std::abs(Eigen::Quaterniond(w, x, y, z).norm() - 1) <= unit_tolerance,
          "its orientation is no unit quaternion");
  std::vector<Offset> needed = needed_images(body), there;
  for (const Image& one : body.images) {
    require(is(one.id, one.offset), "an image of it is not in the world");
    there.push_back(one.offset);
  }
  std::sort(needed.begin(), needed.end());
  std::sort(there.begin(), there.end());
  require(needed == there, "it has not just the images that it needs");
}

template <int Degree>
void PeriodicWorld<Degree>::check_loaded() const {
  double slack = 0;
  if (greatest_radius_ != 0) {
    try {
      require_room(greatest_radius_);
    } catch (const std::invalid_argument& error) {
      image::fail(error.what());
    }
    if (!(greatest_radius_ > 0 && std::isfinite(greatest_radius_))) image::fail("the greatest radius is none");
    slack = slack_of(greatest_radius_);
  }
  if (slack_ != slack) image::fail("the slack of the ends is not that of the greatest radius");
  if (keys_.generations().size() > reals_.size()) image::fail("generations: there are more than there are slots");
  for (BodySlot slot = 0; slot < reals_.size(); ++slot) {
    image::require(id_of(slot) < keys_.next_id(), "generations", slot, "is not before the next one");
  }
  std::set<BodySlot> free;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    image::require(free_[i] < reals_.size() && !reals_[free_[i]].alive && free.insert(free_[i]).second, "free", i,
                   "is no free slot, or listed twice");
  }
  if (free.size() + size_ != reals_.size()) image::fail("bodies: a slot is free, and not listed");
  std::size_t images = 0;
  for (const Real& body : reals_) {
    if (!body.alive) continue;
    check_loaded(body);
    images += body.images.size();
  }
  if (world_.size() != size_ + images) image::fail("there is a body in the world of a periodic world that is none");
}

template <int Degree>
template <class Archive>
void PeriodicWorld<Degree>::archive(Archive& archive) {
  archive.tag("periodic world, form 2");
  archive_periodic_options(archive, options_);
  archive(world_, roles_, reals_, keys_, free_, greatest_radius_, slack_, thermal_, counters_);
  if constexpr (Archive::loading) {
    size_ = static_cast<std::size_t>(
        std::count_if(reals_.begin(), reals_.end(), [](const Real& body) { return body.alive; }));
    check_loaded();
    leaving_.resize(0);
    make_room(leaving_, reals_.size());
    for (Real& body : reals_) {
      if (body.alive) schedule(body);
    }
  }
}

#define KDS_INSTANTIATE(degree)                                       \
  KDS_TEMPLATE_PART class PeriodicWorld<degree>;                      \
  template void PeriodicWorld<degree>::archive(kds::detail::Writer&); \
  template void PeriodicWorld<degree>::archive(kds::detail::Reader&);
KDS_INSTANTIATE(1)
KDS_INSTANTIATE(2)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
