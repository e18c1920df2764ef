// The default: a broad phase that chooses, and may change its mind.
#pragma once

#include "collision/broad_phase/all_pairs.hpp"
#include "collision/broad_phase/kinetic_grid.hpp"

#include <memory>
#include <string_view>
#include <vector>

namespace kds::collision {

/// All pairs while there are few bodies, the kinetic grid from then on, and back when most have gone. A change reports
/// just the pairs that one has and the other has not, so no contact is lost.
///
/// These two are enough: from some ten bodies on the grid is the cheapest at nearly all sizes, densities and rates that
/// were measured (docs/speed.md).
template <int Degree>
class AdaptiveBroadPhase final : public BroadPhase<Degree> {
 public:
  using Entry = typename BroadPhase<Degree>::Entry;

  /// At most so many bodies are compared pair by pair at first, and when others have gone.
  static constexpr std::size_t most_for_all_pairs = 8;
  static constexpr std::size_t few_again = 4;

  /// `threads`: see KineticGrid.
  explicit AdaptiveBroadPhase(std::size_t threads = 1) : threads_(threads) {}

  bool exact() const override { return false; }
  std::string_view name() const override { return chosen().name(); }
  void insert(std::span<const Entry> bodies, double now, PairListener& listener) override;
  void remove(BodyId id, double now, PairListener& listener) override;
  void update(BodyId id, const KineticBox<Degree>& box, double now, PairListener& listener) override;
  bool advance(double limit, PairListener& listener) override { return grid_ && grid_->advance(limit, listener); }
  double next_time() const override { return grid_ ? grid_->next_time() : never; }
  void extend_horizon(double now, double horizon) override;
  void audit(double now) const override { chosen().audit(now); }
  BroadPhaseCounters counters() const override;

 private:
  struct Body {
    BodyId id;
    KineticBox<Degree> box;
  };

  const BroadPhase<Degree>& chosen() const {
    return grid_ ? static_cast<const BroadPhase<Degree>&>(*grid_) : all_pairs_;
  }
  void change_to_grid(double now, PairListener& listener);
  void change_to_all_pairs(double now, PairListener& listener);
  template <class Report>
  void each_unpaired(Report&& report) const;

  AllPairs<Degree> all_pairs_;
  std::unique_ptr<KineticGrid<Degree>> grid_;  ///< if it is what is used
  std::vector<Body> few_;                      ///< all bodies, if not
  std::size_t threads_;
  double horizon_ = never;
  BroadPhaseCounters done_;  ///< by grids that have been given up
};

extern template class AdaptiveBroadPhase<1>;
extern template class AdaptiveBroadPhase<2>;

}  // namespace kds::collision
