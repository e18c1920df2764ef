// What a query of a world finds.
#pragma once

#include "collision/body_id.hpp"
#include "collision/narrow_phase/contact.hpp"

#include <functional>

namespace kds::collision {

/// A body, and where and when what is cast meets it. The normal points from what is cast to the body, and feature_a is
/// of what is cast.
struct Hit {
  BodyId body{};
  Contact contact;
};

/// Whether a query is to look at a body. Empty: at all. It may ask the world, but must not change it: a body that it
/// removes may be looked at after that, which throws std::out_of_range.
using BodyFilter = std::function<bool(BodyId)>;

namespace detail {

inline bool accepts(const BodyFilter& filter, BodyId body) { return !filter || filter(body); }

/// By time, and bodies that are hit at the same time by the order in which they were added.
inline bool sooner(const Hit& a, const Hit& b) {
  if (a.contact.time != b.contact.time) return a.contact.time < b.contact.time;
  return a.body < b.body;
}

}  // namespace detail

}  // namespace kds::collision
