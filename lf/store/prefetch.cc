#include "lf/store/prefetch.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

namespace lf {
namespace {

double ThreadCpuSeconds() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

// An exception that leaves a thread would end the program.
Result<LfPixels> LoadWithoutThrowing(const LfImageStore& store, const LoadRequest& request) {
  try {
    return store.Load(request.id, request.rect);
  } catch (const std::bad_alloc&) {
    return OutputError(
        fmt::format("LF image {}: no memory to load it: lower --memory, or give the machine more",
                    request.id.value));
  } catch (const std::exception& exception) {
    return InputError(fmt::format("LF image {}: {}", request.id.value, exception.what()));
  }
}

}  // namespace

// Requests [0, delivered) are handed over, [delivered, begun) in `slots`, the others wait. They are
// begun in order, so the one that Next() waits for is always begun first, and at least one is
// begun whenever none is in the queue: nobody can wait for ever.
struct Prefetcher::State {
  State(const LfImageStore& the_store, std::vector<LoadRequest> the_requests,
        const PrefetchOptions& options)
      : store(the_store),
        requests(std::move(the_requests)),
        queue_bytes(options.queue_bytes),
        image_bytes(options.image_bytes_estimate) {}

  struct Slot {
    size_t bytes = 0;  // of the queue
    std::optional<Result<LfPixels>> pixels;
  };

  size_t begun() const { return delivered + slots.size(); }
  bool MayBegin() const {
    if (slots.empty()) return true;
    return image_bytes > 0 && used_bytes + image_bytes <= queue_bytes;
  }

  // A loader thread.
  void Run();
  Result<LfPixels> TimedLoad(const LoadRequest& request);

  const LfImageStore& store;
  const std::vector<LoadRequest> requests;
  const size_t queue_bytes;

  mutable std::mutex mutex;  // guards all that follows
  std::condition_variable may_begin;
  std::condition_variable is_loaded;
  std::deque<Slot> slots;
  size_t delivered = 0;
  size_t used_bytes = 0;
  size_t image_bytes;  // the largest seen, or the estimate
  bool stopping = false;
  double load_seconds = 0;

  std::vector<std::thread> threads;
};

void Prefetcher::State::Run() {
  std::unique_lock lock(mutex);
  while (true) {
    may_begin.wait(lock, [&] { return stopping || begun() == requests.size() || MayBegin(); });
    if (stopping || begun() == requests.size()) return;
    const size_t index = begun();
    const size_t reserved_bytes = image_bytes;
    slots.push_back({reserved_bytes, std::nullopt});
    used_bytes += reserved_bytes;

    lock.unlock();
    Result<LfPixels> pixels = TimedLoad(requests[index]);
    lock.lock();

    Slot& slot = slots[index - delivered];
    slot.bytes = pixels ? pixels->size_bytes() : 0;
    used_bytes += slot.bytes - reserved_bytes;
    image_bytes = std::max(image_bytes, slot.bytes);
    slot.pixels = std::move(pixels);
    if (index == delivered) is_loaded.notify_one();
    may_begin.notify_all();  // the true size may leave room, and the last one wakes all to end
  }
}

Result<LfPixels> Prefetcher::State::TimedLoad(const LoadRequest& request) {
  const double begin = ThreadCpuSeconds();
  Result<LfPixels> pixels = LoadWithoutThrowing(store, request);
  const double seconds = ThreadCpuSeconds() - begin;
  const std::lock_guard lock(mutex);
  load_seconds += seconds;
  return pixels;
}

Prefetcher::Prefetcher(const LfImageStore& store, std::vector<LoadRequest> requests,
                       const PrefetchOptions& options)
    : state_(std::make_unique<State>(store, std::move(requests), options)) {
  State& state = *state_;
  const size_t thread_count =
      std::min(static_cast<size_t>(std::max(0, options.thread_count)), state.requests.size());
  state.threads.reserve(thread_count);
  try {
    for (size_t i = 0; i < thread_count; ++i) state.threads.emplace_back([&state] { state.Run(); });
  } catch (const std::exception&) {
    // Those that did start do the work; without any, Next() does.
  }
}

Prefetcher::~Prefetcher() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->stopping = true;
  }
  state_->may_begin.notify_all();
  for (std::thread& thread : state_->threads) thread.join();
}

std::optional<LoadedImage> Prefetcher::Next() {
  State& state = *state_;
  std::unique_lock lock(state.mutex);
  if (state.delivered == state.requests.size()) return std::nullopt;
  const LoadRequest& request = state.requests[state.delivered];
  if (state.threads.empty()) {
    ++state.delivered;
    lock.unlock();
    return LoadedImage{request.id, state.TimedLoad(request)};
  }
  state.is_loaded.wait(lock, [&] { return !state.slots.empty() && state.slots.front().pixels; });
  LoadedImage image{request.id, *std::move(state.slots.front().pixels)};
  state.used_bytes -= state.slots.front().bytes;
  state.slots.pop_front();
  ++state.delivered;
  lock.unlock();
  state.may_begin.notify_all();
  return image;
}

double Prefetcher::load_seconds() const {
  const std::lock_guard lock(state_->mutex);
  return state_->load_seconds;
}

}  // namespace lf
