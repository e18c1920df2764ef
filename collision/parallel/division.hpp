// How a scene is divided: into how many cells, where, with how large a halo, and who owns and knows each body.
#pragma once

#include "collision/parallel/parallel_options.hpp"
#include "collision/parallel/partition.hpp"
#include "collision/parallel/world_events.hpp"
#include "collision/world/bodies.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace kds::collision {

/// A set of domains, one bit each.
using DomainMask = std::uint64_t;
constexpr DomainMask domain_bit(std::size_t domain) { return DomainMask{1} << domain; }

/// A body, by its number, is owned or known by others than before.
struct BodyMove {
  BodySlot number;
  std::uint8_t owner;
  DomainMask known;

  template <class Archive>
  void archive(Archive& archive) {
    archive(number, owner, known);
  }
};

/// What the domains of a scene share. Bodies by their numbers.
struct Division {
  static constexpr std::uint8_t nobody = DomainEvent::nobody;

  Partition partition;
  double halo = 0;                    ///< how far outside a cell its domain knows bodies
  double greatest_radius = 0;         ///< of bodies that have owners
  double greatest_speed = 0;          ///< of these, along an axis, at first
  double greatest_bend = 0;           ///< of these: half an acceleration, along an axis
  double bulge = 0;                   ///< how far a path may leave the chord between two of its places within a window
  std::vector<std::uint8_t> owner{};  ///< the domain in whose cell a body is; `nobody` of fixed bodies at rest
  std::vector<DomainMask> known{};    ///< to whom

  /// Rounding of places, and what else is far below a halo.
  double margin() const { return 0x1p-20 * halo; }
  /// What of the halo windows can use.
  double room() const { return halo - 2 * greatest_radius; }
};

namespace detail {

/// Whether a body can change its place. Other bodies have no owner, since nothing about them is found out.
template <class Motion>
bool has_owner(const Bodies<Motion>& bodies, BodySlot slot) {
  if (!bodies.fixed(slot)) return true;
  const auto& path = bodies.path(slot);
  return std::any_of(path.coefficients.begin() + 1, path.coefficients.end(),
                     [](const auto& c) { return !c.isZero(0); });
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

/// How many domains a scene is to have: as many as are asked for, or one for each thread if it has enough to do.
inline std::size_t domains_wanted(const ParallelOptions& options, std::size_t threads, std::size_t bodies) {
  constexpr std::size_t bodies_per_domain = 10'000;  // fewer are mostly copies of others'
  if (options.domains > 0) return bodies > 1 ? options.domains : 1;
  return std::min({threads, bodies / bodies_per_domain, most_domains});
}

/// Finds out who owns and who knows each body at a time.
template <class Motion>
void assign_bodies(Division& division, const Bodies<Motion>& bodies, double now) {
  division.owner.assign(bodies.slots(), Division::nobody);
  division.known.assign(bodies.slots(), 0);
  for (BodySlot slot = 0; slot < bodies.slots(); ++slot) {
    if (!bodies.alive(slot)) continue;
    const Eigen::Vector3d place = bodies.path(slot).position(now);
    const bool owned = detail::has_owner(bodies, slot);
    if (owned) division.owner[slot] = static_cast<std::uint8_t>(division.partition.cell_of(place));
    // Those without an owner stay known for good, so it counts how far they reach.
    const double reach = division.halo + (owned ? 0 : bodies[slot].bounding_radius);
    for (std::size_t i = 0; i < division.partition.size(); ++i) {
      if (outside(place, division.partition.cell(i)) <= reach) division.known[slot] |= domain_bit(i);
    }
  }
}

/// Divides the bodies as they are at a time; none if the scene is to be run as one world.
template <class Motion>
std::optional<Division> divide(const Bodies<Motion>& bodies, double now, const ParallelOptions& options,
                               std::size_t threads) {
  std::vector<Eigen::Vector3d> places;
  double farthest = 0, greatest_radius = 0, greatest_speed = 0, greatest_bend = 0;
  for (BodySlot slot = 0; slot < bodies.slots(); ++slot) {
    if (!bodies.alive(slot) || !detail::has_owner(bodies, slot)) continue;
    const auto& path = bodies.path(slot);
    places.push_back(path.position(now));
    farthest = std::max(farthest, places.back().cwiseAbs().maxCoeff());
    greatest_radius = std::max(greatest_radius, bodies[slot].bounding_radius);
    greatest_speed = std::max(greatest_speed, path.velocity(now).cwiseAbs().maxCoeff());
    if constexpr (Motion::degree == 2) {
      greatest_bend = std::max(greatest_bend, path.coefficients[2].cwiseAbs().maxCoeff());
    }
  }
  if (places.size() < 2) return std::nullopt;
  const double halo = 2 * greatest_radius + options.halo * detail::spacing(places);
  // Places must be known far better than how far bodies are apart.
  if (!(std::isfinite(halo) && halo > 0x1p-20 * farthest)) return std::nullopt;
  std::size_t wanted = domains_wanted(options, threads, places.size());
  Partition partition(places, wanted);
  while (wanted > 1 && options.domains == 0 && !detail::wide_enough(partition, halo)) {
    partition = Partition(places, --wanted);
  }
  if (partition.size() < 2) return std::nullopt;
  Division division{.partition = std::move(partition),
                    .halo = halo,
                    .greatest_radius = greatest_radius,
                    .greatest_speed = greatest_speed,
                    .greatest_bend = greatest_bend};
  assign_bodies(division, bodies, now);
  return division;
}

}  // namespace kds::collision
