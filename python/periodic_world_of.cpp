#include "collision/periodic/periodic_world.hpp"
#include "io/events.hpp"
#include "io/periodic_recorder.hpp"
#include "python/any_periodic_world.hpp"
#include "python/narrowed.hpp"
#include "python/recording.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace kds_python {
namespace {

using namespace kds::collision;
using kds::io::EventKind;

template <int Degree>
class PeriodicTeller final : public PeriodicListener<Degree> {
 public:
  using World = PeriodicWorld<Degree>;

  explicit PeriodicTeller(AnyPeriodicWorld::Listener listener) : listener_(std::move(listener)) {}

  void contact(World&, const PeriodicEvent& e) override { tell(EventKind::contact, e); }
  void overlap(World&, const PeriodicEvent& e) override { tell(EventKind::overlap, e); }
  void passes(World&, const PeriodicEvent& e) override { tell(EventKind::pass, e); }
  void wall(World&, const WallEvent& e) override {
    const auto wall = static_cast<std::uint64_t>(e.wall);
    listener_({to_row(static_cast<std::int64_t>(EventKind::wall), e.body, wall, e.contact, e.user_data), {}, 0});
  }
  void wrapped(World& world, BodyId body, const Offset& offset) override {
    Contact nowhere;
    nowhere.time = world.now();
    nowhere.normal = Eigen::Vector3d::Zero();
    listener_({to_row(wrap_kind, body, body, nowhere), offset, 0});
  }

 private:
  void tell(EventKind kind, const PeriodicEvent& e) {
    const EventRow row = to_row(static_cast<std::int64_t>(kind), e.a, e.b, e.contact, e.user_data_a, e.user_data_b);
    listener_({row, e.offset, e.impulse});
  }

  AnyPeriodicWorld::Listener listener_;
};

template <int Degree>
class PeriodicWorldOf final : public AnyPeriodicWorld {
  using M = kds::certificates::PointMotion<Degree>;

 public:
  PeriodicWorldOf(const PeriodicOptions& options, bool record, Listener listener)
      : min_(options.min),
        teller_(std::move(listener)),
        recording_(record, options, teller_),
        world_(options, recording_.listener()) {}

  BodyId add_body(const Description& body) override {
    const BodyId id = world_.add_body(narrowed<M>(body));
    recording_.look(world_, id);
    return id;
  }
  void reserve(std::size_t bodies) override { world_.reserve(bodies); }
  void remove_body(BodyId id) override {
    world_.remove_body(id);
    recording_.look(world_, id);
  }

  void update_motions(const std::vector<BodyId>& ids, const std::vector<Motion>& motions) override {
    if (motions.size() != ids.size()) throw std::invalid_argument("then: in a periodic world a motion has one piece");
    for (const BodyId id : ids) (void)world_.motion(id);  // throws if it is not there
    const std::vector<M> own = narrowed_scripts<M>(ids, motions);
    for (std::size_t i = 0; i < ids.size(); ++i) require_near(own[i], "motion of body " + std::to_string(ids[i]));
    for (std::size_t i = 0; i < ids.size(); ++i) {
      world_.update_motion(ids[i], own[i]);
      recording_.look(world_, ids[i]);
    }
  }
  void set_restitutions(const std::vector<BodyId>& ids, const double* restitutions) override {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      (void)world_.motion(ids[i]);  // throws if it is not there
      if (!(restitutions[i] >= 0 && restitutions[i] <= 1)) {
        throw std::invalid_argument("restitution of body " + std::to_string(ids[i]) + ": must be in [0, 1]");
      }
    }
    for (std::size_t i = 0; i < ids.size(); ++i) world_.set_restitution(ids[i], restitutions[i]);
  }

  /// One that is infinite is refused by the world.
  bool step(double limit) override { return world_.step(limit); }
  bool advance_for(double budget_seconds, double t) override {
    using Clock = std::chrono::steady_clock;
    const auto budget = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(budget_seconds));
    const auto end = Clock::now() + budget;
    while (world_.step(t)) {
      if (Clock::now() >= end) return false;
    }
    world_.advance_to(t);
    return true;
  }

  double now() const override { return world_.now(); }
  std::size_t size() const override { return world_.size(); }
  bool contains(BodyId id) const override { return world_.contains(id); }
  Motion motion_now(BodyId id) const override {
    Motion wide = motion_as<Motion>(world_.motion(id).restarted(now()));
    wide.orientation = Eigen::Quaterniond(world_.world().shape(world_.in_world(id)).rotation);
    return wide;
  }
  Motion free_motion_now(BodyId id) const override {
    return motion_as<Motion>(world_.world().free_motion(world_.in_world(id)).restarted(now()));
  }
  void audit() const override { world_.audit(); }
  kds::Snapshot save() override { return kds::save(world_); }
  void restore(const kds::Snapshot& snapshot) override {
    kds::restore(snapshot, world_);
    recording_.start_again(world_);
  }

  void write_replay(const std::string& file, const std::string& title) override {
    recording_.write_replay(world_, file, title);
  }
  void write_gltf(const std::string& file, const std::string& title, double frames_per_second) override {
    recording_.write_gltf(world_, file, title, frames_per_second);
  }
  void write_vtk(const std::string& file, double frames_per_second) override {
    recording_.write_vtk(world_, file, frames_per_second);
  }

  std::vector<BodyId> bodies() const override {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<BodyId> found;
    const auto visit = [&](BodyId in_world) {
      const auto owner = world_.owner(in_world);
      if (owner.offset == Offset{}) found.push_back(owner.body);
    };
    world_.world().visit_overlapping(Eigen::Vector3d::Constant(-infinity), Eigen::Vector3d::Constant(infinity), visit);
    std::sort(found.begin(), found.end());
    return found;
  }
  Offset crossings(BodyId id) const override { return world_.crossings(id); }
  Eigen::Vector3d way_wrapped(BodyId id) const override {
    return world_.lattice().displacement(world_.crossings(id), now());
  }
  PeriodicCounters counters() const override { return world_.counters(); }

 private:
  /// The world counts periods from the box up to 2^31; throws where it would refuse the motion.
  void require_near(const M& motion, const std::string& name) const {
    const PeriodLattice& lattice = world_.lattice();
    Offset way{};
    for (const int axis : {1, 2, 0}) {
      if (!lattice.periodic(axis)) continue;
      const double x = lattice.moved(motion, way).position(now())[axis];
      const double periods = std::floor((x - min_[axis]) / lattice.period(axis));
      if (!(std::abs(periods) < 0x1p31)) {
        throw std::invalid_argument(name + ": more than 2^31 periods away from the box");
      }
      way[static_cast<std::size_t>(axis)] = -static_cast<std::int64_t>(periods);
    }
  }

  Eigen::Vector3d min_;
  PeriodicTeller<Degree> teller_;
  Recording<kds::io::PeriodicRecorder<Degree>> recording_;
  PeriodicWorld<Degree> world_;
};

}  // namespace

std::unique_ptr<AnyPeriodicWorld> make_periodic_world(int degree, bool record, const PeriodicOptions& options,
                                                      AnyPeriodicWorld::Listener listener) {
  if (degree == 1) return std::make_unique<PeriodicWorldOf<1>>(options, record, std::move(listener));
  if (degree == 2) return std::make_unique<PeriodicWorldOf<2>>(options, record, std::move(listener));
  throw std::invalid_argument("degree: must be 1 (lines) or 2 (parabolas) in a periodic world, not " +
                              std::to_string(degree));
}

}  // namespace kds_python
