// The fat boxes of a kinetic grid: how large each is, and how long it is valid.
#include "collision/broad_phase/kinetic_grid.hpp"
#include "collision/degrees.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kds::collision {
namespace {

constexpr double largest = std::numeric_limits<double>::max();

/// The least travel, over its coordinates: boxes without extent have a travel too, which then adapts.
constexpr double least_part_of_coordinates = 0x1p-40;
constexpr double least_travel_at_all = 0x1p-500;

/// Seconds until a box on a straight path leaves a fat one that contains it now, or a little less; 0 if that is not
/// certain. Without branches, since processors cannot predict to which sides it moves.
template <int Degree>
double exit_time(const KineticBox<Degree>& box, const BoxBounds& present, const BoxBounds& fat) {
  if constexpr (Degree > 1) return 0;
  const Eigen::Vector3d& low = box.min.coefficients[1];
  const Eigen::Vector3d& high = box.max.coefficients[1];
  const auto time = [](Two room, Two speed) { return speed > 0 ? room / speed : both(never); };
  const Two xy = time(present.xy - fat.xy, Two{-low[0], -low[1]});
  const Two zx = time(present.zx - fat.zx, Two{-low[2], high[0]});
  const Two yz = time(present.yz - fat.yz, Two{high[1], high[2]});
  const Two earliest = lesser(lesser(xy, zx), yz);
  return std::min(earliest[0], earliest[1]) * (1 - 0x1p-20);
}

}  // namespace

/// Seconds until a box has moved by its travel, `never` if it is at rest; exact for straight paths, up to rounding.
template <int Degree>
template <class Sweep>
inline double KineticGrid<Degree>::lifetime(double travel, const KineticBox<Degree>& kinetic, const Sweep& sweep) {
  if constexpr (Degree >= 3) return sweep.time_to_move(travel);
  const double speed = sweep.speed();
  double time = speed > 0 ? std::min(travel / speed, largest) : never;
  if constexpr (Degree == 2) {
    const double bend =
        kinetic.min.coefficients[2].cwiseAbs().cwiseMax(kinetic.max.coefficients[2].cwiseAbs()).maxCoeff();
    if (bend > 0) time = std::min(time, std::sqrt(travel / bend));
  }
  return time;
}

/// `may_begin()`: whether a level coarser than `coarsest` may be begun just for the body's travel.
template <int Degree>
template <class Sweep, class MayBegin>
inline auto KineticGrid<Degree>::fat_box(Body& body, const KineticBox<Degree>& kinetic, const Sweep& sweep,
                                         const StaticBox& present, double now, double coarsest,
                                         MayBegin&& may_begin) const -> FatBox {
  body.way = body.way_until(now);
  const double size = present.extent();
  const double coordinates = present.min.abs().max(present.max.abs()).maxCoeff();
  body.travel = std::max(
      {double{body.travel}, tuning_.least_travel * size, least_part_of_coordinates * coordinates, least_travel_at_all});
  double time = lifetime(body.travel, kinetic, sweep);
  body.speed = body.travel / time;
  if (time == never) return {present, never};
  // A jostled body may go anywhere next; a margin larger than its size would mostly be in vain.
  double margin = body.jostled >= tuning_.jostled_at && body.travel <= 0.5 * size ? double{body.travel} : 0;
  Eigen::Array3d ahead = Eigen::Array3d::Zero();  // over the margin
  if (margin > 0) {
    ahead = tuning_.lead / sweep.speed() * kinetic.min.coefficients[1].array();
    time *= 1 + tuning_.lead;
  }
  const auto swept = [&](double expiry) {
    const StaticBox box = sweep.until(expiry);
    if (margin == 0) return box;
    const Eigen::Array3d shift = margin * ahead;
    return StaticBox{box.min.min(present.min + (shift - margin)), box.max.max(present.max + (shift + margin))};
  };
  for (std::uint32_t certificates = 0;;) {
    // At a large clock, where doubles are sparse, a box lasts until the next one at least.
    double expiry = std::max(now + time, next_up(now));
    if (expiry > largest) return {whole_space(), never, certificates};
    StaticBox box = swept(expiry);
    double extent = box.extent();
    if (!(extent <= largest)) return {whole_space(), never, certificates};
    ++certificates;
    // Cutting a box that is just too large for a level costs less than putting it into the next.
    const double room_below = fat_boxes_.room_below(extent);
    if (extent < 1.5 * room_below && size < 0.75 * room_below) {
      const double cut = 0.999 * (room_below - size) / (extent - size);
      time *= cut;
      margin *= cut;
      expiry = std::max(now + time, next_up(now));
      box = swept(expiry);
      extent = box.extent();
    }
    // A coarser level has a cost for all bodies, so it is begun only if many want it; until then boxes are cut to fit.
    const double room = coarsest - size;
    if (extent - size <= room || room < 0.25 * size || expiry == next_up(now) || may_begin()) {
      return {box, expiry, certificates};
    }
    body.travel *= 0.75;
    time *= 0.75;
    margin *= 0.75;
  }
}

template <int Degree>
auto KineticGrid<Degree>::fat_box(BodySlot id, const KineticBox<Degree>& kinetic, const BoxSweep<Degree>& sweep,
                                  const StaticBox& present, double now) -> FatBox {
  if (++boxes_since_ > fat_boxes_.size()) wishes_ = boxes_since_ = 0;
  const FatBox fat = fat_box(bodies_[id], kinetic, sweep, present, now, fat_boxes_.coarsest(), [&] {
    if (++wishes_ * tuning_.share_for_level <= fat_boxes_.size()) return false;
    wishes_ = boxes_since_ = 0;
    return true;
  });
  counters_.certificates += fat.certificates;
  return fat;
}

/// Gives a body a fat box that fits a level, unless the body itself does not. Returns the number of tries.
template <int Degree>
std::uint32_t KineticGrid<Degree>::fit(Body& body, const KineticBox<Degree>& kinetic, StaticBox& box, double now,
                                       double coarsest) const {
  const auto fit = [&](const auto& sweep) __attribute__((always_inline)) {
    const FatBox fat = fat_box(body, kinetic, sweep, sweep.begin(), now, coarsest, [] { return false; });
    box = fat.box;
    body.begin_life(fat.expiry, now);
    return fat.certificates;
  };
  if constexpr (Degree == 1) {
    if (corners_move_alike(kinetic)) return fit(AlikeSweep(kinetic, now));
  }
  return fit(BoxSweep<Degree>(kinetic, now));
}

/// The factor of the travel of a body that has not been jostled, if its box has lasted its time.
template <int Degree>
double KineticGrid<Degree>::travel_factor(std::uint32_t begun) const {
  switch (begun) {
    case 0:
      return tuning_.grow_after_none;
    case 1:
      return tuning_.grow_after_one;
    case 2:
      return 1;
    default:
      return begun < tuning_.many ? tuning_.shrink_after_some : tuning_.shrink_after_many;
  }
}

/// The travel of a jostled body is chosen so that its renewals cost about as much as its pairs and their tests. For
/// other bodies it depends on how the last box ended. A renewal costs about as much as two pairs, so if a box that has
/// lasted its time had one or two pairs, including those begun by others' renewals, a longer travel and a shorter one
/// would both cost more (measured, for packings from 0.01 to 0.25). A travel whose box the body left early, since its
/// motion changed, was too long.
template <int Degree>
void KineticGrid<Degree>::adapt_travel(BodySlot id, double now) {
  Body& body = bodies_[id];
  const bool lasted = body.expiry <= now;
  add_up_to_most(body.begun, body.in_vain / tuning_.found_per_pair);
  if (body.jostled >= tuning_.jostled_at) {
    const std::uint32_t spent = tuning_.tests_per_pair * body.begun + body.tests;
    if (spent < tuning_.little_spent) body.travel = std::min(tuning_.grow_jostled * body.travel, greatest_travel);
    if (spent > tuning_.much_spent) body.travel *= tuning_.shrink_jostled;
  } else if (lasted) {
    body.travel = std::min(travel_factor(body.begun) * body.travel, greatest_travel);
  } else if (body.expiry - now > 0.5 * body.life) {
    body.travel *= tuning_.shrink_after_turn;
  }
  if (Degree == 1 && body.changed) {
    body.jostled = static_cast<std::int8_t>(std::min(body.jostled + 1, tuning_.jostled_most));
  } else {
    body.jostled = static_cast<std::int8_t>(std::max(body.jostled - 2, 0));
  }
  body.begun = body.in_vain = 0;
  body.changed = false;
  body.tests = 0;
}

/// Until when the present fat box of a body contains a new motion, if that is long enough to keep the box; otherwise
/// `now`.
template <int Degree>
double KineticGrid<Degree>::kept_until(BodySlot id, const KineticBox<Degree>& kinetic, const BoxSweep<Degree>& sweep,
                                       const StaticBox& present, double now) {
  const BoxBounds& fat = fat_boxes_.bounds(id);
  const BoxBounds bounds(present);
  if (!fat.contains(bounds) || fat_boxes_.slanted(id)) return now;
  const double time = lifetime(bodies_[id].travel, kinetic, sweep);
  if (time == never) return never;
  const double expiry = now + std::max((Degree == 1 ? tuning_.kept_share_straight : tuning_.kept_share_curved) * time,
                                       exit_time(kinetic, bounds, fat));
  if (!(expiry > now && expiry <= largest && fat.contains(BoxBounds(sweep.until(expiry))))) return now;
  ++counters_.certificates;
  return expiry;
}

#define KDS_INSTANTIATE(degree) KDS_TEMPLATE_PART class KineticGrid<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
