// Two domains by themselves, without what runs them.
#pragma once

#include "collision/parallel/body_store.hpp"
#include "collision/parallel/division.hpp"
#include "collision/parallel/domain.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

namespace kds::collision::tests {

/// Bodies as they are at a time, in two domains, each of which knows all of them, or those that are near.
template <class Motion>
class InTwo {
 public:
  InTwo(const WorldOptions& options, const std::function<void(BasicWorld<Motion>&)>& fill, double now, double halo,
        bool know_all = true)
      : now_(now), whole_(options), store_(options, engine()) {
    fill(whole_);
    whole_.advance_to(now);
    Team alone(nullptr);
    std::vector<BodySlot> all(whole_.size());
    std::iota(all.begin(), all.end(), BodySlot{0});
    division_ = divide(engine().bodies(), {}, all, now, {.domains = 2}, 1, alone);
    division_->halo = halo;
    division_->window_end = now + 4;
    std::array<std::vector<BodySlot>, 2> known;
    std::vector<DomainIndex> knowers;
    for (const BodySlot slot : all) {
      const DomainIndex owner = assign_body(*division_, engine().bodies(), {}, slot, now, knowers);
      if (know_all) knowers = {0, 1};
      division_->note(slot, owner, knowers);
      for (const DomainIndex domain : knowers) known[domain].push_back(slot);
    }
    engine().transfer().set_aside();
    for (std::size_t i = 0; i < 2; ++i) {
      domains_[i].emplace(options, *division_, i, now, true, i == 0);
      domains_[i]->exchange({}, known[i], store_, {});
      domains_[i]->begin_window();
    }
  }

  Domain<Motion>& domain(std::size_t i) { return *domains_[i]; }
  const BodyStore<Motion>& store() const { return store_; }
  /// How far a body is outside the cell of the first domain at the beginning, and how far a place is.
  double outside_first(BodyId id) { return outside_first(path_of(whole_.motion(id)).position(now_)); }
  double outside_first(const Eigen::Vector3d& place) const { return outside(place, division_->partition.cell(0)); }

 private:
  Engine<Motion>& engine() { return detail::EngineOf<Motion>::of(whole_); }

  const double now_;
  BasicWorld<Motion> whole_;
  BodyStore<Motion> store_;
  std::optional<Division> division_;
  std::array<std::optional<Domain<Motion>>, 2> domains_;
};

}  // namespace kds::collision::tests
