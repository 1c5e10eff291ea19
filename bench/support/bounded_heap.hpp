// The k nearest candidates so far, as a binary heap with the farthest on top once there are k.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace photile::bench {

class BoundedHeap {
 public:
  struct Candidate {
    float squared_distance;
    std::uint32_t photon;
  };

  explicit BoundedHeap(std::size_t capacity) : capacity_(capacity) { entries_.reserve(capacity); }

  void clear() { entries_.clear(); }
  bool full() const { return entries_.size() == capacity_; }
  /// Of a full heap.
  float farthest() const { return entries_[0].squared_distance; }
  const std::vector<Candidate>& entries() const { return entries_; }

  /// Adds a candidate. Where the heap is full it must be nearer than farthest(), which it replaces.
  void add(const Candidate& candidate) {
    if (full()) {
      sink(candidate);
      return;
    }
    // In any order until all are there: no one asks for the farthest before.
    entries_.push_back(candidate);
    if (full()) {
      std::make_heap(entries_.begin(), entries_.end(), [](const Candidate& a, const Candidate& b) {
        return a.squared_distance < b.squared_distance;
      });
    }
  }

 private:
  void sink(const Candidate& candidate) {
    std::size_t place = 0;
    for (std::size_t child = 1; child < entries_.size(); child = 2 * place + 1) {
      if (child + 1 < entries_.size() &&
          entries_[child + 1].squared_distance > entries_[child].squared_distance) {
        ++child;
      }
      if (entries_[child].squared_distance <= candidate.squared_distance) break;
      entries_[place] = entries_[child];
      place = child;
    }
    entries_[place] = candidate;
  }

  std::vector<Candidate> entries_;
  std::size_t capacity_;
};

}  // namespace photile::bench
