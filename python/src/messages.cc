// SPDX-License-Identifier: Apache-2.0
#include "python/src/messages.h"

#include <pybind11/pybind11.h>

#include <string>

#include "python/src/errors.h"
#include "python/src/gil.h"

#include "lf/core/log.h"

namespace lf::python {
namespace {

namespace py = pybind11;

int LevelOf(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return 10;
    case LogLevel::kInfo:
      return 20;
    case LogLevel::kWarning:
      return 30;
    case LogLevel::kError:
      return 40;
  }
  return 40;
}

// Hands a message to the logger. Any thread may call it, even while Python ends: the message is
// then lost.
void SendToPython(LogLevel level, std::string_view message) {
  const GilHold hold;
  if (!hold.has_lock()) return;
  try {
    py::module_::import("logging")
        .attr("getLogger")("lfrendertools")
        .attr("log")(LevelOf(level), "%s", TextOf(std::string(message)));
  } catch (py::error_already_set& error) {
    error.discard_as_unraisable("a handler of the logger lfrendertools");
  }
}

}  // namespace

void SendMessagesToPython() {
  SetLogLevel(LogLevel::kDebug);
  SetLogReceiver(&SendToPython);
}

}  // namespace lf::python
