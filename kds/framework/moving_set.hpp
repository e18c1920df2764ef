// The moving elements that several structures share; the structures are told of each change.
#pragma once

#include "kds/framework/wave.hpp"
#include "kds/member_named.hpp"
#include "kds/motion.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds {

/// Number of a moving element: a small integer chosen by the caller, or by MovingSet::add().
using Id = std::uint32_t;

template <class Rule>
class KineticOf;

/// No element.
inline constexpr Id nobody = std::numeric_limits<Id>::max();

/// Names one element and no other, though its id may be given to others when it has been removed: the id, and how many
/// elements of this id had been removed when it came.
struct ElementHandle {
  Id id = nobody;
  std::uint64_t generation = 0;

  friend bool operator==(const ElementHandle&, const ElementHandle&) = default;
};

namespace detail {
template <class E>
bool finite(const E& element) {
  if constexpr (requires { element.finite(); }) {
    return element.finite();
  } else {
    return is_finite(element);
  }
}
}  // namespace detail

/// A moving element: a Motion, a path in the plane or in space, a sampled position with a bound on its speed.
template <class E>
concept MovingElement = std::default_initializable<E> && std::copyable<E> && requires(const E& element) {
  { detail::finite(element) } -> std::convertible_to<bool>;
};

/// An element of which only samples are known, the last one at time `start`: Bounded, and types made of it.
template <class E>
concept Sampled = MovingElement<E> && requires(const E& element) {
  requires std::same_as<decltype(E::sampled), const bool>;
  requires E::sampled;
  { element.start } -> std::convertible_to<double>;
};

/// A sample that goes on moving, at the velocity that it had: BoundedAcceleration. The state is that of the samples as
/// they move, so certificates of samples fail, and are repaired, as those of polynomials are.
template <class E>
concept MovingSample = Sampled<E> && requires {
  requires std::same_as<decltype(E::moves), const bool>;
  requires E::moves;
};

namespace detail {
KDS_MEMBER_NAMED(NamesSampled, sampled);
KDS_MEMBER_NAMED(NamesMoves, moves);
}  // namespace detail

/// An element whose motion can be written in time that runs backwards, exactly: reversed(e)(-t) = e(t).
template <class E>
concept Reversible = MovingElement<E> && requires(const E& element) {
  { reversed(element) } -> std::convertible_to<E>;
};

/// Moving elements by id. Structures attach themselves, and are told of every edit.
///
/// An edit is made at a clock value, which is that of the simulator that runs the structures. Law: an edit comes after
/// the events of its time: every structure first processes what is due then (so that no structure is edited in an
/// invalid state), the edit is made, and every structure takes it up. A time before the last event or edit, or past an
/// event that has not been processed, is refused by the structures with std::logic_error before the elements are
/// changed; one that is not finite by the set with std::invalid_argument. Any other time is taken for the clock, and
/// not compared with it.
///
/// Cost: a virtual call a structure and edit; none for an event. Elements are stored by id, and so is most of what
/// structures know of them, so that memory is that of the greatest id: of the most elements at a time, if they come by
/// enter().
template <MovingElement E>
class MovingSet {
  static_assert(
      Sampled<E> || !detail::NamesSampled<E>,
      "moving element: `sampled` must be `static constexpr bool sampled = true`, and the element have a `start`");
  static_assert(MovingSample<E> || !detail::NamesMoves<E>,
                "moving element: `moves` must be `static constexpr bool moves = true`, of a sampled element");

 public:
  using Element = E;

  /// A structure that is told of edits. For each edit: process_due(), then one of the others, which must not throw.
  /// Structures that stand on others (StandsOn) take part after these, whether they are observers or not.
  class Observer {
   public:
    virtual void process_due(double now) = 0;                     ///< process what is due up to now, or throw
    virtual void inserted(Id id, double now) = 0;                 ///< the element is there
    virtual void removing(Id id, double now) = 0;                 ///< the element is still there
    virtual void changing(Id id, const E& next, double now) = 0;  ///< the element still moves as before
    virtual void changed(Id id, double now) = 0;                  ///< it has its new motion

   protected:
    ~Observer() = default;
  };

  MovingSet() = default;
  MovingSet(const MovingSet&) = delete;  ///< observers refer to it; see save() for a copy of its state
  MovingSet& operator=(const MovingSet&) = delete;

  bool contains(Id id) const { return id < present_.size() && present_[id]; }
  bool contains(const ElementHandle& handle) const {
    return contains(handle.id) && generation_[handle.id] == handle.generation;
  }
  std::size_t size() const { return size_; }
  /// All ids are below this.
  Id end_id() const { return static_cast<Id>(present_.size()); }
  /// Precondition: contains(id). The reference holds until the next insertion, and shows later motions.
  const Element& operator[](Id id) const { return elements_[id]; }

  /// The handle of the element that has an id now. Throws std::out_of_range if there is none.
  ElementHandle handle(Id id) const {
    require(id);
    return {id, generation_[id]};
  }
  /// The id of an element. Throws std::out_of_range if it has been removed, even if another has its id now.
  Id id(const ElementHandle& handle) const { return require(handle); }

  /// An id that is not in use: the last one that has become free, else end_id(). O(1) on average.
  Id free_id() {
    while (!free_.empty() && contains(free_.back())) {
      listed_[free_.back()] = 0;
      free_.pop_back();
    }
    return free_.empty() ? end_id() : free_.back();
  }

  /// The ids in use, ascending.
  std::vector<Id> ids() const {
    std::vector<Id> result;
    for (Id id = 0; id < end_id(); ++id) {
      if (present_[id]) result.push_back(id);
    }
    return result;
  }

  /// The first step of every edit: the structures process what is due up to now. Their listeners may edit the set then,
  /// so the edit that follows sees the set as they leave it.
  void process_due(double now) {
    if (!std::isfinite(now)) throw std::invalid_argument("MovingSet: the time of an edit must be finite");
    for (Observer* observer : observers_) observer->process_due(now);
  }

  /// Throws std::invalid_argument for an id that is used or reserved (`nobody`), even if only the listener of an event
  /// of this time has taken it, and for an element that is not finite.
  void insert(Id id, Element element, double now) {
    require_free(id);
    require_finite(id, element);
    process_due(now);
    put(id, std::move(element), now);
  }

  /// Inserts under free_id(), and returns a handle. With this in place of add(), a set (and the structures, which store
  /// by id and by slot too) needs the memory of the most elements at a time, and not of all that ever were; an id is
  /// then that of several elements, one after the other, and the handle tells them apart. Throws as insert() does.
  ElementHandle enter(Element element, double now) {
    require_finite(free_id(), element);
    process_due(now);
    const Id id = free_id();  // A listener may have taken the one before.
    put(id, std::move(element), now);
    return {id, generation_[id]};
  }

  /// Inserts under the first id above all that were ever used, and returns it: so an id is never that of two elements.
  /// Throws as insert() does.
  Id add(Element element, double now) {
    require_finite(end_id(), element);
    process_due(now);
    const Id id = end_id();
    put(id, std::move(element), now);
    return id;
  }

  /// Throws std::out_of_range for an id that is not used and for a handle whose element has been removed, even if only
  /// the listener of an event of this time has removed it.
  void remove(Id id, double now) { remove_named(id, now); }
  void remove(const ElementHandle& handle, double now) { remove_named(handle, now); }

  /// Gives an element another motion, continuously or with a jump. Throws as insert() and remove() do.
  void update(Id id, Element element, double now) { update_named(id, element, now); }
  void update(const ElementHandle& handle, Element element, double now) { update_named(handle, element, now); }

  /// Sets the source of new samples: sampler(id, now) gives an element sampled at now. Structures ask for one when the
  /// guarantee of a certificate ends, but not before a member's last one is `tick` seconds old: a certificate that may
  /// fail sooner than that is not guaranteed in between (with a tick of 0, two elements that meet would be sampled
  /// without end). Throws std::invalid_argument for a tick that is not > 0.
  void sample_with(std::function<Element(Id, double)> sampler, double tick) requires Sampled<Element> {
    if (!(tick > 0)) throw std::invalid_argument("MovingSet::sample_with: the tick must be > 0");
    sampler_ = std::move(sampler);
    tick_ = tick;
  }
  double tick() const { return tick_; }
  std::uint64_t samples() const { return samples_; }  ///< taken so far

  /// Samples an element, and tells the structures. Unlike other edits this one may come amidst the events of a time,
  /// unless samples move (MovingSample). Throws std::out_of_range for an id that is not used, std::logic_error if there
  /// is no sampler or its sample is of another time, std::invalid_argument for a sample that is not finite.
  void resample(Id id, double now) requires Sampled<Element> {
    if (!sampler_) throw std::logic_error("MovingSet: an element is to be sampled, but there is no sampler");
    require(id);
    process_due(now);
    require(id);
    const Element element = sampler_(id, now);
    if (element.start != now) throw std::logic_error("MovingSet: a sample must be of the time it is asked for");
    require_finite(id, element);
    ++samples_;
    replace(id, element, now);
  }

  /// Whether the motions are written in time that runs backwards. To be turned by reverse() in reverse.hpp only: the
  /// structures must be turned with them.
  bool backwards() const { return backwards_; }
  void turn_round() requires Reversible<E> {
    for (E& element : elements_) element = reversed(element);
    backwards_ = !backwards_;
  }

  /// Observers are told in the order in which they were attached. Not to be called from within an edit.
  void attach(Observer& observer) { observers_.push_back(&observer); }
  void detach(Observer& observer) { std::erase(observers_, &observer); }

  /// Saves or loads the elements; not the observers, the sampler and the tick. See save() in snapshot.hpp.
  template <class Archive>
  void archive(Archive& archive) {
    archive.tag("MovingSet");
    archive(elements_, present_, generation_, free_, size_, samples_, backwards_);
    if constexpr (Archive::loading) {
      archive.require(present_.size() == elements_.size(), "a set has not as many places as elements");
      archive.require(generation_.size() == elements_.size(), "a set has not as many generations as elements");
      std::size_t found = 0;
      for (std::size_t id = 0; id < present_.size(); ++id) {
        archive.require(present_[id] <= 1, "an element of a set is neither there nor not");
        if (present_[id] == 0) continue;
        archive.require(detail::finite(elements_[id]), "the motion of an element of a set is not finite");
        ++found;
      }
      archive.require(found == size_, "a set has not as many elements as it says");
      listed_.assign(present_.size(), 0);
      for (const Id id : free_) {
        archive.require(id < end_id(), "a free id of a set has never been used");
        archive.require(std::exchange(listed_[id], 1) == 0, "a free id of a set is listed twice");
      }
    }
  }

 private:
  template <class>
  friend class KineticOf;

  template <class Name>
  void remove_named(const Name& name, double now) {
    require(name);
    process_due(now);
    const Id id = require(name);  // A listener of an event that was due may have removed it.
    detail::Wave::Passage edit(wave_);
    for (Observer* observer : observers_) observer->removing(id, now);
    edit.end(now, false);
    present_[id] = 0;
    ++generation_[id];
    if (std::exchange(listed_[id], 1) == 0) free_.push_back(id);
    --size_;
  }

  template <class Name>
  void update_named(const Name& name, const Element& element, double now) {
    require_finite(require(name), element);
    process_due(now);
    replace(require(name), element, now);
  }

  void replace(Id id, const Element& element, double now) {
    detail::Wave::Passage edit(wave_);
    for (Observer* observer : observers_) observer->changing(id, element, now);
    elements_[id] = element;
    for (Observer* observer : observers_) observer->changed(id, now);
    edit.end(now, false);
  }

  /// After process_due().
  void put(Id id, Element&& element, double now) {
    require_free(id);  // A listener may have taken it.
    if (id >= present_.size()) {
      elements_.resize(id + std::size_t{1});
      present_.resize(id + std::size_t{1}, 0);
      listed_.resize(id + std::size_t{1}, 0);
      generation_.resize(id + std::size_t{1}, 0);
    }
    elements_[id] = std::move(element);
    present_[id] = 1;
    ++size_;
    detail::Wave::Passage edit(wave_);
    for (Observer* observer : observers_) observer->inserted(id, now);
    edit.end(now, false);
  }

  void require_free(Id id) const {
    if (id == nobody) throw std::invalid_argument("MovingSet: id " + std::to_string(id) + " is reserved");
    if (contains(id)) throw std::invalid_argument("MovingSet: id " + std::to_string(id) + " is used twice");
  }

  Id require(Id id) const {
    if (!contains(id)) throw std::out_of_range("MovingSet: no element with id " + std::to_string(id));
    return id;
  }
  Id require(const ElementHandle& handle) const {
    if (contains(handle)) return handle.id;
    throw std::out_of_range("MovingSet: the element of id " + std::to_string(handle.id) + " and generation " +
                            std::to_string(handle.generation) + " has been removed");
  }

  static void require_finite(Id id, const Element& element) {
    if (!detail::finite(element)) {
      throw std::invalid_argument("MovingSet: the motion of id " + std::to_string(id) + " is not finite");
    }
  }

  std::vector<Element> elements_;
  std::vector<std::uint8_t> present_;
  std::vector<std::uint64_t> generation_;  ///< by id: how many elements of it have been removed
  std::vector<Id> free_;                   ///< ids of removed elements, each once; some may be in use again
  std::vector<std::uint8_t> listed_;       ///< whether an id is in free_
  std::size_t size_ = 0;
  std::vector<Observer*> observers_;
  detail::Wave wave_;  ///< of edits of the set, and of events of the structures that have its elements
  std::function<Element(Id, double)> sampler_;
  double tick_ = 0;
  std::uint64_t samples_ = 0;
  bool backwards_ = false;
};

}  // namespace kds
