// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/watched_loop.h"

#include <fmt/format.h>

#include <mutex>
#include <optional>

namespace lf {

Result<void> ForEachWatched(ThreadPool& pool, size_t count, const Watch& watch,
                            const std::function<Result<void>(size_t)>& body) {
  std::mutex mutex;  // guards both variables below
  std::optional<Error> error;
  size_t done = 0;
  // Returns true, and notes it as the error, if the user has interrupted.
  const auto is_interrupted = [&] {
    if (!error && IsSet(watch.interrupted))
      error = Error{ErrorKind::kInterrupted,
                    fmt::format("interrupted after {} of {} ({}): {{resume}} continues", done,
                                count, watch.step)};
    return error.has_value();
  };
  if (watch.tell && count > 0) watch.tell(0, count);
  pool.ForEach(count, [&](size_t i) {
    {
      const std::lock_guard lock(mutex);
      if (is_interrupted()) return;
    }
    const Result<void> result = body(i);
    const std::lock_guard lock(mutex);
    if (is_interrupted()) return;
    if (!result) {
      error = result.error();
      return;
    }
    ++done;
    if (watch.tell) watch.tell(done, count);
  });
  if (error) return *error;
  return {};
}

}  // namespace lf
