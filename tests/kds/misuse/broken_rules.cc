// Rules from which one part each is missing: they must not compile, and the compiler must say what is missing.
#include "kds/framework/kinetic.hpp"
#include "kds/framework/snapshot.hpp"

#include <concepts>
#include <optional>
#include <span>
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
struct Archived : Base {
  void archive(int) {}
};
static_assert(KineticRule<KeepsAndChanges> && ChoosesMotions<KeepsAndChanges>);
static_assert(!KineticRule<WithoutElement> && !KineticRule<WithoutName> && !KineticRule<WithoutCertificate> &&
              !KineticRule<WithoutMembers> && !KineticRule<WithoutRepair> && !KineticRule<WithoutRemove>);

// Optional parts that are there, but would never be called.
struct ChangesLate : Base {
  void change(Id, Repair<Value>&, double) {}
};
struct KeepsUnknown : KeepsAndChanges {
  int keeps(Id, const Value&, Repair<Value>&) { return 2; }
};
struct BuildsForItself : Base {
 private:
  void build(Repair<Value>&) {}
};
struct AuditsByChanging : Base {
  void audit(const MovingSet<Value>&, double) {}
};

// Certificates that are none.
template <class Certificate>
struct Certified : Base {
  Certificate certificate(Slot, const MovingSet<Value>&) const { return {}; }
};
struct WithoutDegree {
  template <class Number>
  Polynomial<1, Number> polynomial(double) const {
    return {};
  }
};
struct InDoubles {
  static constexpr int degree = 1;
  Polynomial<1> polynomial(double) const { return {}; }
};
struct OfAnotherDegree : WithoutDegree {
  static constexpr int degree = 2;
};

/// Of a copy all marks would be lost.
struct RepairsACopy : Base {
  Effect repair(Slot, Repair<Value>) { return Effect::internal; }
};
static_assert(!KineticRule<RepairsACopy>);

// Rules on rules.
struct Silent : StandsOn<Base> {
  static constexpr const char* name = "Silent";
  std::optional<PolynomialCertificate<1>> certificate(Slot, const MovingSet<Value>&) const { return {}; }
  std::vector<Id> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Value>&) { return Effect::internal; }
};
struct Reports : Base {
  using Change = int;
};
struct Deaf : StandsOn<Reports> {
  static constexpr const char* name = "Deaf";
  std::optional<PolynomialCertificate<1>> certificate(Slot, const MovingSet<Value>&) const { return {}; }
  std::vector<Id> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Value>&) { return Effect::internal; }
  void follow(std::span<const int>, Repair<Value>&) {}
};
struct HearsOfOthers : StandsOn<Telling<Reports, float>> {
  static constexpr const char* name = "HearsOfOthers";
  std::optional<PolynomialCertificate<1>> certificate(Slot, const MovingSet<Value>&) const { return {}; }
  std::vector<Id> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Value>&) { return Effect::internal; }
  Effect follow(std::span<const float>, Repair<Value>&) { return Effect::internal; }
};

/// Follows one of the two that it stands on.
struct HalfDeaf : StandsOn<Reports, Reports> {
  static constexpr const char* name = "HalfDeaf";
  std::optional<PolynomialCertificate<1>> certificate(Slot, const MovingSet<Value>&) const { return {}; }
  std::vector<Id> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Value>&) { return Effect::internal; }
  Effect follow(From<1>, std::span<const int>, Repair<Value>&) { return Effect::internal; }
};
struct FollowsBoth : HalfDeaf {
  using HalfDeaf::follow;
  Effect follow(From<0>, std::span<const int>, Repair<Value>&) { return Effect::internal; }
};
static_assert(!KineticRule<HalfDeaf> && KineticRule<FollowsBoth>);
struct FollowedForNothing : FollowsBoth {
  void followed(Repair<Value>&) {}
};

template <class Rule>
using With = Kinetic<Rule>;
constexpr std::size_t sizes[] = {sizeof(With<WithoutElement>),   sizeof(With<WithoutName>),
                                 sizeof(With<WithoutCertificate>), sizeof(With<WithoutMembers>),
                                 sizeof(With<WithoutRepair>),    sizeof(With<WithoutRemove>),
                                 sizeof(With<KeepsOnly>),        sizeof(With<ChangesLate>),
                                 sizeof(With<KeepsUnknown>),     sizeof(With<BuildsForItself>),
                                 sizeof(With<AuditsByChanging>), sizeof(With<KeepsAndChanges>),
                                 sizeof(With<Certified<WithoutDegree>>),
                                 sizeof(With<Certified<std::optional<InDoubles>>>),
                                 sizeof(With<Certified<OfAnotherDegree>>),
                                 sizeof(With<RepairsACopy>),     sizeof(With<Silent>),
                                 sizeof(With<Deaf>),             sizeof(With<Reports>),
                                 sizeof(With<HearsOfOthers>),    sizeof(With<HalfDeaf>),
                                 sizeof(With<FollowedForNothing>),
                                 sizeof(Kinetic<Base, NoListener, DefaultEventQueue, int>)};

struct LateSolver : CertifiedSolver {
  template <class C>
  double after_turn(const C&, double) const {
    return never;
  }
};
struct SometimesSampled : Value {
  bool sampled = true;
};
bool is_finite(const SometimesSampled&) { return true; }
struct MovesByNumber : Bounded {
  static constexpr int moves = 1;
};

void parts(Schedule<DefaultEventQueue, LateSolver>& schedule, Kinetic<Archived>& structure) {
  schedule.certify_turned(0, PolynomialCertificate<1>{}, 0);
  detail::Writer writer;
  structure.archive(writer);
  MovingSet<SometimesSampled> sometimes;
  MovingSet<MovesByNumber> moving;
}

double time_of_high_degree() { return failure_time(PolynomialCertificate<32>{}, 0, 1); }

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
