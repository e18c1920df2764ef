// References that refuse temporaries.
#pragma once

namespace kds {

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

}  // namespace kds
