#include "kernels/block_team.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <latch>
#include <thread>
#include <utility>
#include <vector>
#ifdef __unix__
#include <sys/resource.h>
#endif

#include "kernels/flush_denormals.hpp"

namespace rheo {
namespace {

constexpr std::size_t fewest_blocks = 4;  // a thread: fewer are waited for longer than they take
constexpr double repay = 20.0;            // of what follows, at most one part in so many is lost to waiting

void wait_for(const std::atomic<std::size_t>& progress, std::size_t wanted) {
  constexpr int spins =
      4000;  // some 50 microseconds; longer only where there are fewer processors than threads
  for (int k = 0; progress.load(std::memory_order_acquire) < wanted; ++k) {
    if (k < spins) {
#if defined(__x86_64__) && defined(__GNUC__)
      __builtin_ia32_pause();
#endif
    } else {
      std::this_thread::yield();
    }
  }
}

// Whether addresses for the stacks of threads may run out (ulimit -v).
bool addresses_are_limited() {
#ifdef __unix__
  rlimit limit{};
  return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
#else
  return false;
#endif
}

// How many of them can be had at once: OpenMP ends the program where it asks for one too many.
int startable_threads(int threads) {
  if (threads == 1 || !addresses_are_limited()) return threads;
  std::latch all_asked(1);
  std::vector<std::thread> started;
  try {
    started.reserve(static_cast<std::size_t>(threads - 1));
    while (static_cast<int>(started.size()) < threads - 1)
      started.emplace_back([&all_asked] { all_asked.wait(); });
  } catch (const std::exception&) {
    // As many as there are.
  }
  all_asked.count_down();
  for (std::thread& thread : started) thread.join();
  return static_cast<int>(started.size()) + 1;
}

}  // namespace

int usable_processors() {
  return std::max(1, omp_get_num_procs());
}

// Below some thousand nodes a thread's part of a step is too short to share.
int paying_threads(int nodes, int asked) {
  constexpr int nodes_a_thread = 1500;
  return asked > 0 ? asked : std::clamp(nodes / nodes_a_thread, 1, usable_processors());
}

BlockTeam::BlockTeam(std::vector<std::int32_t> ends, int threads)
    : ends_(std::move(ends)),
      threads_(startable_threads(
          std::clamp(threads, 1, static_cast<int>(std::max<std::size_t>(1, ends_.size() / fewest_blocks))))),
      progress_(std::make_unique<Progress[]>(static_cast<std::size_t>(threads_))) {}

// The block that holds the member's share of the nodes, but so that each member has a block at least.
std::size_t BlockTeam::stretch_begin(std::size_t member, std::size_t team) const {
  if (member == team) return ends_.size();
  std::size_t begin = 0;
  for (std::size_t m = 1; m <= member; ++m) {
    const auto share = static_cast<std::int64_t>(m) * ends_.back() / static_cast<std::int64_t>(team);
    const auto at = std::upper_bound(ends_.begin(), ends_.end(), share) - ends_.begin();
    begin = std::clamp(static_cast<std::size_t>(at), begin + 1, ends_.size() - (team - m));
  }
  return begin;
}

BlockTeam::Record& BlockTeam::record_of(Call call, std::size_t sweeps) {
  for (Record& record : records_) {
    if (record.call == nullptr) {
      record.call = call;
      record.sweeps = sweeps;
    }
    if (record.call == call && record.sweeps == sweeps) return record;
  }
  return records_.back();  // more kinds than there are
}

void BlockTeam::run(std::size_t sweeps, Call call, const void* context) {
  if (threads_ == 1) {
    run_stretch(0, 1, sweeps, call, context);
    return;
  }
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  Record& record = record_of(call, sweeps);
  if (record.trials > 0 || alone_for_ > 0.0) {
    run_stretch(0, 1, sweeps, call, context);
    const double taken = seconds();
    if (record.trials > 0) --record.trials;
    alone_for_ -= taken;
    // Forgets slowly what was once faster.
    record.alone = std::min(taken, 1.1 * record.alone);
    return;
  }
  for (int k = 0; k < threads_; ++k) {
    progress_[k].first.store(0, std::memory_order_relaxed);
    progress_[k].last.store(0, std::memory_order_relaxed);
  }
#pragma omp parallel num_threads(threads_)
  {
    const FlushDenormals flush;
    run_stretch(static_cast<std::size_t>(omp_get_thread_num()),
                static_cast<std::size_t>(omp_get_num_threads()), sweeps, call, context);
  }
  const double lost = seconds() - record.alone;
  if (lost > 0.0) alone_for_ = repay * lost;
}

void BlockTeam::run_stretch(std::size_t member, std::size_t team, std::size_t sweeps, Call call,
                            const void* context) {
  const std::size_t begin = stretch_begin(member, team);
  const std::size_t end = stretch_begin(member + 1, team);
  const std::size_t length = end - begin;
  // Of two neighbours the first, third, ... goes down from the edge that they share, the other up.
  const bool down = team > 1 && member % 2 == 0;
  const auto way = down ? BlockVisit::Way::down : BlockVisit::Way::up;
  const std::size_t none = team;
  const std::size_t above = member + 1 < team ? member + 1 : none;
  const std::size_t below = member > 0 ? member - 1 : none;
  const std::size_t at_start = down ? above : below;
  const std::size_t at_end = down ? below : above;
  for (std::size_t turn = 0; turn < length + sweeps - 1; ++turn) {
    for (std::size_t sweep = 0; sweep < sweeps && sweep <= turn; ++sweep) {
      const std::size_t k = turn - sweep;  // of my blocks
      if (k >= length) continue;
      if (k == 0 && at_start != none) wait_for(progress_[at_start].first, sweep);
      if (k + 1 == length && at_end != none) wait_for(progress_[at_end].last, sweep);
      call(context, {sweep, down ? end - 1 - k : begin + k, way, k == 0, k + 1 == length});
      if (k == 0) progress_[member].first.store(sweep + 1, std::memory_order_release);
      if (k + 1 == length) progress_[member].last.store(sweep + 1, std::memory_order_release);
    }
  }
}

}  // namespace rheo
