#include "collision/narrow_phase/mesh_contact.hpp"

#include "collision/degrees.hpp"
#include "collision/narrow_phase/mesh_query.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

namespace kds::collision {
namespace {

using namespace detail;

constexpr double infinity = TimeSpans::infinity;

}  // namespace

// ---- MeshPair ------------------------------------------------------------------------------------------------------

template <int Degree>
MeshPair<Degree>::MeshPair(const PlacedShape& a, const PlacedShape& b, const RelativeMotion<Degree>& motion)
    : a_(a), b_(b), motion_(motion), gap_(contact_gap(motion, a.bounding_radius + b.bounding_radius)) {}

/// Calls `question` with the Query for the kind of b and the degree of the motion.
template <int Degree>
template <class Question>
auto MeshPair<Degree>::ask(const Question& question) const {
  const auto with_motion = [&](const auto& motion, const auto& gap) {
    constexpr int degree = static_cast<int>(std::tuple_size_v<std::decay_t<decltype(gap.c)>>) - 1;
    const auto with_partner = [&]<class Partner>(std::type_identity<Partner>) {
      return question(Query<degree, Partner>(a_, b_, motion, gap));
    };
    using Answer = decltype(with_partner(std::type_identity<BallPartner>{}));
    return std::visit(
        [&](const auto& shape) -> Answer {
          using Kind = std::decay_t<decltype(shape)>;
          if constexpr (has_partner<Kind>) {
            return with_partner(std::type_identity<PartnerOf<Kind>>{});
          } else {
            throw std::logic_error(std::string("MeshPair: asked of a ") + kind_name(b_.shape));
          }
        },
        b_.shape);
  };
  if constexpr (Degree == 2) {
    if (motion_.coefficients[2].isZero(0) && gap_.c[2] == 0) {
      const auto& [r0, r1, r2] = motion_.coefficients;
      const auto& [u0, u1, u2] = motion_.uncertainty;
      return with_motion(RelativeMotion<1>{{r0, r1}, {u0, u1}, motion_.epoch}, ContactGap<1>{{gap_.c[0], gap_.c[1]}});
    }
  }
  return with_motion(motion_, gap_);
}

template <int Degree>
std::optional<MeshTouch> MeshPair<Degree>::first_contact(double tau0, double tau1, ContactMode mode) const {
  return ask([&](const auto& query) { return query.first_contact(tau0, tau1, mode); });
}

template <int Degree>
double MeshPair<Degree>::apart_until(double tau0, double tau1) const {
  return ask([&](const auto& query) { return query.apart_until(tau0, tau1); });
}

template <int Degree>
bool MeshPair<Degree>::touching(double tau) const {
  return ask([&](const auto& query) { return query.touching(tau); });
}

template <int Degree>
double MeshPair<Degree>::first_free_time(double tau, double limit) const {
  return ask([&](const auto& query) { return query.first_free_time(tau, limit); });
}

template <int Degree>
MeshTouchPlace MeshPair<Degree>::where(double tau, const MeshTouch* known) const {
  return ask([&](const auto& query) { return query.where(tau, known); });
}

#define KDS_INSTANTIATE(degree) template class MeshPair<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

// ---- MeshContact ---------------------------------------------------------------------------------------------------

namespace {

/// The first double t with t - epoch >= tau, or infinity. Precondition: tau > 0, finite.
///
/// The difference is rounded: if the epoch is not near 0, many t near 0 have the same difference. So t is found by
/// bisection, between a time whose exact difference is below the double before tau, and one whose difference is above
/// tau.
double clock_time(double epoch, double tau) {
  if (epoch + tau == infinity) return infinity;
  double before = next_down(epoch + next_down(tau));
  double t = next_up(epoch + tau);
  while (lattice_distance(before, t) > 1) {
    const double middle = lattice_middle(before, t);
    (middle - epoch >= tau ? t : before) = middle;
  }
  return t;
}

/// A pair in which a is a mesh, on the clock.
template <int Degree>
struct ClockedPair {
  using Body = TranslatingShape<Degree>;

  ClockedPair(const Body& a, const Body& b) : motion(relative_to(a.motion, b.motion)), pair(a.shape, b.shape, motion) {}

  /// Before the epoch one of the two motions has not begun: times before it are not searched.
  double tau(double t) const { return std::max(t - motion.epoch, 0.0); }
  double clock(double tau_found, double t0, double horizon) const {
    if (tau_found == infinity) return infinity;
    if (tau_found <= tau(t0)) return t0;
    const double t = std::max(t0, clock_time(motion.epoch, tau_found));
    return t <= horizon ? t : infinity;
  }

  RelativeMotion<Degree> motion;
  MeshPair<Degree> pair;
};

}  // namespace

template <int Degree>
double MeshContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                                          FoundTouch* found) {
  const ClockedPair<Degree> clocked(a, b);
  const auto touch = clocked.pair.first_contact(clocked.tau(t0), clocked.tau(horizon), mode);
  if (!touch) return infinity;
  const double time = clocked.clock(touch->tau, t0, horizon);
  if (found && touch->foremost) *found = {time, touch->tau, touch->triangle_a, touch->triangle_b};
  return time;
}

template <int Degree>
double MeshContact<Degree>::apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&) {
  const ClockedPair<Degree> clocked(a, b);
  const double tau = clocked.pair.apart_until(clocked.tau(t0), clocked.tau(horizon));
  if (tau == infinity) return infinity;
  return tau <= clocked.tau(t0) ? t0 : std::max(t0, next_down(clocked.motion.epoch + tau * (1 - 0x1p-50)));
}

template <int Degree>
bool MeshContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  const ClockedPair<Degree> clocked(a, b);
  return clocked.pair.touching(clocked.tau(t));
}

template <int Degree>
double MeshContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  const ClockedPair<Degree> clocked(a, b);
  return clocked.clock(clocked.pair.first_free_time(clocked.tau(t0), clocked.tau(horizon)), t0, horizon);
}

template <int Degree>
Contact MeshContact<Degree>::contact_at(const Body& a, const Body& b, double t, const FoundTouch& found) {
  const ClockedPair<Degree> clocked(a, b);
  const MeshTouch known{found.tau, found.triangle_a, found.triangle_b, true};
  const auto where = clocked.pair.where(clocked.tau(t), found.time == t ? &known : nullptr);
  return {t, a.motion.position(t) + where.point, where.normal, where.feature_a, where.feature_b};
}

#define KDS_INSTANTIATE(degree) template struct MeshContact<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
