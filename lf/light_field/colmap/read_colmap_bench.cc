// SPDX-License-Identifier: Apache-2.0
// Measures the time and memory of reading models of a million images with 50 2D points each: 1.3 GB
// of images.bin, 2.2 GB of images.txt. The files are first written into the temporary folder.
// Reports the peak memory of the process before reading and at the end, and the size of the light
// field. The peak includes earlier benchmarks; therefore run one benchmark at a time
// (--benchmark_filter=Binary/1/).
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>

#include "lf/light_field/colmap/test_colmap.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

constexpr uint32_t kImageCount = 1'000'000;
constexpr uint64_t kPoints2DCount = 50;
constexpr uint64_t kPointCount = 1'000'000;
constexpr size_t kTrackLength = 10;
constexpr double kMiB = 1 << 20;

class File {
 public:
  explicit File(const fs::path& path) : file_(std::fopen(path.c_str(), "wb")) { LF_CHECK(file_); }
  ~File() { LF_CHECK(std::fclose(file_) == 0); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  void Write(std::string_view bytes) {
    LF_CHECK(std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size());
  }

 private:
  std::FILE* file_;
};

// Images are written in descending order of their ids and names, because COLMAP may write any
// order.
TestImage Image(uint32_t i, uint32_t camera_count) {
  const uint32_t id = kImageCount - i;
  return {.id = id,
          .translation = {0.001 * (id % 1000), 0.001 * (id / 1000), 0},
          .camera_id = id % camera_count + 1,
          .name = fmt::format("capture/image_{:07}.jpg", id),
          .point_count = kPoints2DCount};
}

TestCamera Camera(uint32_t i) { return {.id = i + 1, .parameters = {1000.0 + i, 1000, 4, 3}}; }

void WriteBinary(const fs::path& folder, uint32_t camera_count) {
  File cameras(folder / "cameras.bin");
  cameras.Write(PackedBytes().Put(uint64_t{camera_count}).bytes());
  for (uint32_t i = 0; i < camera_count; ++i) cameras.Write(CamerasBin({Camera(i)}).substr(8));
  File images(folder / "images.bin");
  images.Write(PackedBytes().Put(uint64_t{kImageCount}).bytes());
  for (uint32_t i = 0; i < kImageCount; ++i)
    images.Write(ImagesBin({Image(i, camera_count)}).substr(8));
  File points(folder / "points3D.bin");
  points.Write(PackedBytes().Put(kPointCount).bytes());
  for (uint64_t i = 0; i < kPointCount; ++i) {
    TestPoint point{.id = i, .xyz = {0, 0, 1 + 1e-6 * static_cast<double>(i)}};
    for (size_t k = 0; k < kTrackLength; ++k)
      point.track.push_back(static_cast<uint32_t>((i * 7919 + k * 1013) % kImageCount + 1));
    points.Write(PointsBin({point}).substr(8));
  }
}

void WriteText(const fs::path& folder, uint32_t camera_count) {
  File cameras(folder / "cameras.txt");
  for (uint32_t i = 0; i < camera_count; ++i)
    cameras.Write(fmt::format("{} PINHOLE 8 6 {} 1000 4 3\n", i + 1, 1000.0 + i));
  std::string points2d;
  for (uint64_t k = 0; k < kPoints2DCount; ++k)
    points2d += "960.12345678901234 540.98765432109876 -1 ";
  File images(folder / "images.txt");
  for (uint32_t i = 0; i < kImageCount; ++i) {
    const TestImage image = Image(i, camera_count);
    images.Write(fmt::format("{} 1 0 0 0 {} {} 0 {} {}\n{}\n", image.id, image.translation[0],
                             image.translation[1], image.camera_id, image.name, points2d));
  }
}

double PeakMiB() {
  struct rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void Read(benchmark::State& state, void (*write)(const fs::path&, uint32_t)) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("lf_colmap_{}", ::getpid());
  fs::create_directories(folder);
  write(folder, static_cast<uint32_t>(state.range(0)));
  const double before_mib = PeakMiB();
  double field_mib = 0;
  for (auto _ : state) {
    const Result<LightField> light_field = ReadColmapModel(folder, folder);
    LF_CHECK(light_field && light_field->size() == kImageCount);
    size_t bytes = light_field->cameras.capacity() * sizeof(LfCamera) +
                   light_field->intrinsics.capacity() * sizeof(Intrinsics) +
                   light_field->image_names.capacity() * sizeof(std::string);
    for (const std::string& name : light_field->image_names) bytes += name.capacity() + 1 + 16;
    field_mib = static_cast<double>(bytes) / kMiB;
  }
  fs::remove_all(folder);
  state.counters["before_MiB"] = before_mib;
  state.counters["peak_MiB"] = PeakMiB();
  state.counters["field_MiB"] = field_mib;
}

// The argument is the number of cameras.
void BM_Binary(benchmark::State& state) { Read(state, WriteBinary); }
void BM_Text(benchmark::State& state) { Read(state, WriteText); }
BENCHMARK(BM_Binary)->Arg(1)->Arg(kImageCount)->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(BM_Text)->Arg(1)->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace
}  // namespace lf
