#include "collision/world/new_broad_phase.hpp"

#include "collision/broad_phase/adaptive_broad_phase.hpp"
#include "collision/broad_phase/all_pairs.hpp"
#include "collision/broad_phase/kinetic_grid.hpp"
#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "collision/broad_phase/swept_sweep_and_prune.hpp"
#include "collision/degrees.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace kds::collision {

template <int Degree>
std::unique_ptr<BroadPhase<Degree>> new_broad_phase(const WorldOptions& options, double now, Profile* profile,
                                                    BoxOf<Degree> box_of, Kdops<Degree> kdops) {
  switch (options.broad_phase) {
    case BroadPhaseKind::automatic:
      return std::make_unique<AdaptiveBroadPhase<Degree>>(std::move(box_of), options.threads);
    case BroadPhaseKind::grid:
      return std::make_unique<KineticGrid<Degree>>(std::move(box_of), options.threads);
    case BroadPhaseKind::kinetic_sap:
      return std::make_unique<KineticSweepAndPrune<Degree>>(now, SweepTuning{}, std::move(kdops));
    case BroadPhaseKind::sap:
      if (!(options.rate > 0) || !std::isfinite(1 / options.rate)) {
        throw std::invalid_argument(
            "WorldOptions.rate: sweep and prune with swept boxes needs a rate > 0, finite and with a finite 1 / rate");
      }
      return std::make_unique<SweptSweepAndPrune<Degree>>(now, options.rate, profile);
    case BroadPhaseKind::all_pairs:
      return std::make_unique<AllPairs<Degree>>();
  }
  throw std::invalid_argument("WorldOptions.broad_phase: unknown");
}

#define KDS_INSTANTIATE(degree)                                                                                      \
  template std::unique_ptr<BroadPhase<degree>> new_broad_phase(const WorldOptions&, double, Profile*, BoxOf<degree>, \
                                                               Kdops<degree>);
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
