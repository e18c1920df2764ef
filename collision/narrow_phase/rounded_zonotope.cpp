#include "collision/narrow_phase/rounded_zonotope.hpp"

#include "collision/degrees.hpp"
#include "collision/vectors.hpp"

#include <cmath>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// The sum of two. The sum of the radii is rounded, which is allowed in a filter.
RoundedCore sum(RoundedCore core, const RoundedCore& other) {
  for (const auto& generator : other.generators) core.generators.push_back(generator);
  core.radius += other.radius;
  return core;
}

}  // namespace

template <int Degree>
RoundedZonotope<Degree>::RoundedZonotope(const Body& a, const Body& b, double now, double horizon)
    : RoundedZonotope(a, b, rounded_core(a.shape), rounded_core(b.shape), now, horizon) {}

/// Error bounds: the bound of QuickMotion includes an axis that is off by 4 roundings, as normals and vectors computed
/// from them are, and the place of a cell, a sum of at most nine numbers: 128 roundings are charged, of which it needs
/// 60.
template <int Degree>
RoundedZonotope<Degree>::RoundedZonotope(const Body& a, const Body& b, const RoundedCore& core_a,
                                         const RoundedCore& core_b, double now, double horizon)
    : a_(a),
      b_(b),
      core_(sum(core_a, core_b)),
      radii_{core_a.radius, core_b.radius},
      cells_({core_.generators.data(), core_.generators.size()}),
      motion_(a.motion, b.motion, now, horizon, a.shape.bounding_radius + b.shape.bounding_radius),
      hull_{0, 0} {
  const auto half_width_along = [this](const Vector3d& axis) {
    double half_width = 0;
    for (const auto& each : core_.generators) half_width += each.length * std::abs(dot(axis, each.direction));
    return half_width;
  };
  std::array<double, 3> half_width;
  for (int d = 0; d < 3; ++d) {
    const auto k = static_cast<std::size_t>(d);
    coordinates_[k] = motion_.along(Vector3d::Unit(d));
    half_width[k] = half_width_along(Vector3d::Unit(d)) + core_.radius;
    motion_.note_parting(coordinates_[k], half_width[k]);
  }
  hull_ = {0, motion_.end()};
  const auto near = [this](const Along& along, double within) {
    if (motion_.clip(along, 1, within, hull_) && motion_.clip(along, -1, within, hull_)) return true;
    apart_ = motion_.whole();
    hull_ = after_end();
    return !apart_;
  };
  for (std::size_t d = 0; d < 3; ++d) {
    if (!near(coordinates_[d], half_width[d])) return;
  }
  for (const auto& each : core_.generators) {
    along_.push_back(motion_.along(each.direction));
    if (!near(along_.back(), half_width_along(each.direction) + core_.radius)) return;
  }
  for (std::uint8_t i = 0; i < cells_.size(); ++i) {
    for (std::uint8_t j = i + 1; j < cells_.size(); ++j) {
      if (cells_.parallel(i, j)) continue;
      const Vector3d product = accurate_cross(core_.generators[i].direction, core_.generators[j].direction);
      const bool known = norm(product) >= unknown_normal;
      const Vector3d normal = known ? normalized(product) : Vector3d(Vector3d::Zero());
      faces_.push_back({{i, j}, normal, known, motion_.along(normal), half_width_along(normal)});
      if (known && !near(faces_.back().along, faces_.back().half_width + core_.radius)) return;
    }
  }
}

template <int Degree>
auto RoundedZonotope<Degree>::face(const Cell& cell) const -> const Face& {
  return *std::find_if(faces_.begin(), faces_.end(), [&](const Face& each) { return each.spanned == cell.swept; });
}

// ---- Pieces ----------------------------------------------------------------------------------------------------

template <int Degree>
RoundedZonotope<Degree>::Piece::Piece(const RoundedZonotope& pair)
    : pair_(&pair), cell_{}, solid_(true), window_(pair.hull_) {
  for (const Face& face : pair.faces_) {
    sides_.push_back({face.along, face.half_width, face.known});
    if (!face.known || !possible()) continue;
    const bool near = pair.motion_.clip(face.along, 1, face.half_width, window_) &&
                      pair.motion_.clip(face.along, -1, face.half_width, window_);
    if (!near) window_ = pair.motion_.whole() ? TimeWindow{1, 0} : pair.after_end();
  }
}

template <int Degree>
RoundedZonotope<Degree>::Piece::Piece(const RoundedZonotope& pair, const Cell& cell)
    : pair_(&pair), cell_(cell), solid_(false), distance_(pair.motion_, pair.core_.radius), window_(pair.hull_) {
  add_cell();
  const auto near = [&] {
    const Quick& motion = pair.motion_;
    const bool between = std::all_of(sides_.begin(), sides_.end(), [&](const Side& s) {
      return !s.known ||
             (motion.clip(s.along, 1, s.half_width, window_) && motion.clip(s.along, -1, s.half_width, window_));
    });
    return between && distance_.clip(window_);
  };
  if (!near()) window_ = pair.motion_.whole() ? TimeWindow{1, 0} : pair.after_end();
}

/// The sides of the cell, and the coordinates of the distance from the point, line or plane that it spans.
template <int Degree>
void RoundedZonotope<Degree>::Piece::add_cell() {
  const auto generators = pair_->cells_.generators();
  const Vector3d centre = pair_->cells_.centre(cell_);
  const auto shifted = [](Along p, double by) {
    p[0] -= by;
    return p;
  };
  if (cell_.dimension == 0) {
    for (std::size_t d = 0; d < 3; ++d) {
      distance_.add(shifted(pair_->coordinates_[d], centre[static_cast<Eigen::Index>(d)]));
    }
    return;
  }
  const auto& first = generators[cell_.swept[0]];
  if (cell_.dimension == 1) {
    const Vector3d& u = first.direction;
    const Along along = shifted(pair_->along_[cell_.swept[0]], dot(u, centre));
    const double square = squared_norm(u);
    sides_.push_back({along, first.length * square, true});
    // The part across the line.
    for (std::size_t d = 0; d < 3; ++d) {
      const auto at = static_cast<Eigen::Index>(d);
      Along y = shifted(pair_->coordinates_[d], centre[at]);
      for (std::size_t i = 0; i <= Degree; ++i) y[i] -= along[i] * u[at] / square;
      distance_.add(y);
    }
    return;
  }
  const Face& face = pair_->face(cell_);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& each = generators[cell_.swept[k]];
    Vector3d axis = Vector3d::Zero();
    if (face.known) {  // as in CellSide, where the normal is that of this one and the other, in this order
      axis = (k == 0 ? 1.0 : -1.0) * normalized(cross(face.normal, generators[cell_.swept[1 - k]].direction));
    }
    const Along along = shifted(pair_->motion_.along(axis), dot(axis, centre));
    sides_.push_back({along, each.length * std::abs(dot(axis, each.direction)), face.known});
  }
  if (face.known) distance_.add(shifted(face.along, dot(face.normal, centre)));
}

template <int Degree>
template <class Ask>
auto RoundedZonotope<Degree>::Piece::with_gap(std::size_t i, const Ask& ask) const {
  const auto& a = pair_->a_.motion;
  const auto& b = pair_->b_.motion;
  const auto generators = pair_->cells_.generators();
  if (solid_) {
    return ask(certificates::ZonotopeSide<Degree>{a, b, generators, pair_->faces_[i / 2].spanned, side(i)});
  }
  if (is_distance(i)) return ask(certificates::CellDistance<Degree>{a, b, generators, cell_, pair_->radii_});
  return ask(certificates::CellSide<Degree>{a, b, generators, cell_, i / 2, side(i)});
}

template <int Degree>
double RoundedZonotope<Degree>::Piece::failure_time(std::size_t i, double t, double horizon) const {
  return with_gap(i, [&](const auto& gap) { return kds::failure_time(gap, t, horizon); });
}

template <int Degree>
double RoundedZonotope<Degree>::Piece::recovery_time(std::size_t i, double t, double horizon) const {
  return with_gap(i, [&](const auto& gap) { return kds::recovery_time(gap, t, horizon); });
}

template <int Degree>
bool RoundedZonotope<Degree>::Piece::closed(std::size_t i, double t) const {
  return with_gap(i, [&](const auto& gap) { return sign_after(gap, t) < 0; });
}

template <int Degree>
bool RoundedZonotope<Degree>::Piece::surely_closed(std::size_t i, double t) const {
  const Quick& motion = pair_->motion_;
  const double tau = motion.tau(t);
  if (is_distance(i)) return distance_.size() > 0 && distance_.surely_closed(tau);
  const Side& s = sides_[i / 2];
  return s.known && motion.surely_closed(s.along, side(i), s.half_width, tau);
}

template <int Degree>
double RoundedZonotope<Degree>::Piece::closed_until(std::size_t i, double t) const {
  if (is_distance(i) || !sides_[i / 2].known) return t;
  const Side& s = sides_[i / 2];
  return pair_->motion_.closed_until(s.along, side(i), s.half_width, t);
}

template <int Degree>
double RoundedZonotope<Degree>::Piece::opened_by(std::size_t i) const {
  const Quick& motion = pair_->motion_;
  if (is_distance(i)) return distance_.size() > 0 ? motion.time_after(distance_.opened_by()) : never;
  const Side& s = sides_[i / 2];
  return s.known ? motion.time_after(motion.opened_by(s.along, side(i), s.half_width)) : never;
}

#define KDS_INSTANTIATE(degree) template class RoundedZonotope<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
