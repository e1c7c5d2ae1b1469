#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "png_encoder.hpp"
#include "png_file.hpp"
#include "render/png.hpp"

namespace render {

struct PngSequence::Impl {
  struct Job {
    Image image;
    std::filesystem::path file;
  };

  explicit Impl(int threads) : capacity(static_cast<std::size_t>(std::max(threads, 1)) + 1) {
    workers.reserve(static_cast<std::size_t>(std::max(threads, 1)));
    try {
      for (int i = 0; i < std::max(threads, 1); ++i) workers.emplace_back([this] { work(); });
    } catch (const std::exception&) {
      // No memory for another thread: one will do.
      if (workers.empty()) throw;
    }
  }

  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      closing = true;
    }
    work_or_end.notify_all();
    for (std::thread& worker : workers) worker.join();
  }

  void work() {
    std::unique_lock lock(mutex);
    std::unique_ptr<PngEncoder> encoder;
    for (;;) {
      work_or_end.wait(lock, [this] { return !queue.empty() || closing; });
      if (queue.empty()) return;
      Job job = std::move(queue.front());
      queue.pop_front();
      ++busy;
      room_or_done.notify_all();
      const bool skip = error != nullptr;  // after an error nothing more is written
      lock.unlock();
      std::exception_ptr failed;
      if (!skip) {
        try {
          if (!encoder) encoder = std::make_unique<PngEncoder>();
          write_file_whole(job.file, encoder->encode(job.image));
        } catch (...) {
          failed = std::current_exception();
        }
      }
      lock.lock();
      if (failed && !error) error = failed;
      if (spare.size() < capacity) spare.push_back(std::move(job.image));
      --busy;
      room_or_done.notify_all();
    }
  }

  std::size_t capacity;  // of the queue
  std::mutex mutex;
  std::condition_variable work_or_end, room_or_done;
  std::deque<Job> queue;
  std::vector<Image> spare;
  std::exception_ptr error;
  int busy = 0;
  bool closing = false;
  std::vector<std::thread> workers;
};

PngSequence::PngSequence(int threads) : impl_(std::make_unique<Impl>(threads)) {}

PngSequence::~PngSequence() = default;

void PngSequence::submit(Image&& image, std::filesystem::path file) {
  std::unique_lock lock(impl_->mutex);
  impl_->room_or_done.wait(lock, [this] { return impl_->queue.size() < impl_->capacity || impl_->error; });
  if (impl_->error) std::rethrow_exception(impl_->error);
  impl_->queue.push_back({std::move(image), std::move(file)});
  lock.unlock();
  impl_->work_or_end.notify_one();
}

void PngSequence::finish() {
  std::unique_lock lock(impl_->mutex);
  impl_->room_or_done.wait(lock, [this] { return impl_->queue.empty() && impl_->busy == 0; });
  if (impl_->error) std::rethrow_exception(impl_->error);
}

Image PngSequence::recycle() {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->spare.empty()) return {};
  Image image = std::move(impl_->spare.back());
  impl_->spare.pop_back();
  return image;
}

}  // namespace render
