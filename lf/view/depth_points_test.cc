// SPDX-License-Identifier: Apache-2.0
#include "lf/view/depth_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

using DepthPointsTest = FolderTest;

constexpr float kUnknown = std::numeric_limits<float>::infinity();

PinholeCamera SomeCamera(int width, int height) {
  PinholeCamera camera;
  camera.intrinsics = {50, 40, 0.4 * width, 0.6 * height, 0, width, height};
  camera.cam_from_world.rotation =
      Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  camera.cam_from_world.translation = {0.3, -0.7, 1.1};
  return camera;
}

// The attribute worldToNDC: (x, y, z, 1) times it is (u w, v w, w - g, w).
std::array<float, 16> WorldToNdc(const PinholeCamera& camera) {
  const Intrinsics& k = camera.intrinsics;
  const Mat3 scale = Vec3(1.0 / k.width_px, 1.0 / k.height_px, 1).asDiagonal();
  const Mat3 by_point = scale * k.Matrix() * camera.cam_from_world.rotation;
  const Vec3 constant = scale * k.Matrix() * camera.cam_from_world.translation;
  std::array<float, 16> matrix = {};
  for (int column = 0; column < 4; ++column) {
    const int row = std::min(column, 2);
    for (int axis = 0; axis < 3; ++axis)
      matrix[static_cast<size_t>(4 * axis + column)] = static_cast<float>(by_point(row, axis));
    matrix[static_cast<size_t>(12 + column)] =
        static_cast<float>(constant[row] - (column == 2 ? 1.5 : 0));
  }
  return matrix;
}

struct DepthMapFile {
  int width = 4, height = 3;
  std::vector<float> z = std::vector<float>(12, 2.0f);
  std::vector<float> confidence = std::vector<float>(12, 1.0f);
  std::string z_name = "Z";
  bool has_colours = true, has_confidence = true;
  ImageMetadata metadata = {{"worldToNDC", WorldToNdc(SomeCamera(4, 3))}, {"lf:unit_m", 0.5}};

  void Write(const std::filesystem::path& path) const {
    Image<float> numbers(width, height, 5, 0.25f);
    for (size_t i = 0; i < z.size(); ++i) {
      numbers.pixels()[5 * i] = z[i];
      numbers.pixels()[5 * i + 1] = confidence[i];
    }
    std::vector<ExrChannel> channels = {{z_name, numbers.view(), 0, false}};
    if (has_confidence) channels.push_back({"confidence", numbers.view(), 1, true});
    if (has_colours)
      for (int c = 0; c < 3; ++c)
        channels.push_back({std::string(1, "RGB"[c]), numbers.view(), 2 + c, true});
    ASSERT_TRUE(WriteExr(path, channels, metadata));
  }
};

std::string FaultOf(const std::filesystem::path& path) {
  const auto read = ReadDepthPoints(path, Vec3::Zero(), 0.5);
  if (read) return "none";
  EXPECT_TRUE(read.error().message.starts_with(path.string() + ": ")) << read.error().message;
  return read.error().message.substr(path.string().size() + 2);
}

TEST_F(DepthPointsTest, ElementsOfADepthMapAreWhereTheirCameraSeesThem) {
  DepthMapFile file;
  for (size_t i = 0; i < 12; ++i) file.z[i] = 1 + 0.25f * static_cast<float>(i);
  file.z[5] = kUnknown;
  file.confidence[6] = 0.5f;
  file.Write(folder_ / "z.exr");
  const Vec3 origin(100, 200, -300);
  const auto read = ReadDepthPoints(folder_ / "z.exr", origin, 0.5);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->count_in_file, 11u);
  EXPECT_EQ(read->unknown_count, 1u);
  ASSERT_EQ(read->places.size(), 11u);
  const PinholeCamera camera = SomeCamera(4, 3);
  EXPECT_NEAR((*read->centre + origin - camera.CentreWorld()).norm(), 0, 1e-5);
  // A column is 1 / 50 of the distance wide.
  EXPECT_NEAR(read->spread, 1.0 / 50, 1e-6);
  for (size_t i = 0; i < 11; ++i) {
    const size_t element = i < 5 ? i : i + 1;
    const auto& place = read->places[i];
    const Vec3 seen = camera.cam_from_world * (Vec3(place[0], place[1], place[2]) + origin);
    EXPECT_NEAR(seen.z(), file.z[element], 1e-4);
    const Vec3 at = camera.intrinsics.Matrix() * seen / seen.z();
    EXPECT_NEAR(at.x(), static_cast<double>(element % 4) + 0.5, 2e-3);
    EXPECT_NEAR(at.y(), static_cast<double>(element / 4) + 0.5, 2e-3);
    EXPECT_EQ(read->colours[i][0], 137);  // 0.25 in sRGB
    EXPECT_EQ(read->colours[i][3], element == 6 ? 128 : 255);
  }
  const std::string bytes = DepthBytes(*read);
  ASSERT_EQ(bytes.size(), 4u + 11 * 16);
  float x = 0;
  std::memcpy(&x, bytes.data() + 4 + 12 * 10, 4);
  EXPECT_EQ(x, read->places[10][0]);
  EXPECT_EQ(static_cast<uint8_t>(bytes.back()), 255);
}

TEST_F(DepthPointsTest, ColoursAndConfidenceMayBeMissing) {
  DepthMapFile file;
  file.has_colours = file.has_confidence = false;
  file.metadata.pop_back();  // nor does the file state its unit
  file.Write(folder_ / "z.exr");
  const DepthPoints points = ReadDepthPoints(folder_ / "z.exr", Vec3::Zero(), 7).value();
  EXPECT_FALSE(points.has_colours || points.has_confidence);
  EXPECT_EQ(points.colours[3], (std::array<uint8_t, 4>{160, 160, 160, 255}));
}

TEST_F(DepthPointsTest, AFileThatIsNoDepthMapIsRefusedWithItsFault) {
  const auto fault_of = [&](auto change) {
    DepthMapFile file;
    change(file);
    file.Write(folder_ / "z.exr");
    return FaultOf(folder_ / "z.exr");
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::pair<std::string, std::string> faults[] = {
      {fault_of([](DepthMapFile&) {}), "none"},
      {fault_of([](DepthMapFile& f) { f.z_name = "depth.V"; }), "no channel Z"},
      {fault_of([](DepthMapFile& f) { f.metadata.erase(f.metadata.begin()); }),
       "no attribute worldToNDC"},
      {fault_of([](DepthMapFile& f) { f.metadata[0].second = std::array<float, 16>{}; }),
       "is not the matrix of a camera"},
      {fault_of([](DepthMapFile& f) {
         std::get<std::array<float, 16>>(f.metadata[0].second)[5] = kNan;
       }),
       "is not the matrix of a camera"},
      {fault_of([](DepthMapFile& f) { f.metadata[1].second = 0.25; }),
       "world units of 0.25 m, but those of the light field are 0.5 m"},
      {fault_of([](DepthMapFile& f) { f.z[6] = kNan; }), "Z is nan in column 2 of row 1"},
      {fault_of([](DepthMapFile& f) { f.z[6] = 0; }), "Z is 0 in column 2 of row 1"},
      {fault_of([](DepthMapFile& f) { f.z[6] = -kUnknown; }), "Z is -inf in column 2 of row 1"},
      {fault_of([](DepthMapFile& f) { f.confidence[6] = kNan; }), "confidence is nan in column 2"},
      {fault_of([](DepthMapFile& f) { f.confidence[6] = 1.5f; }), "confidence is 1.5"},
      {fault_of([](DepthMapFile& f) { f.z.assign(12, kUnknown); }), "no element has a depth"}};
  for (const auto& [fault, expected] : faults)
    EXPECT_NE(fault.find(expected), std::string::npos) << fault << " / " << expected;
  ASSERT_TRUE(WriteImage(folder_ / "p.png", NoiseImage<uint8_t>(4, 3, 3).view()));
  std::filesystem::rename(folder_ / "p.png", folder_ / "p.exr");
  EXPECT_NE(FaultOf(folder_ / "p.exr").find("no channel Z"), std::string::npos);
  EXPECT_EQ(ReadDepthPoints(folder_ / "z.pfm", Vec3::Zero(), 1).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(ReadDepthPoints(folder_ / "none.ply", Vec3::Zero(), 1).error().kind, ErrorKind::kInput);
}

template <class T>
void Append(T value, std::string* bytes) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes->append(raw, sizeof(T));
}

// As lffocus depth writes it.
std::string PlyFile(size_t count, const std::string& unit = "0.5") {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment world units; " + unit +
      " m each\nelement vertex " + std::to_string(count) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar "
      "green\nproperty uchar blue\nproperty float confidence\nend_header\n";
  for (size_t i = 0; i < count; ++i) {
    for (const double place : {10.0 + static_cast<double>(i), 20.0, 30.0})
      Append(static_cast<float>(place), &bytes);
    for (const int colour : {1, 2, 250}) Append(static_cast<uint8_t>(colour), &bytes);
    Append(0.2f, &bytes);
  }
  return bytes;
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(DepthPointsTest, APointCloudIsReadAsItIs) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "p.ply", PlyFile(7)));
  const auto read = ReadDepthPoints(folder_ / "p.ply", Vec3(10, 20, 20), 0.5);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->places.size(), 7u);
  EXPECT_EQ(read->places[3], (std::array<float, 3>{3, 0, 10}));
  EXPECT_EQ(read->colours[3], (std::array<uint8_t, 4>{1, 2, 250, 51}));
  EXPECT_FALSE(read->centre.has_value());
}

TEST_F(DepthPointsTest, OtherOrdersAndTypesOfPropertiesAreRead) {
  std::string bytes =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\nproperty short flag\r\n"
      "property double z\r\nproperty double y\r\nproperty float x\r\nelement face 1\r\n"
      "property list uchar int vertex_indices\r\nend_header\r\n";
  Append(int16_t{5}, &bytes);
  Append(3.0, &bytes);
  Append(2.0, &bytes);
  Append(1.0f, &bytes);
  const DepthPoints points = ReadPlyPoints(bytes, "p.ply", Vec3::Zero(), 1).value();
  ASSERT_EQ(points.places.size(), 1u);
  EXPECT_EQ(points.places[0], (std::array<float, 3>{1, 2, 3}));
  EXPECT_FALSE(points.has_colours || points.has_confidence);
}

TEST_F(DepthPointsTest, AFileThatIsNoPointCloudIsRefusedWithItsFault) {
  const std::string good = PlyFile(3);
  const auto fault_of = [](const std::string& bytes) {
    const auto read = ReadPlyPoints(bytes, "p.ply", Vec3::Zero(), 0.5);
    return read ? "none" : read.error().message;
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    return fault_of(Replaced(good, from, to));
  };
  std::string nan = good, sure = good;
  const float values[] = {std::numeric_limits<float>::quiet_NaN(), 1.25f};
  std::memcpy(nan.data() + good.size() - 11, values, 4);      // z of the last point
  std::memcpy(sure.data() + good.size() - 4, values + 1, 4);  // its confidence
  const std::pair<std::string, std::string> faults[] = {
      {fault_of(good), "none"},
      {fault_of(""), "is no PLY file"},
      {fault_of("PNG\n"), "is no PLY file"},
      {fault_of("ply\n"), "no line end_header"},
      {with("binary_little_endian", "ascii"), "has the format ascii"},
      {with("format binary_little_endian 1.0\n", ""), "states no format"},
      {with("element vertex 3", "element face 3"), "its first element is `element face 3`"},
      {with("element vertex 3", "element vertex -3"), "its first element"},
      {with("element vertex 3", "element vertex 0"), "has no point"},
      {with("element vertex 3", "element vertex 4"), "is truncated: 4 points of 19 bytes"},
      {with("element vertex 3", "element vertex 18446744073709551615"), "is truncated"},
      {with("property float y", "property float w"), "no property y"},
      {with("property float y", "property list uchar float y"), "and no list"},
      {with("property float y", "property int y"), "property y is int"},
      {with("property uchar red", "property float red"), "property red is float"},
      {with("0.5 m each", "0.25 m each"), "world units of 0.25 m"},
      {fault_of(nan), "point 2 is at 12, 20, nan"},
      {fault_of(sure), "the confidence of point 2 is 1.25"}};
  for (const auto& [fault, expected] : faults) {
    EXPECT_NE(fault.find(expected), std::string::npos) << fault << " / " << expected;
    EXPECT_TRUE(expected == "none" || fault.starts_with("p.ply: ")) << fault;
  }
}

TEST_F(DepthPointsTest, LargeFilesAreThinnedEvenly) {
  const std::string bytes = PlyFile(1003);
  const DepthPoints points = ReadPlyPoints(bytes, "p.ply", Vec3(10, 0, 0), 0.5, 100).value();
  EXPECT_EQ(points.count_in_file, 1003u);
  ASSERT_EQ(points.places.size(), 92u);  // one of each 11, and one of the last 2
  std::set<int> offsets;
  for (size_t i = 0; i < points.places.size(); ++i) {
    const int index = static_cast<int>(points.places[i][0]);
    EXPECT_EQ(index / 11, static_cast<int>(i));
    offsets.insert(index % 11);
  }
  EXPECT_GT(offsets.size(), 8u);
  EXPECT_EQ(ReadPlyPoints(bytes, "p.ply", Vec3::Zero(), 0.5, 1003).value().places.size(), 1003u);
  EXPECT_EQ(ReadPlyPoints(bytes, "p.ply", Vec3::Zero(), 0.5, 1).value().places.size(), 1u);
}

}  // namespace
}  // namespace lf
