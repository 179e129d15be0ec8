// SPDX-License-Identifier: Apache-2.0
// A separate folder for every test, and pictures of noise.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "lf/core/image.h"
#include "lf/core/random.h"

namespace lf {

class FolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("lf_") + test->test_suite_name() + "." + test->name() + "." +
               std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

template <class T>
Image<T> NoiseImage(int width, int height, int channels) {
  Image<T> image(width, height, channels);
  uint64_t i = 0;
  for (T& value : image.pixels()) value = static_cast<T>(RandomBits(1, 2, i++));
  return image;
}

}  // namespace lf
