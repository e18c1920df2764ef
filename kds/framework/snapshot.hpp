// The state of a run as bytes: to go back to, to keep in a file, to run again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <istream>
#include <iterator>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds {

/// The state that save() returns and restore() takes: a copy of everything that decides later events. Loaded into parts
/// of the same types, it gives the same events, bit for bit. A roll-back is a restore() of an earlier snapshot, as
/// optimistic concurrency needs it ([Coming06] section 4.2; [Jefferson85]).
///
/// The bytes are those of the machine: a file is for the same program on the same kind of processor.
class Snapshot {
 public:
  Snapshot() = default;
  explicit Snapshot(std::vector<char> bytes) : bytes_(std::move(bytes)) {}

  const std::vector<char>& bytes() const { return bytes_; }
  /// Compares the bytes, which are those of the state; but elements of a caller's own type without archive() are copied
  /// with their padding, whose bytes count too.
  friend bool operator==(const Snapshot&, const Snapshot&) = default;

 private:
  std::vector<char> bytes_;
};

namespace detail {

template <class T>
concept OptionalLike = requires(T& value) {
  value.has_value();
  value.emplace();
  value.reset();
};

/// Calls archive() of types that have one, goes through vectors and optional values, and copies the bytes of trivially
/// copyable types.
template <class Derived>
class Archive {
 public:
  template <class... T>
  void operator()(T&... values) {
    (one(values), ...);
  }

  /// A name that must be found again when the snapshot is loaded.
  void tag(std::string_view name) {
    std::vector<char> letters(name.begin(), name.end());
    const std::vector<char> expected = letters;
    one(letters);
    if (letters != expected) {
      constexpr std::size_t most_shown = 80;
      const auto shown = static_cast<std::ptrdiff_t>(std::min(letters.size(), most_shown));
      throw std::runtime_error("snapshot: expected " + std::string(name) + ", found " +
                               std::string(letters.begin(), letters.begin() + shown));
    }
  }

  /// By this a part checks what it has loaded before it relies on it.
  static void require(bool right, const char* otherwise) {
    if (!right) throw std::runtime_error(std::string("snapshot: ") + otherwise);
  }

  /// The size of a list, and each of its entries by one(entry). When the list is loaded, entries are made one after
  /// another, so that an impossible size is noticed at the end of the bytes, and not when memory is exhausted.
  template <class T, class One>
  void each(std::vector<T>& values, const One& one_of) {
    std::uint64_t size = values.size();
    one(size);
    entries(values, size, one_of);
  }

 private:
  template <class T>
  void one(T& value) {
    auto& self = static_cast<Derived&>(*this);
    if constexpr (requires { value.archive(self); }) {
      value.archive(self);
    } else if constexpr (requires { archive_members(self, value); }) {
      archive_members(self, value);
    } else if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = value;
      self.bytes(reinterpret_cast<char*>(&byte), 1);
      if (byte > 1) throw std::runtime_error("snapshot: a flag is neither true nor false");
      value = byte == 1;
    } else if constexpr (OptionalLike<T>) {
      bool there = value.has_value();
      one(there);
      if constexpr (Derived::loading) there ? void(value.emplace()) : value.reset();
      if (value.has_value()) one(*value);
    } else if constexpr (requires { value.resize(1), value.data(); }) {
      several(value);
    } else {
      static_assert(std::is_trivially_copyable_v<T>, "snapshot: a type without archive(), which is not plain data");
      self.bytes(reinterpret_cast<char*>(&value), sizeof(T));
    }
  }

  /// The number of entries and, for plain ones, the size of one: so that entries of other types are refused.
  template <class T>
  void several(T& values) {
    auto& self = static_cast<Derived&>(*this);
    using Entry = std::remove_cvref_t<decltype(values[0])>;
    constexpr bool plain = std::is_trivially_copyable_v<Entry> && !OptionalLike<Entry> && !requires(Entry & entry) {
      entry.archive(self);
    }
    &&!requires(Entry & entry) { archive_members(self, entry); };
    std::uint64_t size = values.size();
    std::uint32_t length = plain ? sizeof(Entry) : 0;
    one(size);
    one(length);
    if (length != (plain ? sizeof(Entry) : 0)) throw std::runtime_error("snapshot: it is one of other types");
    if constexpr (plain) {
      self.room(size, sizeof(Entry));
      values.resize(size);
      self.bytes(reinterpret_cast<char*>(values.data()), size * sizeof(Entry));
    } else {
      entries(values, size, [this](Entry& entry) { one(entry); });
    }
  }

  /// An entry that exists already is loaded in place: it may contain more than is saved.
  template <class Values, class One>
  void entries(Values& values, std::uint64_t size, const One& one_of) {
    static_cast<Derived&>(*this).room(size, 1);
    if (size < values.size()) values.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      if (i == values.size()) values.emplace_back();
      one_of(values[i]);
    }
  }
};

class Writer : public Archive<Writer> {
 public:
  static constexpr bool loading = false;
  void bytes(char* data, std::size_t size) { out_.insert(out_.end(), data, data + size); }
  void room(std::uint64_t /*entries*/, std::size_t /*length*/) const {}
  std::vector<char> take() { return std::move(out_); }

 private:
  std::vector<char> out_;
};

class Reader : public Archive<Reader> {
 public:
  static constexpr bool loading = true;
  explicit Reader(const std::vector<char>& in) : in_(in) {}
  void bytes(char* data, std::size_t size) {
    room(size, 1);
    std::copy_n(in_.begin() + static_cast<std::ptrdiff_t>(at_), size, data);
    at_ += size;
  }
  /// Refuses impossible sizes: at least so many bytes for each of so many entries must follow.
  void room(std::uint64_t entries, std::size_t length) const {
    if (entries > (in_.size() - at_) / length) throw std::runtime_error("snapshot: it ends before its time");
  }
  bool at_end() const { return at_ == in_.size(); }

 private:
  const std::vector<char>& in_;
  std::size_t at_ = 0;
};

/// FNV-1a: detects damage, but not a forgery.
inline std::uint64_t checksum(const std::vector<char>& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

}  // namespace detail

/// Copies the state of simulators, sets of elements, structures: of all types with archive(). A Simulator includes its
/// structures, but not the elements: save(simulator, points).
template <class... Parts>
Snapshot save(Parts&... parts) {
  detail::Writer writer;
  (parts.archive(writer), ...);
  return Snapshot(writer.take());
}

/// Puts parts back into a saved state. They must be those that were saved, or others made of the same types in the same
/// order; structures must be attached to the sets. Listeners and queues may be others. Throws std::runtime_error for a
/// snapshot of other parts, or one that is damaged, and then leaves the parts as they were. A snapshot from elsewhere
/// may have been changed into another valid state, which cannot be detected. Worlds, sets, and lists and tournaments
/// that are not made of rules check all that they rely on. Structures made of rules check lengths and times, but not
/// all links, nor that they fit the elements: load them only from files that you trust. Cost: that of a save() and a
/// load.
template <class... Parts>
void restore(const Snapshot& snapshot, Parts&... parts) {
  const auto load = [&](const Snapshot& from) {
    detail::Reader reader(from.bytes());
    (parts.archive(reader), ...);
    if (!reader.at_end()) throw std::runtime_error("snapshot: there is more in it than was asked for");
  };
  const Snapshot before = save(parts...);
  try {
    load(snapshot);
  } catch (...) {
    load(before);
    throw;
  }
}

/// Writes a snapshot, with its length and a checksum. The stream must be a binary one. Throws std::runtime_error if it
/// cannot be written.
inline void write(std::ostream& out, const Snapshot& snapshot) {
  const std::uint64_t head[3] = {0x31534453444bu, snapshot.bytes().size(), detail::checksum(snapshot.bytes())};
  char letters[sizeof head];
  std::memcpy(letters, head, sizeof head);
  out.write(letters, sizeof head);
  out.write(snapshot.bytes().data(), static_cast<std::streamsize>(snapshot.bytes().size()));
  if (!out) throw std::runtime_error("snapshot: cannot be written");
}

/// Reads a snapshot, which must be all that is left of the stream: a file has one snapshot at most, at its end. Throws
/// std::runtime_error if it is damaged, or not a snapshot of this kind of machine.
inline Snapshot read_snapshot(std::istream& in) {
  std::uint64_t head[3] = {};
  char letters[sizeof head];
  if (!in.read(letters, sizeof head)) throw std::runtime_error("snapshot: it ends before its time");
  std::memcpy(head, letters, sizeof head);
  if (head[0] != 0x31534453444bu)
    throw std::runtime_error("snapshot: this is none, or is from another kind of machine");
  std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  if (bytes.size() != head[1] || detail::checksum(bytes) != head[2])
    throw std::runtime_error("snapshot: it is damaged");
  return Snapshot(std::move(bytes));
}

}  // namespace kds
