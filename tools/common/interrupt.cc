// SPDX-License-Identifier: Apache-2.0
#include "tools/common/interrupt.h"

#include <signal.h>
#include <time.h>

#include <cerrno>
#include <cstdint>

#include "tools/common/process_start.h"

#include "lf/storage/remote/remote_options.h"

namespace lf {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);
static_assert(std::atomic<int64_t>::is_always_lock_free);

RenderSignals render_signals;
std::atomic<int64_t> first_interrupt_ns = 0;

// The timer that ends a program whose work does not notice the signal, and the time until then.
timer_t patience_timer{};
bool has_patience_timer = false;
constexpr itimerspec kPatience = {.it_interval = {}, .it_value = {1, 500'000'000}};
std::atomic<int> ends_soon_count = 0;  // objects of EndsSoon
static_assert(std::atomic<int>::is_always_lock_free);

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
    const int error = errno;
    first_interrupt_ns = NowNanoseconds();
    if (ends_soon_count > 0 && has_patience_timer)
      ::timer_settime(patience_timer, 0, &kPatience, nullptr);
    *flag = true;
    errno = error;
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

EndsSoon::EndsSoon() {
  if (!has_patience_timer) {
    struct sigaction action {};
    action.sa_handler = [](int) { EndInterrupted(); };
    ::sigaction(SIGALRM, &action, nullptr);
    // The timer sends SIGALRM, because nothing else is asked for. If the system has none left, the
    // program ends when its work notices the flag.
    has_patience_timer = ::timer_create(CLOCK_MONOTONIC, nullptr, &patience_timer) == 0;
  }
  ++ends_soon_count;
}

EndsSoon::~EndsSoon() { --ends_soon_count; }

const std::atomic<bool>& CatchInterrupts() {
  static const EndsSoon always;
  return CatchInterruptsOfJob();
}

const std::atomic<bool>& CatchInterruptsOfJob() {
  struct sigaction action {};
  action.sa_handler = OnSignal;
  for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
  if (!IsIgnored(SIGHUP)) ::sigaction(SIGHUP, &action, nullptr);
  StopRemoteReadsIf(&interrupted);
  return interrupted;
}

RenderSignals& CatchRenderSignals() {
  struct sigaction action {};
  action.sa_handler = OnRenderSignal;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) ::sigaction(signal, &action, nullptr);
  if (!IsIgnored(SIGHUP)) ::sigaction(SIGHUP, &action, nullptr);
  StopRemoteReadsIf(&render_signals.stop);
  return render_signals;
}

}  // namespace lf
