#include "collision/world/reports.hpp"

#include <algorithm>
#include <tuple>

namespace kds::collision {

/// As WorldListener says.
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
    return std::tuple(stage(), body_rank(event.a), body_rank(event.b), event.kind);
  };
  return key(*this) < key(other);
}

void Reports::add_volumes(bool meet, BodyId a, BodyId b, double now) {
  if (take_back(meet ? Kind::pair_ended : Kind::pair_began, a, b)) return;
  add(meet ? Kind::pair_began : Kind::pair_ended, a, b, {.time = now});
}

bool Reports::take_back(Kind kind, BodyId a, BodyId b) {
  if (reports_.empty()) return false;
  const auto it = reports_.find({kind, a, b, {}});
  if (it == reports_.end()) return false;
  reports_.erase(it);
  return true;
}

void Reports::forget(BodyId removed) {
  std::erase_if(reports_, [&](const Report& report) {
    const bool of_present = report.kind == Kind::overlap || report.kind == Kind::moved;
    return of_present && (report.a == removed || report.b == removed);
  });
}

Reports::Report Reports::take_first() {
  const Report first = *reports_.begin();
  reports_.erase(reports_.begin());
  return first;
}

}  // namespace kds::collision
