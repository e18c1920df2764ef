#include "collision/world/reports.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace kds::collision {

/// The order that WorldListener states.
bool detail::Pending::operator<(const Pending& other) const {
  const auto key = [](const Pending& event) {
    // Volumes that meet and volumes that part are reported together.
    const Kind stage = event.kind == Kind::pair_began ? Kind::pair_ended : event.kind;
    return std::tuple(stage, body_rank(event.a), body_rank(event.b), event.kind, event.wall);
  };
  return key(*this) < key(other);
}

void Reports::add_volumes(bool meet, BodyId a, BodyId b, double now) {
  if (take_back(meet ? Kind::pair_ended : Kind::pair_began, a, b)) return;
  add(meet ? Kind::pair_began : Kind::pair_ended, a, b, {.time = now});
}

void Reports::add_resting(bool begins, BodyId a, BodyId b, const Contact& contact, int wall) {
  if (take_back(begins ? Kind::wakes : Kind::rests, a, b, wall)) return;
  add(begins ? Kind::rests : Kind::wakes, a, b, contact, wall);
}

bool Reports::take_back(Kind kind, BodyId a, BodyId b, int wall) {
  if (reports_.empty()) return false;
  const auto it = reports_.find({kind, a, b, {}, wall, 0, 0});
  if (it == reports_.end()) return false;
  reports_.erase(it);
  return true;
}

void Reports::forget(BodyId removed, std::uint64_t user_data) {
  std::vector<Report> kept;
  for (Report report : std::exchange(reports_, {})) {
    const bool is_a = report.a == removed, is_b = report.b == removed;
    const bool of_present = report.kind == Kind::overlap || report.kind == Kind::moved || report.kind == Kind::piece ||
                            report.kind == Kind::rests;
    if (of_present && (is_a || is_b)) continue;
    if (is_a) report.user_data_a = user_data;
    if (is_b) report.user_data_b = user_data;
    kept.push_back(report);
  }
  become(kept);
}

Reports::Report Reports::take_first() {
  const Report first = *reports_.begin();
  reports_.erase(reports_.begin());
  return first;
}

}  // namespace kds::collision
