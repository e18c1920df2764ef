#include "tests/benchmarks/roots/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bench_roots {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The root nearest to t. Precondition: there is one.
std::size_t nearest_root(const Truth& truth, double t) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < truth.roots.size(); ++i) {
    if (std::abs(truth.roots[i].distance_to(t)) < std::abs(truth.roots[best].distance_to(t))) best = i;
  }
  return best;
}

bool near(const ExactRoot& root, double t) {
  return std::abs(root.distance_to(t)) <= std::max(astray * root.high, root.spacing());
}

Judgement at(const ExactRoot& root, double t) {
  return {Verdict::right, true, std::abs(root.distance_to(t)) / root.spacing(), root.compare(t) > 0};
}

}  // namespace

Judgement judge(const Truth& truth, double horizon, double answer) {
  const int expected = truth.first_failure(horizon);
  const bool sense = answer >= 0;  // not if it is a NaN
  if (!sense || answer == infinity || answer > horizon) {
    if (expected != -1) return {Verdict::missed};
    return {sense ? Verdict::right : Verdict::phantom};
  }
  if (expected == Truth::root_at_now) return answer == 0 ? at({}, 0) : Judgement{Verdict::wrong_crossing};
  const Verdict wrong = expected == -1 ? Verdict::phantom : Verdict::wrong_crossing;
  if (truth.roots.empty()) return {wrong};
  if (expected != -1) {
    const ExactRoot& root = truth.roots[static_cast<std::size_t>(expected)];
    if (std::abs(root.distance_to(answer)) <= root.spacing()) return at(root, answer);
  }
  const std::size_t nearest = nearest_root(truth, answer);
  const ExactRoot& root = truth.roots[nearest];
  const bool unseen_dip =
      root.falling() && !truth.seen(nearest) && truth.sign_after_now > 0 && root.compare(horizon) <= 0;
  if (static_cast<int>(nearest) != expected && !unseen_dip) return {wrong};
  return near(root, answer) ? at(root, answer) : Judgement{wrong};
}

Judgement judge(const Truth& truth, double horizon, double answer, double lower, double upper) {
  Judgement judgement = judge(truth, horizon, answer);
  const int i = truth.first_failure(horizon);
  if (!judgement.crossing || i == -1) return judgement;
  const ExactRoot root = i == Truth::root_at_now ? ExactRoot{} : truth.roots[static_cast<std::size_t>(i)];
  judgement.enclosed = root.compare(lower) >= 0 && root.compare(upper) <= 0;
  return judgement;
}

void Tally::add(const Judgement& judgement) {
  ++count;
  missed += judgement.verdict == Verdict::missed;
  phantom += judgement.verdict == Verdict::phantom;
  wrong_crossing += judgement.verdict == Verdict::wrong_crossing;
  early += judgement.early;
  crossings += judgement.crossing;
  unenclosed += !judgement.enclosed;
  if (judgement.crossing) ulps_.push_back(judgement.ulps);
}

void Tally::add(const Tally& other) {
  count += other.count;
  missed += other.missed;
  phantom += other.phantom;
  wrong_crossing += other.wrong_crossing;
  early += other.early;
  crossings += other.crossings;
  unenclosed += other.unenclosed;
  ulps_.insert(ulps_.end(), other.ulps_.begin(), other.ulps_.end());
}

double Tally::ulps_max() const { return ulps_.empty() ? 0 : *std::max_element(ulps_.begin(), ulps_.end()); }

double Tally::ulps_999() const {
  if (ulps_.empty()) return 0;
  std::vector<double> sorted = ulps_;
  const auto rank = sorted.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(sorted.size() - 1) * 0.999);
  std::nth_element(sorted.begin(), rank, sorted.end());
  return *rank;
}

}  // namespace bench_roots
