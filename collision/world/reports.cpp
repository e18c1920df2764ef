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
    return std::tuple(stage, event.a, event.b, event.kind, event.wall);
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
  drop_first();
  return true;
}

void Reports::forget(BodyId removed, std::uint64_t user_data) {
  if (reports_.empty()) return;
  removed_.emplace(removed, user_data);
  drop_first();
}

bool Reports::is_dropped(const Report& report) const {
  const bool of_present = report.kind == Kind::overlap || report.kind == Kind::moved || report.kind == Kind::piece ||
                          report.kind == Kind::rests;
  return of_present && (removed_.contains(report.a) || removed_.contains(report.b));
}

void Reports::drop_first() {
  if (!removed_.empty()) {
    while (!reports_.empty() && is_dropped(*reports_.begin())) reports_.erase(reports_.begin());
  }
  if (reports_.empty()) removed_.clear();
}

Reports::Report Reports::with_user_data(Report report) const {
  if (removed_.empty()) return report;
  if (const auto a = removed_.find(report.a); a != removed_.end()) report.user_data_a = a->second;
  if (const auto b = removed_.find(report.b); b != removed_.end()) report.user_data_b = b->second;
  return report;
}

Reports::Report Reports::take_first() {
  const Report first = with_user_data(*reports_.begin());
  reports_.erase(reports_.begin());
  drop_first();
  return first;
}

std::vector<Reports::Report> Reports::image() const {
  std::vector<Report> image;
  for (const Report& report : reports_) {
    if (!is_dropped(report)) image.push_back(with_user_data(report));
  }
  return image;
}

}  // namespace kds::collision
