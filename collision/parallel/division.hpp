// How a scene is divided: into how many cells, where, with how large a halo, and who owns and knows each body.
#pragma once

#include "collision/parallel/domain_sets.hpp"
#include "collision/parallel/parallel_options.hpp"
#include "collision/parallel/partition.hpp"
#include "collision/parallel/processes.hpp"
#include "collision/parallel/slots_by_number.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/scripts.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

/// Bodies, by their numbers, whose owner or whose knowing domains change.
class BodyMoves {
 public:
  /// `known`: the domains that are to know it, ascending.
  void add(BodySlot number, DomainIndex owner, std::span<const DomainIndex> known) {
    moves_.push_back({number, owner, static_cast<DomainIndex>(known.size())});
    known_.insert(known_.end(), known.begin(), known.end());
  }
  void clear() { moves_.clear(), known_.clear(); }
  bool empty() const { return moves_.empty(); }
  /// Calls take(number, owner, known) for each, in the order in which they were added.
  template <class Take>
  void each(const Take& take) const {
    std::span<const DomainIndex> left = known_;
    for (const Move& move : moves_) {
      take(move.number, move.owner, left.first(move.knowers));
      left = left.subspan(move.knowers);
    }
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(moves_, known_);
  }

 private:
  struct Move {
    BodySlot number;
    DomainIndex owner, knowers;
  };
  std::vector<Move> moves_;
  std::vector<DomainIndex> known_;  ///< of all, one after another
};

/// What the domains of a scene share. Owners and knowing domains are stored of the bodies that this process stores.
struct Division {
  static constexpr DomainIndex nobody = no_domain;

  Partition partition;
  double halo = 0;                       ///< how far outside a cell its domain knows bodies
  double greatest_radius = 0;            ///< of bodies that have owners
  double greatest_speed = 0;             ///< of these, along an axis, at the beginnings of motions
  double straight_for = never;           ///< s: so long, about, their paths stay nearer than a halo to straight lines
  double largest_guided = never;         ///< greatest radius of bodies that have owners though no other body moves them
  double window_end = never;             ///< s: the window that begins next is over by then
  const SlotsByNumber* slots = nullptr;  ///< of the bodies that are stored; null where they are numbers
  DomainSets sets{partition.size()};
  std::vector<DomainIndex> owner{};         ///< by slot
  std::vector<DomainSets::Number> known{};  ///< by slot, to whom: a set of `sets`

  BodySlot slot(BodySlot number) const { return slots ? slots->find(number) : number; }
  /// The domain in whose cell a body is; `nobody` for fixed bodies that stand still, and for large ones that move: no
  /// other body changes their motion, so all copies of them are right.
  DomainIndex owner_of(BodySlot number) const { return owner[slot(number)]; }
  /// The domains that know it, as a set of `sets`, and as a list, ascending.
  DomainSets::Number known_to(BodySlot number) const { return known[slot(number)]; }
  std::span<const DomainIndex> knowers(BodySlot number) const { return sets[known_to(number)]; }
  bool is_known_to_one(BodySlot number) const { return known_to(number) < partition.size(); }
  void note(BodySlot number, DomainIndex its_owner, std::span<const DomainIndex> its_knowers) {
    const BodySlot at = slot(number);
    if (owner.size() <= at) owner.resize(at + std::size_t{1}, nobody), known.resize(owner.size());
    owner[at] = its_owner, known[at] = sets.number_of(its_knowers);
  }
  /// Finds the domains that know a body with its centre at a place and with a radius: those in whose halo it is.
  void find_knowers(const Eigen::Vector3d& place, double radius, std::vector<DomainIndex>& found) const {
    found.clear();
    partition.each_within(place, halo + radius,
                          [&](std::size_t cell) { found.push_back(static_cast<DomainIndex>(cell)); });
  }
  /// Finds the domains that know an island whose bodies have their centres there: those that are to know one of them,
  /// but for those for which another is farther outside than standing bodies are known, twice the halo. False if one of
  /// these is to own a body of it.
  bool find_knowers(std::span<const Eigen::Vector3d> places, std::vector<DomainIndex>& found) const {
    std::vector<DomainIndex> of_one, both;
    found.clear();
    for (const Eigen::Vector3d& place : places) {
      find_knowers(place, 0, of_one);
      both.clear();
      std::ranges::set_union(found, of_one, std::back_inserter(both));
      found.swap(both);
    }
    std::erase_if(found, [&](DomainIndex domain) {
      return std::ranges::any_of(
          places, [&](const Eigen::Vector3d& place) { return !(outside(place, partition.cell(domain)) <= 2 * halo); });
    });
    return std::ranges::all_of(places, [&](const Eigen::Vector3d& place) {
      return std::ranges::binary_search(found, static_cast<DomainIndex>(partition.cell_of(place)));
    });
  }

  /// Rounding of places, and what else is far below a halo.
  double margin() const { return 0x1p-20 * halo; }
  /// How far apart the centres of two bodies are at most that touch, or rest on each other: in clusters with a gap of
  /// up to 2^-7 of the smaller one's size.
  double touching() const { return (2 + 0x1p-7) * greatest_radius; }
  /// What of the halo windows can use.
  double room() const { return halo - touching(); }
};

/// Where the centre of a body is at a time; for a body that has not entered, where it will enter.
template <int Degree>
Eigen::Vector3d place_at(const certificates::PointMotion<Degree>& path, double t) {
  return path.position(std::max(t, path.start));
}
/// A box in which the centre is during a stretch of time.
template <int Degree>
StaticBox swept_place(const certificates::PointMotion<Degree>& path, double from, double to) {
  return swept_point(path, std::max(from, path.start), std::max(to, path.start));
}
/// How far, along an axis, a path may leave the chord between any two of its places from one time to another, at most:
/// an eighth of the greatest acceleration there, times the square of the time.
template <int Degree>
double bulge_of(const certificates::PointMotion<Degree>& path, double from, double to) {
  double half_acceleration = 0;
  if constexpr (Degree == 2) half_acceleration = path.coefficients[2].cwiseAbs().maxCoeff();
  if constexpr (Degree >= 3) {
    certificates::PointMotion<Degree - 2> halved{.start = path.start};
    bool bends = false;
    for (std::size_t i = 2; i <= Degree; ++i) {
      halved.coefficients[i - 2] = path.coefficients[i] * static_cast<double>(i * (i - 1) / 2);
      bends = bends || !path.coefficients[i].isZero(0);
    }
    if (!bends) return 0;
    const StaticBox swept = swept_place(halved, from, to);
    half_acceleration = swept.min.abs().max(swept.max.abs()).maxCoeff();
  }
  return half_acceleration > 0 ? half_acceleration * (to - from) * (to - from) / 4 : 0;
}

namespace detail {

/// The body whose motion a body has: itself, or that to which it is attached.
template <class Motion>
BodySlot mover_of(const Bodies<Motion>& bodies, BodySlot slot) {
  if (bodies.attachments().empty()) return slot;
  const BodySlot owner = bodies.attachments().owner(slot);
  return owner == no_body ? slot : owner;
}

/// Whether pieces of its motion are to come.
template <class Motion>
bool has_script(const Bodies<Motion>& bodies, const Scripts<Motion>& scripts, BodySlot slot) {
  return !scripts.to_come(mover_of(bodies, slot)).empty();
}

/// What changes the place of a body: nothing; its motion, its script and walls, but no other body; or others too.
enum class MovedBy { nothing, itself, others };

template <class Motion>
MovedBy moved_by(const Bodies<Motion>& bodies, const Scripts<Motion>& scripts, BodySlot slot) {
  const BodySlot mover = mover_of(bodies, slot);
  if (!bodies.fixed(mover)) return MovedBy::others;
  const auto& path = bodies.path(mover);
  const bool moves =
      std::any_of(path.coefficients.begin() + 1, path.coefficients.end(), [](const auto& c) { return !c.isZero(0); });
  return moves || has_script(bodies, scripts, slot) ? MovedBy::itself : MovedBy::nothing;
}

/// The radius of the ball about the centre of a body that holds it; where bodies are attached to each other, all of
/// these.
template <class Motion>
double radius_with_sensors(const Bodies<Motion>& bodies, BodySlot slot) {
  const BodySlot mover = mover_of(bodies, slot);
  double radius = bodies[mover].bounding_radius;
  for (const BodySlot sensor : bodies.attachments().sensors(mover)) {
    radius = std::max(radius, bodies[sensor].bounding_radius);
  }
  return radius;
}

/// The mean distance of neighbours of so many places between two corners; along axes in which all places are much the
/// same it does not count.
inline double spacing(std::uint64_t places, const Eigen::Array3d& low, const Eigen::Array3d& high) {
  const Eigen::Array3d extents = high - low;
  double volume = 1;
  int axes = 0;
  for (int d = 0; d < 3; ++d) {
    if (extents[d] > 1e-3 * extents.maxCoeff()) volume *= extents[d], ++axes;
  }
  return axes > 0 ? std::pow(volume / static_cast<double>(places), 1.0 / axes) : 0;
}

/// Whether each cell is so wide that much of it is far from all others.
inline bool wide_enough(const Partition& partition, double halo) {
  for (std::size_t i = 0; i < partition.size(); ++i) {
    if (!((partition.cell(i).max - partition.cell(i).min).minCoeff() > 6 * halo)) return false;
  }
  return true;
}

}  // namespace detail

/// How many domains a scene is to have: as many as are asked for, or one for each thread if it has enough to do.
inline std::size_t domains_wanted(const ParallelOptions& options, std::size_t threads, std::size_t bodies) {
  constexpr std::size_t bodies_per_domain = 10'000;  // fewer are mostly copies of others'
  if (options.domains > 0) return bodies > 1 ? options.domains : 1;
  return std::min({threads, bodies / bodies_per_domain, most_domains});
}

/// Finds the owner of a body at a time and the domains that know it. Returns the owner.
template <class Motion>
DomainIndex assign_body(const Division& division, const Bodies<Motion>& bodies, const Scripts<Motion>& scripts,
                        BodySlot slot, double now, std::vector<DomainIndex>& knowers) {
  const Eigen::Vector3d place = place_at(bodies.path(slot), now);
  const auto moved = detail::moved_by(bodies, scripts, slot);
  const double radius = detail::radius_with_sensors(bodies, slot);
  const bool guided = moved == detail::MovedBy::itself;
  const bool owned = moved == detail::MovedBy::others || (guided && radius <= division.largest_guided);
  // A body without an owner stays known to the same domains, so its radius counts; and who knows a body that rests on
  // it has to know it too, also one in an island that reaches out of the halo.
  const double reach = radius + 2 * division.greatest_radius + division.halo;
  division.find_knowers(place, owned ? 0 : guided ? never : reach, knowers);
  return owned ? static_cast<DomainIndex>(division.partition.cell_of(place)) : Division::nobody;
}

namespace detail {

/// The greatest radius with which bodies that move by themselves have owners. If all of them had owners, windows of a
/// scene with a large one would be short; so those that are larger than all bodies that others move have none, unless
/// they are many.
template <class Motion>
double largest_guided(const Bodies<Motion>& bodies, const Scripts<Motion>& scripts, std::span<const BodySlot> slots,
                      Team& team) {
  constexpr std::uint64_t few = 16, one_in = 100;
  std::array<double, 1> largest_moved{0};
  std::vector<double> guided;
  for (const BodySlot slot : slots) {
    const MovedBy moved = moved_by(bodies, scripts, slot);
    if (moved == MovedBy::others) largest_moved[0] = std::max(largest_moved[0], bodies[slot].bounding_radius);
    if (moved == MovedBy::itself) guided.push_back(radius_with_sensors(bodies, slot));
  }
  team.combine({}, largest_moved);
  const auto larger = [&](double radius) { return radius > largest_moved[0]; };
  std::array<std::uint64_t, 2> counts{static_cast<std::uint64_t>(std::ranges::count_if(guided, larger)), slots.size()};
  team.combine(counts, {});
  return largest_moved[0] > 0 && counts[0] <= std::max(few, counts[1] / one_in) ? largest_moved[0] : never;
}

}  // namespace detail

/// Divides the bodies as they are at a time; none if the scene is to be run as one world. `slots`: of the bodies that
/// this process answers for; each body of the scene is in one process. The result is the same in all processes.
template <class Motion>
std::optional<Division> divide(const Bodies<Motion>& bodies, const Scripts<Motion>& scripts,
                               std::span<const BodySlot> slots, double now, const ParallelOptions& options,
                               std::size_t threads, Team& team) {
  std::vector<Eigen::Vector3d> places;
  double farthest = 0, radius = 0, speed = 0;
  constexpr std::size_t degree = Motion::degree;
  std::array<double, degree + 1> terms{};  // of paths, along an axis: what is from the square of the time on bends them
  Eigen::Array3d high = Eigen::Array3d::Constant(-never), minus_low = high;
  const auto note = [&](const auto& path, double t) {
    speed = std::max(speed, path.velocity(t).cwiseAbs().maxCoeff());
    const auto local = degree >= 3 ? path.restarted(t) : path;
    for (std::size_t i = 2; i <= degree; ++i)
      terms[i] = std::max(terms[i], local.coefficients[i].cwiseAbs().maxCoeff());
  };
  const double largest_guided = detail::largest_guided(bodies, scripts, slots, team);
  for (const BodySlot slot : slots) {
    const auto moved = detail::moved_by(bodies, scripts, slot);
    if (moved == detail::MovedBy::nothing) continue;
    if (moved == detail::MovedBy::itself && detail::radius_with_sensors(bodies, slot) > largest_guided) continue;
    const auto& path = bodies.path(slot);
    const Eigen::Vector3d& place = places.emplace_back(place_at(path, now));
    farthest = std::max(farthest, place.cwiseAbs().maxCoeff());
    radius = std::max(radius, bodies[slot].bounding_radius);
    high = high.max(place.array()), minus_low = minus_low.max(-place.array());
    note(path, std::max(now, path.start));
    for (std::size_t i = 2; i <= degree; ++i) {  // of what rests, when it does no more
      terms[i] = std::max(terms[i], bodies.free_term(slot, i, now).cwiseAbs().maxCoeff());
    }
    for (const Motion& piece : scripts.to_come(slot)) note(path_of(piece), path_of(piece).start);
  }
  std::array<std::uint64_t, 1> count{places.size()};
  std::vector<double> greatest{farthest, radius,       speed,        high[0],     high[1],
                               high[2],  minus_low[0], minus_low[1], minus_low[2]};
  greatest.insert(greatest.end(), terms.begin(), terms.end());
  team.combine(count, greatest);
  if (count[0] < 2) return std::nullopt;
  farthest = greatest[0], radius = greatest[1], speed = greatest[2];
  std::copy_n(&greatest[3], 3, high.begin()), std::copy_n(&greatest[6], 3, minus_low.begin());
  std::copy_n(&greatest[9], terms.size(), terms.begin());
  const double halo = 2 * radius + options.halo * detail::spacing(count[0], -minus_low, high);
  // Places must be known far more exactly than the distances of bodies.
  if (!(std::isfinite(halo) && halo > 0x1p-20 * farthest)) return std::nullopt;
  double straight_for = never;
  for (std::size_t i = 2; i <= degree; ++i) {
    if (terms[i] > 0) straight_for = std::min(straight_for, std::pow(halo / terms[i], 1.0 / static_cast<double>(i)));
  }
  std::size_t wanted = domains_wanted(options, threads, count[0]);
  Partition partition(places, wanted, team);
  while (wanted > 1 && options.domains == 0 && !detail::wide_enough(partition, halo)) {
    wanted -= std::max<std::size_t>(1, wanted / 8);
    partition = Partition(places, wanted, team);
  }
  if (partition.size() < 2) return std::nullopt;
  return Division{.partition = std::move(partition),
                  .halo = halo,
                  .greatest_radius = radius,
                  .greatest_speed = speed,
                  .straight_for = straight_for,
                  .largest_guided = largest_guided};
}

}  // namespace kds::collision
