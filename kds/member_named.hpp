// Whether a class has a member with some name, of whatever kind: tells an optional member that is missing from one that
// is declared wrongly.
#pragma once

#include <type_traits>

namespace kds::detail {
template <class T>
concept MayBeDerivedFrom = std::is_class_v<T> && !std::is_final_v<T>;
}  // namespace kds::detail

/// KDS_MEMBER_NAMED(HasX, x), in a namespace, makes HasX<T> a concept: T has or inherits a member x, of any kind,
/// private or not, overloaded or a template or switched off by a requires-clause.
///
/// A class derived from T and from another class with a member x has two of them if T has one, so that the name is
/// ambiguous. A final class cannot be derived from: in such a class only an x that is public and not overloaded is
/// found.
#define KDS_MEMBER_NAMED(Concept, member)                                                                \
  struct Concept##Decoy {                                                                                \
    int member;                                                                                          \
  };                                                                                                     \
  template <class T>                                                                                     \
  struct Concept##Mixed : T, Concept##Decoy {};                                                          \
  template <class T>                                                                                     \
  concept Concept = (::kds::detail::MayBeDerivedFrom<T> && !requires { &Concept##Mixed<T>::member; }) || \
                    (!::kds::detail::MayBeDerivedFrom<T> && requires { &T::member; })
