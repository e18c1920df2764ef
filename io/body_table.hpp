// Bodies as columns of numbers, and the HDF5 files that hold them.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::io {

/// One entry a body in each column that is used; the others are empty. Every body has a position. Units are those of
/// the scene. A scene says which shapes the bodies have, or `radius` or `half_extents` do: see docs/kds-collide.md.
struct BodyTable {
  std::vector<Eigen::Vector3d> position;          ///< at the start
  std::vector<Eigen::Vector3d> velocity;          ///< at the start
  std::vector<Eigen::Vector3d> acceleration;      ///< constant
  std::vector<double> start;                      ///< when the motion begins
  std::vector<Eigen::Vector4d> orientation;       ///< unit quaternions w, x, y, z, at the start
  std::vector<Eigen::Vector3d> angular_velocity;  ///< constant, rad/s, in the axes of the world
  std::vector<double> radius;                     ///< of balls
  std::vector<Eigen::Vector3d> half_extents;      ///< of boxes
  std::vector<std::int64_t> shape;                ///< which of the shapes that the scene lists, from 0
  std::vector<double> scale;                      ///< of meshes
  std::vector<double> mass;
  std::vector<double> restitution;
  std::vector<double> friction;
  std::vector<double> tangential_restitution;
  std::vector<double> rolling_friction;
  std::vector<std::int8_t> fixed;   ///< 0 or 1
  std::vector<std::int8_t> sensor;  ///< 0 or 1

  std::size_t rows() const { return position.size(); }
};

/// Calls visit(name, column) for each column of a table, in the order above.
template <class Table, class Visit>
void for_each_column(Table& table, const Visit& visit) {
  visit("position", table.position);
  visit("velocity", table.velocity);
  visit("acceleration", table.acceleration);
  visit("start", table.start);
  visit("orientation", table.orientation);
  visit("angular_velocity", table.angular_velocity);
  visit("radius", table.radius);
  visit("half_extents", table.half_extents);
  visit("shape", table.shape);
  visit("scale", table.scale);
  visit("mass", table.mass);
  visit("restitution", table.restitution);
  visit("friction", table.friction);
  visit("tangential_restitution", table.tangential_restitution);
  visit("rolling_friction", table.rolling_friction);
  visit("fixed", table.fixed);
  visit("sensor", table.sensor);
}

/// Is no table of bodies; the message says what is wrong, and in which column.
struct BodyTableError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads the columns that the file has as datasets of its root group, of the shapes (rows), (rows, 3) or (rows, 4), in
/// any of HDF5's numeric types and layouts. Throws BodyTableError where it cannot be read, a dataset has a name that is
/// no column's, or another shape or number of rows, or is of some size and stored in less than 1/2048 of the bytes of
/// its rows (HDF5's own compression makes them 1032 times fewer at most). What the numbers are is not checked.
/// Files of others are only as safe to read as the HDF5 library makes them: it trusts their structure in places.
BodyTable read_body_table(const std::filesystem::path& file);

/// How many rows it has: those of the column position, whatever the others say. Throws BodyTableError.
std::size_t body_table_rows(const std::filesystem::path& file);
/// The same of so many rows from one on, of which only these are read. Precondition: it has them.
BodyTable read_body_table(const std::filesystem::path& file, std::size_t first, std::size_t rows);

/// The HDF5 file of a table, as bytes to be written: equal tables give equal bytes. Throws std::invalid_argument where
/// a column that is used has another number of rows than `position`.
std::string to_hdf5(const BodyTable& table);

}  // namespace kds::io
