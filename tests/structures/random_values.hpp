// Random moving values of the kinds that are hard on a kinetic structure, and operations on them.
#pragma once

#include "certificates/plane_motion.hpp"
#include "certificates/point_motion.hpp"
#include "kds/motion.hpp"
#include "kds/testing/random_motions.hpp"
#include "tests/support/exact_models.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace kds::tests {

using testing::all_kinds;
using testing::beginning;
using testing::Kind;
using testing::random_delay;
using testing::random_motion;

/// The same in the plane, each axis on its own.
template <int Degree>
certificates::PlaneMotion<Degree> random_plane_motion(Random& random, Kind kind, double now) {
  const auto x = random_motion<Degree>(random, kind, now);
  return {{x.position, random_motion<Degree>(random, kind, now).position}, x.start};
}

/// The same in space, each axis on its own.
template <int Degree>
certificates::PointMotion<Degree> random_point_motion(Random& random, Kind kind, double now) {
  certificates::PointMotion<Degree> path;
  for (int d = 0; d < 3; ++d) {
    const auto axis = random_motion<Degree>(random, kind, now);
    for (std::size_t i = 0; i <= Degree; ++i) path.coefficients[i][d] = axis.position.c[i];
    path.start = axis.start;
  }
  return path;
}

/// Motions by id, and what they say of each other just after a time, exactly.
template <int Degree>
class Model {
 public:
  std::map<std::uint32_t, Motion<Degree>> motions;

  /// Ids in ascending order of value, those of values that are one for ever by (rank, id).
  template <class Rank>
  std::vector<std::uint32_t> order(double t, Rank&& rank) const {
    std::vector<std::uint32_t> ids;
    for (const auto& [id, motion] : motions) ids.push_back(id);
    std::stable_sort(ids.begin(), ids.end(), [&](auto a, auto b) { return rank(a) < rank(b); });
    std::vector<oracle::Value> values;
    for (const std::uint32_t id : ids) values.push_back(value(id));
    std::vector<std::uint32_t> result;
    for (const std::size_t i : oracle::order_after(values, t)) result.push_back(ids[i]);
    return result;
  }

  /// Id of the greatest value, the least id of those that are one for ever. Precondition: not empty.
  std::uint32_t greatest(double t) const {
    std::vector<std::uint32_t> ids;
    std::vector<oracle::Value> values;
    for (const auto& [id, motion] : motions) {
      ids.push_back(id);
      values.push_back(value(id));
    }
    return ids[oracle::greatest_after(values, t)];
  }

  oracle::Value value(std::uint32_t id) const {
    const auto& motion = motions.at(id);
    return {{motion.position.c.begin(), motion.position.c.end()}, motion.start};
  }

  std::uint32_t random_id(Random& random) const {
    return std::next(motions.begin(), static_cast<std::ptrdiff_t>(random.below(motions.size())))->first;
  }
};

/// One change of one value.
template <int Degree>
struct Change {
  enum class What { insert, remove, update } what;
  std::uint32_t id;
  Motion<Degree> motion;
};

/// Draws a change that is legal for the model at time `now`, and makes it there.
template <int Degree>
Change<Degree> random_change(Random& random, Kind kind, double now, std::size_t most, Model<Degree>& model) {
  using What = typename Change<Degree>::What;
  auto& motions = model.motions;
  const std::size_t choice = random.below(6);
  if (motions.empty() || (choice == 0 && motions.size() < most)) {
    std::uint32_t id = 0;
    do id = static_cast<std::uint32_t>(random.below(2 * most));
    while (motions.contains(id));
    motions[id] = random_motion<Degree>(random, kind, now);
    if (random.one_in(4)) motions[id] = motions.begin()->second;  // maybe itself, maybe one with the first for ever
    return {What::insert, id, motions[id]};
  }
  const std::uint32_t id = model.random_id(random);
  if (choice == 1 && motions.size() > 2) {
    motions.erase(id);
    return {What::remove, id, {}};
  }
  auto& motion = motions[id];
  if (choice == 2) {  // turns round where it is
    motion = restarted(motion, now);
    if constexpr (Degree >= 1) motion.position.c[1] = -motion.position.c[1];
  } else if (choice == 3) {  // takes up the motion of another
    motion = motions[model.random_id(random)];
  } else if (choice != 4) {  // jumps; 4: the same motion again
    motion = random_motion<Degree>(random, kind, now);
  }
  return {What::update, id, motion};
}

template <int Degree, class Structure>
void apply(const Change<Degree>& change, Structure& structure, double now) {
  using What = typename Change<Degree>::What;
  switch (change.what) {
    case What::insert:
      structure.insert(change.id, change.motion, now);
      break;
    case What::remove:
      structure.remove(change.id, now);
      break;
    case What::update:
      structure.update(change.id, change.motion, now);
      break;
  }
}

}  // namespace kds::tests
