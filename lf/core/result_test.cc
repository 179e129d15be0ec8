// SPDX-License-Identifier: Apache-2.0
#include "lf/core/result.h"

#include <gtest/gtest.h>

#include <memory>

namespace lf {
namespace {

Result<int> Half(int n) {
  if (n % 2 != 0) return InputError("odd");
  return n / 2;
}

Result<int> Quarter(int n) {
  LF_ASSIGN_OR_RETURN(const int half, Half(n));
  LF_ASSIGN_OR_RETURN(const int quarter, Half(half));
  return quarter;
}

Result<void> MustBeEven(int n) {
  LF_RETURN_IF_ERROR(Half(n));
  return {};
}

TEST(Result, CarriesAValueThroughCalls) { EXPECT_EQ(*Quarter(12), 3); }

TEST(Result, CarriesAnErrorThroughCalls) {
  EXPECT_EQ(Quarter(6).error().message, "odd");
  EXPECT_EQ(Quarter(6).error().kind, ErrorKind::kInput);
  EXPECT_FALSE(MustBeEven(3));
  EXPECT_TRUE(MustBeEven(2));
}

TEST(Result, HoldsWhatCanOnlyBeMoved) {
  Result<std::unique_ptr<int>> result(std::make_unique<int>(7));
  const std::unique_ptr<int> owned = *std::move(result);
  EXPECT_EQ(*owned, 7);
}

}  // namespace
}  // namespace lf
