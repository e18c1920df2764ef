// The tests of pairs of shapes, as a table over the kinds of both.
#pragma once

#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/shape.hpp"

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

namespace kds::collision {

/// The tests of two shapes of given kinds. They answer as the functions of narrow_phase.hpp.
template <class Motion>
struct PairTests {
  using Body = MovingShape<Motion>;

  double (*first_contact)(const Body& a, const Body& b, double t0, double horizon, ContactMode mode, FoundTouch* found);
  /// A time in [t0, never] before which there is no contact; later than the horizon if there is none until then.
  double (*apart_until)(const Body& a, const Body& b, double t0, double horizon, PairMemory& memory);
  /// For bodies of which apart_until tells nothing at t0: the first contact (exact), or a time before which there is
  /// none. That is a time up to `farthest` that costs no more than the first contact (`never`, not exact, if there is
  /// no contact until `farthest`), or with `earlier` an earlier time that costs less. Null: as first_contact.
  ContactEstimate (*estimated_contact)(const Body& a, const Body& b, double t0, double horizon, double farthest,
                                       ContactMode mode, bool earlier);
  bool (*in_contact)(const Body& a, const Body& b, double t);
  double (*first_separation)(const Body& a, const Body& b, double t0, double horizon);
  Contact (*contact_at)(const Body& a, const Body& b, double t, const FoundTouch& found);
};

/// The tests of the kinds of two shapes.
template <class Motion>
const PairTests<Motion>& pair_tests(const PlacedShape& a, const PlacedShape& b);

#define KDS_DECLARE(motion) extern template const PairTests<motion>& pair_tests(const PlacedShape&, const PlacedShape&);
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

/// Whether tests have a function estimated_contact.
template <class Motion, class Tests>
concept estimates_contacts = requires(const MovingShape<Motion>& body) {
  Tests::estimated_contact(body, body, 0.0, 0.0, 0.0, ContactMode{}, true);
};

/// Tests, given as a struct of static functions with these names, of the same pair named the other way round.
template <class Motion, class Tests>
struct Swapped {
  using Body = MovingShape<Motion>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                              FoundTouch* found) {
    return Tests::first_contact(b, a, t0, horizon, mode, found);
  }
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory& memory) {
    return Tests::apart_until(b, a, t0, horizon, memory);
  }
  static ContactEstimate estimated_contact(const Body& a, const Body& b, double t0, double horizon, double farthest,
                                           ContactMode mode, bool earlier) requires estimates_contacts<Motion, Tests> {
    return Tests::estimated_contact(b, a, t0, horizon, farthest, mode, earlier);
  }
  static bool in_contact(const Body& a, const Body& b, double t) { return Tests::in_contact(b, a, t); }
  static double first_separation(const Body& a, const Body& b, double t0, double horizon) {
    return Tests::first_separation(b, a, t0, horizon);
  }
  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch& found) {
    Contact contact = Tests::contact_at(b, a, t, found);
    contact.normal = -contact.normal;
    std::swap(contact.feature_a, contact.feature_b);
    return contact;
  }
};

/// Some kinds of shapes.
template <class... Kinds>
struct KindList {};
template <class... A, class... B>
constexpr KindList<A..., B...> operator+(KindList<A...>, KindList<B...>) {
  return {};
}

/// Pair tests by the kinds of a and b, the places of their shapes in the list of Shape. What is added later takes the
/// place of what has been added before.
template <class Motion>
class PairTable {
 public:
  static constexpr std::size_t kinds = std::variant_size_v<Shape>;

  constexpr const PairTests<Motion>& of(std::size_t a, std::size_t b) const { return tests_[a][b]; }

  /// Adds the tests of an A with each of the Others, and of them with it.
  template <class A, class... Others, class Tests>
  constexpr void add(Tests) {
    (add_pair<A, Others, Tests>(), ...);
  }

  template <class A, class... Others, class Tests>
  constexpr void add(KindList<Others...>, Tests tests) {
    add<A, Others...>(tests);
  }
  /// Adds the tests of each kind of a list with itself and with those before it.
  template <class First, class... Others, class Tests>
  constexpr void add_among(KindList<First, Others...>, Tests tests) {
    add<First, First>(tests);
    (add_pair<Others, First, Tests>(), ...);
    if constexpr (sizeof...(Others) > 0) add_among(KindList<Others...>{}, tests);
  }

  /// Whether there are tests of a kind, with itself at least.
  constexpr bool has(std::size_t kind) const { return given_[kind][kind]; }

  /// Whether all pairs have tests.
  constexpr bool complete() const {
    for (const auto& row : given_) {
      for (const bool given : row) {
        if (!given) return false;
      }
    }
    return true;
  }

 private:
  template <class Alternative>
  static constexpr std::size_t kind_of() {
    return []<class... Each>(std::type_identity<std::variant<Each...>>) {
      std::size_t place = 0;
      bool found = false;
      ((found = found || std::is_same_v<Each, Alternative>, place += found ? 0 : 1), ...);
      return place;
    }(std::type_identity<Shape>{});
  }
  template <class Tests>
  static constexpr PairTests<Motion> functions_of() {
    PairTests<Motion> tests{Tests::first_contact, Tests::apart_until,      nullptr,
                            Tests::in_contact,    Tests::first_separation, Tests::contact_at};
    if constexpr (estimates_contacts<Motion, Tests>) tests.estimated_contact = Tests::estimated_contact;
    return tests;
  }
  template <class A, class B, class Tests>
  constexpr void add_pair() {
    tests_[kind_of<A>()][kind_of<B>()] = functions_of<Tests>();
    if (!std::is_same_v<A, B>) tests_[kind_of<B>()][kind_of<A>()] = functions_of<Swapped<Motion, Tests>>();
    given_[kind_of<A>()][kind_of<B>()] = given_[kind_of<B>()][kind_of<A>()] = true;
  }

  std::array<std::array<PairTests<Motion>, kinds>, kinds> tests_{};
  /// Which tests have been added. (With sanitizers g++ 12 does not compare a pointer to a function with null in
  /// constants.)
  std::array<std::array<bool, kinds>, kinds> given_{};
};

}  // namespace kds::collision
