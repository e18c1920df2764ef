#include "collision/parallel/parallel_world.hpp"
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/near_pairs.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/world.hpp"
#include "collision/world/edits/checked_pieces.hpp"
#include "io/scene_world.hpp"
#include "io/world_recorder.hpp"
#include "python/any_world.hpp"
#include "python/narrowed.hpp"
#include "python/recording.hpp"
#include "python/tellers.hpp"

#include <algorithm>
#include <chrono>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace kds_python {
namespace {

using namespace kds::collision;

template <class M, bool divided = false>
class WorldOf final : public AnyWorld {
  using World = std::conditional_t<divided, BasicParallelWorld<M>, BasicWorld<M>>;

 public:
  WorldOf(const WorldOptions& options, bool record, Listener listener) requires(!divided)
      : teller_(std::move(listener), options.report_pieces),
        recording_(record, options, teller_),
        world_(recorded(options, record), recording_.listener()) {}
  WorldOf(const WorldOptions& options, const ParallelOptions& parallel, Listener listener) requires(divided)
      : teller_(std::move(listener)), world_(options, parallel, &teller_) {}

  BodyId add_body(const Description& body) override { return added(whole().add_body(narrowed<M>(body))); }
  BodyId add_body(const kds::io::SceneBody& body) override {
    return added(whole().add_body(kds::io::describe<M>(body)));
  }
  void reserve(std::size_t bodies) override { whole().reserve(bodies); }
  void remove_body(BodyId id) override {
    whole().remove_body(id);
    look(id);
  }

  void update_motions(const std::vector<BodyId>& ids, const std::vector<Motion>& pieces) override {
    BasicWorld<M>& world = whole();
    for (const BodyId id : ids) (void)world.mass(id);  // throws if it is not there
    const std::vector<M> own = narrowed_scripts<M>(ids, pieces);
    const std::size_t each = own.size() / std::max<std::size_t>(ids.size(), 1);
    if constexpr (turns<M>) {
      for (std::size_t i = 0; i < own.size(); ++i) {
        const BodyId id = ids[i / each];
        require_no_spin(world.shape(id).shape, own[i], "motion of body " + std::to_string(id));
      }
    }
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (each == 1) {
        world.update_motion(ids[i], own[i]);
      } else {
        world.update_motion(ids[i], std::span(own).subspan(each * i, each));
      }
      look(ids[i]);
    }
  }
  void append_motion(BodyId id, const std::vector<Motion>& pieces) override {
    std::vector<M> own;
    for (const Motion& piece : pieces) own.push_back(narrowed<M>(piece, "motion[" + std::to_string(own.size()) + "]"));
    whole().append_motion(id, own);
  }
  void update_vertices(BodyId id, std::vector<MeshKeyframe> keyframes) override {
    whole().update_vertices(id, std::move(keyframes));
  }

  void set_masses(const std::vector<BodyId>& ids, const double* masses) override {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (whole().fixed(ids[i])) {
        throw std::invalid_argument("set_mass: body " + std::to_string(ids[i]) + " is fixed, and no mass counts");
      }
      require_size(masses[i], ("mass of body " + std::to_string(ids[i])).c_str());
    }
    for (std::size_t i = 0; i < ids.size(); ++i) whole().set_mass(ids[i], masses[i]);
  }
  void set_restitutions(const std::vector<BodyId>& ids, const double* restitutions) override {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      (void)whole().restitution(ids[i]);  // throws if it is not there
      if (!(restitutions[i] >= 0 && restitutions[i] <= 1)) {
        throw std::invalid_argument("restitution of body " + std::to_string(ids[i]) + ": must be in [0, 1]");
      }
    }
    for (std::size_t i = 0; i < ids.size(); ++i) whole().set_restitution(ids[i], restitutions[i]);
  }
  void set_filters(const std::vector<BodyId>& ids, const BodyMasks* masks) override {
    for (const BodyId id : ids) (void)whole().category(id);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      whole().set_filter(ids[i], masks[i][0], masks[i][1]);
      whole().set_group(ids[i], masks[i][2]);
    }
  }
  void set_user_data(const std::vector<BodyId>& ids, const std::uint64_t* user_data) override {
    for (const BodyId id : ids) (void)whole().user_data(id);
    for (std::size_t i = 0; i < ids.size(); ++i) whole().set_user_data(ids[i], user_data[i]);
  }
  TimerId set_timer(double t) override { return whole().set_timer(t); }
  bool cancel_timer(TimerId timer) override { return whole().cancel_timer(timer); }

  bool step(double limit) override {
    if constexpr (!divided) return world_.step(limit);
    throw std::logic_error("step: a world in domains goes by advance_to()");
  }
  bool advance_for(double budget_seconds, double t) override {
    if constexpr (!divided) return world_.advance_for(budget_seconds, t);
    if constexpr (divided) {
      const auto budget = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(budget_seconds));
      teller_.time_up = Clock::now() + budget;
      try {
        world_.advance_to(t);
      } catch (const OutOfTime&) {
        return false;
      }
    }
    return true;
  }
  double next_time() const override { return whole().next_time(); }

  double now() const override { return world_.now(); }
  std::size_t size() const override { return world_.size(); }
  bool contains(BodyId id) const override { return whole().contains(id); }
  Motion motion_now(BodyId id) const override { return now_of(whole().motion(id), id); }
  Motion free_motion_now(BodyId id) const override { return now_of(whole().free_motion(id), id); }
  Shape shape(BodyId id) const override { return whole().shape(id).shape; }
  std::vector<Eigen::Vector3d> vertices(BodyId id) const override {
    const Shape shape = whole().shape(id).shape;
    if (!bends(shape)) {
      throw std::invalid_argument("vertices: body " + std::to_string(id) + " is no mesh that bends");
    }
    const MeshScript& script = *script_of(shape);
    std::vector<Eigen::Vector3d> positions(script.vertices());
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = script.position(i, now());
    return positions;
  }
  FreeTurning free_turning(BodyId id) const override {
    if constexpr (turns<M>) return whole().free_turning(id);
    if constexpr (!turns<M>) throw std::invalid_argument("free_turning: in this world bodies do not turn");
  }
  double mass(BodyId id) const override { return whole().mass(id); }
  bool fixed(BodyId id) const override { return whole().fixed(id); }
  bool sensor(BodyId id) const override { return whole().sensor(id); }
  std::optional<BodyId> attached_to(BodyId id) const override { return whole().attached_to(id); }
  double restitution(BodyId id) const override { return whole().restitution(id); }
  BodyMasks masks(BodyId id) const override {
    return {whole().category(id), whole().collides_with(id), whole().group(id)};
  }
  void ignore_pair(BodyId a, BodyId b, bool ignored) override { whole().ignore_pair(a, b, ignored); }
  bool ignores_pair(BodyId a, BodyId b) const override { return whole().ignores_pair(a, b); }
  std::uint64_t user_data(BodyId id) const override { return whole().user_data(id); }
  std::vector<BodyId> partners(BodyId id) const override {
    std::vector<BodyId> found;
    whole().visit_partners(id, [&found](BodyId other) { found.push_back(other); });
    return found;
  }
  bool touching(BodyId a, BodyId b) const override { return whole().touching(a, b); }
  bool resting(BodyId a, BodyId b) const override { return whole().resting(a, b); }
  bool resting_at_wall(BodyId a, int wall) const override { return whole().resting_at_wall(a, wall); }
  WorldCounters counters() const override {
    if constexpr (divided) return world_.work();
    if constexpr (!divided) return world_.counters();
  }
  std::string_view broad_phase() const override { return world_.broad_phase(); }
  Profile profile() const override { return whole().work_profile(); }
  void audit() const override { whole().audit(); }
  kds::Snapshot save() override { return kds::save(world_); }
  void restore(const kds::Snapshot& snapshot) override {
    kds::restore(snapshot, world_);
    attached_ = true;  // or so it may be
    recording_.start_again(whole());
  }

  void write_replay(const std::string& file, const std::string& title) override {
    recording_.write_replay(whole(), file, title);
  }
  void write_gltf(const std::string& file, const std::string& title, double frames_per_second) override {
    recording_.write_gltf(whole(), file, title, frames_per_second);
  }
  void write_vtk(const std::string& file, double frames_per_second) override {
    recording_.write_vtk(whole(), file, frames_per_second);
  }

  std::vector<BodyId> bodies() const override {
    std::vector<BodyId> ids;
    whole().visit_bodies([&ids](BodyId id) { ids.push_back(id); });
    return ids;
  }
  std::vector<BodyId> in_box(const Eigen::Vector3d& min, const Eigen::Vector3d& max) const override {
    std::vector<BodyId> ids;
    whole().visit_overlapping(min, max, [&ids](BodyId id) { ids.push_back(id); });
    return ids;
  }
  std::vector<BodyId> in_moving_box(const Motion& motion, const Eigen::Vector3d& extent, double until) const override {
    KineticBox<M::degree> box;
    box.min = box.max = path_of(narrowed<M>(motion, "motion"));
    box.max.coefficients[0] += extent;
    std::vector<BodyId> ids;
    whole().visit_swept(box, until, [&ids](BodyId id) { ids.push_back(id); });
    return ids;
  }
  std::vector<Hit> cast(const std::optional<PlacedShape>& shape, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        bool all, const Filter& filter) const override {
    const Ray ray{from, to};
    if (all) return shape ? cast_all(whole(), *shape, ray, filter) : cast_all(whole(), ray, filter);
    const auto hit =
        shape ? kds::collision::cast(whole(), *shape, ray, filter) : kds::collision::cast(whole(), ray, filter);
    return hit ? std::vector<Hit>{*hit} : std::vector<Hit>{};
  }
  std::vector<BodyId> overlapping(const PlacedShape& shape, const Eigen::Vector3d& at,
                                  const Filter& filter) const override {
    return kds::collision::overlapping(whole(), shape, at, filter);
  }
  std::vector<NearBody> nearest(const std::optional<PlacedShape>& shape, const Eigen::Vector3d& to, std::size_t count,
                                const Filter& filter) const override {
    return shape ? kds::collision::nearest(whole(), *shape, to, count, filter)
                 : kds::collision::nearest(whole(), to, count, filter);
  }
  ShapeDistance distance_between(BodyId a, BodyId b) const override {
    return kds::collision::distance_between(whole(), a, b);
  }
  std::optional<Hit> next_contact(const Shape& shape, const Motion& motion, double until,
                                  const Filter& filter) const override {
    return kds::collision::next_contact(whole(), placed(shape, motion), narrowed<M>(motion, "motion"), until, filter);
  }
  std::vector<Hit> next_contacts(const Shape& shape, const Motion& motion, double until,
                                 const Filter& filter) const override {
    return kds::collision::next_contacts(whole(), placed(shape, motion), narrowed<M>(motion, "motion"), until, filter);
  }
  std::optional<Hit> next_contact_of(BodyId body, double until, const Filter& filter, ContactMode mode) const override {
    return kds::collision::next_contact_of(whole(), body, until, filter, mode);
  }
  std::vector<Hit> next_contacts_of(BodyId body, double until, const Filter& filter, ContactMode mode) const override {
    return kds::collision::next_contacts_of(whole(), body, until, filter, mode);
  }
  std::optional<Contact> next_contact_between(BodyId a, BodyId b, double until, ContactMode mode) const override {
    return kds::collision::next_contact_between(whole(), a, b, until, mode);
  }
  Approach closest_approach(BodyId a, BodyId b, double until) const override {
    return kds::collision::closest_approach(whole(), a, b, until);
  }
  std::vector<BodyPair> contact_pairs() const override { return kds::collision::contact_pairs(whole()); }
  std::vector<NearPair> pairs_nearer_than(double distance, double until, const Filter& filter) const override {
    return kds::collision::pairs_nearer_than(whole(), distance, until, filter);
  }

 private:
  /// For all but running.
  BasicWorld<M>& whole() const {
    if constexpr (divided) return world_.whole();
    if constexpr (!divided) return world_;
  }

  BodyId added(BodyId id) {
    attached_ = attached_ || whole().attached_to(id);
    recording_.look(whole(), id);
    return id;
  }
  /// What is attached to a body changes with it.
  void look(BodyId id) {
    if (attached_) {
      recording_.look(whole());
    } else {
      recording_.look(whole(), id);
    }
  }

  static PlacedShape placed(const Shape& shape, const Motion& motion) {
    return place(shape, turns<M> ? Eigen::Quaterniond::Identity() : motion.orientation);
  }

  /// Of a body that is to enter later the motion is that of its start.
  Motion now_of(const M& motion, BodyId id) const {
    Motion wide = motion_as<Motion>(path_of(motion).start < now() ? motion.restarted(now()) : motion);
    if constexpr (!turns<M>) wide.orientation = Eigen::Quaterniond(whole().shape(id).rotation);
    return wide;
  }

  std::conditional_t<divided, TellerOfDomains, Teller<M>> teller_;
  Recording<kds::io::WorldRecorder<M>> recording_;
  bool attached_ = false;  ///< whether a sensor may be attached to a body
  mutable World world_;    ///< one that is divided is made whole to be asked
};

}  // namespace

std::unique_ptr<AnyWorld> make_world(const WorldType& type, const WorldOptions& options, AnyWorld::Listener listener) {
  using kds::certificates::PointMotion;
  using kds::certificates::RigidMotion;
  const int degree = type.degree;
  const auto make = [&]<class M>(M) -> std::unique_ptr<AnyWorld> {
    if (!type.divided()) return std::make_unique<WorldOf<M>>(options, type.record, std::move(listener));
    const ParallelOptions parallel{.threads = options.threads, .domains = type.domains};
    return std::make_unique<WorldOf<M, true>>(options, parallel, std::move(listener));
  };
  const auto refuse = [degree](const std::string& most) {
    return std::invalid_argument("degree: must be 1 (lines)" + most + ", not " + std::to_string(degree));
  };
  if (type.divided() && type.record) throw std::invalid_argument("record: must be False in a world in domains");
  if (type.turning) {
    if (degree != 1 && degree != 2) throw refuse(" or 2 (parabolas) where bodies turn");
    return degree == 1 ? make(RigidMotion<1>{}) : make(RigidMotion<2>{});
  }
  switch (degree) {
    case 1:
      return make(PointMotion<1>{});
    case 2:
      return make(PointMotion<2>{});
    case 3:
      return make(PointMotion<3>{});
    case 4:
      return make(PointMotion<4>{});
    case 5:
      return make(PointMotion<5>{});
    default:
      throw refuse(", 2 (parabolas), or up to 5 (splines)");
  }
}

}  // namespace kds_python
