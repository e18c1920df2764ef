// What makers of scenes have in common: numbers, shapes and places that are drawn, and fixed boxes.
#pragma once

#include "tests/fuzz/random_piles/depth.hpp"
#include "tests/fuzz/random_piles/scene.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Geometry>

#include <cstddef>
#include <initializer_list>

namespace kds::piles {

/// A scene being made. Lengths are about 1, gravity is along -y, until it is scaled at the end.
struct Maker {
  explicit Maker(std::uint64_t seed) : random(seed) {}

  tests::Random random;
  Scene scene{};
  double restitution = 1;    ///< of all bodies and walls
  double greatest_mass = 1;  ///< over the least, beside what follows from sizes
  double least_size = 0.25;
  double greatest_size = 0.4;
  double speed = 2;    ///< of what falls, sideways, at the start
  bool boxes = false;  ///< what else than balls is drawn
  bool turned = false;
  bool capsules = false;

  Eigen::Quaterniond orientation();
  Eigen::Quaterniond about(const Eigen::Vector3d& axis, double angle) const;
  /// Of the sizes and kinds above; the orientation may be drawn with it.
  Description draw_body();
  double draw_size();

  /// Adds a free body at a place, with gravity.
  Description& add(Description body, const Eigen::Vector3d& place,
                   const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero());
  Description& add_ball(double radius, const Eigen::Vector3d& place,
                        const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero());
  Description& fix(const collision::Shape& shape, const Eigen::Vector3d& place,
                   const Eigen::Quaterniond& turn = Eigen::Quaterniond::Identity());
  Description& fix_box(const Eigen::Vector3d& min, const Eigen::Vector3d& max);

  /// Bodies at random places of a box, apart from each other and from what is there; higher ones where there is no
  /// room. `inside`: so that their bounding balls are in it, sideways.
  void drop(std::size_t count, const Eigen::Vector3d& min, const Eigen::Vector3d& max);
  bool has_room(const Description& body, const Eigen::Vector3d& place) const;

  std::vector<Solid> solids{};  ///< of the bodies, in their order
};

/// How many bodies: few more often than many.
std::size_t draw_count(tests::Random& random);

using Kind = void (*)(Maker&);
struct NamedKind {
  const char* name;
  Kind make;
};
/// kinds_of_boxes.cpp, kinds_of_slopes.cpp, kinds_of_rows.cpp
std::initializer_list<NamedKind> kinds_in_boxes();
std::initializer_list<NamedKind> kinds_on_slopes();
std::initializer_list<NamedKind> kinds_in_rows();

}  // namespace kds::piles
