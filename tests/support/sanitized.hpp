// Whether this is compiled under the address sanitizer. It looks at addresses and lifetimes, which do not depend on the
// numbers that a random test draws as its results do, and it makes each round some ten times as long: so tests whose
// rounds differ in their numbers alone do fewer of them, and those that are made for many degrees are for fewer.
#pragma once

#if defined(__SANITIZE_ADDRESS__)
#define KDS_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define KDS_SANITIZED 1
#endif
#endif
#if !defined(KDS_SANITIZED)
#define KDS_SANITIZED 0
#endif

namespace kds::tests {

/// So many rounds: all, or the few that sanitizers look at. At least one.
constexpr int rounds_here(int all) { return KDS_SANITIZED ? (all + 4) / 5 : all; }

}  // namespace kds::tests
