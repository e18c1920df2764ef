// What really happens in a scene, and how well a list of reports tells it.
#pragma once

#include "collision/world.hpp"
#include "tests/benchmarks/accuracy/static_tests.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace accuracy {

using kds::collision::BodyId;

/// "a and b are in contact": what a sampler says at a sample, the engine at the time itself.
struct Report {
  BodyId a, b;
  double time;
};

/// a and b penetrate just after begin until end.
struct TrueContact {
  BodyId a, b;
  double begin;
  double end = std::numeric_limits<double>::infinity();
  Vector3d normal;  ///< at begin

  friend bool operator==(const TrueContact& x, const TrueContact& y) {
    return x.a == y.a && x.b == y.b && x.begin == y.begin && x.end == y.end;
  }
};

/// Writes contacts down.
template <int Degree>
class ContactList final : public kds::collision::WorldListener<Degree> {
 public:
  using World = kds::collision::World<Degree>;
  using PairEvent = kds::collision::PairEvent;

  std::vector<TrueContact> contacts;

  void contact(World&, const PairEvent& e) override { begin(e); }
  void overlap(World&, const PairEvent& e) override { begin(e); }  // at the start
  void separation(World&, const PairEvent& e) override {
    const auto it = open_.find({e.a, e.b});
    contacts[it->second].end = e.contact.time;
    open_.erase(it);
  }

 private:
  void begin(const PairEvent& e) {
    contacts.push_back({e.a, e.b, e.contact.time, std::numeric_limits<double>::infinity(), e.contact.normal});
    open_[{e.a, e.b}] = contacts.size() - 1;
  }

  std::map<std::pair<BodyId, BodyId>, std::size_t> open_;
};

/// How a list of reports compares with the truth. Times in s, depths in units of length.
struct Errors {
  std::size_t contacts = 0;
  std::size_t missed = 0;
  std::size_t phantom = 0;  ///< reports where nothing touches
  double time_mean = 0, time_p99 = 0, time_max = 0;
  double depth_mean = 0, depth_max = 0;
};

/// Reports of contacts that are none are counted, but for those within a rounding of an end of one.
template <int Degree>
Errors compare(const std::vector<TrueContact>& truth, const std::vector<Report>& reports,
               const std::vector<PlacedShape>& shapes,
               const std::vector<kds::certificates::PointMotion<Degree>>& motions) {
  constexpr double rounding = 1e-9;  // s; far above what rounding makes of times of seconds, far below any sample
  std::map<std::pair<BodyId, BodyId>, std::vector<std::size_t>> by_pair;
  for (std::size_t i = 0; i < truth.size(); ++i) by_pair[{truth[i].a, truth[i].b}].push_back(i);
  std::vector<bool> found(truth.size());
  std::vector<double> late, depths;
  Errors errors;
  errors.contacts = truth.size();
  for (const Report& report : reports) {
    bool matched = false;
    for (const std::size_t i : by_pair[{report.a, report.b}]) {
      const TrueContact& contact = truth[i];
      if (report.time < contact.begin - rounding || report.time > contact.end + rounding) continue;
      matched = true;
      if (found[i]) continue;
      found[i] = true;
      late.push_back(std::abs(report.time - contact.begin));
      const auto place = [&](double t) -> Vector3d {
        return motions[report.b].position(t) - motions[report.a].position(t);
      };
      const bool mesh = std::holds_alternative<kds::collision::MeshShape>(shapes[report.a].shape);
      // Of surfaces: how far they have gone into each other along the normal since they touched.
      depths.push_back(mesh ? contact.normal.dot(place(contact.begin) - place(report.time))
                            : depth(shapes[report.a], shapes[report.b], place(report.time)));
    }
    errors.phantom += !matched;
  }
  errors.missed = truth.size() - late.size();
  if (late.empty()) return errors;
  std::sort(late.begin(), late.end());
  for (const double x : late) errors.time_mean += x / static_cast<double>(late.size());
  errors.time_p99 = late[(late.size() * 99 - 1) / 100];
  errors.time_max = late.back();
  for (const double x : depths) {
    errors.depth_mean += std::max(x, 0.0) / static_cast<double>(depths.size());
    errors.depth_max = std::max(errors.depth_max, x);
  }
  return errors;
}

}  // namespace accuracy
