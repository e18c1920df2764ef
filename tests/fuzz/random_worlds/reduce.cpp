#include "tests/fuzz/random_worlds/reduce.hpp"

#include "tests/fuzz/random_worlds/differences.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <utility>

namespace kds::fuzz {
namespace {

class Reducer {
 public:
  Reducer(const DrawnScenario& drawn, const Way& way, double seconds)
      : best_(drawn), way_(way), wanted_(difference(drawn, way).what), end_(Clock::now() + duration(seconds)) {
    DrawnScenario written = drawn;
    written.scenario = written_down(drawn, way);
    still_differs(written, way_);
  }

  void run() {
    do {
      better_ = false;
      remove_some([](Scenario & s) -> auto& { return s.calls; });
      remove_some([](Scenario & s) -> auto& { return s.reactions; });
      simplify_reactions();
      simplify_way();
      simplify_options();
      for (std::size_t i = 0; i < best_.scenario.bodies.size(); ++i) simplify_body(i);
      simplify_calls();
    } while (better_ && !late());
  }

  Scenario scenario() const { return best_.scenario; }
  Way way() const { return way_; }

 private:
  using Clock = std::chrono::steady_clock;
  static Clock::duration duration(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }
  bool late() const { return Clock::now() > end_; }

  /// If so, it is the best from now on.
  bool still_differs(const DrawnScenario& changed, const Way& way) {
    if (late() || difference(changed, way).what != wanted_) return false;
    best_ = changed;
    way_ = way;
    return better_ = true;
  }
  bool attempt(const std::function<void(Scenario&)>& change) {
    DrawnScenario changed = best_;
    change(changed.scenario);
    return still_differs(changed, way_);
  }

  /// Leaves out halves, quarters ... and single elements.
  template <class List>
  void remove_some(List list) {
    for (std::size_t part = std::max<std::size_t>(list(best_.scenario).size() / 2, 1); part >= 1; part /= 2) {
      for (std::size_t end = list(best_.scenario).size(); end > 0 && !late(); end = end > part ? end - part : 0) {
        const std::size_t begin = end > part ? end - part : 0;
        attempt([&](Scenario& s) {
          auto& all = list(s);
          all.erase(all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(end));
        });
      }
    }
  }

  void simplify_reactions() {
    for (std::size_t r = 0; r < best_.scenario.reactions.size(); ++r) {
      remove_some([r](Scenario & s) -> auto& { return s.reactions[r].calls; });
    }
  }

  void simplify_way() {
    const auto simpler = [&](auto member, auto value) {
      if (way_.*member == value) return;
      Way changed = way_;
      changed.*member = value;
      still_differs(best_, changed);
    };
    simpler(&Way::audits, false);
    simpler(&Way::window, never);
    simpler(&Way::threads, std::size_t{1});
    simpler(&Way::kdop, 6);
    simpler(&Way::budgets, false);
    simpler(&Way::stops, 0);
    simpler(&Way::stops, 1);
    simpler(&Way::save_every, std::size_t{0});
    simpler(&Way::saves_between_calls, false);
    simpler(&Way::runs_ahead, false);
    simpler(&Way::load_into, way_.broad_phase);
    simpler(&Way::broad_phase, BroadPhaseKind::all_pairs);
    simpler(&Way::broad_phase, BroadPhaseKind::automatic);
  }

  void simplify_options() {
    const auto simpler = [&](auto member, auto value) {
      if (best_.scenario.*member != value) attempt([&](Scenario& s) { s.*member = value; });
    };
    simpler(&Scenario::walls, false);
    simpler(&Scenario::report_pairs, false);
    simpler(&Scenario::unit, 1.0);
    simpler(&Scenario::start_time, 0.0);
    simpler(&Scenario::zeno_contacts, 100u);
    simpler(&Scenario::zeno_interval, 1e-9);
    simpler(&Scenario::response, Response::none);
    simpler(&Scenario::response, Response::elastic);
    simpler(&Scenario::degree, 1);
    attempt([](Scenario& s) { s.wall.restitution = 1; });
  }

  void simplify_body(std::size_t i) {
    const auto body = [&](auto&& change) { attempt([&](Scenario& s) { change(s.bodies[i]); }); };
    const BodyPlan plain;
    if (best_.scenario.bodies[i].shape == ShapeKind::half_space) {
      body([&](BodyPlan& b) { b.shape = ShapeKind::ball, b.size = plain.size; });
      return;
    }
    if (best_.scenario.bodies[i].shape != ShapeKind::ball) body([](BodyPlan& b) { b.shape = ShapeKind::ball; });
    if (best_.scenario.bodies[i].shape == ShapeKind::mesh) body([](BodyPlan& b) { b.shape = ShapeKind::box; });
    if (best_.scenario.bodies[i].shape == ShapeKind::mesh) body([](BodyPlan& b) { b.shape = ShapeKind::capsule; });
    if (best_.scenario.bodies[i].shape == ShapeKind::compound) body([](BodyPlan& b) { b.shape = ShapeKind::box; });
    if (best_.scenario.bodies[i].shape == ShapeKind::hull) body([](BodyPlan& b) { b.shape = ShapeKind::box; });
    if (best_.scenario.bodies[i].mesh > 0) body([](BodyPlan& b) { b.mesh = 0; });
    if (best_.scenario.bodies[i].box_function) body([](BodyPlan& b) { b.box_function = false; });
    if (best_.scenario.bodies[i].fixed) body([](BodyPlan& b) { b.fixed = false; });
    body([&](BodyPlan& b) { b.orientation = plain.orientation; });
    body([&](BodyPlan& b) { b.mass = plain.mass; });
    body([&](BodyPlan& b) { b.restitution = plain.restitution; });
    body([&](BodyPlan& b) { b.category = plain.category, b.collides_with = plain.collides_with; });
    body([&](BodyPlan& b) { b.volume = plain.volume; });
    for (std::size_t more = best_.scenario.bodies[i].pieces.size(); more > 1; --more) {
      body([&](BodyPlan& b) { b.pieces.erase(b.pieces.begin() + static_cast<std::ptrdiff_t>(more - 1)); });
    }
    simplify_vector([i](Scenario& s) -> Vector3d& { return s.bodies[i].size; }, Vector3d::Ones());
    for (std::size_t p = 0; p < best_.scenario.bodies[i].pieces.size(); ++p) {
      simplify_path([i, p](Scenario& s) -> Path& { return s.bodies[i].pieces[p]; });
    }
  }

  void simplify_calls() {
    for (std::size_t c = 0; c < best_.scenario.calls.size(); ++c) {
      if (best_.scenario.calls[c].kind == Call::Kind::advance) {
        simplify_number([c](Scenario& s) -> double& { return s.calls[c].seconds; }, 1);
      } else if (best_.scenario.calls[c].kind == Call::Kind::move) {
        simplify_path([c](Scenario& s) -> Path& { return s.calls[c].path; });
      }
    }
    for (std::size_t r = 0; r < best_.scenario.reactions.size(); ++r) {
      for (std::size_t c = 0; c < best_.scenario.reactions[r].calls.size(); ++c) {
        simplify_path([r, c](Scenario& s) -> Path& { return s.reactions[r].calls[c].path; });
      }
    }
  }

  template <class Which>
  void simplify_path(Which which) {
    if (which(best_.scenario).start != 0)
      simplify_number([which](Scenario& s) -> double& { return which(s).start; }, 0);
    simplify_vector([which](Scenario& s) -> Vector3d& { return which(s).half_acceleration; }, Vector3d::Zero());
    simplify_vector([which](Scenario& s) -> Vector3d& { return which(s).velocity; }, Vector3d::Zero());
    simplify_vector([which](Scenario& s) -> Vector3d& { return which(s).place; }, Vector3d::Zero());
  }
  template <class Which>
  void simplify_vector(Which which, const Vector3d& simplest) {
    if (which(best_.scenario) == simplest || attempt([&](Scenario& s) { which(s) = simplest; })) return;
    for (int d = 0; d < 3; ++d) {
      simplify_number([which, d](Scenario& s) -> double& { return which(s)[d]; }, simplest[d]);
    }
  }
  /// The simplest one, or one of fewer bits.
  template <class Which>
  void simplify_number(Which which, double simplest) {
    const double now = which(best_.scenario);
    for (const double x : {simplest, std::round(now), std::round(2 * now) / 2, std::round(8 * now) / 8}) {
      if (which(best_.scenario) == x || attempt([&](Scenario& s) { which(s) = x; })) return;
    }
  }

  DrawnScenario best_;
  Way way_;
  std::string wanted_;
  Clock::time_point end_;
  bool better_ = false;
};

}  // namespace

Scenario reduced(const DrawnScenario& drawn, Way& way, double seconds) {
  Reducer reducer(drawn, way, seconds);
  reducer.run();
  way = reducer.way();
  return reducer.scenario();
}

}  // namespace kds::fuzz
