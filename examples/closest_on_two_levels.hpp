// The closest pair of points on two levels: a rule that stands on a closest pair of each.
#pragma once

#include "certificates/plane_motion.hpp"
#include "kds/framework/elements_rule.hpp"
#include "structures/champion.hpp"
#include "structures/closest_pair.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <variant>
#include <vector>

namespace kds::examples {

using Line = certificates::PlaneMotion<1>;
using Curve = certificates::PlaneMotion<2>;
using Lower = structures::ClosestPairRule<Line>;
using Upper = structures::ClosestPairRule<Curve>;

/// |b - a|^2 <= |d - c|^2, for pairs on paths of two types.
template <class Path, class OtherPath>
struct NotFarther {
  static constexpr int degree = 2 * std::max(Path::degree, OtherPath::degree);
  const Path &a, &b;
  const OtherPath &c, &d;

  template <class Number>
  auto polynomial(double epoch) const {
    const auto apart = [epoch](const auto& p, const auto& q) {
      return square(difference_about<Number>(q.axis(0), p.axis(0), epoch)) +
             square(difference_about<Number>(q.axis(1), p.axis(1), epoch));
    };
    return apart(c, d) - apart(a, b);
  }
};
using CloserOnLevels = std::variant<NotFarther<Line, Curve>, NotFarther<Curve, Line>>;

/// Two points, the lower id first, and their level: 0 or 1.
struct PairOnLevel {
  std::uint32_t level;
  std::array<Id, 2> ids;

  friend bool operator==(const PairOnLevel&, const PairOnLevel&) = default;
};

/// Keeps the two points that are closest to each other of all that are on one level. On the first they move straight,
/// on the second in parabolas. It stands on the closest pair of each level, and has one certificate: which of the two
/// pairs is the closer one.
///
///     Kinetic<ClosestOnTwoLevels> closest({closest_on_lower, closest_on_upper, upper_points}, now);
class ClosestOnTwoLevels
    : public structures::ChampionRule<ClosestOnTwoLevels, StandsOn<Lower, Upper, ElementsRule<Curve>>, CloserOnLevels,
                                      std::optional<PairOnLevel>> {
 public:
  static constexpr const char* name = "ClosestOnTwoLevels";

  const std::optional<PairOnLevel>& closest() const { return answer(); }

  // Two candidates: the closest pairs of both levels.
  Candidate candidate(From<0> /*lower*/, const Lower::Change& /*change*/) const { return 0; }
  Candidate candidate(From<1> /*upper*/, const Upper::Change& /*change*/) const { return 1; }
  Candidate candidate(From<2> /*upper points*/, const ElementChange& /*change*/) const { return 1; }
  bool takes_part(Candidate level) const { return pair(level).has_value(); }
  /// Of the lower level only: those of the upper one are elements of another set.
  std::vector<Id> ids(Candidate level) const {
    return level == 0 ? std::vector<Id>(pair(0)->begin(), pair(0)->end()) : std::vector<Id>();
  }
  CloserOnLevels better(Candidate level, Candidate /*other*/, const MovingSet<Line>& lower) const {
    const ElementsRule<Curve>& upper = inner(From<2>());
    const auto [a, b] = *pair(0);
    const auto [c, d] = *pair(1);
    if (level == 0) return NotFarther<Line, Curve>{lower[a], lower[b], upper[c], upper[d]};
    return NotFarther<Curve, Line>{upper[c], upper[d], lower[a], lower[b]};
  }
  std::optional<PairOnLevel> find_answer() const {
    return champion() == none ? std::nullopt : std::optional(PairOnLevel{champion(), *pair(champion())});
  }

 private:
  const std::optional<std::array<Id, 2>>& pair(Candidate level) const {
    return level == 0 ? inner(From<0>()).pair() : inner(From<1>()).pair();
  }
};

}  // namespace kds::examples
