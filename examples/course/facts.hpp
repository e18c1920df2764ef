// Certificates in words, with their failure times: what a page lists beside the picture.
#pragma once

#include "certificates/direction_order.hpp"
#include "certificates/in_circle.hpp"
#include "certificates/in_order.hpp"
#include "certificates/in_sphere.hpp"
#include "certificates/order.hpp"
#include "certificates/orientation.hpp"
#include "certificates/space_orientation.hpp"
#include "examples/course/page.hpp"
#include "kds/framework/kinetic_rule.hpp"
#include "kds/roots/failure_time.hpp"

#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace kds::course {

/// The fact of a certificate in words. One overload for each kind in the library; your own certificate may have a
/// function fact(certificate, name) beside it, where name(element) gives the element's name; otherwise the names of its
/// members are shown.
template <class Element>
class Facts {
 public:
  Facts(const Page& page, const MovingSet<Element>& elements, std::vector<Id> members)
      : page_(page), elements_(elements), members_(std::move(members)) {}

  /// The fact of a certificate whose elements are among the members.
  template <int Degree>
  Held of(const certificates::Order<Degree>& c) const {
    return {.fact = name(c.lower) + " \u2264 " + name(c.upper),
            .members = {id(c.lower), id(c.upper)},
            .function = name(c.upper) + "(t) \u2212 " + name(c.lower) + "(t)"};
  }
  template <class Path>
  Held of(const certificates::Orientation<Path>& c) const {
    return {name(c.a) + ", " + name(c.b) + ", " + name(c.c) + " turn left", {id(c.a), id(c.b), id(c.c)}};
  }
  template <class Path>
  Held of(const certificates::InCircle<Path>& c) const {
    return {name(c.d) + " is not in the circle " + name(c.a) + ", " + name(c.b) + ", " + name(c.c),
            {id(c.a), id(c.b), id(c.c), id(c.d)}};
  }
  template <class Path>
  Held of(const certificates::InSphere<Path>& c) const {
    return {name(c.e) + " is not in the sphere " + name(c.a) + ", " + name(c.b) + ", " + name(c.c) + ", " + name(c.d),
            {id(c.a), id(c.b), id(c.c), id(c.d), id(c.e)}};
  }
  template <class Path>
  Held of(const certificates::SpaceOrientation<Path>& c) const {
    return {name(c.a) + ", " + name(c.b) + ", " + name(c.c) + ", " + name(c.d) + " have a positive volume",
            {id(c.a), id(c.b), id(c.c), id(c.d)}};
  }
  template <class Path>
  Held of(const certificates::NormalDirection<Path>& c) const {
    return {name(c.a) + ", " + name(c.b) + ", " + name(c.c) + " face the way they do", {id(c.a), id(c.b), id(c.c)}};
  }
  template <class Path, std::size_t Dimension>
  Held of(const certificates::DirectionOrder<Path, Dimension>& c) const {
    const std::string where = c.direction[0] != 0 ? " is not right of " : " is not above ";
    return {name(c.lower) + where + name(c.upper), {id(c.lower), id(c.upper)}};
  }
  template <class Value>
  Held of(const certificates::Ascending<Value>& c) const {
    return {name(c.lower) + " \u2264 " + name(c.upper), {id(c.lower), id(c.upper)}};
  }
  template <class Other>
  Held of(const Other& c) const {
    const auto called = [this](const Element& element) { return name(element); };
    if constexpr (requires { fact(c, called); }) return {fact(c, called), members_};
    std::string all;
    for (const Id id : members_) all += (all.empty() ? "" : ", ") + page_.name(id);
    return {all, members_};
  }

 private:
  /// Finds an element's name by its address: certificates refer to their elements.
  Id id(const Element& element) const {
    for (const Id id : members_) {
      if (&elements_[id] == &element) return id;
    }
    return nobody;
  }
  const std::string& name(const Element& element) const { return page_.name(id(element)); }

  const Page& page_;
  const MovingSet<Element>& elements_;
  std::vector<Id> members_;
};

/// A certificate that fails at a time, in your own words, with its polynomial in the time since `begin`.
template <class Certificate>
Held held(std::string fact, std::vector<Id> members, const Certificate& certificate, double fails, double begin,
          std::string function = {}) {
  Held held{std::move(fact), std::move(members), fails, std::move(function), {}};
  const auto polynomial = certificate.template polynomial<double>(begin);
  held.polynomial.assign(polynomial.c.begin(), polynomial.c.end());
  return held;
}

/// The certificates of a rule in the slots below `end`, and when each fails if nothing happens before.
template <class Rule>
std::vector<Held> certificates_of(const Rule& rule, Slot end, const MovingSet<typename Rule::Element>& elements,
                                  double now, const Page& page) {
  std::vector<Held> all;
  for (Slot slot = 0; slot < end; ++slot) {
    detail::with_certificate(rule.certificate(slot, elements), [&](const auto& certificate) {
      const auto members = rule.members(slot);
      const Facts<typename Rule::Element> facts(page, elements, {std::begin(members), std::end(members)});
      Held fact = facts.of(certificate);
      fact.fails = failure_time(certificate, now);
      if constexpr (requires { certificate.template polynomial<double>(now); }) {
        fact = held(fact.fact, fact.members, certificate, fact.fails, page.begin(), fact.function);
      }
      all.push_back(std::move(fact));
    });
  }
  return all;
}

}  // namespace kds::course
