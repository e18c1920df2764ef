// Bodies of a scene as they are saved in parts.
#pragma once

#include "collision/world/engine.hpp"
#include "collision/world/engine_image.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/transfer/parcel.hpp"
#include "kds/framework/snapshot.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace kds::collision {

/// Some bodies, and pairs that overlap: of which one is among these, or of bodies that stand.
template <class Motion>
struct SavedBodies {
  using Overlap = typename Transfer<Motion>::Overlap;

  Parcel<Motion> parcel{};
  std::vector<Overlap> overlaps{};  ///< by numbers

  template <class Archive>
  void archive(Archive& archive) {
    archive.tag("bodies of a scene in parts");
    archive(parcel);
    archive.each(overlaps, [&](Overlap& overlap) { archive(overlap.a, overlap.b, overlap.passes_at); });
  }

  /// Throws std::runtime_error, naming what is wrong, unless they may be bodies of a scene with these options, of which
  /// this is saved too.
  void check(const typename Engine<Motion>::Image& rest, const WorldOptions& options) const {
    const auto& numbers = parcel.numbers;
    const auto& bodies = parcel.bodies;
    if (bodies.bodies.size() != numbers.size() || parcel.to_come.size() != numbers.size() ||
        parcel.resting.size() != numbers.size() || (turns<Motion> && parcel.turning.size() != numbers.size())) {
      image::fail("bodies: lists about them are of different lengths");
    }
    bodies.check(rest.now);
    const auto alive = [&](BodySlot place) { return bodies.alive(place); };
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      image::require(alive(static_cast<BodySlot>(i)) && numbers[i] < rest.bodies.elsewhere.slots, "bodies", i,
                     "is none of the scene");
    }
    check_orientations(bodies, parcel.to_come);
    typename Scripts<Motion>::Image{parcel.to_come}.check(bodies, rest.now);
    if constexpr (turns<Motion>) {
      typename Tumbling<Motion>::Image turning;
      for (const auto& progress : parcel.turning) {
        turning.of.push_back(progress.body() ? std::optional(*progress.body()) : std::nullopt);
      }
      turning.check(bodies, rest.now);
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (parcel.resting[i].state()) check_resting(i, *parcel.resting[i].state(), rest, options);
    }
    for (std::size_t i = 0; i < overlaps.size(); ++i) {
      const Overlap& overlap = overlaps[i];
      image::require(
          rest.bodies.before(overlap.a, overlap.b) && std::max(overlap.a, overlap.b) < rest.bodies.elsewhere.slots,
          "overlaps", i, "is not of two bodies");
      image::require(image::is_past(overlap.passes_at, rest.now), "overlaps", i, "passes at a time after now");
    }
  }

 private:
  /// That what it rests on is there is seen when all bodies have been read.
  void check_resting(std::size_t i, const RestingProgress::State& state, const typename Engine<Motion>::Image& rest,
                     const WorldOptions& options) const {
    const auto need = [i](bool right, const char* what) { image::require(right, "resting", i, what); };
    const double now = rest.now;
    const bool fixed = parcel.bodies.bodies[i].inverse_mass == 0;
    const bool spans = state.span_ends != -never;
    need(parcel.bodies.bodies[i].entered, "is of a body that has not entered");
    need(state.releases.size() == state.contacts.size(), "has not as many releases as contacts");
    need(!spans || (image::is_to_come(state.span_ends, now) && !fixed && options.response == Response::elastic),
         "is in a span that is over, or where there are none");
    need(state.calm_since == never || image::is_past(state.calm_since, now), "is not calm yet");
    // Of several bodies in one cluster only one knows when its span ends.
    const bool may_lean =
        std::any_of(state.contacts.begin(), state.contacts.end(), [](const auto& c) { return c.b != no_body; });
    need(image::is_to_come(state.looked_at, now) && (!spans || may_lean || state.looked_at <= state.span_ends),
         "has a span that never ends, or has ended");
    for (std::size_t k = 0; k < state.contacts.size(); ++k) {
      const auto& contact = state.contacts[k];
      need(contact.alive && (contact.a == parcel.numbers[i] || contact.b == parcel.numbers[i]), "is of other bodies");
      if (contact.b == no_body) {
        need(options.walls && contact.wall >= 0 && contact.wall < 6, "is at no wall");
      } else {
        const BodySlot last = std::max(contact.a, contact.b);
        need(contact.wall == -1 && last < rest.bodies.elsewhere.slots && rest.bodies.before(contact.a, contact.b),
             "is not of two bodies");
        need(!fixed && options.response == Response::elastic, "is of two bodies in a mode without resting contacts");
      }
      detail::check_numbers(contact, now, need);
      need(image::is_to_come(state.releases[k], now), "is to be let go before now");
    }
  }
  void check_resting(std::size_t i, const TurningRestProgress::State& state, const typename Engine<Motion>::Image& rest,
                     const WorldOptions& options) const {
    const auto need = [i](bool right, const char* what) { image::require(right, "resting", i, what); };
    const double now = rest.now;
    const BodySlot number = parcel.numbers[i];
    need(parcel.bodies.bodies[i].entered, "is of a body that has not entered");
    need(parcel.bodies.bodies[i].inverse_mass > 0 && options.response == Response::elastic,
         "is of a fixed body, or in a mode without it");
    need(state.since == never || image::is_past(state.since, now), "is not calm yet");
    need(image::is_past(state.looked, now), "has not been looked at yet");
    need(image::is_past(state.ignored.since, now), "has not been struck yet");
    need(state.ignored.velocity.allFinite() && state.ignored.angular_velocity.allFinite(), "a velocity is not finite");
    need(state.carrier.finite(), "the motion of what carries it is not finite");
    bool holds = false;
    for (std::size_t k = 0; k < state.links.size(); ++k) {
      const auto& link = state.links[k];
      need(link.other != number && link.other < rest.bodies.elsewhere.slots, "is with no body of the scene");
      need(k == 0 || rest.bodies.before(state.links[k - 1].other, link.other), "is out of order");
      check_numbers(link.pair, now, need);
      holds = holds || link.pair.rests;
    }
    need(!state.rests || holds, "rests on nothing");
  }
};

}  // namespace kds::collision
