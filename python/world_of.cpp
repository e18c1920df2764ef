#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/world.hpp"
#include "collision/world/checked_pieces.hpp"
#include "io/events.hpp"
#include "io/scene_world.hpp"
#include "python/any_world.hpp"

#include <stdexcept>
#include <utility>

namespace kds_python {
namespace {

using namespace kds::collision;
using kds::io::EventKind;

/// Hands on what a world of some motion reports.
template <class M>
class Teller final : public BasicWorldListener<M> {
 public:
  explicit Teller(AnyWorld::Listener listener) : listener_(std::move(listener)) {}

  void contact(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::contact, e); }
  void separation(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::separation, e); }
  void overlap(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::overlap, e); }
  void wall(BasicWorld<M>&, const WallEvent& e) override { tell(EventKind::wall, e); }
  void rests(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::rest, e); }
  void wakes(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::wake, e); }
  void rests_at_wall(BasicWorld<M>&, const WallEvent& e) override { tell(EventKind::rest_at_wall, e); }
  void wakes_at_wall(BasicWorld<M>&, const WallEvent& e) override { tell(EventKind::wake_at_wall, e); }
  void passes(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::pass, e); }
  void piece(BasicWorld<M>& world, BodyId body) override { tell(piece_kind, body, world.now(), world.user_data(body)); }
  void timer(BasicWorld<M>& world, TimerId timer) override { tell(timer_kind, timer, world.now(), 0); }
  void pair_began(BasicWorld<M>&, BodyId a, BodyId b, double t) override { tell(EventKind::pair_begin, a, b, t); }
  void pair_ended(BasicWorld<M>&, BodyId a, BodyId b, double t) override { tell(EventKind::pair_end, a, b, t); }

 private:
  void tell(EventKind kind, const PairEvent& e) {
    listener_(to_row(static_cast<std::int64_t>(kind), e.a, e.b, e.contact, e.user_data_a, e.user_data_b));
  }
  void tell(EventKind kind, const WallEvent& e) {
    const auto wall = static_cast<std::uint64_t>(e.wall);
    listener_(to_row(static_cast<std::int64_t>(kind), e.body, wall, e.contact, e.user_data));
  }
  void tell(EventKind kind, BodyId a, BodyId b, double t) {
    listener_(to_row(static_cast<std::int64_t>(kind), a, b, nowhere(t)));
  }
  void tell(std::int64_t kind, std::uint64_t of, double t, std::uint64_t user_data) {
    listener_(to_row(kind, of, of, nowhere(t), user_data, user_data));
  }
  /// As in the files of the tool, point and normal are zero.
  static Contact nowhere(double t) {
    Contact contact;
    contact.time = t;
    contact.normal = Eigen::Vector3d::Zero();
    return contact;
  }

  AnyWorld::Listener listener_;
};

/// A motion of a world of this type; throws where something would be lost.
template <class M>
M narrowed(const Motion& motion, const std::string& name) {
  if (M::degree < 2 && !motion.path.coefficients[2].isZero(0)) {
    throw std::invalid_argument(name + ".acceleration: must be 0 in a world of degree 1");
  }
  if (!turns<M> && !motion.angular_velocity.isZero(0)) {
    throw std::invalid_argument(name + ".angular_velocity: must be 0 in a world that is not turning");
  }
  return kds::io::to_motion<M>(motion);
}

template <class M>
class WorldOf final : public AnyWorld {
 public:
  WorldOf(const WorldOptions& options, Listener listener) : teller_(std::move(listener)), world_(options, &teller_) {}

  BodyId add_body(const Description& body) override {
    BasicBodyDescription<M> own;
    own.shape = body.shape;
    own.motion = narrowed_script(body.motion);
    if constexpr (!turns<M>) {
      if (!body.motion.empty()) own.orientation = body.motion.front().orientation;
    }
    own.mass = body.mass;
    own.inertia = body.inertia;
    own.fixed = body.fixed;
    own.restitution = body.restitution;
    own.friction = body.friction;
    own.tangential_restitution = body.tangential_restitution;
    own.rolling_friction = body.rolling_friction;
    own.category = body.category;
    own.collides_with = body.collides_with;
    own.group = body.group;
    own.attached_to = body.attached_to;
    own.sensor = body.sensor;
    own.user_data = body.user_data;
    return world_.add_body(own);
  }
  BodyId add_body(const kds::io::SceneBody& body) override { return world_.add_body(kds::io::describe<M>(body)); }
  void reserve(std::size_t bodies) override { world_.reserve(bodies); }
  void remove_body(BodyId id) override { world_.remove_body(id); }

  void update_motions(const std::vector<BodyId>& ids, const std::vector<Motion>& motions) override {
    std::vector<M> own;
    own.reserve(motions.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const std::string name = "motion of body " + std::to_string(ids[i]);
      (void)world_.mass(ids[i]);  // throws if it is not there
      own.push_back(narrowed<M>(motions[i], name));
      if (!in_range(own.back())) refuse_motion(own.back(), name);
      if constexpr (turns<M>) require_no_spin_of_half_space(world_.shape(ids[i]).shape, own.back(), name);
    }
    for (std::size_t i = 0; i < ids.size(); ++i) world_.update_motion(ids[i], own[i]);
  }

  void update_motion(BodyId id, const std::vector<Motion>& pieces) override {
    world_.update_motion(id, narrowed_script(pieces));
  }
  void append_motion(BodyId id, const std::vector<Motion>& pieces) override {
    std::vector<M> own;
    for (const Motion& piece : pieces) own.push_back(narrowed<M>(piece, "motion[" + std::to_string(own.size()) + "]"));
    world_.append_motion(id, own);
  }

  void set_masses(const std::vector<BodyId>& ids, const double* masses) override {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (world_.fixed(ids[i])) {
        throw std::invalid_argument("set_mass: body " + std::to_string(ids[i]) + " is fixed, and no mass counts");
      }
      require_size(masses[i], ("mass of body " + std::to_string(ids[i])).c_str());
    }
    for (std::size_t i = 0; i < ids.size(); ++i) world_.set_mass(ids[i], masses[i]);
  }
  void set_restitutions(const std::vector<BodyId>& ids, const double* restitutions) override {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      (void)world_.restitution(ids[i]);  // throws if it is not there
      if (!(restitutions[i] >= 0 && restitutions[i] <= 1)) {
        throw std::invalid_argument("restitution of body " + std::to_string(ids[i]) + ": must be in [0, 1]");
      }
    }
    for (std::size_t i = 0; i < ids.size(); ++i) world_.set_restitution(ids[i], restitutions[i]);
  }
  void set_filters(const std::vector<BodyId>& ids, const BodyMasks* masks) override {
    for (const BodyId id : ids) (void)world_.category(id);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      world_.set_filter(ids[i], masks[i][0], masks[i][1]);
      world_.set_group(ids[i], masks[i][2]);
    }
  }
  void set_user_data(const std::vector<BodyId>& ids, const std::uint64_t* user_data) override {
    for (const BodyId id : ids) (void)world_.user_data(id);
    for (std::size_t i = 0; i < ids.size(); ++i) world_.set_user_data(ids[i], user_data[i]);
  }
  TimerId set_timer(double t) override { return world_.set_timer(t); }
  bool cancel_timer(TimerId timer) override { return world_.cancel_timer(timer); }

  void advance_to(double t) override { world_.advance_to(t); }
  bool step(double limit) override { return world_.step(limit); }
  bool advance_for(double budget_seconds, double t) override { return world_.advance_for(budget_seconds, t); }
  double next_time() const override { return world_.next_time(); }

  double now() const override { return world_.now(); }
  std::size_t size() const override { return world_.size(); }
  bool contains(BodyId id) const override { return world_.contains(id); }
  Motion motion_now(BodyId id) const override { return widened(world_.motion(id), id); }
  Motion free_motion_now(BodyId id) const override { return widened(world_.free_motion(id), id); }
  Shape shape(BodyId id) const override { return world_.shape(id).shape; }
  double mass(BodyId id) const override { return world_.mass(id); }
  bool fixed(BodyId id) const override { return world_.fixed(id); }
  bool sensor(BodyId id) const override { return world_.sensor(id); }
  double restitution(BodyId id) const override { return world_.restitution(id); }
  BodyMasks masks(BodyId id) const override {
    return {world_.category(id), world_.collides_with(id), world_.group(id)};
  }
  void ignore_pair(BodyId a, BodyId b, bool ignored) override { world_.ignore_pair(a, b, ignored); }
  bool ignores_pair(BodyId a, BodyId b) const override { return world_.ignores_pair(a, b); }
  std::uint64_t user_data(BodyId id) const override { return world_.user_data(id); }
  std::vector<BodyId> partners(BodyId id) const override {
    std::vector<BodyId> found;
    world_.visit_partners(id, [&found](BodyId other) { found.push_back(other); });
    return found;
  }
  bool touching(BodyId a, BodyId b) const override { return world_.touching(a, b); }
  bool resting(BodyId a, BodyId b) const override { return world_.resting(a, b); }
  bool resting_at_wall(BodyId a, int wall) const override { return world_.resting_at_wall(a, wall); }
  WorldCounters counters() const override { return world_.counters(); }
  std::string_view broad_phase() const override { return world_.broad_phase(); }
  void audit() const override { world_.audit(); }
  kds::Snapshot save() override { return kds::save(world_); }
  void restore(const kds::Snapshot& snapshot) override { kds::restore(snapshot, world_); }

  std::vector<BodyId> in_box(const Eigen::Vector3d& min, const Eigen::Vector3d& max) const override {
    std::vector<BodyId> ids;
    world_.visit_overlapping(min, max, [&ids](BodyId id) { ids.push_back(id); });
    return ids;
  }
  std::vector<Hit> cast(const std::optional<PlacedShape>& shape, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        bool all, const Filter& filter) const override {
    const Ray ray{from, to};
    if (all) return shape ? cast_all(world_, *shape, ray, filter) : cast_all(world_, ray, filter);
    const auto hit =
        shape ? kds::collision::cast(world_, *shape, ray, filter) : kds::collision::cast(world_, ray, filter);
    return hit ? std::vector<Hit>{*hit} : std::vector<Hit>{};
  }
  std::vector<BodyId> overlapping(const PlacedShape& shape, const Eigen::Vector3d& at,
                                  const Filter& filter) const override {
    return kds::collision::overlapping(world_, shape, at, filter);
  }
  std::vector<NearBody> nearest(const std::optional<PlacedShape>& shape, const Eigen::Vector3d& to, std::size_t count,
                                const Filter& filter) const override {
    return shape ? kds::collision::nearest(world_, *shape, to, count, filter)
                 : kds::collision::nearest(world_, to, count, filter);
  }
  ShapeDistance distance_between(BodyId a, BodyId b) const override {
    return kds::collision::distance_between(world_, a, b);
  }
  std::optional<Hit> next_contact(const Shape& shape, const Motion& motion, double until,
                                  const Filter& filter) const override {
    const M own = narrowed<M>(motion, "motion");
    const PlacedShape placed = place(shape, turns<M> ? Eigen::Quaterniond::Identity() : motion.orientation);
    return kds::collision::next_contact(world_, placed, own, until, filter);
  }
  std::optional<Hit> next_contact_of(BodyId body, double until, const Filter& filter) const override {
    return kds::collision::next_contact_of(world_, body, until, filter);
  }
  std::optional<Contact> next_contact_between(BodyId a, BodyId b, double until) const override {
    return kds::collision::next_contact_between(world_, a, b, until);
  }
  Approach closest_approach(BodyId a, BodyId b, double until) const override {
    return kds::collision::closest_approach(world_, a, b, until);
  }

 private:
  /// A motion, and those that add_body() and update_motion() in Python name `then`.
  static std::vector<M> narrowed_script(const std::vector<Motion>& pieces) {
    std::vector<M> own;
    own.reserve(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const std::string name = i == 0 ? "motion" : "then[" + std::to_string(i - 1) + "]";
      own.push_back(narrowed<M>(pieces[i], name));
      if (!in_range(own.back())) refuse_motion(own.back(), name);
    }
    return own;
  }

  /// Of a body that is to enter later the motion is that of its start.
  Motion widened(const M& motion, BodyId id) const {
    Motion wide = kds::io::to_piece(motion);
    if constexpr (!turns<M>) wide.orientation = Eigen::Quaterniond(world_.shape(id).rotation);
    return wide.start() < world_.now() ? wide.restarted(world_.now()) : wide;
  }

  Teller<M> teller_;
  BasicWorld<M> world_;
};

}  // namespace

std::unique_ptr<AnyWorld> make_world(int degree, bool turning, const WorldOptions& options,
                                     AnyWorld::Listener listener) {
  using kds::certificates::PointMotion;
  using kds::certificates::RigidMotion;
  if (degree != 1 && degree != 2) {
    throw std::invalid_argument("degree: must be 1 (lines) or 2 (parabolas), not " + std::to_string(degree));
  }
  const auto make = [&]<class M>(M) -> std::unique_ptr<AnyWorld> {
    return std::make_unique<WorldOf<M>>(options, std::move(listener));
  };
  if (turning) return degree == 1 ? make(RigidMotion<1>{}) : make(RigidMotion<2>{});
  return degree == 1 ? make(PointMotion<1>{}) : make(PointMotion<2>{});
}

}  // namespace kds_python
