// PNG sequences at 1280 x 720: frames a second by way of encoding, on the same rendered frames.
//
// The requirement: at least five times the frames a second of stb_image_write's defaults.
#include <benchmark/benchmark.h>
#include <libdeflate.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench_frames.hpp"
#include "png_encoder.hpp"
#include "render/png.hpp"
#include "stb_default.hpp"

namespace {

namespace fs = std::filesystem;
constexpr int width = 1280, height = 720;
constexpr int different_files = 32;  // names are used again, so that a long run does not fill the disk

fs::path folder() {
  const fs::path path = fs::path(RHEO_TEST_OUTPUT) / "png_bench";
  fs::create_directories(path);
  return path;
}

fs::path frame_file(const fs::path& directory, int i) {
  return directory / ("frame_" + std::to_string(i % different_files) + ".png");
}

// Arguments: triangles; 0 for the beam, 1 for the disk that fills the picture with colour.
void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"triangles", "disk"})->UseRealTime()->Unit(benchmark::kMillisecond);
  for (const int disk : {0, 1}) {
    for (const int triangles : {8, 1000, 10000}) {
      if (disk == 0 || triangles > 8) b->Args({triangles, disk});
    }
  }
}

bench::Frames frames_of(const benchmark::State& state) {
  return {static_cast<int>(state.range(0)), width, height, bench::Colour::shown,
          state.range(1) != 0 ? bench::Subject::disk : bench::Subject::beam};
}

void SequenceByStbDefaults(benchmark::State& state) {
  bench::Frames frames = frames_of(state);
  const fs::path directory = folder();
  render::Image image;
  int i = 0;
  for (auto _ : state) {
    frames.draw(image);
    if (!write_png_by_stb(frame_file(directory, i++), image)) throw std::runtime_error("stb cannot write");
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(SequenceByStbDefaults)->Apply(sizes);

void SequenceOnOneThread(benchmark::State& state) {
  bench::Frames frames = frames_of(state);
  const fs::path directory = folder();
  render::Image image;
  int i = 0;
  for (auto _ : state) {
    frames.draw(image);
    render::write_png(frame_file(directory, i++), image);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(SequenceOnOneThread)->Apply(sizes);

template <int encoders>
void SequenceWithEncoders(benchmark::State& state) {
  bench::Frames frames = frames_of(state);
  const fs::path directory = folder();
  render::PngSequence sequence(encoders);
  int i = 0;
  for (auto _ : state) {
    render::Image image = sequence.recycle();
    frames.draw(image);
    sequence.submit(std::move(image), frame_file(directory, i++));
  }
  sequence.finish();
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(SequenceWithEncoders<1>)->Apply(sizes);
BENCHMARK(SequenceWithEncoders<2>)->Apply(sizes);

// The bound for every sequence.
void SequenceWithoutFiles(benchmark::State& state) {
  bench::Frames frames = frames_of(state);
  render::Image image;
  for (auto _ : state) frames.draw(image);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(SequenceWithoutFiles)->Apply(sizes);

render::Image one_frame(bench::Frames frames) {
  render::Image image;
  for (int i = 0; i < 10; ++i) frames.draw(image);
  return image;
}

void EncodeByStbDefaults(benchmark::State& state) {
  const render::Image image = one_frame(frames_of(state));
  std::size_t size = 0;
  for (auto _ : state) benchmark::DoNotOptimize(size = encode_png_by_stb(image));
  state.counters["kB"] = static_cast<double>(size) / 1000;
}
BENCHMARK(EncodeByStbDefaults)->Apply(sizes);

void EncodeByOurs(benchmark::State& state) {
  const render::Image image = one_frame(frames_of(state));
  render::PngEncoder encoder;
  std::size_t size = 0;
  for (auto _ : state) benchmark::DoNotOptimize(size = encoder.encode(image).size());
  state.counters["kB"] = static_cast<double>(size) / 1000;
}
BENCHMARK(EncodeByOurs)->Apply(sizes);

// Why ours is as it is: rows as RGB or RGBA, unfiltered or as differences to the row above, over libdeflate's
// levels.
void DeflateRows(benchmark::State& state) {
  const render::Image image = one_frame({1000, width, height});
  const auto level = static_cast<int>(state.range(0));
  const auto channels = static_cast<std::size_t>(state.range(1));
  const bool up = state.range(2) != 0;
  libdeflate_compressor* compressor = libdeflate_alloc_compressor(level);
  const std::size_t row = 1 + channels * static_cast<std::size_t>(width);
  std::vector<unsigned char> rows(row * height),
      packed(libdeflate_zlib_compress_bound(compressor, rows.size()));
  std::size_t size = 0;
  for (auto _ : state) {
    for (std::size_t y = 0; y < height; ++y) {
      unsigned char* to = rows.data() + y * row;
      const unsigned char* from = image.rgba.data() + y * 4 * static_cast<std::size_t>(width);
      const bool difference = up && y > 0;
      *to++ = difference ? 2 : 0;
      for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x, from += 4) {
        for (std::size_t k = 0; k < channels; ++k) {
          *to++ = difference ? static_cast<unsigned char>(from[k] - from[k - 4 * width]) : from[k];
        }
      }
    }
    size = libdeflate_zlib_compress(compressor, rows.data(), rows.size(), packed.data(), packed.size());
  }
  libdeflate_free_compressor(compressor);
  state.counters["kB"] = static_cast<double>(size) / 1000;
}
BENCHMARK(DeflateRows)
    ->ArgNames({"level", "channels", "up"})
    ->ArgsProduct({{0, 1, 2, 3, 6}, {3, 4}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
