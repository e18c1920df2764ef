// Elastic balls in a box, frame by frame, on any broad phase that takes boxes.
#pragma once

#include "tests/benchmarks/speed/peers/peers.hpp"
#include "tests/benchmarks/thread_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

namespace speed {

struct SweptBox {
  Eigen::Vector3d min, max;
};

inline bool overlap(const SweptBox& a, const SweptBox& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

/// At the start of a frame each ball that moves gets the box that it sweeps until the end; each pair of boxes that
/// overlap is tested for the time at which the balls meet; the earliest meeting or wall is processed, what it moves
/// gets another box for the rest of the frame and is tested against the balls near it; and so on to the end of the
/// frame. So it finds the contacts that the event-driven engine finds, but for rounding.
///
/// BroadPhase: built from the scene and the boxes of all balls;
///     move(i, box)             a new box for the frame that begins,
///     update()                 once all are told,
///     for_each_pair(f)         f(i, j) of pairs that may overlap,
///     renew(i, box, f)         another box in mid-frame; f(j) of all that may overlap it.
template <class BroadPhase>
class FrameSimulation {
 public:
  FrameSimulation(const BallScene& scene, const Drive& drive, std::vector<Meeting>* meetings)
      : side_(scene.side),
        start_(scene.start_time),
        drive_(drive),
        meetings_(meetings),
        balls_(make_balls(scene)),
        broad_phase_(scene, boxes_of_first_frame()) {}

  void run() {
    const double end = start_ + drive_.duration;
    double from = start_;
    for (std::uint64_t frame = 1; from < end; ++frame) {
      const double until = std::min(start_ + static_cast<double>(frame) / drive_.rate, end);
      run_frame(from, until, frame == 1);
      from = until;
    }
  }

  std::uint64_t tests() const { return tests_; }

 private:
  static constexpr double never = std::numeric_limits<double>::infinity();

  struct Ball {
    Eigen::Vector3d position, velocity;
    double radius;
    double since;  ///< s; of `position`
    double wall_time = never;
    int wall_axis = 0;
    std::uint32_t version = 0;  ///< motions so far: what was predicted for an older one is void
    bool renewed = false;       ///< its box in the broad phase is that of a motion it has no more
  };
  struct Event {
    double time;
    std::uint32_t a, b;  ///< b == a: the wall
    std::uint32_t version_a, version_b;
    bool operator<(const Event& other) const { return time > other.time; }  // the earliest on top
  };

  std::vector<Ball> make_balls(const BallScene& scene) {
    std::vector<Ball> balls;
    balls.reserve(scene.balls.size());
    for (const BallScene::Ball& b : scene.balls) {
      balls.push_back({b.position, b.velocity, b.radius, start_});
      predict_wall(balls.back());
    }
    return balls;
  }

  std::vector<SweptBox> boxes_of_first_frame() const {
    std::vector<SweptBox> boxes;
    boxes.reserve(balls_.size());
    for (const Ball& ball : balls_) boxes.push_back(swept(ball, start_, start_ + 1 / drive_.rate));
    return boxes;
  }

  static Eigen::Vector3d place(const Ball& ball, double t) { return ball.position + (t - ball.since) * ball.velocity; }

  static SweptBox swept(const Ball& ball, double from, double until) {
    const Eigen::Vector3d p = place(ball, from);
    const Eigen::Vector3d q = place(ball, until);
    const Eigen::Vector3d r = Eigen::Vector3d::Constant(ball.radius * (1 + 1e-12));  // for the rounding of both
    return {p.cwiseMin(q) - r, p.cwiseMax(q) + r};
  }

  void predict_wall(Ball& ball) const {
    ball.wall_time = never;
    for (int d = 0; d < 3; ++d) {
      const double v = ball.velocity[d];
      if (v == 0) continue;
      const double way = (v > 0 ? side_[d] - ball.radius : ball.radius) - ball.position[d];
      const double t = ball.since + std::max(0.0, way / v);
      if (t < ball.wall_time) {
        ball.wall_time = t;
        ball.wall_axis = d;
      }
    }
  }

  void run_frame(double from, double until, bool is_first) {
    until_ = until;
    for (std::uint32_t i = 0; i < balls_.size(); ++i) {
      Ball& ball = balls_[i];
      if (ball.wall_time <= until) events_.push({ball.wall_time, i, i, ball.version, ball.version});
      const bool rests = ball.velocity.isZero(0) && !ball.renewed;
      if (is_first || rests) continue;
      ball.renewed = false;
      broad_phase_.move(i, swept(ball, from, until));
    }
    broad_phase_.update();
    broad_phase_.for_each_pair([&](std::uint32_t i, std::uint32_t j) { test(i, j, from); });
    while (!events_.empty()) {
      const Event event = events_.top();
      events_.pop();
      if (balls_[event.a].version == event.version_a && balls_[event.b].version == event.version_b) process(event);
    }
  }

  /// The ball-ball quadratic, solved without cancellation.
  void test(std::uint32_t i, std::uint32_t j, double from) {
    ++tests_;
    const Ball& a = balls_[i];
    const Ball& b = balls_[j];
    const Eigen::Vector3d d = place(b, from) - place(a, from);
    const Eigen::Vector3d w = b.velocity - a.velocity;
    const double closing = d.dot(w);
    if (!(closing < 0)) return;
    const double sum_of_radii = a.radius + b.radius;
    const double gap = d.squaredNorm() - sum_of_radii * sum_of_radii;
    double time = from;
    if (gap > 0) {
      const double discriminant = closing * closing - w.squaredNorm() * gap;
      if (!(discriminant > 0)) return;
      time += gap / (std::sqrt(discriminant) - closing);
    }
    if (time <= until_) events_.push({time, i, j, a.version, b.version});
  }

  void process(const Event& event) {
    Ball& a = balls_[event.a];
    stop_at(a, event.time);
    if (event.a == event.b) {
      a.velocity[a.wall_axis] = -a.velocity[a.wall_axis];
    } else {
      Ball& b = balls_[event.b];
      stop_at(b, event.time);
      const Eigen::Vector3d n = (b.position - a.position).normalized();
      const Eigen::Vector3d change = (b.velocity - a.velocity).dot(n) * n;  // equal masses exchange it
      a.velocity += change;
      b.velocity -= change;
      if (meetings_) meetings_->push_back({event.time, std::min(event.a, event.b), std::max(event.a, event.b)});
      restart(event.b, event.time);
    }
    restart(event.a, event.time);
  }

  static void stop_at(Ball& ball, double t) {
    ball.position = place(ball, t);
    ball.since = t;
    ++ball.version;
  }

  void restart(std::uint32_t i, double t) {
    Ball& ball = balls_[i];
    predict_wall(ball);
    if (ball.wall_time <= until_) events_.push({ball.wall_time, i, i, ball.version, ball.version});
    ball.renewed = true;
    broad_phase_.renew(i, swept(ball, t, until_), [&](std::uint32_t j) {
      if (j != i) test(i, j, t);
    });
  }

  Eigen::Vector3d side_;
  double start_;
  Drive drive_;
  std::vector<Meeting>* meetings_;
  std::vector<Ball> balls_;
  BroadPhase broad_phase_;
  std::priority_queue<Event> events_;
  double until_ = 0;
  std::uint64_t tests_ = 0;
};

/// For renew() of broad phases that had better not be changed in mid-frame: they are asked what overlaps the new box,
/// and the new boxes of the frame are remembered here and searched one by one.
class RenewedBoxes {
 public:
  void clear() { boxes_.clear(); }
  void add(std::uint32_t i, const SweptBox& box) { boxes_.push_back({i, box}); }
  template <class Found>
  void for_each_overlap(const SweptBox& box, Found found) const {
    for (const Entry& entry : boxes_) {
      if (overlap(entry.box, box)) found(entry.id);
    }
  }

 private:
  struct Entry {
    std::uint32_t id;
    SweptBox box;
  };
  std::vector<Entry> boxes_;
};

template <class BroadPhase>
PeerOutcome run_peer(const BallScene& scene, const Drive& drive, std::vector<Meeting>* meetings) {
  using kds::benchmarks::thread_seconds;
  PeerOutcome outcome;
  const double begin = thread_seconds();
  FrameSimulation<BroadPhase> simulation(scene, drive, meetings);
  const double middle = thread_seconds();
  simulation.run();
  outcome.run = thread_seconds() - middle;
  outcome.setup = middle - begin;
  outcome.tests = simulation.tests();
  return outcome;
}

}  // namespace speed
