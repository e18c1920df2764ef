// Points that are no vertices of a triangulation, by the tetrahedron that they are in.
#pragma once

#include "kds/framework/moving_set.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace kds::structures {

/// A list of points for each tetrahedron. O(1) to put one in, O(points of the tetrahedron) to take one out.
class HiddenPoints {
 public:
  static constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

  std::size_t size() const { return size_; }
  bool contains(Id id) const { return id < in_.size() && in_[id] != nowhere; }
  /// The tetrahedron that a point is in, `nowhere` for one that is not hidden.
  std::uint32_t place(Id id) const { return id < in_.size() ? in_[id] : nowhere; }

  void put(Id id, std::uint32_t t) {
    if (id >= in_.size()) {
      in_.resize(id + std::size_t{1}, nowhere);
      next_.resize(id + std::size_t{1}, nobody);
    }
    if (t >= first_.size()) first_.resize(t + std::size_t{1}, nobody);
    in_[id] = t;
    next_[id] = first_[t];
    first_[t] = id;
    ++size_;
  }
  void remove(Id id) {
    Id* link = &first_[in_[id]];
    while (*link != id) link = &next_[*link];
    *link = next_[id];
    in_[id] = nowhere;
    --size_;
  }
  void clear() { *this = {}; }

  /// Calls f for each point in a tetrahedron, which f may take out.
  template <class F>
  void for_each(std::uint32_t t, F&& f) const {
    for (Id id = t < first_.size() ? first_[t] : nobody; id != nobody;) {
      const Id next = next_[id];
      f(id);
      id = next;
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(in_, next_, first_, size_);
    if constexpr (Archive::loading) {
      archive.require(next_.size() == in_.size(), "the lists of hidden points are broken");
      std::size_t found = 0;
      for (std::uint32_t t = 0; t < first_.size(); ++t) {
        for (Id id = first_[t]; id != nobody; id = next_[id]) {
          archive.require(id < in_.size() && in_[id] == t && ++found <= size_, "the lists of hidden points are broken");
        }
      }
      archive.require(found == size_, "the lists of hidden points are broken");
    }
  }

 private:
  std::vector<std::uint32_t> in_;  ///< by id
  std::vector<Id> next_;           ///< by id: the next in the same tetrahedron
  std::vector<Id> first_;          ///< by tetrahedron
  std::size_t size_ = 0;
};

}  // namespace kds::structures
