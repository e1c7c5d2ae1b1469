// Sweeps over the blocks of a mesh by several threads, in an order that keeps blocks in cache and results the
// same.
//
// Sweep k may visit block b once sweep k - 1 has visited blocks b - 1, b and b + 1 (EdgeForm::Block: a
// block's nodes have neighbours in adjacent blocks only). Sweeps follow each other through the blocks at a
// distance of one. Each thread has one stretch of blocks; neighbouring threads start at the block edge that
// they share and move apart, or move towards each other and end there, so that they wait for each other a few
// times a chain at most. What a visit computes does not depend on who makes it: results are the same for any
// number of threads.
//
// Where other programs want the processors, a chain by several threads can take as long as the system lets
// them have one, milliseconds. How long a chain takes one thread is therefore measured, and where several
// took longer, one alone makes those that follow for twenty times what was lost: a busy machine costs little
// more than one thread's time.
//
// Threads  OpenMP's pool, which stays between chains; a waiting thread spins, then yields
// Errors   none; the runtime may give fewer threads than asked for
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace rheo {

// How many processors this process may use.
int usable_processors();

// As many threads as are asked for; 0: as many as pay for a mesh of so many nodes.
int paying_threads(int nodes, int asked);

// A thread's turn at a block.
struct BlockVisit {
  enum class Way { up, down };
  std::size_t sweep = 0;
  std::size_t block = 0;
  Way way = Way::up;   // of the thread through its stretch of blocks
  bool first = false;  // of the stretch, in this way
  bool last = false;
};

class BlockTeam {
 public:
  // `ends`: one past each block's last node, rising (node_blocks.hpp). Threads' stretches have about as many
  // nodes each. `threads` are brought down to what the blocks keep busy; at least 1.
  BlockTeam(std::vector<std::int32_t> ends, int threads);

  int threads() const { return threads_; }

  // visit(BlockVisit) for all sweeps and blocks, in such an order; for a single sweep in any. Where
  // threads() is 1, every sweep visits the blocks in rising order, and at each of them after the sweep before
  // has visited the next.
  template <class Visit>
  void chain(std::size_t sweeps, const Visit& visit) {
    run(
        sweeps,
        [](const void* context, const BlockVisit& one) { (*static_cast<const Visit*>(context))(one); },
        &visit);
  }

 private:
  using Call = void (*)(const void* context, const BlockVisit& visit);
  // How many sweeps have visited the first and the last block of a thread's stretch, in its own direction.
  struct alignas(64) Progress {
    std::atomic<std::size_t> first{0}, last{0};
  };

  // One kind of chain: what one thread takes for it [s], as far as is known.
  struct Record {
    Call call = nullptr;
    std::size_t sweeps = 0;
    int trials = 3;  // still to be made alone
    double alone = std::numeric_limits<double>::infinity();
  };

  Record& record_of(Call call, std::size_t sweeps);
  void run(std::size_t sweeps, Call call, const void* context);
  void run_stretch(std::size_t member, std::size_t team, std::size_t sweeps, Call call, const void* context);

  // Where the stretch of a team's member begins.
  std::size_t stretch_begin(std::size_t member, std::size_t team) const;

  std::vector<std::int32_t> ends_;
  int threads_;
  std::unique_ptr<Progress[]> progress_;
  std::array<Record, 8> records_;
  double alone_for_ = 0.0;  // how long one thread is to make all chains [s]
};

}  // namespace rheo
