// SPDX-License-Identifier: Apache-2.0
#include "lf/core/byte_text.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(ByteText, IsNeverZeroUnlessTheSizeIs) {
  EXPECT_EQ(ByteText(0), "0 bytes");
  EXPECT_EQ(ByteText(1), "1 byte");
  EXPECT_EQ(ByteText(1023), "1023 bytes");
  EXPECT_EQ(ByteText(1024), "1 KiB");
  EXPECT_EQ(ByteText((uint64_t{1} << 20) - 1), "1023 KiB");
  EXPECT_EQ(ByteText(uint64_t{1} << 20), "1 MiB");
  EXPECT_EQ(ByteText(uint64_t{8} << 30), "8192 MiB");
}

}  // namespace
}  // namespace lf
