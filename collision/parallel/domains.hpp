// All domains of a scene, of which this process runs some.
#pragma once

#include "collision/motions.hpp"
#include "collision/parallel/body_store.hpp"
#include "collision/parallel/division.hpp"
#include "collision/parallel/domain.hpp"
#include "collision/parallel/news.hpp"
#include "collision/parallel/processes.hpp"
#include "collision/parallel/step_events.hpp"
#include "collision/parallel/step_outcome.hpp"
#include "collision/world.hpp"
#include "collision/world/engine.hpp"
#include "kds/framework/snapshot.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace kds::collision {

/// The domains of a divided scene, and `store`, which has its bodies: each as it was at the end of the last step that
/// was committed.
///
/// Where several processes run the scene, each runs some of the domains and stores the bodies that these know. Those
/// that they own are right; their copies become right whenever a window ends (end_window()). All processes make the
/// same calls; what they decide by, the outcome of a step, is the same in all. Processes write only to those whose
/// domains know bodies of theirs, or have cells which these may come near.
template <class Motion>
class Domains {
 public:
  using Overlap = typename Transfer<Motion>::Overlap;

  /// `whole`: the world of the whole scene, which must outlive this.
  Domains(const WorldOptions& options, std::size_t threads, Engine<Motion>& whole, Team& team);

  bool any() const { return division_ != nullptr; }
  std::size_t size() const { return any() ? division_->partition.size() : 1; }
  const Division& division() const { return *division_; }
  BodyStore<Motion>& store() { return store_; }
  const BodyStore<Motion>& store() const { return store_; }
  /// Whether this process stores the body in its right state: as one that it owns, or one without an owner.
  bool has(BodySlot number) const;
  /// Slots, in the store, of the bodies that this process answers for: each body of the scene is in one process.
  std::vector<BodySlot> answered() const;

  // divide_bodies.cpp
  /// As BasicParallelWorld::add_shares(), at `now`.
  void add_shares(std::size_t count, const std::function<BasicBodyDescription<Motion>(std::size_t)>& body, double now);
  /// Divides the bodies as they are in the stores. `answered`: the bodies that this process answers for, as from
  /// answered(). `overlaps`: all pairs that overlap with one of these, by numbers. `logs`: whether events are recorded.
  /// Then make().
  void begin(Division division, std::span<const BodySlot> answered, std::vector<Overlap> overlaps, bool logs,
             double now);
  /// The pairs that overlap of which this process knows.
  std::vector<Overlap> take_overlaps() { return std::move(overlaps_); }
  /// Whether each domain that owns a body knows all that it leans on and rests on, and no fixed one of these has an
  /// owner.
  bool carriers_are_known() const;
  /// Whether of the bodies that this process stores some lean on each other.
  bool any_islands() const;
  /// Ends the domains, and gives the world of each process all bodies. Returns the pairs that overlap.
  std::vector<Overlap> end();
  /// Ends the domains without bringing their bodies together. The caller then puts other bodies into the stores.
  void leave();

  // saved_parts.cpp
  using WriteBodies = std::function<void(std::vector<char>)>;
  using ReadBodies = std::function<bool(std::vector<char>&)>;
  /// As BasicParallelWorld::save_parts() where the bodies are not all in the whole world, or there are domains.
  kds::Snapshot save(double now, const WriteBodies& write, std::size_t bodies_in_block);
  /// As BasicParallelWorld::load_parts(), of a scene whose bodies are in parts: afterwards each process stores those
  /// that it has read, as after add_shares(). If it throws, nothing changes.
  void load(const typename Engine<Motion>::Image& rest, const ReadBodies& read);

  /// The window that begins next is over by then.
  void set_window_end(double end) { division_->window_end = end; }
  /// Makes the domains anew, each with a new window, as the store has the bodies at a time.
  void make(double now);
  /// Runs a step of a window. Throws what a domain throws; other processes then wait for this one in vain.
  void run(double until);
  /// The outcome of that step.
  const StepOutcome& outcome() const { return outcome_; }
  /// The step, up to `now`, holds: brings the bodies of the store to its end.
  void commit(double now);
  /// The events of a step that holds, before it is committed, of the domains of this process.
  StepEvents take_step();
  /// The same of all domains, in process 0; none in others.
  EventMerge take_events();

  /// After the last step of a window that was committed, at `now`: finds out who is to own and to know which bodies,
  /// and tells those who are to know them. Then exchange() or make().
  void end_window(double now);
  /// The domains take in and let go bodies as end_window() has found, and begin a new window.
  void exchange();

  /// The work of the domains that this process runs, and has run.
  WorldCounters work() const;
  /// That of the first domain of this process; empty if it has none.
  std::string_view broad_phase() const;

 private:
  using Change = MotionChange<Motion>;
  using NewsByProcess = std::map<std::size_t, WindowNews<Motion>>;

  static Letters letters_of(NewsByProcess news);
  template <class Work>
  void in_each(const Work& work);
  std::size_t process_of(std::size_t domain) const { return domain * team_.count() / size(); }
  bool is_here(std::size_t domain) const { return process_of(domain) == team_.rank(); }
  /// Calls take(process) for each other process that runs some of these domains, which must be ascending.
  template <class Take>
  void each_process(std::span<const DomainIndex> domains, const Take& take) const {
    std::size_t last = team_.rank();
    for (const DomainIndex domain : domains) {
      const std::size_t process = process_of(domain);
      if (process == last || process == team_.rank()) continue;
      take(process);
      last = process;
    }
  }
  std::vector<double> share_step();
  void compare();
  double halo_used(const Domain<Motion>& domain, double nearest_stranger) const;
  std::span<const Change> changes_of(DomainIndex domain) const;
  BodyNews<Motion> news_of(BodySlot number) const;
  void add_moves(NewsByProcess& news);
  void add_progress(NewsByProcess& news);
  void note_move(BodySlot number, DomainIndex owner, std::span<const DomainIndex> knowers);
  void take_in(const Parcel<Motion>& newcomers);
  void hear(const WindowNews<Motion>& news);
  /// Calls take(news) for what each process has written to this one.
  template <class Take>
  void exchange_news(Letters letters, const Take& take) {
    team_.exchange(std::move(letters), [&](std::size_t, auto& reader) {
      WindowNews<Motion> heard;
      heard.newcomers.bodies.meshes = meshes_;
      reader(heard);
      take(heard);
    });
  }

  // divide_bodies.cpp
  void share_meshes();
  bool answers_for(BodySlot number) const;
  std::uint64_t rounds_of(std::size_t bodies, std::size_t at_once);
  void find_islands(const Engine<Motion>& from, double now);
  DomainIndex assign(const Engine<Motion>& from, BodySlot slot, double now, std::vector<DomainIndex>& knowers) const;
  void send_bodies(Engine<Motion>& from, std::span<const BodySlot> answered, double now);
  void send_overlaps(Engine<Motion>& from, std::span<const BodySlot> answered, std::vector<Overlap> overlaps,
                     double now);
  std::vector<std::vector<Overlap>> overlaps_by_domain() const;
  void sort_overlaps();
  void drop();

  // saved_parts.cpp
  std::vector<BodySlot> with_attached(std::span<const BodySlot> slots) const;
  bool answers_for_stored(BodySlot number) const;
  bool carriers_are_there();
  void check_attached(BodySlot sensor, BodySlot owner) const;

  const WorldOptions options_;
  const std::size_t threads_;
  BodyStore<Motion> store_;
  Team& team_;
  bool logs_ = false;
  std::unique_ptr<Division> division_;
  std::size_t first_ = 0;                                 ///< the first domain of this process
  std::vector<std::unique_ptr<Domain<Motion>>> domains_;  ///< of this process, by index
  StepOutcome outcome_;
  std::map<DomainIndex, MotionChanges<Motion>> heard_;  ///< what other processes have told of bodies of their domains
  std::vector<BodySlot> changed_;                       ///< owned here, since others were told of them
  /// By domain of this process: numbers of those that are to go and come, but for copies that are wrong.
  std::vector<std::vector<BodySlot>> go_, come_;
  std::vector<BodySlot> gone_;                       ///< numbers of those that no domain of this process is to know
  std::vector<std::shared_ptr<const Mesh>> meshes_;  ///< of all bodies; the same in all processes
  std::uint64_t copies_made_ = 0;                    ///< of bodies owned here, since the last step that held
  /// Pairs that overlap, by numbers: where a window begins all of which a domain of this process knows both bodies.
  std::vector<Overlap> overlaps_;
  /// While the scene is divided, by slots: who is to know the bodies that lean on others, and what is attached to them.
  std::map<BodySlot, std::vector<DomainIndex>> know_islands_;
  bool islands_are_known_ = true;  ///< to those that are to own bodies of them
  WorldCounters work_;             ///< of domains that there were
};

#define KDS_DECLARE(motion) extern template class Domains<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
