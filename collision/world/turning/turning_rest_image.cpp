// Rest in worlds of bodies that turn: its audit, and all of it as plain data, made, read and checked.
#include "collision/motions.hpp"
#include "collision/world/bodies_image.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/world/turning/turning_rest.hpp"
#include "kds/audit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

namespace kds::collision {

template <class Motion>
typename TurningRest<Motion>::Image TurningRest<Motion>::image() const {
  Image image;
  for (const auto& [key, pair] : pairs_) image.pairs.push_back({key.first, key.second, pair});
  // What decides nothing any more is left out: so it makes no difference which world has been told of the bodies.
  std::size_t last = of_.size();
  while (last > 0 && of_[last - 1].others.empty() && of_[last - 1].since == never) --last;
  for (const Member& member : std::span(of_).first(last)) {
    image.since.push_back(member.since);
    image.looked.push_back(member.looked > member.since ? member.looked : -never);
    image.rests.push_back(member.rests);
    image.ignored.push_back(member.rests ? member.ignored : Ignored());
    image.carriers.push_back(member.others.empty() ? turning_rest::Carrier{} : member.carrier);
  }
  image.woken = woken_;
  image.blows = blows_.image(clock_.now);
  return image;
}

template <class Motion>
void TurningRest<Motion>::become(const Image& image) {
  pairs_.clear(), of_.clear(), kept_.clear();
  of_.resize(image.since.size());
  resting_ = 0;
  for (BodySlot slot = 0; slot < of_.size(); ++slot) {
    of_[slot].since = image.since[slot];
    of_[slot].looked = image.looked[slot];
    of_[slot].rests = image.rests[slot] != 0;
    of_[slot].ignored = image.ignored[slot];
    of_[slot].carrier = image.carriers[slot];
  }
  for (const auto& one : image.pairs) {
    pair({one.a, one.b}) = one.pair;
    resting_ += one.pair.rests;
  }
  woken_ = image.woken;
  blows_.become(image.blows);
}

template <class Motion>
void TurningRest<Motion>::Image::check(const typename Bodies<Motion>::Image& bodies, double now,
                                       const WorldOptions& options) const {
  if (rests.size() != since.size() || looked.size() != since.size() || ignored.size() != since.size() ||
      carriers.size() != since.size())
    image::fail("resting: is not of as many bodies as are calm");
  if (since.size() > bodies.bodies.size()) image::fail("resting: of more bodies than there are");
  if (!pairs.empty() && options.response != Response::elastic) image::fail("resting: is there in a mode without it");
  std::vector<char> held(since.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& [a, b, pair] = pairs[i];
    const auto need = [i](bool right, const char* what) { image::require(right, "resting", i, what); };
    need(bodies.before(a, b) && std::max(a, b) < since.size() && bodies.entered(a) && bodies.entered(b),
         "is not of two bodies in the world");
    need(i == 0 || std::pair(pairs[i - 1].a, pairs[i - 1].b) < std::pair(a, b), "is out of order");
    check_numbers(pair, now, need);
    if (pair.rests) held[a] = held[b] = 1;
  }
  for (std::size_t i = 0; i < since.size(); ++i) {
    image::require(since[i] == never || image::is_past(since[i], now), "resting bodies", i, "is not calm yet");
    image::require(image::is_past(looked[i], now), "resting bodies", i, "has not been looked at yet");
    image::require(!rests[i] || held[i], "resting bodies", i, "rests on nothing");
    image::require(image::is_past(ignored[i].since, now), "resting bodies", i, "has not been struck yet");
    image::require(ignored[i].velocity.allFinite() && ignored[i].angular_velocity.allFinite(), "resting bodies", i,
                   "a velocity is not finite");
    image::require(carriers[i].finite(), "resting bodies", i, "the motion of what carries it is not finite");
  }
  for (std::size_t i = 0; i < woken.size(); ++i) {
    image::require(bodies.entered(woken[i]), "woken", i, "is no body in the world");
  }
  constexpr double unit_rounding = 0x1p-40;  // far above that of a normalisation
  for (std::size_t i = 0; i < blows.size(); ++i) {
    const auto& [a, b, point, normal, time, least] = blows[i];
    const auto need = [i](bool right, const char* what) { image::require(right, "blows", i, what); };
    need(bodies.before(a, b) && bodies.entered(a) && bodies.entered(b), "is not of two bodies in the world");
    need(point.allFinite() && std::abs(normal.norm() - 1) <= unit_rounding, "its contact is not one");
    need(least >= 0 && least < never, "its speed is not >= 0");
    need(image::is_past(time, now) && (i == 0 || blows[i - 1].time <= time), "is out of order");
  }
}

template <class Motion>
void TurningRest<Motion>::audit(double) const {
  if (!solved()) return;
  const auto need = [&](bool right, BodySlot slot, const char* what) {
    if (!right) throw AuditFailure("World: body " + std::to_string(bodies_.id_of(slot)) + ": " + what);
  };
  std::size_t resting = 0;
  for (const auto& [key, pair] : pairs_) {
    const turning_rest::Carrier& carrier = of_[bodies_.fixed(key.first) ? key.second : key.first].carrier;
    for (const BodySlot slot : {key.first, key.second}) {
      need(bodies_.entered(slot), slot, "it rests on another, and is not there");
      need(!pair.rests || moves_with(bodies_.motion(slot), carrier) || slides_under(slot, carrier), slot,
           "it rests, and does not move with what it rests on");
      need(!pair.rests || of_[slot].rests || bodies_.fixed(slot), slot, "it rests on another, and is awake");
    }
    resting += pair.rests;
  }
  for (BodySlot slot = 0; slot < of_.size(); ++slot) {
    if (!of_[slot].rests) continue;
    const auto& others = of_[slot].others;
    need(bodies_.entered(slot) && !bodies_.fixed(slot), slot, "it rests, and is not there");
    need(!others.empty(), slot, "it rests on nothing");
  }
  if (resting != resting_) throw AuditFailure("World: pairs that rest are miscounted");
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class TurningRest<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
