// SPDX-License-Identifier: Apache-2.0
#include "python/src/captures.h"

#include <fmt/format.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/src/cameras.h"
#include "python/src/errors.h"
#include "python/src/light_field.h"
#include "python/src/setting_words.h"
#include "python/src/work.h"

#include "lf/core/quantities.h"
#include "lf/core/shell_word.h"
#include "lf/core/version.h"
#include "lf/densify/densify.h"
#include "lf/densify/densify_report.h"
#include "lf/densify/depth_cache.h"
#include "lf/distribute/compress/codec_words.h"
#include "lf/distribute/compress/compress_report.h"
#include "lf/distribute/compress/demosaicked_images.h"
#include "lf/distribute/preprocess/forecast_report.h"
#include "lf/distribute/preprocess/known_depths.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/report/import_report.h"
#include "lf/light_field/synthetic/synthetic_field.h"
#include "lf/render/settings/interpolation.h"
#include "lf/storage/load/measure_footprint.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf::python {
namespace {

namespace py = pybind11;

using Tell = std::function<void(size_t done, size_t total, int phase)>;

// Work whose progress is told to a function of Python.
struct ToldWork {
  explicit ToldWork(Tell tell) { signals.tell = std::move(tell); }
  std::function<void(size_t, size_t)> Progress() {
    return [this](size_t done, size_t total) { signals.SetProgress({done, total}); };
  }
  WorkSignals signals;
};

// Returns the report of lfimport as JSON.
//   check  "none", "headers" or "pixels"
std::string Report(const OpenedField& field, const std::string& name, const std::string& check,
                   std::optional<double> distance_w, int threads, const Tell& tell) {
  ThreadPool& pool = PoolOf(threads);
  ToldWork work(tell);
  return CallWithoutGil(
      [&] {
        const LightField& light_field = field.light_field;
        ImportReport report;
        report.light_field = name;
        report.first_image = light_field.ImagePath({0}).lexically_normal().string();
        report.capture = ReportCapture(light_field, {distance_w}, pool);
        if (check == "none") return ReportJson(report);
        CheckOptions options;
        options.check = check == "pixels" ? ImageCheck::kPixels : ImageCheck::kHeaders;
        options.interrupted = &work.signals.interrupted;
        options.progress = work.Progress();
        report.faults = Take(CheckImages(light_field, options, pool));
        WarnOfFaults(light_field, &report);
        report.profile = FindProfile(light_field);
        if (report.faults->missing.size() + report.faults->broken.size() < light_field.size()) {
          const auto repair_call = [&](const std::string& words) {
            return ShellCommand(
                {"lfimport", FileArgument(name), "-o", "repaired", "--repair", words});
          };
          Take(JudgePoses(light_field, pool, work.signals.interrupted, repair_call, &report));
          report.pixels = FootprintFacts{Take(FootprintOf(light_field, *field.store)),
                                         light_field.encoding.footprint.has_value()};
        }
        return ReportJson(report);
      },
      &work.signals);
}

// The options of packages as Python's keyword arguments; members have the meaning and the default
// of the options of lfpreprocessor with these names.
struct PackageWords {
  std::string output, memory = "8G", balance = "rays";
  std::optional<size_t> packages, frames_per_package;
  std::optional<std::pair<double, double>> depths;
  bool overwrite = false, strict = false;
};

PreprocessOptions PreprocessOptionsOf(const PackageWords& words, const SettingWords& film_words) {
  PreprocessOptions options;
  if (!words.output.empty()) options.output_folder = words.output;
  options.overwrite = words.overwrite;
  options.film = Take(FilmSettingsOf(film_words));
  options.memory_bytes = Take(ParseByteSize(words.memory, "memory"));
  options.package_count = words.packages;
  options.frames_per_package = words.frames_per_package;
  options.balance = words.balance == "frames" ? PackageBalance::kFrames : PackageBalance::kRays;
  if (words.depths) options.depths = DepthRange{words.depths->first, words.depths->second};
  options.strict = words.strict;
  options.version = Version();
  return options;
}

// Makes packages, or only forecasts their render. Returns the report of lfpreprocessor as JSON.
std::string Preprocess(const OpenedField& field, const std::string& name,
                       std::vector<RenderCamera> cameras, double fps, uint32_t first_frame,
                       ShutterWords shutter, const std::vector<uint32_t>& frames,
                       const SettingWords& film, const PackageWords& words, int threads,
                       const Tell& tell) {
  ThreadPool& pool = PoolOf(threads);
  ToldWork work(tell);
  const LightField& light_field = field.light_field;
  PreprocessOptions options = PreprocessOptionsOf(words, film);
  for (const uint32_t frame : frames) options.frames.push_back(FrameId{frame});
  options.light_field_name = name;
  options.light_field_options = field.options;
  options.interrupted = &work.signals.interrupted;
  return CallWithoutGil(
      [&] {
        const CameraPath path =
            PathOf(std::move(cameras), fps, first_frame, light_field.unit_m, std::move(shutter));
        ForecastFacts facts;
        facts.light_field = name;
        facts.output = words.output;
        facts.order = options.film.order;
        facts.seed = options.film.seed;
        facts.thread_count = pool.thread_count();
        facts.rebins = KeepsCells(options.film);
        facts.completes = options.film.mode == RenderMode::kHybrid;
        facts.depths_from = KnowDepths(light_field, path, pool, &options);
        const PreprocessReport report =
            Take(lf::Preprocess(light_field, path, options, pool, work.Progress()));
        return ForecastJson(report, path, facts);
      },
      &work.signals);
}

// The options of a packed store that are not those of its codec, with the names of lfcompressor.
struct StoreWords {
  std::string output, shard_size;
  bool resume = false, overwrite = false, verify = false, strict = false;
};

// Compresses all LF images. Returns the report of lfcompressor as JSON.
std::string CompressField(const OpenedField& field, const std::string& name,
                          const CodecWords& codec, const StoreWords& words, int threads,
                          const Tell& tell) {
  ThreadPool& pool = PoolOf(threads);
  ToldWork work(tell);
  CompressOptions options;
  options.store = words.output;
  Take(SetCodec(codec, &options));
  if (!words.shard_size.empty())
    options.shard_bytes = Take(ParseByteSize(words.shard_size, "shard_size"));
  options.resume = words.resume;
  options.overwrite = words.overwrite;
  options.verify = words.verify;
  options.strict = words.strict;
  options.source_name = name;
  options.version = Version();
  options.interrupted = &work.signals.interrupted;
  return CallWithoutGil(
      [&] {
        const auto progress = [&](const CompressProgress& now) {
          work.signals.SetProgress({now.done, now.total, static_cast<int>(now.phase)});
        };
        const CompressSource source =
            Take(codec.demosaic == "joint" ? DemosaickedJointly(field.light_field)
                                           : SourceOfAll(field.light_field));
        const CompressReport report = Take(Compress(source, options, pool, progress));
        return CompressJson(report, options);
      },
      &work.signals);
}

// The options of lfdensify, with its names.
struct DensifyWords {
  std::string output, memory = "2G", cache;
  std::optional<std::pair<double, double>> depths;  // near, far
  double spacing = 1.5;
  size_t most = 2000;
  int divisor = 1;
  bool force = false, resume = false, overwrite = false, strict = false;
};

// Puts virtual LF images into the lenses of frames, or between all LF cameras if there are none.
// Returns the report of lfdensify as JSON.
std::string DensifyField(const OpenedField& field, const std::string& name,
                         const std::vector<RenderCamera>& frames, const DensifyWords& words,
                         int threads, const Tell& tell) {
  ThreadPool& pool = PoolOf(threads);
  ToldWork work(tell);
  DensifyOptions options;
  options.store = words.output;
  options.choices.frames = frames;
  options.choices.spacing_px = words.spacing;
  options.choices.most_virtual = words.most;
  options.choices.divisor = words.divisor;
  options.choices.force = words.force;
  if (words.depths) options.choices.depths = DepthRange{words.depths->first, words.depths->second};
  options.memory_bytes = Take(ParseByteSize(words.memory, "memory"));
  options.cache = Take(DepthCacheFolder(words.cache, field.light_field));
  options.resume = words.resume;
  options.overwrite = words.overwrite;
  options.strict = words.strict;
  options.source_name = name;
  options.version = Version();
  options.interrupted = &work.signals.interrupted;
  return CallWithoutGil(
      [&] {
        const DensifyReport report =
            Take(Densify(field.light_field, options, pool, [&](const DensifyProgress& now) {
              work.signals.SetProgress({now.work_done, now.work_total});
            }));
        if (!report.dense.empty()) Take(Result<void>(InputError(report.dense)));
        return DensifyJson(report, options, 0);
      },
      &work.signals);
}

//   truth  file of a path whose frames become the ground truth; "": that of the options
void Synthesise(SyntheticFieldOptions options, const std::string& truth, int threads,
                const Tell& tell) {
  ThreadPool& pool = PoolOf(threads);
  ToldWork work(tell);
  options.holds_light_field = HoldsLightField;
  RunWithoutGil(
      [&] {
        if (!truth.empty()) {
          const CameraPath path = Take(
              OpenPath(truth, {.light_field_unit_m = 1.0, .surface = PathOptions::Surface::kMake}));
          options.truth_cameras.assign(path.AllInstants().begin(), path.AllInstants().end());
          options.truth_instants = path.shutter.samples;
          options.first_truth_frame = path.first_frame;
          options.inputs = FilesOfPath(truth);
        }
        Take(WriteSyntheticField(options, pool, [&](size_t done, size_t total, bool is_truth) {
          work.signals.SetProgress({done, total, is_truth ? 1 : 0});
          return !work.signals.interrupted;
        }));
      },
      &work.signals);
}

}  // namespace

void AddCaptures(py::module_& module) {
  module.def("report", &Report);
  py::class_<PackageWords>(module, "PackageWords")
      .def(py::init<>())
      .def_readwrite("output", &PackageWords::output)
      .def_readwrite("memory", &PackageWords::memory)
      .def_readwrite("balance", &PackageWords::balance)
      .def_readwrite("packages", &PackageWords::packages)
      .def_readwrite("frames_per_package", &PackageWords::frames_per_package)
      .def_readwrite("depths", &PackageWords::depths)
      .def_readwrite("overwrite", &PackageWords::overwrite)
      .def_readwrite("strict", &PackageWords::strict);
  module.def("preprocess", &Preprocess);
  py::class_<CodecWords>(module, "CodecWords")
      .def(py::init<>())
      .def_readwrite("profile", &CodecWords::profile)
      .def_readwrite("quantizer", &CodecWords::quantizer)
      .def_readwrite("levels", &CodecWords::levels)
      .def_readwrite("entropy", &CodecWords::entropy)
      .def_readwrite("reencode", &CodecWords::reencode)
      .def_readwrite("demosaic", &CodecWords::demosaic)
      .def_readwrite("threshold", &CodecWords::threshold)
      .def_readwrite("target_psnr", &CodecWords::target_psnr);
  py::class_<StoreWords>(module, "StoreWords")
      .def(py::init<>())
      .def_readwrite("output", &StoreWords::output)
      .def_readwrite("shard_size", &StoreWords::shard_size)
      .def_readwrite("resume", &StoreWords::resume)
      .def_readwrite("overwrite", &StoreWords::overwrite)
      .def_readwrite("verify", &StoreWords::verify)
      .def_readwrite("strict", &StoreWords::strict);
  module.def("compress", &CompressField);
  py::class_<DensifyWords>(module, "DensifyWords")
      .def(py::init<>())
      .def_readwrite("output", &DensifyWords::output)
      .def_readwrite("memory", &DensifyWords::memory)
      .def_readwrite("cache", &DensifyWords::cache)
      .def_readwrite("depths", &DensifyWords::depths)
      .def_readwrite("spacing", &DensifyWords::spacing)
      .def_readwrite("most", &DensifyWords::most)
      .def_readwrite("divisor", &DensifyWords::divisor)
      .def_readwrite("force", &DensifyWords::force)
      .def_readwrite("resume", &DensifyWords::resume)
      .def_readwrite("overwrite", &DensifyWords::overwrite)
      .def_readwrite("strict", &DensifyWords::strict);
  module.def("densify", &DensifyField);
  py::class_<SyntheticFieldOptions>(module, "SyntheticFieldOptions")
      .def(py::init<>())
      .def_readwrite("scene", &SyntheticFieldOptions::scene)
      .def_readwrite("output", &SyntheticFieldOptions::output)
      .def_readwrite("capture", &SyntheticFieldOptions::capture)
      .def_readwrite("format", &SyntheticFieldOptions::format)
      .def_readwrite("alpha", &SyntheticFieldOptions::alpha)
      .def_readwrite("truth_cameras", &SyntheticFieldOptions::truth_cameras)
      .def_readwrite("truth_instants", &SyntheticFieldOptions::truth_instants)
      .def_readwrite("first_truth_frame", &SyntheticFieldOptions::first_truth_frame)
      .def_readwrite("size", &SyntheticFieldOptions::size_px)
      .def_readwrite("count", &SyntheticFieldOptions::count)
      .def_readwrite("spacing", &SyntheticFieldOptions::spacing)
      .def_readwrite("distance", &SyntheticFieldOptions::distance)
      .def_readwrite("jitter", &SyntheticFieldOptions::jitter)
      .def_readwrite("noise", &SyntheticFieldOptions::noise)
      .def_readwrite("distortion", &SyntheticFieldOptions::distortion)
      .def_readwrite("fisheye", &SyntheticFieldOptions::fisheye)
      .def_readwrite("fov", &SyntheticFieldOptions::fov)
      .def_readwrite("samples", &SyntheticFieldOptions::samples)
      .def_readwrite("truth_samples", &SyntheticFieldOptions::truth_samples)
      .def_readwrite("bayer", &SyntheticFieldOptions::bayer)
      .def_readwrite("calibration_only", &SyntheticFieldOptions::calibration_only)
      .def_readwrite("overwrite", &SyntheticFieldOptions::overwrite)
      .def_readwrite("seed", &SyntheticFieldOptions::seed);
  module.def("synth", &Synthesise);
}

}  // namespace lf::python
