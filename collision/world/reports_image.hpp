// The pending reports of a world as plain data: written, read and checked.
#pragma once

#include "collision/shapes/feature.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/reports.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::collision {

namespace detail {

template <class Archive>
void archive_members(Archive& archive, detail::Pending& report) {
  archive(report.kind, report.a, report.b, report.contact.time, report.wall, report.user_data_a, report.user_data_b);
  archive(report.contact.feature_a, report.contact.feature_b);
  image::vector(archive, report.contact.point), image::vector(archive, report.contact.normal);
}

}  // namespace detail

/// Throws std::runtime_error, naming what is wrong. `bodies`: the image of a world's Bodies.
template <class BodiesImage>
void check_reports(const std::vector<Reports::Report>& pending, const BodiesImage& bodies, double now) {
  using Report = Reports::Report;
  using Kind = Reports::Kind;
  for (std::size_t i = 0; i < pending.size(); ++i) {
    const Report& event = pending[i];
    const auto need = [i](bool right, const char* what) { image::require(right, "pending", i, what); };
    need(event.kind >= Kind::rebound_suppressed && event.kind <= Kind::overlap, "is of an unknown kind");
    const bool resting = event.kind == Kind::rests || event.kind == Kind::wakes;
    need(event.wall == -1 || (resting && event.wall >= 0 && event.wall < 6), "is at no wall");
    if (event.kind == Kind::moved || event.kind == Kind::piece || event.wall >= 0) {
      const bool known = bodies.present(event.a) || (event.kind == Kind::wakes && bodies.removed(event.a)) ||
                         (event.kind == Kind::piece && bodies.there(event.a));
      need(known && event.b == event.a, "is not of a body in the world");
    } else {
      const bool itself = event.a == event.b && (event.kind == Kind::overlap || event.kind == Kind::separation);
      need(itself || event.a < event.b, "is of no pair");
      const bool of_present = bodies.present(event.a) && bodies.present(event.b);
      const auto known = [&](BodyId id) { return bodies.present(id) || bodies.removed(id); };
      need(of_present || (known(event.a) && known(event.b)), "is not of two bodies that are or were in the world");
      need(of_present || (event.kind != Kind::overlap && event.kind != Kind::rests),
           "is an overlap or a rest of a body that was removed");
    }
    const Contact& contact = event.contact;
    need(std::isfinite(contact.time) && contact.time <= now, "is of no time up to now");
    need(!contact.point.hasNaN() && !contact.normal.hasNaN(), "its point or normal is not a number");
    for (const Feature& feature : {contact.feature_a, contact.feature_b}) {
      need(feature.kind <= Feature::Kind::face, "has a feature of an unknown kind");
    }
  }
}

}  // namespace kds::collision
