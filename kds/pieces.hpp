// Piecewise motion: elements whose motion changes at known times.
#pragma once

#include "kds/audit.hpp"
#include "kds/events/default_event_queue.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/number_text.hpp"
#include "kds/raised_flag.hpp"
#include "kds/roots/failure_time.hpp"
#include "kds/statistics.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds {

/// Plans for the elements of a set: from `start` on the element has this motion. To the simulator it is one more
/// structure, whose events are the seams between pieces; an edit by hand leaves the plan as it is, a removal drops it.
///
/// As with every edit, events of the seam's time come before it (see MovingSet). Pieces need not meet at a seam: a jump
/// is legal.
///
/// Cost: O(1) queue operations a seam, a move of the element's later pieces, and what the structures have to do for an
/// edit.
template <MovingElement E>
class Pieces final : private MovingSet<E>::Observer {
 public:
  /// The set must outlive it.
  explicit Pieces(MovingSet<E>& elements) : elements_(elements) { elements_.attach(*this); }
  ~Pieces() { elements_.detach(*this); }
  Pieces(const Pieces&) = delete;
  Pieces& operator=(const Pieces&) = delete;

  /// Appends a piece to the plan of an element, which takes it up at `start`, in seconds. `now` is the clock. Throws
  /// std::out_of_range for an element that is not there, std::invalid_argument for a motion that is not finite and for
  /// a start that is not finite, before `now`, or not after that of the piece before; the plan is then as it was.
  void plan(Id id, double start, const E& motion, double now) {
    if (!elements_.contains(id)) throw std::out_of_range("Pieces: no element with id " + std::to_string(id));
    if (!detail::finite(motion)) {
      throw std::invalid_argument("Pieces: a motion of id " + std::to_string(id) + " is not finite");
    }
    if (id >= plans_.size()) {
      plans_.resize(id + std::size_t{1});
      queue_.resize(plans_.size());
    }
    auto& plan = plans_[id];
    if (!std::isfinite(start) || start < now || (!plan.empty() && start <= plan.back().start)) {
      throw std::invalid_argument("Pieces: the pieces of id " + std::to_string(id) + " must start one after another");
    }
    plan.push_back({start, motion});
    schedule(id);
  }

  /// Pieces still to come.
  std::size_t planned(Id id) const { return id < plans_.size() ? plans_[id].size() : 0; }

  /// Time of the next seam, `never` if there is none.
  double next_time() const { return queue_.empty() ? never : queue_.top().time; }

  /// Makes the change of motion due at next_time(), unless a listener of an event of that time removes the element.
  /// Precondition: there is one.
  void process() {
    const double time = queue_.top().time;
    const detail::RaisedFlag processing(processing_);
    elements_.process_due(time);
    if (next_time() != time) return;
    const Id id = queue_.top().slot;
    const Piece piece = plans_[id].front();
    plans_[id].erase(plans_[id].begin());
    schedule(id);
    ++counters_.events;
    elements_.update(id, piece.motion, time);
  }

  void extend_horizon(double /*now*/, double /*horizon*/) {}  // All seams are known.

  /// Throws AuditFailure if a piece is not scheduled at its start, or should have started before now.
  void audit(double now) const {
    for (Id id = 0; id < plans_.size(); ++id) {
      const double start = plans_[id].empty() ? never : plans_[id].front().start;
      if (queue_.time(id) != start)
        throw AuditFailure("Pieces: id " + std::to_string(id) + ": scheduled at another time");
      if (start < now) throw AuditFailure("Pieces: id " + std::to_string(id) + ": a piece has been passed over");
    }
  }

  const Counters& counters() const { return counters_; }

  template <class Archive>
  void archive(Archive& archive) {
    archive.tag("Pieces");
    archive(plans_, counters_);
    if constexpr (Archive::loading) {
      for (const auto& plan : plans_) {
        for (std::size_t i = 0; i < plan.size(); ++i) {
          archive.require(std::isfinite(plan[i].start) && (i == 0 || plan[i].start > plan[i - 1].start),
                          "pieces do not start one after another");
          archive.require(detail::finite(plan[i].motion), "the motion of a piece is not finite");
        }
      }
      for (Slot slot = 0; slot < queue_.slots(); ++slot) queue_.clear(slot);
      queue_.resize(plans_.size());
      for (Id id = 0; id < plans_.size(); ++id) schedule(id);
    }
  }

 private:
  struct Piece {
    double start = 0;
    E motion{};

    template <class Archive>
    void archive(Archive& archive) {
      archive(start, motion);
    }
  };

  void schedule(Id id) {
    if (plans_[id].empty()) {
      queue_.clear(id);
    } else {
      queue_.set(id, plans_[id].front().start);
    }
  }

  void process_due(double now) override {
    if (next_time() < now)
      throw std::logic_error("Pieces: an edit at " + number_text(now) + " would pass over a piece");
    while (!processing_ && next_time() <= now) process();
  }
  void inserted(Id /*id*/, double /*now*/) override {}
  void removing(Id id, double /*now*/) override {
    if (planned(id) == 0) return;
    plans_[id].clear();
    queue_.clear(id);
  }
  void changing(Id /*id*/, const E& /*next*/, double /*now*/) override {}
  void changed(Id /*id*/, double /*now*/) override {}

  MovingSet<E>& elements_;
  std::vector<std::vector<Piece>> plans_;
  DefaultEventQueue queue_;
  Counters counters_;
  bool processing_ = false;
};

}  // namespace kds
