// What a run tells while it goes on.
#pragma once

#include "collision/shapes/feature.hpp"
#include "io/scene.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace kds::io {

/// What an event of a scene is.
enum class EventKind {
  contact,
  separation,
  overlap,
  wall,
  pair_begin,
  pair_end,
  rest,
  wake,
  rest_at_wall,
  wake_at_wall,
  pass
};

/// As the file has them.
inline constexpr std::array<std::string_view, 11> event_kind_names{
    "contact", "separation", "overlap", "wall", "pair_begin", "pair_end", "rest", "wake", "rest", "wake", "pass"};
inline constexpr std::array<std::string_view, 6> wall_names{"-x", "+x", "-y", "+y", "-z", "+z"};

/// An event of a scene.
struct Event {
  double time = 0;
  EventKind kind = EventKind::contact;
  std::uint32_t a = 0;  ///< place of the body in the scene
  std::uint32_t b = 0;  ///< the same, greater than a, or a itself; of a wall its place in wall_names
  /// Not used by pair_begin and pair_end, which have neither point nor normal nor features.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  kds::collision::Feature feature_a{};
  kds::collision::Feature feature_b{};

  bool is_at_wall() const {
    return kind == EventKind::wall || kind == EventKind::rest_at_wall || kind == EventKind::wake_at_wall;
  }
  bool is_about_rest() const { return kind >= EventKind::rest && kind <= EventKind::wake_at_wall; }
  bool is_about_volumes() const { return kind == EventKind::pair_begin || kind == EventKind::pair_end; }
};

/// Is told of a run as it goes, in order of time.
class EventSink {
 public:
  virtual ~EventSink() = default;
  virtual void on_event(const Event&) {}
  /// From piece.start on the body moves so: a contact, a wall or what holds it has changed its motion.
  virtual void on_motion(std::uint32_t /*body*/, const MotionPiece& /*piece*/) {}
  /// Whether on_motion() has to be called; if not, runs with bodies that precess are faster.
  virtual bool hears_motions() const { return true; }
  /// The clock has come to `time`.
  virtual void on_time(double /*time*/) {}
};

/// Tells several.
class EventSinks final : public EventSink {
 public:
  void add(EventSink& sink) { sinks_.push_back(&sink); }
  bool empty() const { return sinks_.empty(); }

  void on_event(const Event& event) override {
    for (EventSink* sink : sinks_) sink->on_event(event);
  }
  void on_motion(std::uint32_t body, const MotionPiece& piece) override {
    for (EventSink* sink : sinks_) sink->on_motion(body, piece);
  }
  bool hears_motions() const override {
    return std::any_of(sinks_.begin(), sinks_.end(), [](const EventSink* sink) { return sink->hears_motions(); });
  }
  void on_time(double time) override {
    for (EventSink* sink : sinks_) sink->on_time(time);
  }

 private:
  std::vector<EventSink*> sinks_;
};

}  // namespace kds::io
