#include "tests/fuzz/random_piles/meter.hpp"

#include <algorithm>
#include <cmath>

namespace kds::piles {

using Eigen::Vector3d;

namespace {

/// With so many bodies or fewer, all pairs are measured at each event.
constexpr std::size_t few = 8;
/// A gain of energy lasts if it does for so many times sqrt(size / acceleration): two spans of clusters.
constexpr double lasting_gain = 0x1p-3;
/// Bodies that begin deeper in each other than this part of the smaller radius are not measured. Those that touch
/// exactly may begin in overlap by a rounding.
constexpr double begins_apart = 1e-12;

}  // namespace

Meter::Meter(const Scene& scene, Result& result) : scene_(scene), result_(result) {
  for (const Description& body : scene.bodies) {
    solids_.emplace_back(collision::place(body.shape, body.orientation));
    places.push_back(body.motion.front().position(0));
    velocities.push_back(body.motion.front().velocity(0));
    if (!body.fixed) free_.push_back(solids_.size() - 1);
  }
  touched_.assign(solids_.size(), 0);
  left_.assign(solids_.size(), 0);
  const std::size_t n = solids_.size();
  skipped_.assign(n * n, 0);
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      skipped_[a * n + b] = a == b || (scene.bodies[a].fixed && scene.bodies[b].fixed) ||
                            depth(solids_[a], places[a], solids_[b], places[b]) > begins_apart * smaller(a, b);
    }
  }
  make_scales();
}

void Meter::touch(std::size_t i) {
  if (scene_.bodies[i].fixed || touched_[i]) return;
  touched_[i] = 1;
  list_.push_back(i);
}

void Meter::look_at_touched(double now) {
  if (solids_.size() <= few) return look_at_all(now);
  for (const std::size_t i : list_) {
    look_at(i, 0, now);
    touched_[i] = 0;
  }
  if (!list_.empty()) look_at_sums(now);
  list_.clear();
}

void Meter::look_at_all(double now) {
  for (const std::size_t i : free_) look_at(i, i, now);
  for (const std::size_t i : list_) touched_[i] = 0;
  list_.clear();
  look_at_sums(now);
}

double Meter::kinetic() const {
  double sum = 0;
  for (const std::size_t i : free_) sum += 0.5 * scene_.bodies[i].mass * velocities[i].squaredNorm();
  return sum / scale_;
}

void Meter::find(const char* what, double now, double amount, const std::string& text) {
  for (Finding& finding : result_.findings) {
    if (finding.what != what) continue;
    finding.worst = std::max(finding.worst, amount);
    return;
  }
  result_.findings.push_back({what, now, amount, text});
}

double Meter::smaller(std::size_t a, std::size_t b) const {
  return std::min(solids_[a].shape.bounding_radius, solids_[b].shape.bounding_radius);
}

/// One body, with all fixed ones and the free ones that come after `after` (all of them if it is 0).
void Meter::look_at(std::size_t i, std::size_t after, double now) {
  const std::size_t n = solids_.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (skipped_[i * n + k] || (k < after && !scene_.bodies[k].fixed)) continue;
    const double deep = depth(solids_[i], places[i], solids_[k], places[k]) / smaller(i, k);
    result_.overlap = std::max(result_.overlap, deep);
    if (deep > deepest_overlap) {
      find("overlap", now, deep, "bodies " + std::to_string(i) + " and " + std::to_string(k));
    }
  }
  look_outside(i, now);
}

void Meter::look_outside(std::size_t i, double now) {
  const double radius = solids_[i].shape.bounding_radius;
  const Vector3d& place = places[i];
  double out = 0;
  if (scene_.walls) {
    out = std::max((scene_.walls->min - place).maxCoeff() + radius, (place - scene_.walls->max).maxCoeff() + radius);
    result_.overlap = std::max(result_.overlap, out / radius);
  } else if (scene_.region) {
    left_[i] = left_[i] || place[1] > scene_.region->max[1];
    if (!left_[i]) out = std::max((scene_.region->min - place).maxCoeff(), (place - scene_.region->max).maxCoeff());
  }
  if (out > deepest_overlap * radius) find("outside", now, out / radius, "body " + std::to_string(i));
}

void Meter::look_at_sums(double now) {
  if (!scene_.driven()) {
    const double gain = gained_for_good(now, energy()) / scale_;
    result_.energy = std::max(result_.energy, gain);
    if (gain > greatest_gain) find("energy", now, gain, "");
  }
  if (scene_.isolated()) {
    const double change = (momentum() - momentum_).norm() / momenta_;
    if (change > greatest_change_of_momentum) find("momentum", now, change, "");
  }
}

double Meter::energy() const {
  double sum = 0;
  for (const std::size_t i : free_) {
    sum += scene_.bodies[i].mass * (0.5 * velocities[i].squaredNorm() - scene_.gravity.dot(places[i]));
  }
  return sum;
}

Vector3d Meter::momentum() const {
  Vector3d sum = Vector3d::Zero();
  for (const std::size_t i : free_) sum += scene_.bodies[i].mass * velocities[i];
  return sum;
}

/// By how much the least energy of the last few spans is more than the least before. Within a span of a cluster energy
/// comes and goes, since a parabola is not an arc (docs/resting.md).
double Meter::gained_for_good(double now, double energy) {
  while (!recent_.empty() && recent_.back().energy >= energy) recent_.pop_back();
  recent_.push_back({now, energy});
  for (; recent_.front().time < now - lasting_; recent_.pop_front()) {
    least_energy_ = std::min(least_energy_, recent_.front().energy);
  }
  return recent_.front().energy - least_energy_;
}

/// The energy at the start, over that at the lowest place of a free body, less its radius.
void Meter::make_scales() {
  const double g = scene_.gravity.norm();
  double low = std::numeric_limits<double>::infinity();
  for (const std::size_t i : free_) {
    if (g > 0) low = std::min(low, -scene_.gravity.dot(places[i]) - g * solids_[i].shape.bounding_radius);
  }
  for (const std::size_t i : free_) {
    const double mass = scene_.bodies[i].mass;
    const Vector3d& velocity = scene_.bodies[i].motion.front().coefficients[1];
    scale_ += mass * 0.5 * velocity.squaredNorm();
    if (g > 0) scale_ += mass * (-scene_.gravity.dot(places[i]) - low);
    momentum_ += mass * velocity;
    momenta_ += mass * velocity.norm();
  }
  double size = 0;
  for (const std::size_t i : free_) size = std::max(size, solids_[i].shape.bounding_radius);
  if (g > 0) lasting_ = lasting_gain * std::sqrt(size / g);
  if (!(scale_ > 0)) scale_ = 1;
  if (!(momenta_ > 0)) momenta_ = 1;
}

}  // namespace kds::piles
