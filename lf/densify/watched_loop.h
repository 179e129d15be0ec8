// SPDX-License-Identifier: Apache-2.0
// Loops over many seconds of work that end early when the user interrupts, and that tell how far
// they are.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

#include "lf/core/parallel.h"
#include "lf/core/result.h"

namespace lf {

// A flag that becomes true once the user interrupts, and stays true; null: nobody interrupts.
using InterruptFlag = const std::atomic<bool>*;

inline bool IsSet(InterruptFlag flag) {
  return flag != nullptr && flag->load(std::memory_order_relaxed);
}

struct Watch {
  const char* step = "";  // what the loop does, for messages
  InterruptFlag interrupted = nullptr;
  // Is called before the first item and after each, by one thread at a time; empty: nobody asks.
  std::function<void(size_t done, size_t count)> tell = {};
};

// Calls body(i) for every i in [0, count) on all threads. The first error ends the loop, and is
// returned. kInterrupted: the flag was set before the last call ended; what that call returned must
// not be used, because functions that look at the flag themselves return something unfinished.
Result<void> ForEachWatched(ThreadPool& pool, size_t count, const Watch& watch,
                            const std::function<Result<void>(size_t)>& body);

}  // namespace lf
