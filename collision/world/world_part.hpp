// What a world asks of each of its parts, and what it does with all of them in the order of their list.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/world_options.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <concepts>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace kds::collision {

/// What is done at an instant before the events of a part, and what after them.
enum class Stage {
  motions,  ///< pieces of motion begin: they are the motion at t+, so the broad phase runs past the instant after them
  boxes,    ///< boxes meet and part, which is reported with all that the broad phase finds at the instant
  reported  ///< the others: before each of them all is reported that has happened at the instant
};

/// A part of a world, with a state, a queue and laws of its own. The world derives from the list of its parts
/// (WorldParts::list) which event is next, what is audited, and what a snapshot consists of; what follows from an event
/// for other parts is in its overload of Engine::process.
///
/// 1. next_time() is a time up to which the part has no event, `never` if it knows of none: of those with the same time
///    the event of the part that stands first in the list is processed first. Of the events of one part those with the
///    lowest slots come first.
/// 2. If next_time() is only a bound, certify() replaces it by the exact time, which may be later, and returns true.
///    Otherwise it returns false and changes nothing. It is asked before an event is processed. Precondition:
///    next_time() < never.
/// 3. extend_horizon() makes known the events up to the new Clock::horizon.
/// 4. audit(t) throws AuditFailure if the state is not that of the bodies just after t, or an event before t has not
///    been processed. Precondition: nothing is due before t.
/// 5. image() is a copy of all that decides later events and is not a function of the bodies. check() throws
///    std::runtime_error, naming what is wrong, unless a part of a world with these bodies, clock and options may have
///    it; then become() makes a part that has the same later events. Parts are given their images in the order of the
///    list, after the bodies.
template <class Part, class BodiesImage>
concept WorldPart = requires(Part& part, const Part& observed, typename Part::Image& image,
                             const typename Part::Image& loaded, detail::AnyArchive& archive, const BodiesImage& bodies,
                             double t, const WorldOptions& options) {
  { Part::stage } -> std::same_as<const Stage&>;
  { observed.next_time() } -> std::same_as<double>;
  { part.certify() } -> std::same_as<bool>;
  part.extend_horizon();
  observed.audit(t);
  { observed.image() } -> std::same_as<typename Part::Image>;
  image.archive(archive);
  loaded.check(bodies, t, options);
  part.become(loaded);
};

/// The image of a part whose state is a function of the bodies or is in that of another part.
struct NoImage {
  template <class Archive>
  void archive(Archive&) {}
  template <class BodiesImage>
  void check(const BodiesImage&, double, const WorldOptions&) const {}
};

namespace detail {

/// Names the part from which something is missing.
template <class Part, class BodiesImage>
struct RightPart {
  static_assert(WorldPart<Part, BodiesImage>, "World: this is no part of a world");
  static constexpr bool right = true;
};

}  // namespace detail

/// The parts of a world, by reference, in the order in which their events are processed if they are due at one time.
template <class... Parts>
class PartList {
 public:
  explicit constexpr PartList(Parts&... parts) : parts_(parts...) {}

  using Images = std::tuple<typename std::remove_const_t<Parts>::Image...>;
  template <class BodiesImage>
  static constexpr bool all_are_parts = (detail::RightPart<std::remove_const_t<Parts>, BodiesImage>::right && ...);
  /// Whether those of a stage follow those of the stages before it.
  static constexpr bool in_order() {
    Stage last = Stage::motions;
    return ((Parts::stage >= std::exchange(last, Parts::stage)) && ...);
  }
  template <class Part>
  static constexpr std::size_t place_of() {
    std::size_t place = 0;
    bool found = false;
    ((found = found || std::is_same_v<std::remove_const_t<Parts>, Part>, place += found ? 0 : 1), ...);
    return place;
  }
  /// How many parts there are up to the end of a stage.
  static constexpr std::size_t up_to(Stage stage) { return (std::size_t{0} + ... + (Parts::stage <= stage ? 1u : 0u)); }

  /// The first event: its time, and the place of its part in the list; `never` if there is none.
  struct Due {
    double time;
    std::size_t place;
    bool is_of(Stage stage) const { return place < up_to(stage); }  ///< or of one before it
  };
  Due next() const {
    Due first{never, 0};
    each_with_place([&first](const auto& part, std::size_t place) {
      const double time = part.next_time();
      if (time < first.time) first = {time, place};
      return false;
    });
    return first;
  }

  /// use(part) of the part at a place, which returns a bool.
  template <class Use>
  bool at(std::size_t wanted, const Use& use) const {
    return each_with_place([&](auto& part, std::size_t place) { return place == wanted && use(part); });
  }
  /// use(part) of all, in order.
  template <class Use>
  void each(const Use& use) const {
    std::apply([&](auto&... part) { (use(part), ...); }, parts_);
  }

  Images images() const {
    return std::apply([](auto&... part) { return Images{part.image()...}; }, parts_);
  }
  void become(const Images& images) const {
    each([&images](auto& part) { part.become(std::get<typename std::remove_cvref_t<decltype(part)>::Image>(images)); });
  }

 private:
  /// use(part, place) in order, until one returns true.
  template <class Use>
  bool each_with_place(const Use& use) const {
    return [&]<std::size_t... I>(std::index_sequence<I...>) { return (use(std::get<I>(parts_), I) || ...); }
    (std::index_sequence_for<Parts...>{});
  }

  std::tuple<Parts&...> parts_;
};

}  // namespace kds::collision
