// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/entropy.h"

#include <gtest/gtest.h>

#include <vector>

namespace lf {
namespace {

std::string CodeOf(uint64_t number) {
  std::string code;
  AppendNumber(number, &code);
  return code;
}

TEST(Numbers, TakeSevenBitsOfAByteTheLowestFirst) {
  EXPECT_EQ(CodeOf(0), std::string("\0", 1));
  EXPECT_EQ(CodeOf(127), "\x7f");
  EXPECT_EQ(CodeOf(128), "\x80\x01");
  EXPECT_EQ(CodeOf(300), "\xac\x02");
  EXPECT_EQ(CodeOf(UINT64_MAX).size(), 10u);
}

TEST(Numbers, AreTakenUpToTheirLimitAndNoFurther) {
  for (const uint64_t number : {uint64_t{0}, uint64_t{1}, uint64_t{127}, uint64_t{128},
                                uint64_t{1} << 30, uint64_t{1} << 63, UINT64_MAX}) {
    const std::string bytes = CodeOf(number) + "rest";
    uint64_t taken = 7;
    std::string_view code = bytes;
    ASSERT_TRUE(TakeNumber(&code, number, &taken)) << number;
    EXPECT_EQ(taken, number);
    EXPECT_EQ(code, "rest");
    code = bytes;
    if (number == 0) continue;
    EXPECT_FALSE(TakeNumber(&code, number - 1, &taken)) << number;
  }
}

TEST(Numbers, EndWithinTheCode) {
  uint64_t number = 0;
  for (const std::string& bytes :
       {std::string(), std::string("\x80"), std::string("\xff\xff"), std::string(20, '\x80')}) {
    std::string_view code = bytes;
    EXPECT_FALSE(TakeNumber(&code, UINT64_MAX, &number)) << bytes.size();
  }
}

TEST(Compressed, GivesExactlyAsManyBytesAsWereCompressed) {
  const std::vector<uint8_t> bytes = {1, 2, 3, 3, 3, 3, 200};
  std::string code;
  AppendCompressed(bytes, &code);
  for (const size_t room : {bytes.size() - 1, bytes.size(), bytes.size() + 1}) {
    std::vector<uint8_t> out(room);
    EXPECT_EQ(Decompress(code, out), room == bytes.size()) << room;
  }
  std::vector<uint8_t> out(bytes.size());
  EXPECT_TRUE(Decompress(code, out));
  EXPECT_EQ(out, bytes);
}

}  // namespace
}  // namespace lf
