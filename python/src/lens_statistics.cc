// SPDX-License-Identifier: Apache-2.0
#include "python/src/lens_statistics.h"

#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/src/errors.h"
#include "python/src/frames.h"
#include "python/src/light_field.h"
#include "python/src/work.h"

#include "lf/analysis/lens_statistics/lens_statistics.h"
#include "lf/core/geometry.h"
#include "lf/core/quantities.h"
#include "lf/core/spelling.h"
#include "lf/core/value_named.h"
#include "lf/core/version.h"

namespace lf::python {
namespace {

namespace py = pybind11;
using Tell = std::function<void(size_t done, size_t total, int phase)>;

// Returns the frame, and name and reason of each broken LF image. The package has checked the
// words.
py::tuple Through(const OpenedField& field, uint32_t frame, const RenderCamera& camera, double fps,
                  const std::string& statistic, double trim, const std::string& order,
                  const std::string& filter, const std::string& lf_pixels,
                  std::optional<double> max_angle_deg, bool strict, const std::string& memory,
                  int threads, const Tell& tell) {
  ThreadPool& pool = PoolOf(threads);
  WorkSignals signals;
  signals.tell = tell;
  LensStatisticOptions options;
  options.statistic =
      ValueNamed(statistic, {LensStatistic::kMedian, LensStatistic::kTrimmed, LensStatistic::kMin,
                             LensStatistic::kMax, LensStatistic::kMean})
          .value();
  options.trim = trim;
  options.order =
      ValueNamed(order, {StatisticOrder::kChannels, StatisticOrder::kLuminance}).value();
  options.filter = ValueNamed(filter, {PixelFilter::kNearest, PixelFilter::kBilinear,
                                       PixelFilter::kBicubic, PixelFilter::kPrefiltered})
                       .value_or(PixelFilter::kAuto);
  if (lf_pixels != "auto")
    options.footprint = lf_pixels == "areas" ? PixelFootprint::kArea : PixelFootprint::kPoint;
  if (max_angle_deg) options.max_angle_rad = RadiansFromDegrees(*max_angle_deg);
  options.memory_bytes = Take(ParseByteSize(memory, "{memory}"));
  options.strict = strict;
  options.stop = &signals.stop;
  options.adds_opacity = true;  // for Frame.save(), which may give files alpha
  StatisticFrame made = CallWithoutGil(
      [&] {
        return Take(MakeStatisticFrame(field.light_field, FrameId{frame}, camera, options, pool,
                                       [&](size_t done, size_t total) {
                                         signals.SetProgress({done, total});
                                       }));
      },
      &signals);
  made.notes.fps = fps;
  made.notes.version = Version();
  std::vector<std::pair<std::string, std::string>> skipped;
  for (const SkippedImage& image : made.skipped)
    skipped.emplace_back(image.name, Spelled(image.reason));
  Frame result = MakeFrame(std::move(made.picture), std::move(made.notes), made.keeps_opacity);
  result.more_metadata = StatisticMetadata(options);
  return py::make_tuple(std::move(result), skipped);
}

}  // namespace

void AddLensStatistics(py::module_& module) { module.def("through", &Through); }

}  // namespace lf::python
