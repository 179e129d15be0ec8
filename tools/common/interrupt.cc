// SPDX-License-Identifier: Apache-2.0
#include "tools/common/interrupt.h"

#include <signal.h>
#include <time.h>

#include <cstdint>

namespace lf {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);
static_assert(std::atomic<int64_t>::is_always_lock_free);

RenderSignals render_signals;
std::atomic<int64_t> first_interrupt_ns = 0;

// Interrupts within this time count as one, because wrappers such as `timeout` send an interrupt
// twice: to the program and to its process group.
constexpr int64_t kOneInterrupt_ns = 500'000'000;

int64_t NowNanoseconds() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);  // allowed in signal handlers
  return int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// Sets the flag. If a person repeats SIGINT, ends the program at once.
void Interrupt(int signal, std::atomic<bool>* flag) {
  if (!*flag) {
    first_interrupt_ns = NowNanoseconds();
    *flag = true;
  } else if (signal == SIGINT && NowNanoseconds() - first_interrupt_ns > kOneInterrupt_ns) {
    ::signal(SIGINT, SIG_DFL);
    ::raise(SIGINT);
  }
}

void OnSignal(int signal) { Interrupt(signal, &interrupted); }

void OnRenderSignal(int signal) {
  if (signal == SIGUSR1)
    render_signals.save = true;
  else
    Interrupt(signal, &render_signals.stop);
  render_signals.attention = true;
}

bool IsIgnored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

const std::atomic<bool>& CatchInterrupts() {
  struct sigaction action {};
  action.sa_handler = OnSignal;
  for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
  if (!IsIgnored(SIGHUP)) ::sigaction(SIGHUP, &action, nullptr);
  return interrupted;
}

RenderSignals& CatchRenderSignals() {
  struct sigaction action {};
  action.sa_handler = OnRenderSignal;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) ::sigaction(signal, &action, nullptr);
  if (!IsIgnored(SIGHUP)) ::sigaction(SIGHUP, &action, nullptr);
  return render_signals;
}

}  // namespace lf
