// A mesh as FCL has it.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/shapes/mesh.hpp"

#include <memory>

namespace turning {

class FclMesh {
 public:
  using Motion = kds::certificates::RigidMotion<1>;

  explicit FclMesh(const kds::collision::Mesh& mesh);

  /// When two of it first meet in [0, 1], s; > 1 if FCL says that they do not. It ends with a step of less than 1e-5 of
  /// a call's time, a constant of FCL's.
  double contact(const Motion& a, const Motion& b) const;

 private:
  struct Model;
  std::shared_ptr<Model> model_;
};

}  // namespace turning
