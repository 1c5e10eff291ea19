// Processes that share one rendering, and what they send each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "photile/errors.hpp"

namespace photile {

/// Another process of a Communicator has failed, and reports its error itself.
struct OtherProcessFailed : Error {
  OtherProcessFailed() : Error("another process failed") {}
};

/// Processes that make the same calls in the same order, each with its own data: ranks, from 0.
/// photile has an implementation over MPI (host/cluster); a program may bring its own. All
/// functions but the first two are collective, and throw OtherProcessFailed once a process has
/// called `conclude` with a failure instead.
class Communicator {
 public:
  using Bytes = std::vector<std::byte>;

  virtual ~Communicator() = default;
  virtual std::uint32_t rank() const = 0;
  virtual std::uint32_t size() const = 0;

  /// Sends to_each[r] to rank r, and returns what each rank has sent here, by rank.
  virtual std::vector<Bytes> exchange(std::vector<Bytes> to_each) = 0;

  /// The data of each rank, by rank, on all ranks.
  virtual std::vector<Bytes> gather(std::span<const std::byte> own) = 0;

  /// The values of all ranks, those of rank 0 first.
  template <class Value>
  std::vector<Value> gather_values(std::span<const Value> own) {
    static_assert(std::is_trivially_copyable_v<Value>);
    std::vector<Value> all;
    for (const Bytes& bytes : gather(std::as_bytes(own))) {
      const std::size_t before = all.size();
      all.resize(before + bytes.size() / sizeof(Value));
      if (!bytes.empty()) std::memcpy(all.data() + before, bytes.data(), bytes.size());
    }
    return all;
  }

  /// Replaces values by their sums over all ranks, which wrap around.
  virtual void sum(std::span<std::uint64_t> values) = 0;

  /// Sums over the ranks before this one; zeros on rank 0.
  virtual std::vector<std::uint64_t> sum_before(std::span<const std::uint64_t> values) = 0;

  /// The outcome of the work of all.
  struct Conclusion {
    std::uint32_t rank = 0;  ///< the first that failed; 0 where none did
    int code = 0;            ///< its exit code
  };
  /// The last call of each rank, with its own exit code, 0 where it did not fail.
  ///   tell   called in the first rank that failed, before any rank ends: a launcher ends all
  ///          of them with the first
  virtual Conclusion conclude(int code, const std::function<void()>& tell) = 0;

  /// The bytes that this rank has sent to others so far, and the time that it has waited for them.
  struct Traffic {
    std::uint64_t bytes = 0;
    std::uint64_t calls = 0;
    double seconds = 0;  ///< in calls, wall clock
  };
  virtual Traffic traffic() const = 0;

  /// Ranks that run on the machine of this one, itself among them.
  virtual std::uint32_t on_this_machine() const = 0;
};

/// Part `index` (from 0) of `count` parts of a sequence, whose lengths differ by at most one
/// element.
struct Shard {
  std::uint32_t index = 0, count = 1;

  /// This part has, of n elements, those from `begin(n)` up to, but without, `end(n)`.
  std::uint64_t begin(std::uint64_t n) const { return begin_of_part(index, n); }
  std::uint64_t end(std::uint64_t n) const { return begin_of_part(index + std::uint64_t{1}, n); }

  bool operator==(const Shard&) const = default;

 private:
  /// n * i / count, where the product may need more than 64 bits.
  std::uint64_t begin_of_part(std::uint64_t i, std::uint64_t n) const {
    return n / count * i + n % count * i / count;
  }
};

}  // namespace photile
