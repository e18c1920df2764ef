#include "collision/parallel/parallel_world.hpp"

#include "collision/motions.hpp"
#include "collision/parallel/parallel_runner.hpp"

#include <functional>
#include <memory>
#include <utility>

namespace kds::collision {

template <class Motion>
BasicParallelWorld<Motion>::BasicParallelWorld(const WorldOptions& options, const ParallelOptions& parallel,
                                               ParallelListener* listener, Processes* processes)
    : runner_(std::make_unique<Runner>(options, parallel, listener, processes)) {}

template <class Motion>
BasicParallelWorld<Motion>::~BasicParallelWorld() = default;

template <class Motion>
typename BasicParallelWorld<Motion>::World& BasicParallelWorld<Motion>::whole() {
  return runner_->whole();
}

template <class Motion>
void BasicParallelWorld<Motion>::add_shares(std::size_t count, const std::function<Description(std::size_t)>& body) {
  runner_->add_shares(count, body);
}

template <class Motion>
void BasicParallelWorld<Motion>::advance_to(double t) {
  runner_->advance_to(t);
}

template <class Motion>
void BasicParallelWorld<Motion>::change(std::function<void(World&)> change) {
  runner_->change(std::move(change));
}

template <class Motion>
kds::Snapshot BasicParallelWorld<Motion>::save_parts(const WriteBodies& write, std::size_t bodies_in_block) {
  return runner_->save_parts(write, bodies_in_block);
}

template <class Motion>
void BasicParallelWorld<Motion>::load_parts(const kds::Snapshot& rest, const ReadBodies& read) {
  runner_->load_parts(rest, read);
}

template <class Motion>
double BasicParallelWorld<Motion>::now() const {
  return runner_->now();
}

template <class Motion>
std::size_t BasicParallelWorld<Motion>::size() const {
  return runner_->world().size();
}

template <class Motion>
const Motion& BasicParallelWorld<Motion>::motion(BodyId id) const {
  return runner_->motion(id);
}

template <class Motion>
std::size_t BasicParallelWorld<Motion>::stored() const {
  return runner_->stored();
}

template <class Motion>
std::size_t BasicParallelWorld<Motion>::domains() const {
  return runner_->domains();
}

template <class Motion>
ParallelCounters BasicParallelWorld<Motion>::counters() const {
  return runner_->counters();
}

template <class Motion>
WorldCounters BasicParallelWorld<Motion>::work() const {
  return runner_->work();
}

template <class Motion>
MessageCounters BasicParallelWorld<Motion>::messages() const {
  return runner_->messages();
}

template <class Motion>
std::string_view BasicParallelWorld<Motion>::broad_phase() const {
  return runner_->broad_phase();
}

template <class Motion>
template <class Archive>
void BasicParallelWorld<Motion>::archive(Archive& archive) {
  runner_->archive(archive);
}

#define KDS_INSTANTIATE(motion)                                            \
  template class BasicParallelWorld<motion>;                               \
  template void BasicParallelWorld<motion>::archive(kds::detail::Writer&); \
  template void BasicParallelWorld<motion>::archive(kds::detail::Reader&);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
