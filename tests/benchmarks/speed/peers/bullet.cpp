// Bullet's broad phases.
#include "tests/benchmarks/speed/peers/bullet.hpp"

#include "tests/benchmarks/speed/peers/frame_simulation.hpp"

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <memory>

namespace speed {
namespace {

/// Debian's default build of Bullet keeps boxes in single precision: they are made larger by its rounding.
class SingleBoxes {
 public:
  explicit SingleBoxes(const BallScene& scene) : margin_(scene.side.maxCoeff() * 0x1p-22) {}
  btVector3 min(const SweptBox& box) const { return vector(box.min, -margin_); }
  btVector3 max(const SweptBox& box) const { return vector(box.max, margin_); }

 private:
  static btVector3 vector(const Eigen::Vector3d& v, double margin) {
    return {static_cast<btScalar>(v[0] + margin), static_cast<btScalar>(v[1] + margin),
            static_cast<btScalar>(v[2] + margin)};
  }
  double margin_;
};

void* tag(std::size_t i) { return reinterpret_cast<void*>(i); }
std::uint32_t id(const btBroadphaseProxy* proxy) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(proxy->m_clientObject));
}

/// What both kinds share. `Derived` gives renew().
template <class Interface>
class BulletBroadPhase {
 public:
  void move(std::uint32_t i, const SweptBox& box) {
    broad_phase_->setAabb(proxies_[i], boxes_.min(box), boxes_.max(box), nullptr);
  }
  template <class Found>
  void for_each_pair(Found found) {
    const btOverlappingPairCache* cache = broad_phase_->getOverlappingPairCache();
    const btBroadphasePair* pairs = cache->getOverlappingPairArrayPtr();
    for (int k = 0; k < cache->getNumOverlappingPairs(); ++k) found(id(pairs[k].m_pProxy0), id(pairs[k].m_pProxy1));
  }

 protected:
  explicit BulletBroadPhase(const BallScene& scene) : boxes_(scene) {}

  void create(const std::vector<SweptBox>& boxes) {
    proxies_.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      proxies_.push_back(broad_phase_->createProxy(boxes_.min(boxes[i]), boxes_.max(boxes[i]), SPHERE_SHAPE_PROXYTYPE,
                                                   tag(i), btBroadphaseProxy::DefaultFilter,
                                                   btBroadphaseProxy::AllFilter, nullptr));
    }
  }

  SingleBoxes boxes_;
  std::unique_ptr<Interface> broad_phase_;
  std::vector<btBroadphaseProxy*> proxies_;
};

/// Trees of boxes that are fat by a margin. Deferred: all pairs are sought at once in calculateOverlappingPairs, else
/// those of each box as it is set.
template <bool Deferred>
class Trees : public BulletBroadPhase<btDbvtBroadphase> {
 public:
  Trees(const BallScene& scene, const std::vector<SweptBox>& boxes) : BulletBroadPhase(scene) {
    broad_phase_ = std::make_unique<btDbvtBroadphase>();
    broad_phase_->m_deferedcollide = Deferred;
    create(boxes);
  }
  Trees(const Trees&) = delete;
  Trees& operator=(const Trees&) = delete;
  ~Trees() {
    for (btBroadphaseProxy* proxy : proxies_) broad_phase_->destroyProxy(proxy, nullptr);
  }

  void update() {
    renewed_.clear();
    broad_phase_->calculateOverlappingPairs(nullptr);
  }

  template <class Found>
  void renew(std::uint32_t i, const SweptBox& box, Found found) {
    Overlaps<Found> overlaps(found);
    broad_phase_->aabbTest(boxes_.min(box), boxes_.max(box), overlaps);
    renewed_.for_each_overlap(box, found);
    renewed_.add(i, box);
  }

 private:
  template <class Found>
  struct Overlaps final : btBroadphaseAabbCallback {
    explicit Overlaps(Found& found) : found_(found) {}
    bool process(const btBroadphaseProxy* proxy) override {
      found_(id(proxy));
      return true;
    }
    Found& found_;
  };

  RenewedBoxes renewed_;
};

/// Sorted lists of interval ends, which keep the pairs right with each box that is set. Without the tree that speeds up
/// queries of rays, which nobody asks here.
template <class Sweep>
class Sweeps : public BulletBroadPhase<Sweep> {
 public:
  Sweeps(const BallScene& scene, const std::vector<SweptBox>& boxes)
      : BulletBroadPhase<Sweep>(scene), partners_(boxes.size()) {
    const Eigen::Vector3d side = scene.side;
    const auto corner = [&](double c) {
      return btVector3(static_cast<btScalar>(c * side[0]), static_cast<btScalar>(c * side[1]),
                       static_cast<btScalar>(c * side[2]));
    };
    // What crosses the bounds before it bounces is clamped to them, which keeps overlaps.
    this->broad_phase_ =
        std::make_unique<Sweep>(corner(-0.02), corner(1.02), static_cast<Count>(boxes.size() + 1), nullptr, true);
    this->broad_phase_->setOverlappingPairUserCallback(&partners_);
    this->create(boxes);
  }
  Sweeps(const Sweeps&) = delete;
  Sweeps& operator=(const Sweeps&) = delete;

  void update() { this->broad_phase_->calculateOverlappingPairs(nullptr); }

  template <class Found>
  void renew(std::uint32_t i, const SweptBox& box, Found found) {
    this->move(i, box);
    for (const std::uint32_t j : partners_.of(i)) found(j);
  }

 private:
  using Count = std::conditional_t<std::is_same_v<Sweep, btAxisSweep3>, unsigned short, unsigned int>;

  /// Who overlaps whom, kept up by the broad phase.
  class Partners final : public btOverlappingPairCallback {
   public:
    explicit Partners(std::size_t bodies) : of_(bodies) {}
    const std::vector<std::uint32_t>& of(std::uint32_t i) const { return of_[i]; }

    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
      of_[id(a)].push_back(id(b));
      of_[id(b)].push_back(id(a));
      return nullptr;
    }
    void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher*) override {
      drop(of_[id(a)], id(b));
      drop(of_[id(b)], id(a));
      return nullptr;
    }
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy*, btDispatcher*) override {}

   private:
    static void drop(std::vector<std::uint32_t>& from, std::uint32_t i) {
      const auto found = std::find(from.begin(), from.end(), i);
      if (found == from.end()) return;
      *found = from.back();
      from.pop_back();
    }
    std::vector<std::vector<std::uint32_t>> of_;
  };

  Partners partners_;
};

}  // namespace

void add_bullet(std::vector<Peer>& list) {
  constexpr std::size_t most_short = 32'766;
  list.push_back({"btAxisSweep3", run_peer<Sweeps<btAxisSweep3>>, most_short});
  list.push_back({"bt32BitAxisSweep3", run_peer<Sweeps<bt32BitAxisSweep3>>});
  list.push_back({"btDbvtBroadphase", run_peer<Trees<false>>});
  list.push_back({"btDbvtBroadphase-deferred", run_peer<Trees<true>>});
}

}  // namespace speed
