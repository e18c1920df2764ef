// FCL's tree manager.
#include "tests/benchmarks/speed/peers/fcl.hpp"

#include "tests/benchmarks/speed/peers/frame_simulation.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include <deque>
#include <memory>

namespace speed {
namespace {

/// An object whose box is given, not computed: FCL's own has that of the shape where it stands.
class SweptObject final : public fcl::CollisionObjectd {
 public:
  SweptObject(const std::shared_ptr<fcl::CollisionGeometryd>& shape, std::uint32_t id)
      : fcl::CollisionObjectd(shape), id_(id) {}
  void set_box(const SweptBox& box) {
    aabb.min_ = box.min;
    aabb.max_ = box.max;
  }
  std::uint32_t id() const { return id_; }

 private:
  std::uint32_t id_;
};

/// Refit: all boxes of the tree are computed anew each frame. Else each leaf that moved is taken out and put back,
/// which FCL also offers.
template <bool Refit>
class DynamicTree {
 public:
  DynamicTree(const BallScene&, const std::vector<SweptBox>& boxes)
      : shape_(std::make_shared<fcl::Sphered>(1)), probe_(shape_, ~0u) {
    std::vector<fcl::CollisionObjectd*> all;
    all.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      objects_.emplace_back(shape_, static_cast<std::uint32_t>(i)).set_box(boxes[i]);
      all.push_back(&objects_.back());
    }
    manager_.registerObjects(all);
    manager_.setup();
  }

  void move(std::uint32_t i, const SweptBox& box) {
    objects_[i].set_box(box);
    moved_.push_back(&objects_[i]);
  }

  void update() {
    renewed_.clear();
    if (moved_.empty()) return;
    if constexpr (Refit) {
      manager_.update();
    } else {
      manager_.update(moved_);
    }
    moved_.clear();
  }

  template <class Found>
  void for_each_pair(Found found) {
    manager_.collide(&found, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
      (*static_cast<Found*>(data))(id(a), id(b));
      return false;
    });
  }

  template <class Found>
  void renew(std::uint32_t i, const SweptBox& box, Found found) {
    probe_.set_box(box);
    manager_.collide(&probe_, &found, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
      const std::uint32_t other = id(a) == ~0u ? id(b) : id(a);
      (*static_cast<Found*>(data))(other);
      return false;
    });
    renewed_.for_each_overlap(box, found);
    renewed_.add(i, box);
  }

 private:
  static std::uint32_t id(const fcl::CollisionObjectd* object) { return static_cast<const SweptObject*>(object)->id(); }

  std::shared_ptr<fcl::CollisionGeometryd> shape_;
  std::deque<SweptObject> objects_;
  SweptObject probe_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
  std::vector<fcl::CollisionObjectd*> moved_;
  RenewedBoxes renewed_;
};

}  // namespace

void add_fcl(std::vector<Peer>& list) {
  list.push_back({"fcl-dynamic-tree", run_peer<DynamicTree<false>>});
  list.push_back({"fcl-dynamic-tree-refit", run_peer<DynamicTree<true>>});
}

}  // namespace speed
