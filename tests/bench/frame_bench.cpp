// Drawing and reading back a frame, over mesh sizes and picture sizes.
#include <benchmark/benchmark.h>

#include "bench_frames.hpp"

namespace {

// Arguments: triangles, picture height (16:9).
void DrawAndReadBack(benchmark::State& state) {
  const auto height = static_cast<int>(state.range(1));
  bench::Frames frames(static_cast<int>(state.range(0)), height * 16 / 9, height);
  render::Image image;
  for (auto _ : state) frames.draw(image);
  state.SetItemsProcessed(state.iterations());
}
// The same without colour: none is read, uploaded or looked up.
void DrawAndReadBackBare(benchmark::State& state) {
  const auto height = static_cast<int>(state.range(1));
  bench::Frames frames(static_cast<int>(state.range(0)), height * 16 / 9, height, bench::Colour::none);
  render::Image image;
  for (auto _ : state) frames.draw(image);
  state.SetItemsProcessed(state.iterations());
}
// The same of a body that stands still: all but the time is taken from the frame before.
void DrawAndReadBackStill(benchmark::State& state) {
  const auto height = static_cast<int>(state.range(1));
  bench::Frames frames(static_cast<int>(state.range(0)), height * 16 / 9, height);
  render::Image image;
  frames.draw_again(image);
  for (auto _ : state) frames.draw_again(image);
  state.SetItemsProcessed(state.iterations());
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"triangles", "height"})->UseRealTime()->Unit(benchmark::kMillisecond);
  for (int triangles : {12, 1000, 10000, 100000}) b->Args({triangles, 720});
}

BENCHMARK(DrawAndReadBack)
    ->Apply(sizes)
    ->Args({1000000, 720})
    ->Args({1000, 240})
    ->Args({1000, 1080})
    ->Args({1000, 2160});
BENCHMARK(DrawAndReadBackBare)->Apply(sizes);
BENCHMARK(DrawAndReadBackStill)->Apply(sizes);

}  // namespace
