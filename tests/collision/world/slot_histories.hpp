// Scenes full of events that happen at one time, and worlds that have them in other slots.
#pragma once

#include "collision/world.hpp"
#include "tests/support/random_numbers.hpp"

#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace kds::tests {

/// Writes down all that a world tells, bit for bit, with bodies by their user data.
template <class Motion>
class ToldOfBodies final : public collision::BasicWorldListener<Motion> {
 public:
  using World = collision::BasicWorld<Motion>;
  using PairEvent = collision::PairEvent;
  using WallEvent = collision::WallEvent;
  using BodyId = collision::BodyId;

  std::vector<std::string> lines;
  std::map<std::string, std::size_t> counts;

  void contact(World&, const PairEvent& e) override { note("contact", e); }
  void separation(World&, const PairEvent& e) override { note("separation", e); }
  void overlap(World&, const PairEvent& e) override { note("overlap", e); }
  void rebound_suppressed(World&, const PairEvent& e) override { note("suppressed", e); }
  void rests(World&, const PairEvent& e) override { note("rests", e); }
  void wakes(World&, const PairEvent& e) override { note("wakes", e); }
  void passes(World&, const PairEvent& e) override { note("passes", e); }
  void wall(World&, const WallEvent& e) override { note("wall", e); }
  void rebound_suppressed_at_wall(World&, const WallEvent& e) override { note("suppressed at wall", e); }
  void rests_at_wall(World&, const WallEvent& e) override { note("rests at wall", e); }
  void wakes_at_wall(World&, const WallEvent& e) override { note("wakes at wall", e); }
  void pair_began(World& w, BodyId a, BodyId b, double t) override { note("pair began", w, a, b, t); }
  void pair_ended(World& w, BodyId a, BodyId b, double t) override { note("pair ended", w, a, b, t); }
  void moved(World& w, BodyId id) override { note("moved", w, id, id, w.now()); }
  void piece(World& w, BodyId id) override { note("piece", w, id, id, w.now()); }

 private:
  void note(const char* what, const collision::Contact& c, std::uint64_t a, std::uint64_t b) {
    char text[300];
    std::snprintf(text, sizeof text, "%a %s %llu %llu  %a %a %a  %a %a %a", c.time, what,
                  static_cast<unsigned long long>(a), static_cast<unsigned long long>(b), c.point[0], c.point[1],
                  c.point[2], c.normal[0], c.normal[1], c.normal[2]);
    lines.emplace_back(text);
    ++counts[what];
  }
  void note(const char* what, const PairEvent& e) { note(what, e.contact, e.user_data_a, e.user_data_b); }
  void note(const char* what, const WallEvent& e) {
    note(what, e.contact, e.user_data, static_cast<std::uint64_t>(e.wall));
  }
  void note(const char* what, const World& w, BodyId a, BodyId b, double t) {
    collision::Contact c{.time = t, .point = Eigen::Vector3d::Zero()};
    c.normal = Eigen::Vector3d::Zero();
    note(what, c, w.contains(a) ? w.user_data(a) : ~0u, w.contains(b) ? w.user_data(b) : ~0u);
  }
};

/// Bodies of which some come when others have gone.
template <class Motion>
struct ComingAndGoing {
  using Description = typename collision::BasicWorld<Motion>::Description;

  std::vector<Description> first{}, later{};
  std::vector<std::size_t> gone{};  ///< of `first`, before those come that come later
  double middle = 1, end = 2;       ///< s: when that is, and how long it goes on
};

/// Runs a scene in which bodies come in an order; `history`, if it is not null, decides which slots they get: others
/// are added before and between them, and removed again, some of them after they have entered.
template <class Motion>
class SlotHistory {
 public:
  using Scene = ComingAndGoing<Motion>;
  using World = collision::BasicWorld<Motion>;

  SlotHistory(const Scene& scene, const collision::WorldOptions& options, Random* history)
      : world_(options, &told), history_(history) {
    stir();
    add(scene.first, 0);
    world_.advance_to(scene.middle);
    for (const std::size_t i : scene.gone) world_.remove_body(ids_[i]);
    stir();
    add(scene.later, scene.first.size());
    world_.advance_to(scene.end);
    world_.audit();
  }

  ToldOfBodies<Motion> told;
  /// How many bodies have a lower slot than the one that was added before.
  std::size_t out_of_order() const { return out_of_order_; }

 private:
  void add(const std::vector<typename World::Description>& bodies, std::size_t number) {
    for (auto body : bodies) {
      body.user_data = number++;
      ids_.push_back(world_.add_body(body));
      if (ids_.size() > 1 && collision::body_slot(ids_.back()) < collision::body_slot(ids_[ids_.size() - 2])) {
        ++out_of_order_;
      }
      if (history_ && history_->one_in(3)) stir();
    }
  }

  /// Strangers far away, of which in the end there are none.
  void stir() {
    if (!history_) return;
    std::vector<collision::BodyId> strangers;
    for (std::size_t i = history_->below(12); i > 0; --i) {
      certificates::PointMotion<Motion::degree> path{};
      path.coefficients[0] = {100.0 + 2 * static_cast<double>(i), 100, 100};
      path.start = world_.now();
      typename World::Description stranger{.shape = collision::Sphere{0.5}};
      if constexpr (collision::turns<Motion>) {
        stranger.motion = {Motion{path}};
      } else {
        stranger.motion = {path};
      }
      strangers.push_back(world_.add_body(stranger));
    }
    // Only when no body of the scene is still to enter: a step lets all of them enter.
    if (ids_.empty() && history_->one_in(2)) world_.advance_to(world_.now());
    while (!strangers.empty()) {
      std::swap(strangers[history_->below(strangers.size())], strangers.back());
      world_.remove_body(strangers.back());
      strangers.pop_back();
    }
  }

  World world_;
  Random* history_;
  std::vector<collision::BodyId> ids_;
  std::size_t out_of_order_ = 0;
};

/// The first line in which two logs differ, or "" if they do not.
inline std::string first_difference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  for (std::size_t i = 0; i < a.size() || i < b.size(); ++i) {
    const std::string of_a = i < a.size() ? a[i] : "nothing", of_b = i < b.size() ? b[i] : "nothing";
    if (of_a != of_b) return "line " + std::to_string(i) + ":\n" + of_a + "\n" + of_b;
  }
  return "";
}

}  // namespace kds::tests
