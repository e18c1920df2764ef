// A scene: bodies, how they move, and the space they move in.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/world_options.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::io {

/// A piece of a body's motion: a path, linear or quadratic, and an orientation, which turns only in scenes that say so.
/// It holds until the next piece's start.
using MotionPiece = kds::certificates::RigidMotion<2>;

/// Of two bodies that meet, the lower counts of each.
struct SurfaceNumbers {
  double restitution = 1;             ///< in [0, 1]
  double friction = 0;                ///< >= 0
  double tangential_restitution = 0;  ///< in [-1, 1]
  double rolling_friction = 0;        ///< a length, >= 0
};

/// How far from 1 the norm of an orientation may be: files carry few digits. It is normalised.
inline constexpr double orientation_tolerance = 1e-6;

/// A body as a scene describes it.
struct SceneBody {
  std::string name;
  kds::collision::Shape shape;
  std::shared_ptr<const kds::collision::Mesh> bent{};  ///< of a mesh that bends: the one that gives it its triangles
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< unit; that of the first piece
  double mass = 1;
  double inertia = 0;                               ///< about every axis; 0: that of a solid of the shape
  std::optional<Eigen::Matrix3d> inertia_tensor{};  ///< in place of it, in the axes of the body; checked where it turns
  bool fixed = false;                               ///< infinite mass
  bool sensor = false;                              ///< only reports
  bool self_contacts = false;                       ///< of a mesh that bends: those with itself are events
  double restitution = 1;                           ///< in [0, 1]; of two bodies the lower counts
  double friction = 0;                              ///< and here; 0 where nothing turns
  double tangential_restitution = 0;
  double rolling_friction = 0;
  std::vector<MotionPiece> motion;  ///< not empty; starts ascend
};

/// A mesh that bodies of a scene share.
struct SceneMesh {
  std::string name;
  std::string file;  ///< as written in the scene; empty of a heightfield, or if it was made for a body with a pivot
  std::shared_ptr<const kds::collision::Mesh> mesh;
};

using kds::collision::Response;  ///< a scene has `none` or `elastic`
/// The box in which a scene takes place.
struct Domain {
  Eigen::Vector3d min;
  Eigen::Vector3d max;
  bool reflects = false;   ///< whether its faces are walls
  double restitution = 1;  ///< of the walls
};

/// Which of the bodies of a scene are those of one of several processes (read_scene()), and what is known of the
/// others.
struct Share {
  std::size_t first = 0;  ///< the number of the first of Scene::bodies
  std::size_t all = 0;    ///< bodies of the scene; 0 if there are no others
  /// The names of the bodies that are in no table, which come first; and of each table the prefix of the names of its
  /// bodies, which end with their rows, and how many there are.
  std::vector<std::string> names{};
  std::vector<std::pair<std::string, std::size_t>> tables{};
  int degree = 1;  ///< of the others
};

/// A file that a scene is made of.
struct SceneSource {
  std::string where;  ///< what names it in the scene: `meshes.wedge.file`; empty of the scene's own text
  std::string file;   ///< as written there
  /// Of what was read: the bytes of the scene's own text, the vertices and triangles of a mesh, the numbers of a table.
  /// Of a table read by several processes that of their rows, until complete().
  std::uint64_t checksum = 0;
  bool in_shares = false;  ///< a table
};

/// What a scene file says, checked.
struct Scene {
  /// The earliest start of a first piece. A body whose first piece starts later enters then.
  double begin_time = 0;
  double end_time = 0;
  Response response = Response::none;
  bool turning = false;  ///< its bodies turn, or contacts may make them: the scene speaks of it
  std::optional<Domain> domain;
  std::vector<SceneMesh> meshes;
  std::vector<SceneBody> bodies;  ///< all, or those of a share
  Share share{};
  std::vector<SceneSource> sources;  ///< its own text, then files of meshes, then tables
  /// What was mended in what the scene names, each as one line `FILE: WHERE: what`.
  std::vector<std::string> warnings;

  /// 2 where any piece accelerates, else 1.
  int degree() const;
  bool is_share() const { return share.all > 0; }
  /// How many bodies the whole scene has.
  std::size_t size() const { return is_share() ? share.all : bodies.size(); }
  /// The name of a body of the whole scene, by its number: its place among all.
  std::string name_of(std::size_t number) const;
};

/// The same for scenes of the same text, meshes and tables, and hardly ever for others. Of a share: after complete().
std::uint64_t fingerprint(const Scene& scene);

/// What is wrong with a scene, as one line `FILE: WHERE: what is wrong`.
class SceneError : public std::runtime_error {
 public:
  SceneError(const std::string& file, const std::string& where, const std::string& what);
};

}  // namespace kds::io
