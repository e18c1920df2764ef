// A world that is run as several, each for a part of the scene, by several threads.
#pragma once

#include "collision/motions.hpp"
#include "collision/parallel/parallel_options.hpp"
#include "collision/parallel/processes.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

namespace kds::collision {

/// Told of the events of a ParallelWorld: those of a WorldListener that are about contacts, in the same order. Of the
/// functions of the world that is telling it, it may call change() alone.
class ParallelListener {
 public:
  virtual ~ParallelListener() = default;
  virtual void contact(const PairEvent&) {}
  virtual void separation(const PairEvent&) {}
  virtual void overlap(const PairEvent&) {}
  virtual void wall(const WallEvent&) {}
  virtual void timer(TimerId, double /*time*/) {}  ///< a timer that was set in whole() has rung
  virtual void rebound_suppressed(const PairEvent&) {}
  virtual void rebound_suppressed_at_wall(const WallEvent&) {}
  virtual void rests(const PairEvent&) {}
  virtual void rests_at_wall(const WallEvent&) {}
  virtual void wakes(const PairEvent&) {}
  virtual void wakes_at_wall(const WallEvent&) {}
  virtual void passes(const PairEvent&) {}
};

/// A world of many bodies, divided into domains: cells of space, each with a world of its own that knows the bodies in
/// the cell and copies of those near it. The domains run a *window* of time by themselves, in as many threads as there
/// are; then it is seen whether what each has computed of the bodies in its cell is what happens in the whole scene.
/// The events are those of a World with the same bodies, in the same order, the same bits, whatever the number of
/// threads and domains and the lengths of windows: docs/parallel.md has the laws and why they hold.
///
/// Scenes that cannot be divided are run as one world, as long as that is so: few bodies; bodies that turn come to
/// rest; others lean on each other in an island that reaches far out of a cell; box functions; response `callback`
/// without WorldOptions::law; reports of pairs or of pieces.
///
/// What this costs is in docs/parallel.md.
///
/// Cost: copies are (1 + 2 halo / size of a cell)^3 - 1 of the bodies, and all they do is computed twice. Memory for
/// the worlds of all domains, and some 200 bytes more for each body. Of several processes each has that of its own
/// domains and of the bodies that these know.
template <class BodyMotionType>
class BasicParallelWorld final {
 public:
  using Motion = BodyMotionType;
  using World = BasicWorld<Motion>;
  using Description = BasicBodyDescription<Motion>;

  /// Throws what validate() and the constructor of World throw. WorldOptions::threads counts where the scene is run as
  /// one world. The listener and the processes, if there are any, must outlive this.
  ///
  /// `processes`: if not null, they run the scene together. Each constructs a world with the same options, adds the
  /// same bodies (or its share of them, add_shares()), and makes the same calls of functions that are not const, and
  /// each runs some of the domains. The listener of process 0 is told of all events, and others are not told, unless
  /// ParallelOptions::steps takes them in each process. A process in which something is thrown leaves the others
  /// waiting: who calls has to end them (MPI_Abort).
  explicit BasicParallelWorld(const WorldOptions& options, const ParallelOptions& parallel = {},
                              ParallelListener* listener = nullptr, Processes* processes = nullptr);
  ~BasicParallelWorld();
  BasicParallelWorld(const BasicParallelWorld&) = delete;
  BasicParallelWorld& operator=(const BasicParallelWorld&) = delete;

  /// As of a World.
  BodyId add_body(const Description& description) { return whole().add_body(description); }
  void reserve(std::size_t bodies) { whole().reserve(bodies); }
  /// The same where each process adds some bodies alone, `body(0)` to `body(count - 1)`: those of process 0 are the
  /// first of the scene, then come those of process 1, and so on; so ids are as if one had added all. No process has
  /// all bodies in memory then, until the scene is run as one world or whole() is called. All processes call it, once,
  /// before there are any bodies; else throws std::logic_error. Throws as add_body() and, naming the body,
  /// std::invalid_argument for one that has a box function or is attached to another.
  void add_shares(std::size_t count, const std::function<Description(std::size_t)>& body);

  /// The scene as one world, at now(): for all changes, queries, audits and snapshots. It must not be advanced, and is
  /// valid until the next advance_to(). Costs, after an advance_to(), what adding all bodies costs; each of several
  /// processes has all of them in memory then.
  World& whole();

  /// Processes everything up to and including t. Throws as World::advance_to(), and std::logic_error if called from
  /// within a callback. If a listener throws, its event counts as told, and the next call goes on with the next one;
  /// until then no other function that is not const may be called.
  void advance_to(double t);

  /// From within a callback: `change` is called with the whole world when the callback returns, at the time of the
  /// event that is being told, and may do what a callback of a World may do. So the events are those of a World whose
  /// listener makes the same changes. Costs nothing to those who do not call it. While the scene is divided, what
  /// domains have computed of times after the event is thrown away, the step is run as one world up to the event, and
  /// the scene is divided anew: what adding all bodies costs, so that a change now and then is cheap, and many in the
  /// time of a window are not. Throws std::logic_error outside of callbacks, and if several processes run the scene.
  void change(std::function<void(World&)> change);

  /// Saves or loads the scene, as a World does: see save() and restore() in kds/framework/snapshot.hpp. What one of the
  /// two has saved the other can load, and it does not matter how many domains or processes there were. After loading
  /// counters() begins at zero. Where several processes run the scene, all of them save and load, and each has all
  /// bodies in memory then; else save_parts().
  template <class Archive>
  void archive(Archive& archive);

  using WriteBodies = std::function<void(std::vector<char>)>;
  using ReadBodies = std::function<bool(std::vector<char>&)>;
  /// Saves the scene without bringing its bodies together, and without ending the window: each process gives `write`
  /// those that it answers for, in blocks. Returns the rest: in process 0, others get an empty one.
  /// While the scene is one world there are no blocks, and the rest is all of it, as kds::save() of the World is. All
  /// processes call it. Throws what `write` throws.
  kds::Snapshot save_parts(const WriteBodies& write, std::size_t bodies_in_block = std::size_t{1} << 14);
  /// Loads what save_parts() has saved, whatever the number of processes and domains, then and here. `rest`: the same
  /// in all processes. `read` gives each of them some of the blocks, in any order, and false when it has had them all;
  /// each block that was written is for one process. No process has all bodies in memory then, until the scene is run
  /// as one world. counters() begins at zero. Throws, where there is something wrong in one of the processes, in all of
  /// them, and all is as it was: what `read` throws; std::runtime_error for blocks that are damaged, missing, of
  /// another scene, or there twice.
  void load_parts(const kds::Snapshot& rest, const ReadBodies& read);

  double now() const;
  std::size_t size() const;
  /// Throws std::out_of_range as World::motion(), std::logic_error for a body that another process owns; whole() has
  /// all.
  const Motion& motion(BodyId id) const;
  /// How many bodies this process stores: those that its domains know, and all while the scene is one world.
  std::size_t stored() const;
  /// Into how many domains the scene is divided: 1 while it is run as one world.
  std::size_t domains() const;
  ParallelCounters counters() const;
  /// The work of all worlds of this process so far: that on copies, and that of windows that failed, counts too.
  WorldCounters work() const;
  /// What this process has sent to others.
  MessageCounters messages() const;
  /// As of a World: that of the scene while it is one world, else of the first domain of this process.
  std::string_view broad_phase() const;

 private:
  class Runner;

  std::unique_ptr<Runner> runner_;
};

/// Of bodies that keep their orientation, on straight paths (degree 1) or parabolas (degree 2), or, in
/// kds::collision_splines, on paths of degree 3 to 5.
template <int Degree>
using ParallelWorld = BasicParallelWorld<certificates::PointMotion<Degree>>;

/// Of bodies that turn (docs/turning.md), in kds::collision_turning.
template <int Degree>
using ParallelTurningWorld = BasicParallelWorld<certificates::RigidMotion<Degree>>;

#define KDS_DECLARE(motion) extern template class BasicParallelWorld<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
