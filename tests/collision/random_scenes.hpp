// Random scenes of moving bodies for property tests.
#pragma once

#include "collision/shapes/mesh.hpp"
#include "collision/vectors.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace kds::collision::tests {

using kds::tests::Random;

enum class Shapes { spheres, boxes, turned_boxes, tetrahedra, cubes, rings, mixture };

inline std::string name(Shapes shapes) {
  switch (shapes) {
    case Shapes::spheres: return "spheres";
    case Shapes::boxes: return "boxes";
    case Shapes::turned_boxes: return "turned boxes";
    case Shapes::tetrahedra: return "tetrahedra";
    case Shapes::cubes: return "cubes";
    case Shapes::rings: return "rings";
    case Shapes::mixture: return "mixture";
  }
  return "?";
}

inline std::shared_ptr<const Mesh> tetrahedron() {
  static const auto mesh = std::make_shared<const Mesh>(
      std::vector<Vector3d>{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
      std::vector<Mesh::Triangle>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  return mesh;
}
inline std::shared_ptr<const Mesh> cube() {
  static const auto mesh = samples::cuboid();
  return mesh;
}
inline std::shared_ptr<const Mesh> ring() {
  static const auto mesh = samples::torus(8, 4);
  return mesh;
}

/// The same bits whatever Eigen is told about vector instructions.
inline Eigen::Quaterniond unit_quaternion(double w, double x, double y, double z) {
  const Eigen::Quaterniond q(w, x, y, z);
  return Eigen::Quaterniond(q.coeffs() / norm(q));
}

/// How numbers are drawn: `coarse` ones make ties, touches and double roots common.
enum class Numbers { fine, coarse };

struct SceneOptions {
  Shapes shapes = Shapes::spheres;
  Numbers numbers = Numbers::fine;
  std::size_t bodies = 14;
  double side = 6;          ///< centres start in [0, side]^3
  bool scripts = false;     ///< several pieces a body, some of them jumps
  bool heterogeneous = false;  ///< unequal masses, some bodies fixed
  double end_time = 3;
};

class SceneMaker {
 public:
  SceneMaker(Random& random, const SceneOptions& options) : random_(random), options_(options) {}

  Vector3d vector(double low, double high) {
    return {number(low, high), number(low, high), number(low, high)};
  }

  template <int Degree>
  certificates::PointMotion<Degree> path(double start) {
    const Vector3d c0 = vector(0, options_.side);
    const Vector3d c1 = vector(-3, 3);
    const Vector3d c2 = vector(-1, 1);
    return motion<Degree>(c0, c1, random_.one_in(3) ? Vector3d(Vector3d::Zero()) : c2, start);
  }

  Shape shape() { return shape(options_.shapes); }

  Eigen::Quaterniond orientation() {
    const bool aligned = options_.shapes == Shapes::boxes || (options_.shapes == Shapes::mixture && random_.one_in(2));
    if (aligned) return Eigen::Quaterniond::Identity();
    const bool turns_axes_to_axes = options_.numbers == Numbers::coarse && random_.one_in(2);
    if (turns_axes_to_axes) return {0.5, 0.5, 0.5, random_.one_in(2) ? 0.5 : -0.5};
    // One by one: the order in which arguments are evaluated is the compiler's choice.
    const double z = random_.between(0.1, 1);
    const double y = random_.between(-1, 1);
    const double x = random_.between(-1, 1);
    const double w = random_.between(-1, 1);
    return unit_quaternion(w, x, y, z);
  }

  template <int Degree>
  Scene<Degree> scene() {
    Scene<Degree> result;
    result.end_time = options_.end_time;
    for (std::size_t i = 0; i < options_.bodies; ++i) {
      const auto motion = path<Degree>(0);
      auto description = body<Degree>(shape(), motion);
      if (options_.shapes != Shapes::spheres) description.orientation = orientation();
      if (options_.scripts) add_script(description);
      if (options_.heterogeneous) {
        description.mass = random_.one_in(2) ? 1 : random_.between(0.1, 10);
        description.fixed = random_.one_in(5);
        // Fixed bodies that move would press others against walls and make them faster without end.
        if (description.fixed) description.motion = {tests::motion<Degree>(motion.coefficients[0])};
      }
      result.bodies.push_back(std::move(description));
    }
    return result;
  }

 private:
  double number(double low, double high) {
    if (options_.numbers == Numbers::fine) return random_.between(low, high);
    return random_.integer(static_cast<int>(2 * low), static_cast<int>(2 * high)) * 0.5;
  }
  double size(double low, double high) {
    return options_.numbers == Numbers::fine ? random_.between(low, high) : 0.5 * random_.integer(1, 2);
  }

  Shape shape(Shapes shapes) {
    switch (shapes) {
      case Shapes::spheres: return Sphere{size(0.3, 1)};
      case Shapes::boxes:
      case Shapes::turned_boxes: return Box{{size(0.3, 1), size(0.3, 1), size(0.3, 1)}};
      case Shapes::tetrahedra: return MeshShape{tetrahedron(), size(0.4, 1)};
      case Shapes::cubes: return MeshShape{cube(), size(0.3, 0.8)};
      case Shapes::rings: return MeshShape{ring(), size(0.5, 1)};
      case Shapes::mixture: break;
    }
    constexpr std::array kinds{Shapes::spheres, Shapes::boxes, Shapes::tetrahedra, Shapes::cubes, Shapes::rings};
    return shape(kinds[random_.below(kinds.size())]);
  }

  /// Some pieces go on where the last one ended (up to rounding), some jump.
  template <int Degree>
  void add_script(BodyDescription<Degree>& description) {
    double start = 0;
    for (int pieces = random_.integer(0, 3); pieces > 0; --pieces) {
      start += options_.numbers == Numbers::fine ? random_.between(0.1, 1.5) : 0.25 * random_.integer(1, 5);
      auto next = path<Degree>(start);
      if (!random_.one_in(3)) next.coefficients[0] = description.motion.back().position(start);
      description.motion.push_back(next);
    }
  }

  Random& random_;
  SceneOptions options_;
};

/// Every broad phase: what a test asks of one it asks of all.
inline constexpr std::array all_methods{BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap,
                                        BroadPhaseKind::sap, BroadPhaseKind::all_pairs};

/// Two unit balls that meet at t = 1 and, in mode none, part at t = 3.
template <int Degree = 1>
std::vector<BodyDescription<Degree>> two_balls() {
  return {ball<Degree>(1, {0, 0, 0}), ball<Degree>(1, {4, 0, 0}, {-2, 0, 0})};
}

inline WorldOptions with_response(Response response) {
  WorldOptions options;
  options.response = response;
  return options;
}

}  // namespace kds::collision::tests
