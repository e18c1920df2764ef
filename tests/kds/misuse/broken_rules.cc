// Rules from which one part each is missing: they must not compile, and the compiler must say what is missing.
#include "kds/framework/kinetic.hpp"
#include "kds/framework/snapshot.hpp"

#include <optional>
#include <string>
#include <vector>

namespace misuse {

using namespace kds;
using Value = Motion<1>;

/// Complete, and of no use: the other rules are this one without a part.
struct Base {
  using Element = Value;
  static constexpr const char* name = "Base";
  std::optional<PolynomialCertificate<1>> certificate(Slot, const MovingSet<Value>&) const { return {}; }
  std::vector<Id> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Value>&) { return Effect::internal; }
  void insert(Id, Repair<Value>&) {}
  void remove(Id, Repair<Value>&) {}
};
static_assert(KineticRule<Base>);

struct WithoutElement {};
struct WithoutName : Base {
  struct name;
};
struct WithoutCertificate : Base {
  int certificate(Slot, const MovingSet<Value>&) const { return 3; }
};
struct WithoutMembers : Base {
  void members(Slot) const {}
};
struct WithoutRepair : Base {
  void repair(Slot, Repair<Value>&) {}
};
struct WithoutRemove : Base {
  void remove() {}
};
/// change() is what it is to be taken up by.
struct KeepsOnly : Base {
  bool keeps(Id, const Value&, Repair<Value>&) { return true; }
};
struct KeepsAndChanges : KeepsOnly {
  void change(Id, Repair<Value>&) {}
};
static_assert(KineticRule<KeepsAndChanges>);
static_assert(!KineticRule<WithoutElement> && !KineticRule<WithoutName> && !KineticRule<WithoutCertificate> &&
              !KineticRule<WithoutMembers> && !KineticRule<WithoutRepair> && !KineticRule<WithoutRemove> &&
              !KineticRule<KeepsOnly>);

template <class Rule>
using With = Kinetic<Rule>;
constexpr std::size_t sizes[] = {sizeof(With<WithoutElement>),     sizeof(With<WithoutName>),   sizeof(With<WithoutCertificate>),
                                 sizeof(With<WithoutMembers>),     sizeof(With<WithoutRepair>), sizeof(With<WithoutRemove>),
                                 sizeof(With<KeepsOnly>),
                                 sizeof(Kinetic<Base, NoListener, DefaultEventQueue, int>)};

struct Unsaved {
  std::string* text;
  std::optional<std::string> name;
};
Snapshot snapshot(Unsaved& part) {
  detail::Writer writer;
  writer(part);
  return {};
}

}  // namespace misuse
