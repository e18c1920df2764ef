#include "collision/broad_phase/few_boxes.hpp"

#include "collision/degrees.hpp"
#include "kds/audit.hpp"
#include "kds/roots/failure_time.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace kds::collision {
namespace {

constexpr double greatest_double = std::numeric_limits<double>::max();

/// The first `count` bits.
constexpr std::uint64_t first_places(std::size_t count) { return count == 64 ? ~0ull : (1ull << count) - 1; }

}  // namespace

template <int Degree>
std::size_t FewBoxes<Degree>::place_of(BodySlot id) const {
  std::size_t place = 0;
  while (bodies_[place].id != id) ++place;
  return place;
}

template <int Degree>
StaticBox FewBoxes<Degree>::swept(const KineticBox<Degree>& box, double now) const {
  // Nothing moves if the clock stands at the end of the span.
  const double until = std::max(now, until_);
  if (!(until <= greatest_double)) {
    const auto still = [](const certificates::PointMotion<Degree>& end) {
      for (std::size_t i = 1; i <= Degree; ++i) {
        if (!end.coefficients[i].isZero(0)) return false;
      }
      return true;
    };
    if (!(still(box.min) && still(box.max))) return whole_space();
    return box_at(box, now);
  }
  const StaticBox swept = swept_box(box, now, until);
  return (swept.min >= -greatest_double).all() && (swept.max <= greatest_double).all() ? swept : whole_space();
}

template <int Degree>
void FewBoxes<Degree>::put(std::size_t place, const StaticBox& box) {
  ++counters_.box_updates;
  for (int d = 0; d < 3; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    min_[axis][place / 2][place % 2] = box.min[d];
    max_[axis][place / 2][place % 2] = box.max[d];
  }
}

template <int Degree>
StaticBox FewBoxes<Degree>::box(std::size_t place) const {
  StaticBox box;
  for (int d = 0; d < 3; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    box.min[d] = min_[axis][place / 2][place % 2];
    box.max[d] = max_[axis][place / 2][place % 2];
  }
  return box;
}

/// Which of the first `count` boxes overlap this one; itself too, if it is one of them.
template <int Degree>
auto FewBoxes<Degree>::overlaps(const StaticBox& box, std::size_t count) const -> Row {
  TwoBits row{};
  TwoBits bit{1, 2};
  const Two low[] = {both(box.min[0]), both(box.min[1]), both(box.min[2])};
  const Two high[] = {both(box.max[0]), both(box.max[1]), both(box.max[2])};
  for (std::size_t i = 0; i < (count + 1) / 2; ++i, bit <<= 2) {
    TwoBits hit = bit;
    for (std::size_t d = 0; d < 3; ++d) hit &= (min_[d][i] <= high[d]) & (low[d] <= max_[d][i]);
    row |= hit;
  }
  return static_cast<Row>(row[0] | row[1]) & first_places(count);
}

/// Reports the changes among the first `count` bodies, and stores the pairs.
template <int Degree>
void FewBoxes<Degree>::change(std::size_t place, Row row, std::size_t count, double now, PairListener& listener) {
  row &= others_[place];
  const Row considered = first_places(count) & ~(Row{1} << place);
  const Row changed = (partners_[place] ^ row) & considered;
  partners_[place] ^= changed;
  const BodySlot id = bodies_[place].id;
  for (Row rest = changed; rest != 0; rest &= rest - 1) {
    const auto other_place = static_cast<std::size_t>(std::countr_zero(rest));
    const BodySlot other = bodies_[other_place].id;
    partners_[other_place] ^= Row{1} << place;
    const auto [a, b] = std::minmax(id, other);
    if ((row >> other_place & 1) != 0) {
      ++spent_;
      listener.pair_began(a, b, now);
    } else {
      listener.pair_ended(a, b, now);
    }
  }
}

/// Seconds in which the moving bodies move by about their size.
template <int Degree>
double FewBoxes<Degree>::first_span(double now) const {
  double size = 0, speed = 0, bend = 0;
  if constexpr (Degree >= 3) {
    double extent = 0;
    for (const auto& [id, box] : bodies_) extent += (box.max.coefficients[0] - box.min.coefficients[0]).maxCoeff();
    const double travel = tuning_.first_travel * extent / static_cast<double>(bodies_.size());
    double time = greatest_double;
    for (const auto& [id, box] : bodies_) {
      const double moves = time_to_move(box.min, now, travel);
      if (moves > 0) time = std::min(time, moves);
    }
    return time;
  }
  for (const auto& [id, box] : bodies_) {
    const double velocity = box.min.velocity(now).cwiseAbs().maxCoeff();
    double force = 0;
    if constexpr (Degree == 2) force = box.min.coefficients[2].cwiseAbs().maxCoeff();
    if (velocity == 0 && force == 0) continue;
    size += (box.max.coefficients[0] - box.min.coefficients[0]).maxCoeff();
    speed += velocity;
    bend += force;
  }
  const double travel = tuning_.first_travel * size;
  double span = speed > 0 ? travel / speed : greatest_double;
  if (bend > 0) span = std::min(span, std::sqrt(travel / bend));
  return span > 0 ? span : greatest_double;
}

/// The cost of new boxes for all, in comparisons.
template <int Degree>
std::uint64_t FewBoxes<Degree>::cost_of_span() const {
  return (bodies_.size() / 2 + tuning_.comparisons_per_box) * bodies_.size();
}

/// `latest`: the span ends then at the latest.
template <int Degree>
void FewBoxes<Degree>::begin_span(double now, double latest) {
  until_ = std::min(latest, std::max(now + span_, next_up(now)));
  spent_ = 0;
  ++counters_.certificates;
}

/// Notes with which others a new body may collide. Rows have bits for unused places too.
template <int Degree>
void FewBoxes<Degree>::meet(std::size_t place, const PairListener& listener) {
  others_[place] = ~Row{0};
  if (!listener.filters()) return;
  for (std::size_t other = 0; other < place; ++other) {
    if (listener.may_collide(bodies_[place].id, bodies_[other].id)) continue;
    others_[place] &= ~(Row{1} << other);
    others_[other] &= ~(Row{1} << place);
  }
}

template <int Degree>
void FewBoxes<Degree>::insert(std::span<const Entry> bodies, double now, PairListener& listener) {
  const std::size_t before = bodies_.size();
  if (before + bodies.size() > most) throw std::length_error("FewBoxes: more than 64 bodies");
  bodies_.reserve(before + bodies.size());
  for (const Entry& body : bodies) bodies_.push_back({body.slot, *body.box});
  // Many runs are not longer than the first horizon. Boxes that are valid for longer than the span are valid for the
  // span.
  span_ = before == 0 ? first_span(now) : std::min(span_, first_span(now));
  begin_span(now, before == 0 ? horizon_ : until_);
  for (std::size_t place = before; place < bodies_.size(); ++place) {
    const StaticBox box = swept(bodies_[place].box, now);
    put(place, box);
    partners_[place] = 0;
    meet(place, listener);
    change(place, overlaps(box, place), place, now, listener);
  }
}

template <int Degree>
void FewBoxes<Degree>::remove(BodySlot id, double now, PairListener& listener) {
  const std::size_t place = place_of(id);
  change(place, 0, bodies_.size(), now, listener);
  const std::size_t last = bodies_.size() - 1;
  if (place != last) {  // the last one takes the place of the one removed
    const StaticBox moved = box(last);
    for (Row rest = partners_[last]; rest != 0; rest &= rest - 1) {
      Row& row = partners_[static_cast<std::size_t>(std::countr_zero(rest))];
      row = (row & ~(Row{1} << last)) | Row{1} << place;
    }
    partners_[place] = partners_[last];
    others_[place] = others_[last];
    bodies_[place] = bodies_[last];
    put(place, moved);
  }
  bodies_.pop_back();
  if (!listener.filters()) return;
  for (std::size_t other = 0; other < last; ++other) {
    Row& row = others_[other];
    row = (row & ~(Row{1} << place)) | (row >> last & 1) << place | Row{1} << last;
  }
}

template <int Degree>
void FewBoxes<Degree>::update(BodySlot id, const KineticBox<Degree>& box, double now, PairListener& listener) {
  const std::size_t place = place_of(id);
  bodies_[place].box = box;
  const StaticBox fat = swept(box, now);
  put(place, fat);
  change(place, overlaps(fat, bodies_.size()), bodies_.size(), now, listener);
  spent_ += static_cast<std::uint64_t>(std::popcount(partners_[place]));
  if (tuning_.comparisons_per_pair * spent_ <= tuning_.far_too_much * cost_of_span() || !(until_ > now)) return;
  span_ = std::min(span_, first_span(now));
  until_ = now;
}

/// Begins the next span; true if it reported a pair.
template <int Degree>
bool FewBoxes<Degree>::renew(double now, PairListener& listener) {
  const std::uint64_t spent = tuning_.comparisons_per_pair * spent_;
  const std::uint64_t cost = cost_of_span();
  if (spent > tuning_.much * cost) span_ *= tuning_.shrink;
  if (spent < tuning_.little * cost) {
    const bool idle = tuning_.idle_part * spent < cost;
    span_ = std::min(span_ * (idle ? tuning_.grow_where_idle : tuning_.grow), greatest_double);
  }
  begin_span(now, never);
  for (std::size_t place = 0; place < bodies_.size(); ++place) put(place, swept(bodies_[place].box, now));
  bool any = false;
  for (std::size_t place = 1; place < bodies_.size(); ++place) {
    const Row row = overlaps(box(place), place) & others_[place];
    const Row below = first_places(place);
    any = any || ((partners_[place] ^ row) & below) != 0;
    change(place, row, place, now, listener);
  }
  return any;
}

template <int Degree>
bool FewBoxes<Degree>::advance(double limit, PairListener& listener) {
  while (next_time() <= limit) {
    if (renew(until_, listener)) return true;
  }
  return false;
}

template <int Degree>
void FewBoxes<Degree>::visit_overlapping(const StaticBox& box, double, SlotVisitor visit) const {
  for (Row rest = overlaps(box, bodies_.size()); rest != 0; rest &= rest - 1) {
    visit(bodies_[static_cast<std::size_t>(std::countr_zero(rest))].id);
  }
}

template <int Degree>
void FewBoxes<Degree>::visit_swept(const KineticBox<Degree>& box, double from, double until, SlotVisitor visit) const {
  const StaticBox swept = bounded_swept_box(box, from, until);
  if (until <= until_) return visit_overlapping(swept, from, visit);
  for (const Body& body : bodies_) {
    if (bounded_swept_box(body.box, from, until).overlaps(swept)) visit(body.id);
  }
}

template <int Degree>
void FewBoxes<Degree>::audit(double now) const {
  if (next_time() <= now) return;  // due
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const StaticBox present = box_at(bodies_[i].box, now);
    // The rounding margins differ from those of the whole span.
    const double slack = 0x1p-45 * std::max(present.min.abs().maxCoeff(), present.max.abs().maxCoeff());
    StaticBox inner = present;
    inner.min += slack;
    inner.max -= slack;
    const std::string who = "FewBoxes: body " + std::to_string(bodies_[i].id);
    if (!box(i).contains(inner)) throw AuditFailure(who + " is outside its swept box");
    for (std::size_t j = 0; j < i; ++j) {
      const bool paired = (partners_[i] >> j & 1) != 0;
      if (paired != ((partners_[j] >> i & 1) != 0) ||
          paired != ((others_[i] >> j & 1) != 0 && box(i).overlaps(box(j)))) {
        throw AuditFailure(who + " and " + std::to_string(bodies_[j].id) + ": a pair that is not, or none that is");
      }
    }
  }
}

#define KDS_INSTANTIATE(degree) template class FewBoxes<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
