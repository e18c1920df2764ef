// Visitors of the bodies that a query finds.
#pragma once

#include "collision/body_id.hpp"

#include <concepts>
#include <memory>
#include <type_traits>

namespace kds::collision {

/// Any function object that takes an id or a slot. It is referred to, not copied: for function arguments only.
template <class Name>
class Visitor {
 public:
  template <class Visit>
  requires(std::invocable<Visit&, Name>&& std::is_object_v<std::remove_reference_t<Visit>> &&
           !std::same_as<std::remove_cvref_t<Visit>, Visitor>) Visitor(Visit&& visit)
      : visit_(const_cast<void*>(static_cast<const void*>(std::addressof(visit)))),
        call_([](void* object, Name body) { (*static_cast<std::remove_reference_t<Visit>*>(object))(body); }) {}

  void operator()(Name body) const { call_(visit_, body); }

 private:
  void* visit_;
  void (*call_)(void* object, Name body);
};

using BodyVisitor = Visitor<BodyId>;    ///< called by a world
using SlotVisitor = Visitor<BodySlot>;  ///< called by a broad phase

}  // namespace kds::collision
