// SPDX-License-Identifier: Apache-2.0
// Measures the time and memory of reading a transforms.json with 10,000 to a million frames (300
// bytes each). The file is first written into the temporary folder. Reports the peak memory of the
// process before reading and at the end. The peak includes earlier benchmarks; therefore run one
// benchmark at a time (--benchmark_filter=Read/1000000).
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cstdio>

#include "lf/core/check.h"
#include "lf/core/random.h"
#include "lf/light_field/transforms_json/opengl_pose.h"
#include "lf/light_field/transforms_json/transforms_json.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

// Returns random pose i. Most of its numbers have 16 or 17 digits, as programs write doubles.
Mat34 Pose(uint64_t i) {
  const auto uniform = [i](uint64_t k) { return std::ldexp(RandomBits(0, i, k), -63) - 1; };
  Mat34 pose;
  pose.leftCols<3>() =
      Eigen::AngleAxisd(uniform(0), Vec3(uniform(1), uniform(2), 1).normalized()).matrix();
  pose.col(3) = Vec3(uniform(3), uniform(4), uniform(5));
  return pose;
}

void WriteFrames(const fs::path& path, uint64_t count) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  LF_CHECK(file);
  fmt::print(file, "{{\"fl_x\": 500, \"w\": 640, \"h\": 480, \"frames\": [\n");
  for (uint64_t i = 0; i < count; ++i) {
    fmt::print(file, "{{\"file_path\": \"images/{:07}.jpg\", \"transform_matrix\": [", i);
    const Mat34 pose = Pose(i);
    for (int row = 0; row < 3; ++row)
      fmt::print(file, "[{}, {}, {}, {}], ", pose(row, 0), pose(row, 1), pose(row, 2),
                 pose(row, 3));
    fmt::print(file, "[0, 0, 0, 1]]}}{}\n", i + 1 < count ? "," : "]}");
  }
  LF_CHECK(std::fclose(file) == 0);
}

double PeakMiB() {
  struct rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// The argument is the number of frames.
void BM_Read(benchmark::State& state) {
  const fs::path path = fs::temp_directory_path() / fmt::format("lf_native_{}.json", ::getpid());
  WriteFrames(path, static_cast<uint64_t>(state.range(0)));
  const double before_mib = PeakMiB();
  for (auto _ : state) {
    const Result<LightField> light_field = ReadTransformsJson(path);
    LF_CHECK(light_field && light_field->size() == static_cast<size_t>(state.range(0)));
  }
  fs::remove(path);
  state.counters["before_MiB"] = before_mib;
  state.counters["peak_MiB"] = PeakMiB();
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(BM_Read)->RangeMultiplier(10)->Range(10'000, 1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lf
