// How a scene is divided: into how many cells, where, with how large a halo, and who owns and knows each body.
#pragma once

#include "collision/parallel/domain_sets.hpp"
#include "collision/parallel/parallel_options.hpp"
#include "collision/parallel/partition.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/scripts.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

/// Bodies, by their numbers, that are owned or known by others than before.
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

/// What the domains of a scene share. Bodies by their numbers.
struct Division {
  static constexpr DomainIndex nobody = no_domain;

  Partition partition;
  double halo = 0;                ///< how far outside a cell its domain knows bodies
  double greatest_radius = 0;     ///< of bodies that have owners
  double greatest_speed = 0;      ///< of these, along an axis, at the beginnings of motions
  double greatest_bend = 0;       ///< of these: half an acceleration, along an axis
  double largest_guided = never;  ///< how far bodies reach that have owners though no other body moves them
  double bulge = 0;               ///< how far a path may leave the chord between two of its places within a window
  /// The domain in whose cell a body is; `nobody` of fixed bodies that stand, and of large ones that move: no other
  /// body changes how they do, so all that know them know them right.
  std::vector<DomainIndex> owner{};
  std::vector<DomainSets::Number> known{};  ///< to whom: a set of `sets`
  DomainSets sets{partition.size()};

  /// Those to whom a body is known, ascending.
  std::span<const DomainIndex> knowers(BodySlot number) const { return sets[known[number]]; }
  /// Whether a body has no owner, and may move.
  bool is_everywhere(BodySlot number) const {
    return owner[number] == nobody && knowers(number).size() == partition.size();
  }
  bool is_known_to_one(BodySlot number) const { return known[number] < partition.size(); }
  /// Finds the domains that know what is at a place and reaches so far: those in whose halo it is.
  void find_knowers(const Eigen::Vector3d& place, double reach, std::vector<DomainIndex>& found) const {
    found.clear();
    partition.each_within(place, halo + reach,
                          [&](std::size_t cell) { found.push_back(static_cast<DomainIndex>(cell)); });
  }

  /// Rounding of places, and what else is far below a halo.
  double margin() const { return 0x1p-20 * halo; }
  /// What of the halo windows can use.
  double room() const { return halo - 2 * greatest_radius; }
};

/// Where the centre of a body is at a time; of one that has not entered, where it will.
template <int Degree>
Eigen::Vector3d place_at(const certificates::PointMotion<Degree>& path, double t) {
  return path.position(std::max(t, path.start));
}
/// A box in which it is for a while.
template <int Degree>
StaticBox swept_place(const certificates::PointMotion<Degree>& path, double from, double to) {
  return swept_point(path, std::max(from, path.start), std::max(to, path.start));
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

/// How far from its centre a body reaches, or the farthest of what is attached to it or it to.
template <class Motion>
double reach(const Bodies<Motion>& bodies, BodySlot slot) {
  const BodySlot mover = mover_of(bodies, slot);
  double reach = bodies[mover].bounding_radius;
  for (const BodySlot sensor : bodies.attachments().sensors(mover)) {
    reach = std::max(reach, bodies[sensor].bounding_radius);
  }
  return reach;
}

/// The mean distance of neighbours; along axes in which all places are much the same it does not count.
inline double spacing(const std::vector<Eigen::Vector3d>& places) {
  Eigen::Array3d low = places.front().array(), high = low;
  for (const Eigen::Vector3d& place : places) low = low.min(place.array()), high = high.max(place.array());
  const Eigen::Array3d extents = high - low;
  double volume = 1;
  int axes = 0;
  for (int d = 0; d < 3; ++d) {
    if (extents[d] > 1e-3 * extents.maxCoeff()) volume *= extents[d], ++axes;
  }
  return axes > 0 ? std::pow(volume / static_cast<double>(places.size()), 1.0 / axes) : 0;
}

/// Whether each cell is so wide that much of it is far from all others.
inline bool wide_enough(const Partition& partition, double halo) {
  for (std::size_t i = 0; i < partition.size(); ++i) {
    if (!((partition.cell(i).max - partition.cell(i).min).minCoeff() > 6 * halo)) return false;
  }
  return true;
}

}  // namespace detail

/// How many domains a scene is to have: as many as are asked for, or one for each thread if it has enough to do. One if
/// bodies turn: two on two threads take as long as one world (docs/parallel.md).
template <class Motion>
std::size_t domains_wanted(const ParallelOptions& options, std::size_t threads, std::size_t bodies) {
  constexpr std::size_t bodies_per_domain = 10'000;  // fewer are mostly copies of others'
  if (options.domains > 0) return bodies > 1 ? options.domains : 1;
  if (turns<Motion>) return 1;
  return std::min({threads, bodies / bodies_per_domain, most_domains});
}

/// Finds out who owns and who knows each body at a time.
template <class Motion>
void assign_bodies(Division& division, const Bodies<Motion>& bodies, const Scripts<Motion>& scripts, double now) {
  division.owner.assign(bodies.slots(), Division::nobody);
  division.known.assign(bodies.slots(), division.sets.number_of({}));
  std::vector<DomainIndex> knowers;
  for (BodySlot slot = 0; slot < bodies.slots(); ++slot) {
    if (!bodies.alive(slot)) continue;
    const Eigen::Vector3d place = place_at(bodies.path(slot), now);
    const auto moved = detail::moved_by(bodies, scripts, slot);
    const double reach = detail::reach(bodies, slot);
    const bool guided = moved == detail::MovedBy::itself;
    const bool owned = moved == detail::MovedBy::others || (guided && reach <= division.largest_guided);
    if (owned) division.owner[slot] = static_cast<DomainIndex>(division.partition.cell_of(place));
    // Those without an owner stay known for good, so it counts how far they reach.
    division.find_knowers(place, owned ? 0 : guided ? never : reach, knowers);
    division.known[slot] = division.sets.number_of(knowers);
  }
}

namespace detail {

/// How far bodies that move by themselves may reach if they are to have owners. If all had, windows of a scene with a
/// large one would be short; so those that are larger than all that others move have none, unless they are many.
template <class Motion>
double largest_guided(const Bodies<Motion>& bodies, const Scripts<Motion>& scripts) {
  constexpr std::size_t few = 16, one_in = 100;
  double largest_moved = 0;
  std::vector<double> guided;
  for (BodySlot slot = 0; slot < bodies.slots(); ++slot) {
    if (!bodies.alive(slot)) continue;
    const MovedBy moved = moved_by(bodies, scripts, slot);
    if (moved == MovedBy::others) largest_moved = std::max(largest_moved, bodies[slot].bounding_radius);
    if (moved == MovedBy::itself) guided.push_back(reach(bodies, slot));
  }
  const auto larger = [&](double reach) { return reach > largest_moved; };
  const auto many = static_cast<std::size_t>(std::ranges::count_if(guided, larger));
  return largest_moved > 0 && many <= std::max(few, bodies.size() / one_in) ? largest_moved : never;
}

}  // namespace detail

/// Divides the bodies as they are at a time; none if the scene is to be run as one world.
template <class Motion>
std::optional<Division> divide(const Bodies<Motion>& bodies, const Scripts<Motion>& scripts, double now,
                               const ParallelOptions& options, std::size_t threads) {
  std::vector<Eigen::Vector3d> places;
  double farthest = 0, greatest_radius = 0, greatest_speed = 0, greatest_bend = 0;
  const auto note = [&](const auto& path, double t) {
    greatest_speed = std::max(greatest_speed, path.velocity(t).cwiseAbs().maxCoeff());
    if constexpr (Motion::degree == 2) {
      greatest_bend = std::max(greatest_bend, path.coefficients[2].cwiseAbs().maxCoeff());
    }
  };
  const double largest_guided = detail::largest_guided(bodies, scripts);
  for (BodySlot slot = 0; slot < bodies.slots(); ++slot) {
    if (!bodies.alive(slot)) continue;
    const auto moved = detail::moved_by(bodies, scripts, slot);
    if (moved == detail::MovedBy::nothing) continue;
    if (moved == detail::MovedBy::itself && detail::reach(bodies, slot) > largest_guided) continue;
    const auto& path = bodies.path(slot);
    places.push_back(place_at(path, now));
    farthest = std::max(farthest, places.back().cwiseAbs().maxCoeff());
    greatest_radius = std::max(greatest_radius, bodies[slot].bounding_radius);
    note(path, std::max(now, path.start));
    for (const Motion& piece : scripts.to_come(slot)) note(path_of(piece), path_of(piece).start);
  }
  if (places.size() < 2) return std::nullopt;
  const double halo = 2 * greatest_radius + options.halo * detail::spacing(places);
  // Places must be known far better than how far bodies are apart.
  if (!(std::isfinite(halo) && halo > 0x1p-20 * farthest)) return std::nullopt;
  std::size_t wanted = domains_wanted<Motion>(options, threads, places.size());
  Partition partition(places, wanted);
  while (wanted > 1 && options.domains == 0 && !detail::wide_enough(partition, halo)) {
    wanted -= std::max<std::size_t>(1, wanted / 8);
    partition = Partition(places, wanted);
  }
  if (partition.size() < 2) return std::nullopt;
  Division division{.partition = std::move(partition),
                    .halo = halo,
                    .greatest_radius = greatest_radius,
                    .greatest_speed = greatest_speed,
                    .greatest_bend = greatest_bend,
                    .largest_guided = largest_guided};
  assign_bodies(division, bodies, scripts, now);
  return division;
}

}  // namespace kds::collision
