// What a scenario does to the world, from outside and from callbacks.
#include "tests/fuzz/random_worlds/player.hpp"

#include "kds/audit.hpp"
#include "kds/framework/snapshot.hpp"

#include <exception>
#include <stdexcept>

namespace kds::fuzz {

template <int Degree>
void Player<Degree>::call_from_outside(const Call& call) {
  if (call.kind == Call::Kind::advance) return advance(call.seconds);
  try {
    this->call(call, nullptr);
  } catch (const std::exception& error) {
    note_thrown(error.what());
  }
}

/// `contact`: of the event, in a callback. What a call needs that is not there makes it do nothing.
template <int Degree>
void Player<Degree>::call(const Call& call, const Contact* contact) {
  World& world = *world_;
  const BodyId id = id_of(call.body);
  const bool moves = this->moves(call.body);
  switch (call.kind) {
    case Call::Kind::add:
      return add(call.body);
    case Call::Kind::remove:
      if (id == gone) return;
      world.remove_body(id);
      for (BodyId& other : ids_) {
        if (other != gone && !world.contains(other)) other = gone;  // and the sensors that were attached to it
      }
      return;
    case Call::Kind::move:
      if (moves) world.update_motion(id, motion(call.path));
      return;
    case Call::Kind::turn_back:
      if (!moves || world.motion(id).start > world.now()) return;
      {
        Motion back = world.free_motion(id).restarted(world.now());
        back.coefficients[1] = -back.coefficients[1];
        world.update_motion(id, back);
      }
      return;
    case Call::Kind::keep:
    case Call::Kind::away_and_back:
      if (!moves || world.motion(id).start > world.now()) return;
      {
        const Motion kept = world.motion(id);
        if (call.kind == Call::Kind::away_and_back) world.update_motion(id, motion(call.path));
        world.update_motion(id, kept);
      }
      return;
    case Call::Kind::follow: {
      const BodyId other = id_of(call.other);
      if (!moves || other == gone || world.motion(other).start > world.now()) return;
      const Motion same = world.motion(other);
      world.update_motion(id, same);
      return;
    }
    case Call::Kind::filter:
      if (id != gone) world.set_filter(id, call.category, call.collides_with);
      return;
    case Call::Kind::group:
      if (id != gone) world.set_group(id, call.category);
      return;
    case Call::Kind::ignore: {
      const BodyId other = id_of(call.other);
      if (id != gone && other != gone && id != other) world.ignore_pair(id, other, ~call.collides_with != 0);
      return;
    }
    case Call::Kind::attach:
      return add(call.body, call.other);
    case Call::Kind::weigh:
      if (id != gone && !world.fixed(id)) world.set_mass(id, call.mass);
      return;
    case Call::Kind::append:
      if (moves) append(id, call);
      return;
    case Call::Kind::ring:
      world.set_timer(world.now() + call.seconds);
      return;
    case Call::Kind::push_off:
      if (!contact) return;
      push_off(call.body, -contact->normal);
      if (call.other != call.body) push_off(call.other, contact->normal);
      return;
    case Call::Kind::advance:
    case Call::Kind::save:
      if (contact) must_be_refused(call);
      return;
    case Call::Kind::fail:
      if (contact) throw std::runtime_error("a callback throws");
      return;
  }
}

template <int Degree>
void Player<Degree>::add(std::size_t body, std::optional<std::size_t> owner) {
  if (world_->size() >= scenario_.most_alive) return;
  collision::BodyDescription<Degree> added = description(bodies_[body]);
  if (owner) {
    const BodyId its = id_of(*owner);
    if (its == gone || world_->attached_to(its)) return;
    added.attached_to = its, added.sensor = true, added.motion = {};
  }
  const BodyId id = world_->add_body(added);
  if (ids_.size() <= body) ids_.resize(body + 1, gone);
  ids_[body] = id;
  numbers_[id] = body;
}

template <int Degree>
void Player<Degree>::push_off(std::size_t body, const Vector3d& normal) {
  if (!moves(body)) return;
  const BodyId id = id_of(body);
  Motion away = world_->free_motion(id).restarted(world_->now());
  away.coefficients[1] = scenario_.unit * normal;
  world_->update_motion(id, away);
}

template <int Degree>
void Player<Degree>::append(BodyId id, const Call& call) {
  Path path = call.path;
  path.start = call.seconds;
  const Motion piece = motion(path);
  try {
    world_->append_motion(id, {&piece, 1});
  } catch (const std::invalid_argument&) {  // the script goes on until later
  }
}

template <int Degree>
void Player<Degree>::must_be_refused(const Call& call) {
  try {
    if (call.kind == Call::Kind::save) {
      (void)kds::save(*world_);
    } else {
      world_->advance_to(world_->now() + call.seconds);
    }
  } catch (const std::logic_error&) {
    return;
  }
  note_accepted();
}

template <int Degree>
void Player<Degree>::edit_in_box_function() {
  const auto refused = [](const auto& edit) {
    try {
      edit();
    } catch (const std::logic_error&) {
      return true;
    }
    return false;
  };
  const bool all = refused([&] { world_->remove_body(0); }) && refused([&] { world_->step(world_->now()); }) &&
                   refused([&] { world_->update_motion(0, motion({})); }) &&
                   refused([&] { world_->add_body(description({})); });
  if (!all) note_accepted();
}

template <int Degree>
void Player<Degree>::advance(double seconds) {
  const double from = world_->now();
  bool goes_on = true;
  for (int part = 1; part <= way_.stops && goes_on && !given_up(); ++part) {
    goes_on = step_up_to(from + seconds * part / (way_.stops + 1));
  }
  if (goes_on) step_up_to(from + seconds);
  if (!given_up()) note_state();
}

/// False if something was thrown: then the clock stands still.
template <int Degree>
bool Player<Degree>::step_up_to(double limit) {
  try {
    while (!given_up() && (way_.budgets ? !world_->advance_for(0, limit) : world_->step(limit))) {
      ++steps_;
      if (way_.audits) world_->audit();
      if (way_.save_every != 0 && steps_ % way_.save_every == 0) save_and_load();
    }
    if (way_.audits && !given_up()) world_->audit();
    return true;
  } catch (const AuditFailure& failure) {
    stopped_ = true;
    note_thrown(failure.what());
  } catch (const std::exception& error) {
    note_thrown(error.what());
  }
  return false;
}

template class Player<1>;
template class Player<2>;

}  // namespace kds::fuzz
