#include "tools/common/interrupt.h"

#include <signal.h>

namespace lf {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void OnSignal(int) { interrupted = true; }

RenderSignals render_signals;

void OnRenderSignal(int signal) {
  if (signal == SIGUSR1) {
    render_signals.save = true;
  } else {
    render_signals.stop = true;
    ::signal(SIGINT, SIG_DFL);
  }
  render_signals.attention = true;
}

}  // namespace

const std::atomic<bool>& CatchInterrupts() {
  struct sigaction action {};
  action.sa_handler = OnSignal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  return interrupted;
}

RenderSignals& CatchRenderSignals() {
  struct sigaction action {};
  action.sa_handler = OnRenderSignal;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) ::sigaction(signal, &action, nullptr);
  return render_signals;
}

}  // namespace lf
