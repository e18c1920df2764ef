#include "collision/broad_phase/adaptive_broad_phase.hpp"

#include <algorithm>
#include <utility>

namespace kds::collision {
namespace {

/// For pairs that are known already.
class NoListener final : public PairListener {
 public:
  void pair_began(BodyId, BodyId, double) override {}
  void pair_ended(BodyId, BodyId, double) override {}
};

void add(BroadPhaseCounters& sum, const BroadPhaseCounters& work) {
  sum.swaps += work.swaps;
  sum.certificates += work.certificates;
  sum.box_updates += work.box_updates;
}

}  // namespace

/// Calls report(a, b) for the pairs of the few that the grid has not.
template <int Degree>
template <class Report>
void AdaptiveBroadPhase<Degree>::each_unpaired(Report&& report) const {
  for (std::size_t i = 0; i < few_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto [a, b] = std::minmax(few_[i].id, few_[j].id);
      if (!grid_->paired(a, b)) report(a, b);
    }
  }
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::change_to_grid(double now, PairListener& listener) {
  std::vector<Entry> entries;
  for (const Body& body : few_) entries.push_back({body.id, &body.box});
  grid_ = std::make_unique<KineticGrid<Degree>>(threads_);
  grid_->extend_horizon(now, horizon_);
  if (few_.empty()) return;
  NoListener known;
  grid_->insert(entries, now, known);
  each_unpaired([&](BodyId a, BodyId b) { listener.pair_ended(a, b, now); });
  for (const Body& body : few_) all_pairs_.remove(body.id, now, known);
  few_.clear();
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::change_to_all_pairs(double now, PairListener& listener) {
  std::vector<Entry> entries;
  grid_->visit([&](BodyId id, const KineticBox<Degree>& box) { few_.push_back({id, box}); });
  for (const Body& body : few_) entries.push_back({body.id, &body.box});
  NoListener known;
  all_pairs_.insert(entries, now, known);
  each_unpaired([&](BodyId a, BodyId b) { listener.pair_began(a, b, now); });
  add(done_, grid_->counters());
  grid_.reset();
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::insert(std::span<const Entry> bodies, double now, PairListener& listener) {
  if (!grid_ && few_.size() + bodies.size() > most_for_all_pairs) change_to_grid(now, listener);
  if (grid_) return grid_->insert(bodies, now, listener);
  for (const Entry& body : bodies) few_.push_back({body.id, *body.box});
  all_pairs_.insert(bodies, now, listener);
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::remove(BodyId id, double now, PairListener& listener) {
  if (!grid_) {
    std::erase_if(few_, [id](const Body& body) { return body.id == id; });
    return all_pairs_.remove(id, now, listener);
  }
  grid_->remove(id, now, listener);
  if (grid_->size() <= few_again) change_to_all_pairs(now, listener);
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::update(BodyId id, const KineticBox<Degree>& box, double now, PairListener& listener) {
  if (grid_) return grid_->update(id, box, now, listener);
  std::find_if(few_.begin(), few_.end(), [id](const Body& body) { return body.id == id; })->box = box;
  all_pairs_.update(id, box, now, listener);
}

template <int Degree>
void AdaptiveBroadPhase<Degree>::extend_horizon(double now, double horizon) {
  horizon_ = horizon;
  if (grid_) grid_->extend_horizon(now, horizon);
}

template <int Degree>
BroadPhaseCounters AdaptiveBroadPhase<Degree>::counters() const {
  BroadPhaseCounters sum = done_;
  add(sum, all_pairs_.counters());
  if (grid_) add(sum, grid_->counters());
  return sum;
}

template class AdaptiveBroadPhase<1>;
template class AdaptiveBroadPhase<2>;

}  // namespace kds::collision
