// Sweeps over blocks by several threads: each block once a sweep, after all that it reads.

#include "kernels/block_team.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "kernels/flush_denormals.hpp"

namespace rheo::test {
namespace {

// Block ends: of one size; growing; one that holds most nodes; as few blocks as a team of four keeps.
const std::vector<std::vector<std::int32_t>> meshes = [] {
  std::vector<std::vector<std::int32_t>> result(4);
  for (int k = 0; k < 40; ++k) result[0].push_back(10 * (k + 1));
  for (int k = 0; k < 40; ++k) result[1].push_back((k + 1) * (k + 1));
  for (int k = 0; k < 40; ++k) result[2].push_back(k < 30 ? k + 1 : 10000 + k);
  for (int k = 0; k < 16; ++k) result[3].push_back(k < 1 ? 100000 : 100000 + k);
  return result;
}();

TEST(BlockTeam, VisitsEveryBlockOnceASweepAfterAllThatItReads) {
  constexpr std::size_t sweeps = 4;
  for (const std::vector<std::int32_t>& ends : meshes) {
    const std::size_t blocks = ends.size();
    for (int threads : {1, 2, 3, 4}) {
      BlockTeam team(ends, threads);
      ASSERT_EQ(team.threads(), threads);
      for (int repeat = 0; repeat < 20; ++repeat) {
        std::vector<std::atomic<int>> visits(sweeps * blocks);
        std::atomic<int> too_early = 0;
        team.chain(sweeps, [&](const BlockVisit& at) {
          const auto [sweep, block] = std::pair(at.sweep, at.block);
          for (std::size_t b = block > 0 ? block - 1 : 0; sweep > 0 && b < std::min(block + 2, blocks); ++b)
            too_early += visits[(sweep - 1) * blocks + b] != 1;
          ++visits[sweep * blocks + block];
        });
        EXPECT_EQ(too_early, 0);
        for (const auto& count : visits) ASSERT_EQ(count, 1);
      }
    }
  }
}

// What a kernel that passes something from block to block goes by.
TEST(BlockTeam, SaysWhereAStretchBeginsWhichWayItGoesAndWhereItEnds) {
  for (const std::vector<std::int32_t>& ends : meshes) {
    for (int threads : {1, 2, 3, 4}) {
      BlockTeam team(ends, threads);
      for (int repeat = 0; repeat < 8; ++repeat) {
        std::vector<BlockVisit> visits(ends.size());
        team.chain(1, [&](const BlockVisit& at) { visits[at.block] = at; });
        // From its lowest block to its highest a stretch goes one way; its ends are where the first and last
        // are.
        bool inside = false;
        for (std::size_t block = 0; block < visits.size(); ++block) {
          const BlockVisit& at = visits[block];
          const bool up = at.way == BlockVisit::Way::up;
          EXPECT_EQ(up ? at.first : at.last, !inside) << block;
          if (inside) {
            EXPECT_EQ(at.way, visits[block - 1].way) << block;
          }
          inside = !(up ? at.last : at.first);
        }
        EXPECT_FALSE(inside);
      }
    }
  }
}

#if defined(__x86_64__) && defined(__GNUC__)
TEST(BlockTeam, TakesDenormalsForZeroOnEveryThreadAndNowhereElse) {
  ASSERT_FALSE(FlushDenormals::is_on());
  BlockTeam team(meshes[0], 2);
  std::mutex mutex;
  std::set<std::thread::id> threads;
  std::atomic<int> kept = 0;
  const auto look = [&](const BlockVisit&) {
    kept += !FlushDenormals::is_on();
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
  };
  {
    const FlushDenormals flush;  // as Stepping::advance: a team that works alone is on the caller's thread
    EXPECT_TRUE(FlushDenormals::is_on());
    // Trials alone come first, and other programs may make it go on alone.
    for (int k = 0; k < 2000 && threads.size() < 2; ++k) team.chain(4, look);
  }
  EXPECT_EQ(threads.size(), 2u);
  EXPECT_EQ(kept, 0);
  EXPECT_FALSE(FlushDenormals::is_on());
}
#endif

TEST(BlockTeam, HasNoMoreThreadsThanBlocksKeepBusy) {
  EXPECT_EQ(BlockTeam(std::vector<std::int32_t>{7}, 8).threads(), 1);
  EXPECT_EQ(BlockTeam(meshes[3], 8).threads(), 4);
}

}  // namespace
}  // namespace rheo::test
