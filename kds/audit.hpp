// Audits: what a structure's own check throws when its state is not what its motions say.
#pragma once

#include <stdexcept>
#include <string>

namespace kds {

/// A structure's state contradicts its motions. The message names the structure and the slot. Exact signs make this
/// a programming error in the structure or a motion changed behind its back, never rounding.
class AuditFailure : public std::logic_error {
 public:
  explicit AuditFailure(const std::string& what) : std::logic_error(what) {}
};

}  // namespace kds
