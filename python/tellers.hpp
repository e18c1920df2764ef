// Listeners of worlds of all types, which hand on their events as rows.
#pragma once

#include "collision/parallel/parallel_world.hpp"
#include "collision/world.hpp"
#include "io/events.hpp"
#include "python/any_world.hpp"
#include "python/rows.hpp"

#include <chrono>
#include <cstdint>
#include <utility>

namespace kds_python {

using Clock = std::chrono::steady_clock;
using kds::collision::BasicWorld;
using kds::collision::BasicWorldListener;
using kds::collision::Contact;
using kds::collision::PairEvent;
using kds::collision::ParallelListener;
using kds::collision::TimerId;
using kds::collision::WallEvent;
using kds::collision::WorldOptions;
using kds::io::EventKind;

/// Hands on events as rows.
class Rows {
 public:
  explicit Rows(AnyWorld::Listener listener) : listener_(std::move(listener)) {}

 protected:
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

 private:
  /// As in the files of the tool, point and normal are zero.
  static Contact nowhere(double t) {
    Contact contact;
    contact.time = t;
    contact.normal = Eigen::Vector3d::Zero();
    return contact;
  }

  AnyWorld::Listener listener_;
};

/// Of a world of some motion. Pieces are told of where they are asked for: what is recorded needs them.
template <class M>
class Teller final : public BasicWorldListener<M>, private Rows {
 public:
  Teller(AnyWorld::Listener listener, bool pieces) : Rows(std::move(listener)), pieces_(pieces) {}

  void contact(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::contact, e); }
  void separation(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::separation, e); }
  void overlap(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::overlap, e); }
  void wall(BasicWorld<M>&, const WallEvent& e) override { tell(EventKind::wall, e); }
  void rests(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::rest, e); }
  void wakes(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::wake, e); }
  void rests_at_wall(BasicWorld<M>&, const WallEvent& e) override { tell(EventKind::rest_at_wall, e); }
  void wakes_at_wall(BasicWorld<M>&, const WallEvent& e) override { tell(EventKind::wake_at_wall, e); }
  void passes(BasicWorld<M>&, const PairEvent& e) override { tell(EventKind::pass, e); }
  void piece(BasicWorld<M>& world, BodyId body) override {
    if (pieces_) tell(piece_kind, body, world.now(), world.user_data(body));
  }
  void timer(BasicWorld<M>& world, TimerId timer) override { tell(timer_kind, timer, world.now(), 0); }
  void pair_began(BasicWorld<M>&, BodyId a, BodyId b, double t) override { tell(EventKind::pair_begin, a, b, t); }
  void pair_ended(BasicWorld<M>&, BodyId a, BodyId b, double t) override { tell(EventKind::pair_end, a, b, t); }

 private:
  bool pieces_;
};

/// Of a world that records, which has to be told of pieces.
inline WorldOptions recorded(WorldOptions options, bool record) {
  options.report_pieces = options.report_pieces || record;
  return options;
}

struct OutOfTime {};

/// Of a world in domains, which has no advance_for(): throws OutOfTime after an event, when its time is up.
class TellerOfDomains final : public ParallelListener, private Rows {
 public:
  using Rows::Rows;

  Clock::time_point time_up = Clock::time_point::max();

  void contact(const PairEvent& e) override { hand_on(EventKind::contact, e); }
  void separation(const PairEvent& e) override { hand_on(EventKind::separation, e); }
  void overlap(const PairEvent& e) override { hand_on(EventKind::overlap, e); }
  void wall(const WallEvent& e) override { hand_on(EventKind::wall, e); }
  void rests(const PairEvent& e) override { hand_on(EventKind::rest, e); }
  void wakes(const PairEvent& e) override { hand_on(EventKind::wake, e); }
  void rests_at_wall(const WallEvent& e) override { hand_on(EventKind::rest_at_wall, e); }
  void wakes_at_wall(const WallEvent& e) override { hand_on(EventKind::wake_at_wall, e); }
  void passes(const PairEvent& e) override { hand_on(EventKind::pass, e); }
  void timer(TimerId timer, double time) override { hand_on(timer_kind, timer, time, 0); }

 private:
  void hand_on(const auto&... event) {
    tell(event...);
    if (Clock::now() >= time_up) throw OutOfTime{};
  }
};

}  // namespace kds_python
