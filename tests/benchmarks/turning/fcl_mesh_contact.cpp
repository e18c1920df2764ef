// FCL's conservative advancement of meshes, in calls of up to 3 rad as of boxes.
#include "tests/benchmarks/turning/fcl_mesh.hpp"
#include "tests/benchmarks/turning/fcl_motion.hpp"
#include "tests/benchmarks/turning/query.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/continuous_collision.h>

#include <algorithm>
#include <vector>

namespace turning {

struct FclMesh::Model : fcl::BVHModel<fcl::OBBRSS<double>> {};

FclMesh::FclMesh(const kds::collision::Mesh& mesh) : model_(std::make_shared<Model>()) {
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles()) triangles.emplace_back(t[0], t[1], t[2]);
  const auto& vertices = mesh.vertices();
  model_->beginModel();
  model_->addSubModel(std::vector<Eigen::Vector3d>(vertices.begin(), vertices.end()), triangles);
  model_->endModel();
}

double FclMesh::contact(const Motion& a, const Motion& b) const {
  const fcl::ContinuousCollisionRequestd request(1000, 1e-4, fcl::CCDM_LINEAR, fcl::GST_LIBCCD,
                                                 fcl::CCDC_CONSERVATIVE_ADVANCEMENT);
  const double turn = std::max(a.angular_velocity.norm(), b.angular_velocity.norm());
  const int parts = std::max(1, static_cast<int>(std::ceil(turn / 3)));
  for (int part = 0; part < parts; ++part) {
    const double from = static_cast<double>(part) / parts, to = (part + 1.0) / parts;
    const fcl::InterpMotion<double> of_a = fcl_motion(a, from, to), of_b = fcl_motion(b, from, to);
    fcl::ContinuousCollisionResultd result;
    fcl::continuousCollide<double>(model_.get(), &of_a, model_.get(), &of_b, request, result);
    if (result.is_collide) return from + result.time_of_contact * (to - from);
  }
  return 2;
}

}  // namespace turning
