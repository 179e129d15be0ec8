// SPDX-License-Identifier: Apache-2.0
// The version of the project, which files and reports state.
#pragma once

namespace lf {

// Returns a text such as "0.1.0".
const char* Version();

// The builds that read files of versions that version 0.1.0 replaced, for messages.
inline constexpr const char* kBuildsOfEarlierFiles =
    "builds of lfrendertools from before version 0.1.0";

}  // namespace lf
