// What goes between C++ and Python as rows of NumPy arrays.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/profile.hpp"
#include "collision/shapes/feature.hpp"
#include "io/events.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace kds_python {

/// Motions of all worlds go through this type, which holds each of them exactly.
struct Motion {
  static constexpr int degree = 5;

  kds::certificates::PointMotion<degree> path{};
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();

  friend const kds::certificates::PointMotion<degree>& path_of(const Motion& motion) { return motion.path; }
};

// Rows have no padding, so that equal ones are equal byte by byte.

struct FeatureRow {
  std::uint32_t kind;  ///< Feature::Kind
  std::uint32_t first;
  std::uint32_t second;
};

// Kinds of events that the tool does not have come after its own.
inline constexpr std::int64_t piece_kind = kds::io::event_kind_names.size();
inline constexpr std::int64_t timer_kind = piece_kind + 1;
inline constexpr std::int64_t wrap_kind = timer_kind + 1;
inline constexpr std::size_t event_kinds = wrap_kind + 1;

/// An event, or a hit of a query.
struct EventRow {
  double time;
  std::int64_t kind;  ///< kds::io::EventKind, or one of the kinds above
  std::uint64_t a;    ///< a body; or a timer
  std::uint64_t b;    ///< a body; of a wall its number, 0 to 5; of one thing alone a itself
  std::array<double, 3> point;
  std::array<double, 3> normal;
  FeatureRow feature_a;
  FeatureRow feature_b;
  std::uint64_t user_data_a;
  std::uint64_t user_data_b;
};

static_assert(sizeof(EventRow) == 120);

/// An event of a periodic world.
struct PeriodicRow {
  EventRow event;
  std::array<std::int64_t, 3> offset;  ///< periods: of the copy of b; of wrap_kind those that have been taken away
  double impulse;                      ///< mass * length/s
};

static_assert(sizeof(PeriodicRow) == 152);

inline std::int64_t kind_of(const EventRow& row) { return row.kind; }
inline std::int64_t kind_of(const PeriodicRow& row) { return row.event.kind; }

/// CPU time in s, by name of the work (kds::collision::Work).
inline std::map<std::string, double> seconds_by_work(const kds::collision::Profile& profile) {
  using kds::collision::Work;
  std::map<std::string, double> seconds;
  for (const auto& [work, name] :
       {std::pair(Work::update, "update"), std::pair(Work::sort, "sort"), std::pair(Work::prune, "prune"),
        std::pair(Work::test, "test"), std::pair(Work::other, "other")}) {
    seconds[name] = profile.seconds(work);
  }
  return seconds;
}

/// A body near a point or a shape.
struct NearRow {
  std::uint64_t body;
  double distance;
  std::array<double, 3> point;
  std::array<double, 3> from_point;
};

/// Two bodies, and when their centres are nearest.
struct NearPairRow {
  std::uint64_t a;
  std::uint64_t b;
  double time;
  double distance;
};

inline FeatureRow to_row(const kds::collision::Feature& feature) {
  return {static_cast<std::uint32_t>(feature.kind), feature.first, feature.second};
}

inline EventRow to_row(std::int64_t kind, std::uint64_t a, std::uint64_t b, const kds::collision::Contact& c,
                       std::uint64_t user_data_a = 0, std::uint64_t user_data_b = 0) {
  return {c.time,
          kind,
          a,
          b,
          {c.point[0], c.point[1], c.point[2]},
          {c.normal[0], c.normal[1], c.normal[2]},
          to_row(c.feature_a),
          to_row(c.feature_b),
          user_data_a,
          user_data_b};
}

/// A motion: position, velocity and acceleration (not its half) at the start; the start; the orientation there, w x y
/// z; the angular velocity; the coefficients of (t - start)^3, ^4 and ^5.
inline constexpr std::size_t motion_length = 26;
inline constexpr std::size_t higher_column = 17;

inline Motion to_motion(const double* row) {
  Motion motion;
  motion.path.coefficients = {Eigen::Vector3d(row[0], row[1], row[2]), Eigen::Vector3d(row[3], row[4], row[5]),
                              Eigen::Vector3d(0.5 * row[6], 0.5 * row[7], 0.5 * row[8])};
  for (std::size_t k = 3; k <= Motion::degree; ++k) {
    motion.path.coefficients[k] = Eigen::Vector3d::Map(row + higher_column + 3 * (k - 3));
  }
  motion.path.start = row[9];
  motion.orientation = Eigen::Quaterniond(row[10], row[11], row[12], row[13]);
  motion.angular_velocity = Eigen::Vector3d(row[14], row[15], row[16]);
  return motion;
}

inline void put(const Motion& motion, double* row) {
  const auto& c = motion.path.coefficients;
  const auto& q = motion.orientation;
  const auto& w = motion.angular_velocity;
  const double numbers[] = {
      c[0][0],           c[0][1], c[0][2], c[1][0], c[1][1], c[1][2], 2 * c[2][0], 2 * c[2][1], 2 * c[2][2],
      motion.path.start, q.w(),   q.x(),   q.y(),   q.z(),   w[0],    w[1],        w[2]};
  static_assert(std::size(numbers) == higher_column);
  std::copy(std::begin(numbers), std::end(numbers), row);
  for (std::size_t k = 3; k <= Motion::degree; ++k) Eigen::Vector3d::Map(row + higher_column + 3 * (k - 3)) = c[k];
}

}  // namespace kds_python
