// The names of bodies: ids, which callers hold, and slots, by which the inside of a world knows them.
#pragma once

#include <bit>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <type_traits>

namespace kds::collision {

/// Where a body is kept: the number by which broad phases, pairs and queues know it. When the body has been removed,
/// another may get its slot.
using BodySlot = std::uint32_t;

/// The slot of no body.
inline constexpr BodySlot no_body = ~BodySlot{0};

/// The name of a body, which no other body of its world ever gets: its slot, and its generation, which is how many
/// bodies were removed from that slot before it.
///
/// It is the number generation * 2^32 + slot, so that bodies are 0, 1, 2, ... as long as none has been removed, and may
/// be used as that number. But it is told apart from slots: the one becomes the other only where that is written down.
class BodyId {
 public:
  constexpr BodyId() = default;
  template <std::integral Number>
  constexpr explicit(std::same_as<Number, BodySlot>) BodyId(Number number)
      : number_(static_cast<std::uint64_t>(number)) {}
  constexpr BodyId(std::uint32_t generation, BodySlot slot) : number_(std::uint64_t{generation} << 32 | slot) {}

  constexpr BodySlot slot() const { return static_cast<BodySlot>(number_); }
  constexpr std::uint32_t generation() const { return static_cast<std::uint32_t>(number_ >> 32); }
  /// Ids in the order in which events of one time are told: by slot, and of one slot by generation.
  constexpr std::uint64_t rank() const { return std::rotl(number_, 32); }

  template <std::same_as<std::uint64_t> Number>
  constexpr operator Number() const {
    return number_;
  }
  /// As another number, which may not hold all of it: where that is written down.
  template <class Number>
  requires(std::is_arithmetic_v<Number> && !std::same_as<Number, std::uint64_t> &&
           !std::same_as<Number, bool>) constexpr explicit
  operator Number() const {
    return static_cast<Number>(number_);
  }

  constexpr BodyId& operator++() {
    ++number_;
    return *this;
  }

  template <std::integral Number>
  friend constexpr BodyId operator+(BodyId a, Number b) {
    return a.number_ + static_cast<std::uint64_t>(b);
  }
  template <std::integral Number>
  friend constexpr BodyId operator-(BodyId a, Number b) {
    return a.number_ - static_cast<std::uint64_t>(b);
  }

  friend constexpr bool operator==(BodyId a, BodyId b) { return a.number_ == b.number_; }
  friend constexpr std::strong_ordering operator<=>(BodyId a, BodyId b) { return a.number_ <=> b.number_; }
  template <std::integral Number>
  friend constexpr bool operator==(BodyId a, Number b) {
    return a.number_ == static_cast<std::uint64_t>(b);
  }
  template <std::integral Number>
  friend constexpr std::strong_ordering operator<=>(BodyId a, Number b) {
    return a.number_ <=> static_cast<std::uint64_t>(b);
  }

 private:
  std::uint64_t number_ = 0;
};

}  // namespace kds::collision

template <>
struct std::hash<kds::collision::BodyId> {
  std::size_t operator()(kds::collision::BodyId id) const noexcept { return std::hash<std::uint64_t>()(id); }
};
