// The reports that a world makes of one instant.
#pragma once

#include "collision/body_id.hpp"
#include "collision/narrow_phase/contact.hpp"

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

namespace kds::collision {

namespace detail {

/// A report to be made at this instant.
struct Pending {
  /// In the order in which WorldListener is told of them.
  enum class Kind {
    rebound_suppressed,
    wakes,
    passes,
    rests,
    moved,
    piece,
    pair_ended,
    pair_began,
    separation,
    overlap
  } kind;
  BodyId a, b;  ///< a <= b; b is a where it is about one body
  Contact contact;
  int wall = -1;                  ///< of a body that rests at one, or ceases to
  std::uint64_t user_data_a = 0;  ///< of bodies that have been removed
  std::uint64_t user_data_b = 0;

  bool operator<(const Pending& other) const;
};

}  // namespace detail

/// The reports of an instant, collected until all that is due then is known, and told in the order that WorldListener
/// states: so the log does not depend on the order in which they were found.
class Reports {
 public:
  using Report = detail::Pending;
  using Kind = Report::Kind;

  bool empty() const { return reports_.empty(); }
  void add(Kind kind, BodyId a, BodyId b, const Contact& contact, int wall = -1) {
    reports_.insert({kind, a, b, contact, wall, 0, 0});
  }
  /// The same, unless there is such a report already.
  void add_once(Kind kind, BodyId a, BodyId b, const Contact& contact) {
    if (!reports_.contains({kind, a, b, contact, -1, 0, 0})) add(kind, a, b, contact);
  }

  /// Bounding volumes meet, or part. If they meet and part at one instant, or part and meet (bodies that are moved in
  /// turn, lists of ends that are brought into order one after the other), neither is reported.
  void add_volumes(bool meet, BodyId a, BodyId b, double now);

  /// Two bodies, or a and a wall, begin or cease to rest on each other. If they do both at one instant, neither is
  /// reported.
  void add_resting(bool begins, BodyId a, BodyId b, const Contact& contact, int wall);

  /// Forgets a report that has been undone before it was made; false if there is none.
  bool take_back(Kind kind, BodyId a, BodyId b, int wall = -1);

  /// A body has been removed, with its pairs: its separations are still reported, with its user data, and the reports
  /// that only a body in the world can have are dropped.
  void forget(BodyId removed, std::uint64_t user_data);

  /// The next to be told. Precondition: not empty.
  Report take_first();

  std::vector<Report> image() const;
  void become(std::span<const Report> reports) {
    reports_ = {reports.begin(), reports.end()};
    removed_.clear();
  }

 private:
  bool is_dropped(const Report& report) const;
  Report with_user_data(Report report) const;
  void drop_first();

  /// In their order; the first is never one of those that are dropped.
  std::multiset<Report> reports_;
  /// Bodies that have been removed while there were reports, with their user data. To look through the reports at each
  /// removal would take time quadratic in the bodies that are removed at one instant.
  std::map<BodyId, std::uint64_t> removed_;
};

}  // namespace kds::collision
