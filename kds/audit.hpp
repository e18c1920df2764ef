// Audits: what a structure's own check throws when its state is not what its motions say.
#pragma once

#include <stdexcept>
#include <string>

namespace kds {

/// A structure's state contradicts its motions. The message names the structure and the slot. Since signs are exact,
/// the cause is never rounding: it is an error in the structure's code, or a motion that was changed without telling
/// the structure.
class AuditFailure : public std::logic_error {
 public:
  explicit AuditFailure(const std::string& what) : std::logic_error(what) {}
};

}  // namespace kds
