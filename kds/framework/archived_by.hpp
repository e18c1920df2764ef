// The concept of a type that can be saved and loaded.
#pragma once

#include "kds/member_named.hpp"

#include <concepts>

namespace kds {

/// `template <class Archive> void archive(Archive& archive)`: name the members, archive(a_, b_); see save() in
/// snapshot.hpp. `Archive::loading` tells which way they go.
template <class T, class Archive>
concept ArchivedBy = requires(T& value, Archive& archive) {
  { value.archive(archive) } -> std::same_as<void>;
};

namespace detail {
KDS_MEMBER_NAMED(NamesArchive, archive);
}

}  // namespace kds
