// SPDX-License-Identifier: Apache-2.0
#include "lf/core/byte_text.h"

#include <fmt/format.h>

namespace lf {

std::string ByteText(uint64_t bytes) {
  constexpr int kKibiBits = 10, kMebiBits = 20;
  if (bytes >> kMebiBits > 0) return fmt::format("{} MiB", bytes >> kMebiBits);
  if (bytes >> kKibiBits > 0) return fmt::format("{} KiB", bytes >> kKibiBits);
  return bytes == 1 ? "1 byte" : fmt::format("{} bytes", bytes);
}

}  // namespace lf
