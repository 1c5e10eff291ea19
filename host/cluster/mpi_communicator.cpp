// Every collective call begins with a reduction that tells whether a process has failed. A process
// that fails makes that reduction in place of the call that the others make, and all end: no
// process waits for one that is gone, and none has to be aborted. It also sends its failure to the
// others, which check for that while they work, so that none of them finishes a long stage first.
// Waiting processes sleep between looks, since ranks may be more than cores.
//
// A process that is stopped, or whose machine is, cannot take part. So a thread of each process
// regularly sends a heartbeat to the next rank, whatever the process works on; if the rank before
// is silent for too long, the thread reports it and aborts all.
#include "mpi_communicator.hpp"

#include <mpi.h>
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <numeric>
#include <stop_token>
#include <thread>
#include <utility>

#include "photile/defaults.hpp"

namespace photile {
namespace {

using Clock = std::chrono::steady_clock;

/// Checks without a sleep between them: most answers arrive soon.
constexpr int quick_polls = 200;
constexpr auto first_sleep = std::chrono::microseconds(20);
constexpr auto longest_sleep = std::chrono::microseconds(500);

/// How often the heartbeat thread checks for messages; every tenth time it sends a heartbeat.
constexpr auto watch_period = std::chrono::milliseconds(100);
constexpr int polls_between_beats = 10;
constexpr int aborting = -1;  ///< in place of the code that a process tells

/// Seconds for which a rank may be silent; 0: for ever.
int patience() {
  const char* const text = std::getenv("PHOTILE_MPI_PATIENCE");
  return text == nullptr ? defaults::rank_patience : std::max(0, std::atoi(text));
}

/// Two threads make the calls of MPI, one at a time.
std::mutex& calls() {
  static std::mutex mutex;
  return mutex;
}

template <class Call>
void call(const Call& made) {
  const std::lock_guard lock(calls());
  made();
}

void wait(MPI_Request& request) {
  auto sleep = first_sleep;
  int done = 0;
  for (int poll = 0;; ++poll) {
    call([&] { MPI_Test(&request, &done, MPI_STATUS_IGNORE); });
    if (done) return;
    if (poll < quick_polls) continue;
    std::this_thread::sleep_for(sleep);
    sleep = std::min(2 * sleep, std::chrono::microseconds(longest_sleep));
  }
}

/// Starts a call that does not block, and waits until it is done.
template <class Start>
void make(const Start& start) {
  MPI_Request request = MPI_REQUEST_NULL;
  call([&] { start(&request); });
  wait(request);
}

class MpiCommunicator final : public Communicator {
 public:
  MpiCommunicator() {
    MPI_Comm_dup(MPI_COMM_WORLD, &all_);
    int rank = 0, size = 1, near = 1;
    MPI_Comm_rank(all_, &rank);
    MPI_Comm_size(all_, &size);
    MPI_Comm_dup(MPI_COMM_WORLD, &news_);
    MPI_Irecv(&heard_code_, 1, MPI_INT, MPI_ANY_SOURCE, 0, news_, &news_request_);
    MPI_Comm machine = MPI_COMM_NULL;
    MPI_Comm_split_type(all_, MPI_COMM_TYPE_SHARED, rank, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &near);
    MPI_Comm_free(&machine);
    rank_ = static_cast<std::uint32_t>(rank);
    size_ = static_cast<std::uint32_t>(size);
    near_ = static_cast<std::uint32_t>(near);
  }

  /// Begins to watch the others, where MPI lets a second thread make calls.
  void watch() {
    if (size_ > 1) watcher_ = std::jthread([this](const std::stop_token& stop) { beat(stop); });
  }

  std::uint32_t rank() const override { return rank_; }
  std::uint32_t size() const override { return size_; }
  std::uint32_t on_this_machine() const override { return near_; }
  Traffic traffic() const override { return traffic_; }

  std::vector<Bytes> exchange(std::vector<Bytes> to_each) override {
    const Call call(*this);
    std::vector<Bytes> from(size_);
    from[rank_] = std::move(to_each[rank_]);
    to_each[rank_] = {};
    std::vector<std::uint64_t> out(size_), in(size_);
    for (std::uint32_t r = 0; r < size_; ++r) {
      out[r] = to_each[r].size();
      traffic_.bytes += out[r];
    }
    make([&](MPI_Request* request) {
      MPI_Ialltoall(out.data(), 1, MPI_UINT64_T, in.data(), 1, MPI_UINT64_T, all_, request);
    });
    for (std::uint32_t r = 0; r < size_; ++r) {
      if (r != rank_) from[r].resize(in[r]);
    }
    const std::uint64_t in_round =
        std::max<std::uint64_t>(1, defaults::exchange_round_bytes / size_);
    std::uint64_t most = std::max(*std::max_element(out.begin(), out.end()),
                                  *std::max_element(in.begin(), in.end()));
    // The number of rounds of the process that has most.
    make([&](MPI_Request* request) {
      MPI_Iallreduce(MPI_IN_PLACE, &most, 1, MPI_UINT64_T, MPI_MAX, all_, request);
    });
    for (std::uint64_t begin = 0; begin < most; begin += in_round) {
      exchange_round(to_each, from, begin, in_round);
    }
    return from;
  }

  std::vector<Bytes> gather(std::span<const std::byte> own) override {
    const Call call(*this);
    const std::uint64_t bytes = own.size();
    std::vector<std::uint64_t> sizes(size_);
    make([&](MPI_Request* request) {
      MPI_Iallgather(&bytes, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, all_, request);
    });
    traffic_.bytes += bytes * (size_ - 1);
    std::vector<Bytes> all;
    for (const std::uint64_t size : sizes) all.emplace_back(size);
    const std::uint64_t most = *std::max_element(sizes.begin(), sizes.end());
    const std::uint64_t in_round =
        std::max<std::uint64_t>(1, defaults::exchange_round_bytes / size_);
    Bytes round;
    std::vector<int> counts(size_), places(size_);
    for (std::uint64_t begin = 0; begin < most; begin += in_round) {
      int total = 0;
      for (std::uint32_t r = 0; r < size_; ++r) {
        counts[r] = part(sizes[r], begin, in_round);
        places[r] = total;
        total += counts[r];
      }
      round.resize(static_cast<std::size_t>(total));
      const std::byte* const from = counts[rank_] > 0 ? own.data() + begin : nullptr;
      make([&](MPI_Request* request) {
        MPI_Iallgatherv(from, counts[rank_], MPI_BYTE, round.data(), counts.data(), places.data(),
                        MPI_BYTE, all_, request);
      });
      for (std::uint32_t r = 0; r < size_; ++r) copy(all[r], begin, round, places[r], counts[r]);
    }
    return all;
  }

  void sum(std::span<std::uint64_t> values) override {
    const Call call(*this);
    traffic_.bytes += values.size_bytes();
    for_each_run(values.size(), [&](std::size_t first, int count) {
      make([&](MPI_Request* request) {
        MPI_Iallreduce(MPI_IN_PLACE, values.data() + first, count, MPI_UINT64_T, MPI_SUM, all_,
                       request);
      });
    });
  }

  std::vector<std::uint64_t> sum_before(std::span<const std::uint64_t> values) override {
    const Call call(*this);
    traffic_.bytes += values.size_bytes();
    std::vector<std::uint64_t> sums(values.size(), 0);
    for_each_run(values.size(), [&](std::size_t first, int count) {
      make([&](MPI_Request* request) {
        MPI_Iexscan(values.data() + first, sums.data() + first, count, MPI_UINT64_T, MPI_SUM, all_,
                    request);
      });
    });
    if (rank_ == 0) std::fill(sums.begin(), sums.end(), 0);  // MPI leaves them undefined
    return sums;
  }

  Conclusion conclude(int code, const std::function<void()>& tell_error) override {
    if (heard_ && heard_code_ == aborting) {  // the thread that watches ends all, and reports why
      std::this_thread::sleep_for(std::chrono::minutes(1));
      std::_Exit(code);
    }
    // Others wait within a call that this process has left: mpirun ends them when it exits.
    if (broken_) {
      watcher_ = {};
      if (code != 0) tell_error();
      return {rank_, code};
    }
    if (code != 0 && !heard_ && !failed_) tell(code);
    // A process that stopped because of another has not failed.
    const Conclusion end = agree(heard_ ? 0 : code);
    if (end.code != 0 && end.rank == rank_) tell_error();
    make([&](MPI_Request* request) { MPI_Ibarrier(all_, request); });
    watcher_ = {};  // stops and joins
    for (MPI_Request* request : {&news_request_, &beat_heard_}) {
      if (*request == MPI_REQUEST_NULL) continue;
      MPI_Cancel(request);
      MPI_Request_free(request);
    }
    if (beat_sent_ != MPI_REQUEST_NULL) MPI_Request_free(&beat_sent_);
    MPI_Comm_free(&all_);
    MPI_Finalize();
    return end;
  }

  bool other_failed() {
    if (std::this_thread::get_id() == thread_ && !heard_ && !broken_) poll_for_news();
    return heard_;
  }

 private:
  /// Encloses every collective call.
  class Call {
   public:
    explicit Call(MpiCommunicator& own) : own_(own) {
      ++own.traffic_.calls;
      if (own.agree(0).code != 0) throw OtherProcessFailed();
    }
    ~Call() {
      own_.broken_ = own_.broken_ || std::uncaught_exceptions() > before_;
      own_.traffic_.seconds += std::chrono::duration<double>(Clock::now() - begin_).count();
    }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

   private:
    MpiCommunicator& own_;
    int before_ = std::uncaught_exceptions();
    Clock::time_point begin_ = Clock::now();
  };

  void tell(int code) {
    told_code_ = code;
    for (std::uint32_t r = 0; r < size_; ++r) {
      if (r == rank_) continue;
      call([&] {
        MPI_Request request;
        MPI_Isend(&told_code_, 1, MPI_INT, static_cast<int>(r), 0, news_, &request);
        MPI_Request_free(&request);  // the reduction that follows shows that it has arrived
      });
    }
  }

  void poll_for_news() {
    int there = 0;
    call([&] { MPI_Request_get_status(news_request_, &there, MPI_STATUS_IGNORE); });
    if (there != 0) heard_ = true;
  }

  /// The loop of the watching thread. It counts its own heartbeats and no time: where all processes
  /// of a job are stopped and go on later, none of them was silent.
  void beat(const std::stop_token& stop) {
    constexpr int tag = 1;
    sigset_t signals;  // are for others
    sigfillset(&signals);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    const auto before = static_cast<int>((rank_ + size_ - 1) % size_);
    const auto after = static_cast<int>((rank_ + 1) % size_);
    const int most_silent_polls =
        patience() * static_cast<int>(std::chrono::seconds(1) / watch_period);
    int silent = 0;
    for (int poll = 0; !stop.stop_requested(); ++poll) {
      poll_for_news();
      call([&] {
        int heard = 1, sent = 1;
        if (beat_heard_ != MPI_REQUEST_NULL) MPI_Test(&beat_heard_, &heard, MPI_STATUS_IGNORE);
        if (heard != 0) {
          MPI_Irecv(nullptr, 0, MPI_BYTE, before, tag, news_, &beat_heard_);
          silent = 0;
        }
        if (poll % polls_between_beats != 0) return;
        // One heartbeat on its way is enough: a process that does not receive it is not to be sent
        // more.
        if (beat_sent_ != MPI_REQUEST_NULL) MPI_Test(&beat_sent_, &sent, MPI_STATUS_IGNORE);
        if (sent != 0) MPI_Isend(nullptr, 0, MPI_BYTE, after, tag, news_, &beat_sent_);
      });
      if (++silent > most_silent_polls && most_silent_polls > 0) give_up(before);
      std::this_thread::sleep_for(watch_period);
    }
  }

  [[noreturn]] void give_up(int silent_rank) {
    tell(aborting);
    std::fprintf(stderr,
                 "photile: error: rank %d of %u has not answered for %d s: its process or machine "
                 "has stopped; all ranks are terminated (PHOTILE_MPI_PATIENCE sets the seconds)\n",
                 silent_rank, size_, patience());
    std::this_thread::sleep_for(3 * watch_period);  // until they know
    const std::lock_guard lock(calls());
    MPI_Abort(MPI_COMM_WORLD, 1);
    std::_Exit(1);
  }

  /// The least rank that has a code, and the code.
  Conclusion agree(int code) {
    if (failed_) return *failed_;
    constexpr int codes = 1 << 10;  // more than there are
    const auto fine = static_cast<int>(size_);
    int first = code == 0 ? fine * codes : static_cast<int>(rank_) * codes + code;
    make([&](MPI_Request* request) {
      MPI_Iallreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, all_, request);
    });
    Conclusion end{static_cast<std::uint32_t>(first / codes), first % codes};
    if (first == fine * codes) return {};
    failed_ = std::make_unique<Conclusion>(end);
    return end;
  }

  /// Bytes of a whole that are in the round from `begin` on.
  static int part(std::uint64_t whole, std::uint64_t begin, std::uint64_t in_round) {
    return begin >= whole ? 0 : static_cast<int>(std::min(in_round, whole - begin));
  }

  static void copy(Bytes& to, std::uint64_t begin, const Bytes& round, int place, int count) {
    if (count == 0) return;
    std::memcpy(to.data() + begin, round.data() + place, static_cast<std::size_t>(count));
  }

  void exchange_round(const std::vector<Bytes>& out, std::vector<Bytes>& in, std::uint64_t begin,
                      std::uint64_t in_round) {
    std::vector<int> sent(size_), got(size_), sent_at(size_), got_at(size_);
    for (std::uint32_t r = 0; r < size_; ++r) {
      sent[r] = part(out[r].size(), begin, in_round);
      got[r] = r == rank_ ? 0 : part(in[r].size(), begin, in_round);
    }
    std::exclusive_scan(sent.begin(), sent.end(), sent_at.begin(), 0);
    std::exclusive_scan(got.begin(), got.end(), got_at.begin(), 0);
    Bytes to(static_cast<std::size_t>(sent_at.back() + sent.back()));
    Bytes from(static_cast<std::size_t>(got_at.back() + got.back()));
    for (std::uint32_t r = 0; r < size_; ++r) {
      if (sent[r] > 0) {
        std::memcpy(to.data() + sent_at[r], out[r].data() + begin,
                    static_cast<std::size_t>(sent[r]));
      }
    }
    make([&](MPI_Request* request) {
      MPI_Ialltoallv(to.data(), sent.data(), sent_at.data(), MPI_BYTE, from.data(), got.data(),
                     got_at.data(), MPI_BYTE, all_, request);
    });
    for (std::uint32_t r = 0; r < size_; ++r) copy(in[r], begin, from, got_at[r], got[r]);
  }

  /// Calls work(first, count) for runs of values whose number MPI counts in an int.
  template <class Work>
  static void for_each_run(std::size_t count, const Work& work) {
    constexpr std::size_t most = defaults::exchange_round_bytes / sizeof(std::uint64_t);
    for (std::size_t first = 0; first < count; first += most) {
      work(first, static_cast<int>(std::min(most, count - first)));
    }
  }

  MPI_Comm all_ = MPI_COMM_NULL, news_ = MPI_COMM_NULL;
  MPI_Request news_request_ = MPI_REQUEST_NULL;
  MPI_Request beat_heard_ = MPI_REQUEST_NULL, beat_sent_ = MPI_REQUEST_NULL;
  int heard_code_ = 0, told_code_ = 0;
  std::atomic<bool> heard_{false};
  const std::thread::id thread_ = std::this_thread::get_id();
  std::uint32_t rank_ = 0, size_ = 1, near_ = 1;
  Traffic traffic_;
  std::unique_ptr<Conclusion> failed_;  ///< what all know of
  bool broken_ = false;                 ///< a call was left by an exception
  std::jthread watcher_;                ///< the last member: it uses the others
};

}  // namespace
}  // namespace photile

namespace {

std::unique_ptr<photile::MpiCommunicator> communicator;

}  // namespace

bool photile_mpi_other_failed() { return communicator && communicator->other_failed(); }

photile::Communicator* photile_mpi_communicator() {
  if (!communicator) {
    int given = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &given) != MPI_SUCCESS)
      return nullptr;
    communicator = std::make_unique<photile::MpiCommunicator>();
    if (given >= MPI_THREAD_SERIALIZED) communicator->watch();
  }
  return communicator.get();
}
