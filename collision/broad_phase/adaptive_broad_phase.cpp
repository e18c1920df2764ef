#include "collision/broad_phase/adaptive_broad_phase.hpp"

#include "collision/degrees.hpp"

#include <algorithm>
#include <utility>

namespace kds::collision {
namespace {

/// For pairs that have been reported already.
class NoListener final : public PairListener {
 public:
  explicit NoListener(const PairListener& told) : told_(told) {}
  bool filters() const override { return told_.filters(); }
  bool may_collide(BodySlot a, BodySlot b) const override { return told_.may_collide(a, b); }
  std::uint64_t filter_of(BodySlot body) const override { return told_.filter_of(body); }
  bool filters_meet(std::uint64_t a, std::uint64_t b) const override { return told_.filters_meet(a, b); }
  void pair_began(BodySlot, BodySlot, double) override {}
  void pair_ended(BodySlot, BodySlot, double) override {}

 private:
  const PairListener& told_;
};

}  // namespace

/// Reports the pairs that one has and the other has not.
template <int Degree>
template <class From, class To>
void AdaptiveBroadPhase<Degree>::report_changes(std::span<const Entry> bodies, const From& from, const To& to,
                                                double now, PairListener& listener) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto [a, b] = std::minmax(bodies[i].slot, bodies[j].slot);
      if (listener.filters() && !listener.may_collide(a, b)) continue;
      const bool was = from.paired(a, b);
      const bool is = to.paired(a, b);
      if (was && !is) listener.pair_ended(a, b, now);
      if (is && !was) listener.pair_began(a, b, now);
    }
  }
}

template <int Degree>
std::unique_ptr<KineticGrid<Degree>> AdaptiveBroadPhase<Degree>::new_grid() const {
  auto grid = std::make_unique<KineticGrid<Degree>>(box_of_, threads_, tuning_.grid);
  grid->reserve(room_);
  return grid;
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::reserve(BodySlot end) {
  room_ = std::max(room_, end);
  if (grid_) return grid_->reserve(room_);
  if (room_ > tuning_.most_for_few) spare_ = new_grid();
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::make_grid(double now) {
  grid_ = spare_ ? std::move(spare_) : new_grid();
  grid_->extend_horizon(now, horizon_);
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::change_to_grid(double now, PairListener& listener) {
  std::vector<Entry> entries;
  few_.visit([&](BodySlot id, const KineticBox<Degree>& box) { entries.push_back({id, &box}); });
  make_grid(now);
  if (entries.empty()) return;
  NoListener known(listener);
  grid_->insert(entries, now, known);
  report_changes(entries, few_, *grid_, now, listener);
  few_.clear();
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::change_to_few(double now, PairListener& listener) {
  std::vector<KineticBox<Degree>> boxes;
  boxes.reserve(grid_->size());
  std::vector<Entry> entries;
  grid_->visit([&](BodySlot id) {
    boxes.push_back(box_of_(id));
    entries.push_back({id, &boxes.back()});
  });
  NoListener known(listener);
  few_.extend_horizon(now, horizon_);
  few_.insert(entries, now, known);
  report_changes(entries, *grid_, few_, now, listener);
  done_ = done_ + grid_->counters();
  grid_.reset();
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::expect(std::size_t bodies, BodySlot end, std::span<const Entry> some, double now) {
  if (!grid_ && few_.size() == 0 && bodies > tuning_.most_for_few) make_grid(now);
  if (grid_) grid_->expect(bodies, end, some, now);
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::insert(std::span<const Entry> bodies, double now, PairListener& listener) {
  if (!grid_ && few_.size() + bodies.size() > tuning_.most_for_few) change_to_grid(now, listener);
  if (grid_) return grid_->insert(bodies, now, listener);
  few_.insert(bodies, now, listener);
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::remove(BodySlot id, double now, PairListener& listener) {
  if (!grid_) return few_.remove(id, now, listener);
  grid_->remove(id, now, listener);
  if (grid_->size() <= tuning_.most_for_few / 2) change_to_few(now, listener);
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::update(BodySlot id, const KineticBox<Degree>& box, double now,
                                        PairListener& listener) {
  if (grid_) return grid_->update(id, box, now, listener);
  few_.update(id, box, now, listener);
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::extend_horizon(double now, double horizon) {
  horizon_ = horizon;
  if (grid_) return grid_->extend_horizon(now, horizon);
  few_.extend_horizon(now, horizon);
}

template <int Degree>
BroadPhaseCounters AdaptiveBroadPhase<Degree>::counters() const {
  const BroadPhaseCounters sum = done_ + few_.counters();
  return grid_ ? sum + grid_->counters() : sum;
}

#define KDS_INSTANTIATE(degree) template class AdaptiveBroadPhase<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
