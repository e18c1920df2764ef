// Who is told of the bodies that a question names.
#pragma once

#include "collision/broad_phase/kinetic_box.hpp"

#include <concepts>
#include <memory>
#include <type_traits>

namespace kds::collision {

/// Any function object that takes a BodySlot. It is referred to, not copied: for arguments of functions alone.
class BodyVisitor {
 public:
  template <class Visit>
  requires(std::invocable<Visit&, BodySlot>&& std::is_object_v<std::remove_reference_t<Visit>> &&
           !std::same_as<std::remove_cvref_t<Visit>, BodyVisitor>) BodyVisitor(Visit&& visit)
      : visit_(const_cast<void*>(static_cast<const void*>(std::addressof(visit)))),
        call_([](void* object, BodySlot id) { (*static_cast<std::remove_reference_t<Visit>*>(object))(id); }) {}

  void operator()(BodySlot id) const { call_(visit_, id); }

 private:
  void* visit_;
  void (*call_)(void* object, BodySlot id);
};

}  // namespace kds::collision
