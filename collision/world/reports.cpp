#include "collision/world/reports.hpp"

#include <algorithm>
#include <tuple>

namespace kds::collision {

/// As WorldListener says. Where a pair ended with a body that was removed, and began again with the next of its id, the
/// end comes first.
bool detail::Pending::operator<(const Pending& other) const {
  const auto key = [](const Pending& event) {
    const auto stage = [&] {
      switch (event.kind) {
        case Kind::held:
          return 0;
        case Kind::moved:
          return 1;
        case Kind::pair_ended:
        case Kind::pair_began:
          return 2;
        case Kind::separation:
          return 3;
        case Kind::overlap:
          return 4;
      }
      return 5;
    };
    return std::tuple(stage(), event.a, event.b, event.kind);
  };
  return key(*this) < key(other);
}

void Reports::add_volumes(bool meet, BodySlot a, BodySlot b, double now) {
  if (take_back(meet ? Kind::pair_ended : Kind::pair_began, a, b)) return;
  add(meet ? Kind::pair_began : Kind::pair_ended, a, b, {.time = now});
}

bool Reports::take_back(Kind kind, BodySlot a, BodySlot b) {
  if (reports_.empty()) return false;
  const auto it = reports_.find({kind, a, b, {}});
  if (it == reports_.end() || it->removed) return false;
  reports_.erase(it);
  return true;
}

void Reports::keep_of(BodySlot removed) {
  std::vector<Report> kept;
  std::erase_if(reports_, [&](const Report& report) {
    if (report.a != removed && report.b != removed) return false;
    if (report.kind != Kind::overlap && report.kind != Kind::moved) kept.push_back(report);
    return true;
  });
  for (Report report : kept) {
    report.removed = true;
    reports_.insert(report);
  }
}

Reports::Report Reports::take_first() {
  const Report first = *reports_.begin();
  reports_.erase(reports_.begin());
  return first;
}

}  // namespace kds::collision
