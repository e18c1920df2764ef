// The cells that may lie on the surface of a zonotope.
#pragma once

#include "certificates/zonotope_separation.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>

namespace kds::collision {

/// u x v in doubles, from products and differences in double-double: each coordinate is known to one rounding of
/// itself and 2^-100 of |u| |v|.
Eigen::Vector3d accurate_cross(const Eigen::Vector3d& u, const Eigen::Vector3d& v);

/// Products of unit vectors shorter than this have a direction that accurate_cross() does not know to some roundings.
inline constexpr double unknown_normal = 0x1p-48;

/// The sums of segments and of ends of segments that may be part of the surface of a zonotope.
///
/// Law: the union of the cells that are visited covers the surface. Others may be visited too, inside or within a face,
/// and cells may overlap: where generators are parallel, or three of them in a plane, or so nearly that doubles do not
/// decide, all sums are visited. (Every face is itself a zonotope, and such sums tile it; which ones does not matter
/// for a union.) Parallelograms of parallel generators are left out. So no exact structure is needed for functions of
/// the union.
///
/// Of n generators in general position there are n (n - 1) parallelograms, 2 n (n - 1) segments and n (n - 1) + 2
/// vertices; of two generators, a parallelogram, 4 and 4.
class ZonotopeCells {
 public:
  using Cell = certificates::ZonotopeCell;

  explicit ZonotopeCells(certificates::Generators generators);

  std::size_t size() const { return generators_.size(); }
  certificates::Generators generators() const { return generators_; }
  bool parallel(std::size_t i, std::size_t j) const { return parallel_[i][j]; }

  /// Calls visit(cell) until it returns false; returns its last result.
  template <class Visit>
  bool every_cell(const Visit& visit) const;

  /// Length times direction of generator k, rounded.
  const Eigen::Vector3d& half(std::size_t k) const { return half_[k]; }
  /// The centre of a cell, rounded.
  Eigen::Vector3d centre(const Cell& cell) const;

 private:
  using Sign = std::int8_t;

  bool inside(const Cell& cell) const;
  Sign turn(std::size_t i, std::size_t j, std::size_t k) const { return turns_[i][j][k]; }
  template <class Visit>
  bool every_end(Cell cell, const Visit& visit) const;

  static constexpr std::size_t most = certificates::most_generators;
  certificates::Generators generators_;
  std::array<Eigen::Vector3d, most> half_;  ///< length times direction, rounded
  std::array<std::array<bool, most>, most> parallel_{};
  /// Sign of the product of three directions, where doubles decide it, otherwise 0.
  std::array<std::array<std::array<Sign, most>, most>, most> turns_{};
};

// ---------------------------------------------------------------------------------------------------------------

template <class Visit>
bool ZonotopeCells::every_end(Cell cell, const Visit& visit) const {
  const std::size_t n = size();
  std::array<std::uint8_t, most> fixed{};
  std::size_t count = 0;
  for (std::uint8_t k = 0; k < n; ++k) {
    const bool sweeps = (cell.dimension > 0 && cell.swept[0] == k) || (cell.dimension > 1 && cell.swept[1] == k);
    if (!sweeps) fixed[count++] = k;
  }
  for (unsigned ends = 0; ends < 1u << count; ++ends) {
    for (std::size_t k = 0; k < count; ++k) cell.end[fixed[k]] = (ends >> k & 1u) != 0 ? 1 : -1;
    if (!inside(cell) && !visit(std::as_const(cell))) return false;
  }
  return true;
}

template <class Visit>
bool ZonotopeCells::every_cell(const Visit& visit) const {
  const auto n = static_cast<std::uint8_t>(size());
  for (std::uint8_t i = 0; i < n; ++i) {
    for (std::uint8_t j = i + 1; j < n; ++j) {
      if (!parallel(i, j) && !every_end({{}, {i, j}, 2}, visit)) return false;
    }
  }
  for (std::uint8_t i = 0; i < n; ++i) {
    if (!every_end({{}, {i, 0}, 1}, visit)) return false;
  }
  return every_end({}, visit);
}

}  // namespace kds::collision
