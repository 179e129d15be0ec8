// SPDX-License-Identifier: Apache-2.0
// The version of the project, which files and reports state.
#pragma once

namespace lf {

// Returns a text such as "0.1.0".
const char* Version();

}  // namespace lf
