// Threads of one process that stand in for several processes.
#pragma once

#include <algorithm>
#include <barrier>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "photile/communicator.hpp"

namespace photile::test {

/// What the threads share: a place for what each gives.
struct ThreadGroup {
  explicit ThreadGroup(std::uint32_t size)
      : given(size), meeting(static_cast<std::ptrdiff_t>(size)) {}
  std::vector<std::vector<Communicator::Bytes>> given;  ///< [from][to]
  std::barrier<> meeting;
};

class ThreadCommunicator : public Communicator {
 public:
  ThreadCommunicator(ThreadGroup& group, std::uint32_t rank) : group_(group), rank_(rank) {}
  std::uint32_t rank() const override { return rank_; }
  std::uint32_t size() const override { return static_cast<std::uint32_t>(group_.given.size()); }
  std::uint32_t on_this_machine() const override { return size(); }
  Traffic traffic() const override { return traffic_; }
  Conclusion conclude(int, const std::function<void()>&) override { return {}; }

  std::vector<Bytes> exchange(std::vector<Bytes> to_each) override {
    ++traffic_.calls;
    group_.given[rank_] = std::move(to_each);
    group_.meeting.arrive_and_wait();
    std::vector<Bytes> from;
    for (const auto& all : group_.given) from.push_back(all[rank_]);
    group_.meeting.arrive_and_wait();
    return from;
  }
  std::vector<Bytes> gather(std::span<const std::byte> own) override {
    return exchange(std::vector<Bytes>(size(), Bytes(own.begin(), own.end())));
  }
  void sum(std::span<std::uint64_t> values) override {
    std::vector<std::uint64_t> sums(values.size(), 0);
    for (const Bytes& bytes : gather(std::as_bytes(values))) add(bytes, sums);
    std::copy(sums.begin(), sums.end(), values.begin());
  }
  std::vector<std::uint64_t> sum_before(std::span<const std::uint64_t> values) override {
    std::vector<std::uint64_t> sums(values.size(), 0);
    const std::vector<Bytes> all = gather(std::as_bytes(values));
    for (std::uint32_t r = 0; r < rank_; ++r) add(all[r], sums);
    return sums;
  }

 private:
  static void add(const Bytes& bytes, std::vector<std::uint64_t>& sums) {
    std::vector<std::uint64_t> values(sums.size());
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += values[i];
  }

  ThreadGroup& group_;
  std::uint32_t rank_;
  Traffic traffic_;
};

/// Runs work(communicator) on so many threads. It must not throw on some of them alone.
inline void on_threads(std::uint32_t size, const std::function<void(Communicator&)>& work) {
  ThreadGroup group(size);
  std::vector<std::exception_ptr> errors(size);
  {
    std::vector<std::jthread> threads;
    for (std::uint32_t rank = 0; rank < size; ++rank) {
      threads.emplace_back([&, rank] {
        ThreadCommunicator communicator(group, rank);
        try {
          work(communicator);
        } catch (...) {
          errors[rank] = std::current_exception();
        }
      });
    }
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace photile::test
