// The arena on Bullet's tree of boxes.
#include "tests/benchmarks/speed/arena.hpp"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace speed {
namespace {

using Eigen::Vector3d;

constexpr double never = std::numeric_limits<double>::infinity();

class FrameArena {
 public:
  FrameArena(const Arena& arena, std::vector<Hit>& hits)
      : arena_(arena),
        hits_(hits),
        targets_(arena.targets),
        bullets_(arena.bullets),
        lives_(arena.bodies()),
        margin_(arena.high.maxCoeff() * 0x1p-22) {
    for (std::uint32_t i = 0; i < arena.targets; ++i) {
      place_target(i, 0);
      targets_[i].leaf = tree_.insert(box(targets_[i], arena.end_of(1)), reinterpret_cast<void*>(std::uintptr_t{i}));
    }
    for (std::uint32_t i = 0; i < arena.bullets; ++i) place_bullet(i, 0);
  }

  void run_frame(double until) {
    for (Target& target : targets_) {
      btDbvtVolume now = box(target, until);
      tree_.update(target.leaf, now);
    }
    for (std::uint32_t i = 0; i < bullets_.size(); ++i) ask(i, until);
    process();
    for (std::uint32_t i = 0; i < targets_.size(); ++i) {
      Target& target = targets_[i];
      if (target.hits == Arena::lives) {
        place_target(i, until);
      } else {
        while (target.wall <= until) reflect(target);
      }
      target.from = until;
    }
    for (std::uint32_t i = 0; i < bullets_.size(); ++i) {
      if (!bullets_[i].alive) place_bullet(i, until);
      bullets_[i].from = until;
    }
  }

  std::uint64_t walls() const { return walls_; }
  std::uint64_t tests() const { return tests_; }

 private:
  struct Body {
    Vector3d position, velocity;
    double since = 0;  ///< of `position`
    double from = 0;   ///< the beginning of the frame
    double wall = never;
    int axis = 0;  ///< of that wall
    Vector3d at(double t) const { return position + (t - since) * velocity; }
  };
  struct Target : Body {
    int hits = 0;
    btDbvtNode* leaf = nullptr;
  };
  struct Bullet : Body {
    bool alive = true;
  };
  struct Event {
    double time;
    std::uint32_t target, bullet;  ///< target == no_target: the wall
    friend bool operator<(const Event& x, const Event& y) {
      return std::tie(x.time, x.target, x.bullet) < std::tie(y.time, y.target, y.bullet);
    }
  };
  static constexpr std::uint32_t no_target = ~std::uint32_t{0};
  struct Finder : btDbvt::ICollide {
    std::vector<std::uint32_t> found;
    void Process(const btDbvtNode* node) override {
      found.push_back(static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(node->data)));
    }
  };

  void predict_wall(Body& body, double radius) const {
    body.wall = never;
    for (int d = 0; d < 3; ++d) {
      const double v = body.velocity[d];
      if (v == 0) continue;
      const double plane = v > 0 ? arena_.high[d] - radius : arena_.low[d] + radius;
      const double t = body.since + std::max(0.0, (plane - body.position[d]) / v);
      if (t < body.wall) body.wall = t, body.axis = d;
    }
  }
  void place(Body& body, std::uint32_t number, double t, double radius) {
    const Arena::Start start = arena_.start(number, lives_[number]++);
    body.position = start.position;
    body.velocity = start.velocity;
    body.since = body.from = t;
    predict_wall(body, radius);
  }
  void place_target(std::uint32_t i, double t) {
    targets_[i].hits = 0;
    place(targets_[i], i, t, Arena::target_radius);
  }
  void place_bullet(std::uint32_t i, double t) {
    bullets_[i].alive = true;
    place(bullets_[i], arena_.targets + i, t, Arena::bullet_radius);
  }
  void reflect(Body& target) const {
    target.position = target.at(target.wall);
    target.since = target.wall;
    target.velocity[target.axis] = -target.velocity[target.axis];
    predict_wall(target, Arena::target_radius);
  }

  /// Of places on the way of a body, rounded outward.
  struct Places {
    Vector3d low, high;
    void add(const Vector3d& p) { low = low.cwiseMin(p), high = high.cwiseMax(p); }
  };
  btDbvtVolume volume(const Places& places, double radius) const {
    const auto vector = [&](const Vector3d& v, double margin) {
      return btVector3(static_cast<btScalar>(v[0] + margin), static_cast<btScalar>(v[1] + margin),
                       static_cast<btScalar>(v[2] + margin));
    };
    return btDbvtVolume::FromMM(vector(places.low, -radius - margin_), vector(places.high, radius + margin_));
  }
  /// Until the end of the frame, with reflections.
  btDbvtVolume box(const Target& target, double until) const {
    Places places{target.at(target.from), target.at(target.from)};
    if (target.wall <= until) {
      Body later = target;
      while (later.wall <= until) {
        reflect(later);
        places.add(later.position);
      }
      places.add(later.at(until));
    } else {
      places.add(target.at(until));
    }
    return volume(places, Arena::target_radius);
  }

  void ask(std::uint32_t i, double until) {
    const Bullet& bullet = bullets_[i];
    const double end = std::min(until, bullet.wall);
    finder_.found.clear();
    Places way{bullet.at(bullet.from), bullet.at(bullet.from)};
    way.add(bullet.at(end));
    tree_.collideTV(tree_.m_root, volume(way, Arena::bullet_radius), finder_);
    for (const std::uint32_t t : finder_.found) {
      Body target = targets_[t];
      for (double from = bullet.from; from < end;) {
        const double to = std::min(end, target.wall);
        const double time = meeting(bullet, target, from, to);
        if (time <= to) {
          events_.push_back({time, t, i});
          break;
        }
        from = to;
        if (to == target.wall) reflect(target);
      }
    }
    if (bullet.wall <= until) events_.push_back({bullet.wall, no_target, i});
  }

  /// When the two meet in [from, to]; `from` if they overlap then.
  double meeting(const Body& a, const Body& b, double from, double) {
    ++tests_;
    constexpr double sum_of_radii = Arena::bullet_radius + Arena::target_radius;
    const Vector3d r = b.at(from) - a.at(from), v = b.velocity - a.velocity;
    const double c = r.squaredNorm() - sum_of_radii * sum_of_radii;
    if (c < 0) return from;
    const double h = r.dot(v), q = v.squaredNorm();
    const double discriminant = h * h - q * c;
    return h >= 0 || discriminant < 0 ? never : from + c / (std::sqrt(discriminant) - h);
  }

  void process() {
    std::sort(events_.begin(), events_.end());
    for (const auto& [time, target, bullet] : events_) {
      if (!bullets_[bullet].alive) continue;
      if (target == no_target) {
        ++walls_;
      } else if (targets_[target].hits == Arena::lives) {
        continue;
      } else {
        ++targets_[target].hits;
        hits_.push_back({time, target, arena_.targets + bullet});
      }
      bullets_[bullet].alive = false;
    }
    events_.clear();
  }

  const Arena& arena_;
  std::vector<Hit>& hits_;
  std::vector<Target> targets_;
  std::vector<Bullet> bullets_;
  std::vector<std::uint32_t> lives_;
  double margin_;  ///< for Bullet's boxes in single precision
  btDbvt tree_;
  Finder finder_;
  std::vector<Event> events_;
  std::uint64_t walls_ = 0;
  std::uint64_t tests_ = 0;
};

}  // namespace

ArenaOutcome run_arena_by_bullet(const Arena& arena, std::vector<Hit>& hits) {
  const double begun = kds::benchmarks::thread_seconds();
  FrameArena frames(arena, hits);
  const double set_up = kds::benchmarks::thread_seconds();
  for (std::uint64_t frame = 1; frame <= arena.frames(); ++frame) frames.run_frame(arena.end_of(frame));
  const double done = kds::benchmarks::thread_seconds();
  return {set_up - begun, done - set_up, frames.walls(), frames.tests()};
}

}  // namespace speed
