// What this machine can do at most: the two ends of a roofline, for the tables to say how near a step comes.
//
//   machine/triad/<MB>/<threads>  a = b + s c on three arrays of together so many MB: bytes a second
//   machine/fma/<simd>            independent multiply-adds in registers: flops a second of one core
//
// The triad counts 24 bytes an entry; where a store reads its cache line first, 32 are moved.
//
// Source   J. McCalpin, STREAM; S. Williams, A. Waterman, D. Patterson, "Roofline" (2009)

#include <benchmark/benchmark.h>

#include <cstddef>
#include <string>
#include <vector>

namespace {

// Each thread has its own part of the arrays, and touches it first.
void triad(benchmark::State& state) {
  const auto entries = static_cast<std::size_t>(state.range(0)) * 1000000 / (3 * sizeof(double)) /
                       static_cast<std::size_t>(state.threads());
  std::vector<double> a(entries, 1.0), b(entries, 2.0), c(entries, 3.0);
  double *pa = a.data(), *pb = b.data(), *pc = c.data();
  for (auto _ : state) {
    for (std::size_t i = 0; i < entries; ++i) pa[i] = pb[i] + 0.4 * pc[i];
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(entries * 3 * sizeof(double)));
}

// Twelve chains hide the latency of four to five cycles on two units.
constexpr int chains = 12;
constexpr int rounds = 1000;

template <int width>
struct Lanes {
  typedef double Type __attribute__((vector_size(width * sizeof(double))));
};

template <int width>
[[gnu::always_inline]] inline void multiply_add(typename Lanes<width>::Type* x) {
  typedef typename Lanes<width>::Type Vec;
  const Vec factor = Vec{} + 0.999999, term = Vec{} + 1e-6;
  for (int k = 0; k < rounds; ++k) {
#pragma GCC unroll 12
    for (int i = 0; i < chains; ++i) x[i] = x[i] * factor + term;
  }
}

template <int width>
[[gnu::always_inline]] inline double sum_after(double start) {
  typename Lanes<width>::Type x[chains];
  for (int i = 0; i < chains; ++i) x[i] = typename Lanes<width>::Type{} + (start + i);
  multiply_add<width>(x);
  double sum = 0.0;
  for (int i = 0; i < chains; ++i) sum += x[i][0];
  return sum;
}

double fma_baseline(double start) {
  return sum_after<2>(start);
}
#if defined(__x86_64__)
[[gnu::target("avx2,fma")]] double fma_avx2(double start) {
  return sum_after<4>(start);
}
[[gnu::target("avx512f")]] double fma_avx512(double start) {
  return sum_after<8>(start);
}
#endif

template <double (*run)(double), int width>
void fma(benchmark::State& state) {
  double start = 1.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(start);
    benchmark::DoNotOptimize(run(start));
  }
  state.counters["flops"] =
      benchmark::Counter(2.0 * chains * rounds * width, benchmark::Counter::kIsIterationInvariantRate);
}

const int registered = [] {
  for (const int threads : {1, 2})
    for (const int megabytes : {1, 4, 16, 64, 256})
      benchmark::RegisterBenchmark("machine/triad", triad)->Arg(megabytes)->Threads(threads)->UseRealTime();
  benchmark::RegisterBenchmark("machine/fma/baseline", fma<fma_baseline, 2>);
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    benchmark::RegisterBenchmark("machine/fma/avx2", fma<fma_avx2, 4>);
  if (__builtin_cpu_supports("avx512f"))
    benchmark::RegisterBenchmark("machine/fma/avx512", fma<fma_avx512, 8>);
#endif
  return 0;
}();

}  // namespace
