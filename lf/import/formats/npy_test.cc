// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/npy.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace lf {
namespace {

// Returns a file of the given format version as numpy.save writes it, but without padding.
std::string Npy(const std::string& header, const std::string& values, char version = 1) {
  std::string bytes = "\x93NUMPY";
  bytes += version;
  bytes += '\0';
  bytes += static_cast<char>(header.size() & 255);
  bytes += static_cast<char>(header.size() >> 8);
  if (version == 2) bytes += std::string(2, '\0');
  return bytes + header + values;
}

template <class T>
std::string Bytes(std::initializer_list<T> values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}

std::string NpyErrorOf(const std::string& bytes) {
  const Result<NpyArray> array = ParseNpy(bytes);
  EXPECT_FALSE(array);
  return array ? "" : array.error().message;
}

void ExpectNpyError(const std::string& bytes, const std::string& part) {
  const std::string message = NpyErrorOf(bytes);
  EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

const std::string kTwo = "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }";
const std::string kValues = Bytes<double>({1.5, -2});

TEST(Npy, ReadsDoublesAndFloatsInCOrder) {
  const NpyArray doubles = *ParseNpy(
      Npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }                   \n",
          Bytes<double>({1, 2, 3, 4, 5, 0.1})));
  EXPECT_EQ(doubles.shape, (std::vector<size_t>{2, 3}));
  EXPECT_EQ(doubles.values, (std::vector<double>{1, 2, 3, 4, 5, 0.1}));
  const NpyArray floats = *ParseNpy(Npy(
      "{\"shape\":(2,),\"fortran_order\":False,\"descr\":\"<f4\"}", Bytes<float>({1.5F, 0.1F}), 2));
  EXPECT_EQ(floats.values, (std::vector<double>{1.5, 0.1F}));
}

// Reads the bytes that numpy.save writes for [[1, 2.5]], whose header is padded to a multiple of 64
// bytes.
TEST(Npy, ReadsTheBytesOfNumpyItself) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2), }";
  header += std::string(117 - header.size(), ' ') + "\n";
  const std::string bytes = Npy(header, Bytes<double>({1, 2.5}));
  ASSERT_EQ(bytes.size(), 128u + 16u);
  EXPECT_EQ(bytes.substr(6, 4), std::string("\x01\x00\x76\x00", 4));
  EXPECT_EQ(ParseNpy(bytes)->values, (std::vector<double>{1, 2.5}));
}

TEST(Npy, OtherTypesAndOrdersAreErrorsThatNameThem) {
  const auto header = [](const std::string& descr, const std::string& order) {
    return "{'descr': " + descr + ", 'fortran_order': " + order + ", 'shape': (2,)}";
  };
  ExpectNpyError(Npy(header("'>f8'", "False"), kValues), "type '>f8': expected '<f8' or '<f4'");
  ExpectNpyError(Npy(header("'|O'", "False"), kValues), "type '|O'");
  ExpectNpyError(Npy(header("[('x', '<f8')]", "False"), kValues), "has the .npy header");
  ExpectNpyError(Npy(header("'<f8'", "True"), kValues), "Fortran order");
  ExpectNpyError(Npy(header("'<f8'", "1"), kValues), "has the .npy header");
  ExpectNpyError(Npy(kTwo, kValues, 3), "format version 3");
}

TEST(Npy, BrokenFilesAreErrors) {
  const std::string good = Npy(kTwo, kValues);
  EXPECT_TRUE(ParseNpy(good));
  for (size_t size = 0; size < good.size(); ++size)
    EXPECT_FALSE(ParseNpy(good.substr(0, size))) << size;
  ExpectNpyError("", "is no .npy file");
  ExpectNpyError("PK\x03\x04 an .npz file", "is no .npy file");
  ExpectNpyError(good.substr(0, 9), "truncated");
  ExpectNpyError(good.substr(0, 30), "truncated");
  ExpectNpyError(good.substr(0, good.size() - 1), "holds 15 bytes of numbers: expected 16");
  ExpectNpyError(good + "x", "holds 17 bytes of numbers: expected 16");
  ExpectNpyError(Npy("", kValues), "has the .npy header \"\"");
  ExpectNpyError(Npy("{'shape': (2,)}", kValues), "has the .npy header");
  ExpectNpyError(Npy(kTwo + "x", kValues), "has the .npy header");
  ExpectNpyError(Npy("{'descr': '<f8', 'descr': '<f8'}", kValues), "has the .npy header");
  ExpectNpyError(Npy(std::string("{'descr\0\n': 1}", 14), kValues), "{'descr");
  std::string long_header = Npy(kTwo, kValues, 2);
  long_header[11] = '\x7f';
  ExpectNpyError(long_header, "expected at most 65535");
}

TEST(Npy, ShapesBeyondTheFileAreErrors) {
  const auto shape = [](const std::string& size) {
    return Npy("{'descr': '<f8', 'fortran_order': False, 'shape': " + size + "}", kValues);
  };
  EXPECT_TRUE(ParseNpy(shape("(2, 1, 1, 1)")));
  ExpectNpyError(shape("(0,)"), "holds an array of the shape (0)");
  ExpectNpyError(shape("(3, 0)"), "holds an array of the shape (3, 0)");
  ExpectNpyError(shape("(4294967295, 4294967295)"), "1 to 2^32 numbers");
  ExpectNpyError(shape("(99999999999999999999,)"), "has the .npy header");
  ExpectNpyError(shape("(-2,)"), "has the .npy header");
  ExpectNpyError(shape("(2, 1, 1, 1, 1)"), "holds an array of 5 dimensions");
  ExpectNpyError(shape("(2, 1, 1, 1, 1, 1)"), "has the .npy header");
  ExpectNpyError(shape("(2"), "has the .npy header");
  ExpectNpyError(shape("()"), "holds 16 bytes of numbers: expected 8");
}

}  // namespace
}  // namespace lf
