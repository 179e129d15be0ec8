// SPDX-License-Identifier: Apache-2.0
#include "lf/core/version.h"

namespace lf {

const char* Version() { return LF_VERSION; }

}  // namespace lf
