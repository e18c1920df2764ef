// References that refuse temporaries.
#pragma once

#include <type_traits>

namespace kds {

/// A type whose objects refer to something that lasts, and so may be copied in place of being referred to: a copy of a
/// moving point that is displaced (PathCopy). It says so by `static constexpr bool refers = true`.
template <class T>
concept Refers = requires {
  requires std::is_same_v<decltype(T::refers), const bool>;
  requires T::refers;
};

/// What a certificate keeps of a thing that moves.
template <class T>
using Held = std::conditional_t<Refers<T>, T, const T&>;

/// The type of a parameter that is kept as a reference: takes an lvalue, and refuses a temporary, which would be gone
/// when the reference is used. The certificates of values and points of the plane take motions so:
/// Order{x.axis(0), y.axis(0)} does not compile if axis() gives a value.
template <class T>
class Lasting {
 public:
  constexpr Lasting(const T& referred) : referred_(referred) {}  // implicit, as the conversion back
  Lasting(const T&& temporary) = delete;
  constexpr operator const T&() const { return referred_; }

 private:
  const T& referred_;
};

template <Refers T>
class Lasting<T> {
 public:
  constexpr Lasting(const T& referring) : referring_(referring) {}
  constexpr operator const T&() const { return referring_; }

 private:
  T referring_;
};

/// Whether two things that certificates keep are one: at the same address, or equal if they refer.
template <class T>
bool is_same_thing(const T& a, const T& b) {
  if constexpr (Refers<T>) {
    return a == b;
  } else {
    return &a == &b;
  }
}

}  // namespace kds
