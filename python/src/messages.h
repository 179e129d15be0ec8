// SPDX-License-Identifier: Apache-2.0
// Hands messages of the library to Python's logging, as the logger "lfrendertools".
#pragma once

namespace lf::python {

void SendMessagesToPython();

}  // namespace lf::python
