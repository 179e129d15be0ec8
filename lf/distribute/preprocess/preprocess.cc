// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/preprocess.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <numeric>

#include "lf/core/log.h"
#include "lf/distribute/preprocess/expected_memory.h"
#include "lf/distribute/preprocess/forecast_rebinning.h"
#include "lf/distribute/preprocess/later_render.h"
#include "lf/distribute/preprocess/package_folder.h"
#include "lf/distribute/preprocess/split_film.h"
#include "lf/light_field/model/reduction.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/hybrid/frame_pixels.h"
#include "lf/render/hybrid/rebin_cost.h"
#include "lf/render/hybrid/render_memory.h"
#include "lf/render/needs/film_order.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/render/settings/interpolation.h"
#include "lf/storage/load/measure_footprint.h"
#include "lf/storage/load/open_store.h"

namespace lf {
namespace {
// Largest memory for kept_needs_; enough for 300 frames with 20,000 LF images each.
constexpr uint64_t kMostKeptBytes = uint64_t{256} << 20;

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Joins the needs of all frames of a package.
class Gathering {
 public:
  struct Image {
    PixelRect rect;  // bounds of the pixels that any frame reads
    uint32_t frame_count = 0;
    uint64_t ray_count = 0;
  };
  void Add(const FrameNeeds& needs) {
    for (const FrameNeeds::Image& image : needs.images) {
      Image& all = images_[image.id];
      all.rect = Bounds(all.rect, image.rect);
      all.frame_count += 1;
      all.ray_count += image.ray_count;
    }
    for (const LfImageId id : needs.neighbours) images_[id];
  }
  // Returns the LF images by ascending ids. If Image::frame_count is 0, only the LF camera is
  // needed (a neighbour), not its image.
  const std::map<LfImageId, Image>& images() const { return images_; }

 private:
  std::map<LfImageId, Image> images_;
};

class Preprocessor {
 public:
  Preprocessor(const LightField& light_field, const CameraPath& path,
               const PreprocessOptions& options, ThreadPool& pool,
               const std::function<void(size_t, size_t)>& progress)
      : light_field_(light_field),
        path_(path),
        options_(options),
        film_(LaterRender(options.film, light_field)),
        pool_(pool),
        progress_(progress),
        needs_(NeedsOfLaterRender(film_, light_field, options.interrupted)) {}

  Result<PreprocessReport> Run();

 private:
  Result<void> Begin();
  Result<void> MakeIndex();
  Result<void> ForecastFrames();
  Result<void> DescribeSurroundings(const std::map<FrameId, FrameSampling>& sampling);
  Result<void> Measure();
  Result<RenderMemory> MemoryOf(const LightField& light_field, size_t frame_count) const;
  bool IsInGroups() const { return film_.order == ImageOrder::kGroups; }
  Result<std::vector<Section>> Split() const;
  Result<void> MakePackage(size_t number, const Section& section, size_t count);
  Package PackageOf(const Section& section, const Gathering& gathering) const;
  std::vector<uint64_t> FileSizes(const Package& package) const;
  Result<void> CountMissing(const Package& package, PackageForecast* forecast);
  Result<void> Forecast(const Package& package, PackageForecast* forecast) const;

  Result<void> CheckInterrupted() const {
    if (options_.interrupted == nullptr || !*options_.interrupted) return {};
    return Error{ErrorKind::kInterrupted, "interrupted: no new package is kept"};
  }
  // Returns the needs of a frame, from kept_needs_ if they are there. Returns kInterrupted if the
  // user interrupted the program, because the needs may then be incomplete.
  Result<FrameNeeds> Needs(FrameId frame) {
    FrameNeeds needs;
    if (const auto kept = kept_needs_.find(frame); kept != kept_needs_.end()) {
      needs = std::move(kept->second);
      kept_needs_.erase(kept);
    } else {
      needs = NeedsOf(*index_, path_, frame, needs_, pool_);
    }
    LF_RETURN_IF_ERROR(CheckInterrupted());
    if (progress_) progress_(++done_, 2 * frames_.size());
    return needs;
  }
  void Keep(FrameId frame, FrameNeeds needs);
  void KeepDistances(FrameId frame, const std::vector<double>& distances_w);

  const LightField& light_field_;
  // The footprint of packages, so that all machines that render them use the same prefilters.
  std::optional<PixelFootprint> footprint_;
  const CameraPath& path_;
  const PreprocessOptions& options_;
  const FilmSettings film_;  // of the later render
  ThreadPool& pool_;
  const std::function<void(size_t, size_t)>& progress_;
  NeedsOptions needs_;
  std::vector<FrameId> frames_;
  std::optional<PackageFolder> folder_;  // where packages are written; unset: nothing is written
  std::unique_ptr<LfImageStore> store_;  // tells file sizes, and which pixels a store has kept
  LightFieldIdentity whole_;
  ImageRanks ranks_;
  std::optional<ImageIndex> index_;
  // Needs that were computed for the forecast, and that MakePackage() uses again; up to
  // kMostKeptBytes.
  std::map<FrameId, FrameNeeds> kept_needs_;
  uint64_t kept_bytes_ = 0;
  std::vector<FrameSurroundings> surroundings_;  // [frame number - 1], for all frames of the film
  std::vector<double> instant_distances_w_;      // Package::instant_distances_w, of all packages
  size_t done_ = 0;
  double begin_cpu_s_ = 0;        // CPU time of the steps of Begin() that a render also takes
  std::vector<bool> is_counted_;  // [LF image]: true if a finished package needs it
  PreprocessReport report_;
};

Result<PreprocessReport> Preprocessor::Run() {
  LF_RETURN_IF_ERROR(Begin());
  LF_RETURN_IF_ERROR(MakeIndex());
  LF_RETURN_IF_ERROR(ForecastFrames());
  LF_RETURN_IF_ERROR(Measure());
  LF_ASSIGN_OR_RETURN(const std::vector<Section> sections, Split());
  for (size_t i = 0; i < sections.size(); ++i)
    LF_RETURN_IF_ERROR(MakePackage(i, sections[i], sections.size()));
  if (folder_) LF_RETURN_IF_ERROR(folder_->Publish());
  return std::move(report_);
}

Result<void> Preprocessor::Begin() {
  frames_ = options_.frames;
  if (frames_.empty()) frames_ = path_.frames().All();
  LF_RETURN_IF_ERROR(CheckLaterRender(light_field_, path_, frames_, options_.film, needs_));
  if (options_.output_folder) {
    LF_ASSIGN_OR_RETURN(
        PackageFolder folder,
        PackageFolder::Open(*options_.output_folder,
                            NameOfPart(options_.frames, path_.frame_count()), options_.overwrite));
    LF_RETURN_IF_ERROR(folder.CheckKeeps(light_field_, options_.inputs));
    folder_.emplace(std::move(folder));
  }
  LF_ASSIGN_OR_RETURN(store_,
                      OpenStore(light_field_, film_.reading.estimator == Estimator::kBilinear
                                                  ? Mosaics::kToRgb
                                                  : Mosaics::kAsRecorded));
  report_.light_field_image_count = RecordedCount(light_field_);
  report_.light_field_virtual_count = light_field_.size() - report_.light_field_image_count;
  whole_ = IdentityOf(light_field_);
  footprint_ = light_field_.encoding.footprint;
  const double start_s = ProcessCpuSeconds();
  if (film_.reading.estimator == Estimator::kBilinear) {
    LF_ASSIGN_OR_RETURN(footprint_, FootprintOf(light_field_, *store_));
  }
  begin_cpu_s_ += ProcessCpuSeconds() - start_s;
  return {};
}

Result<void> Preprocessor::MakeIndex() {
  const auto start = std::chrono::steady_clock::now();
  const double start_cpu_s = ProcessCpuSeconds();
  const Result<ImageRanks> ranks =
      RanksOfFilm(film_.order, film_.seed, light_field_, path_, needs_, pool_);
  LF_RETURN_IF_ERROR(CheckInterrupted());
  if (!ranks) return ranks.error();
  ranks_ = *ranks;
  index_.emplace(light_field_, ranks_);
  report_.index_s = SecondsSince(start);
  begin_cpu_s_ += ProcessCpuSeconds() - start_cpu_s;
  LogDebug("order {} of {} LF images by seed {}, and their octree: {:.2f} s", NameOf(film_.order),
           light_field_.size(), film_.seed, report_.index_s);
  return {};
}

// Stores the sampling of all frames of the film, even if only some frames are packed, because slabs
// of rebinned rays are planned for the whole film. Stores nothing for packages without neighbours.
Result<void> Preprocessor::DescribeSurroundings(const std::map<FrameId, FrameSampling>& sampling) {
  if (!needs_.HasNeighbours()) return {};
  for (const FrameId frame : path_.frames().All()) {
    const auto known = sampling.find(frame);
    surroundings_.push_back(SurroundingsOf(
        known != sampling.end() ? known->second
                                : SamplingOf(*index_, path_.Camera(frame), needs_.select, pool_)));
    LF_RETURN_IF_ERROR(CheckInterrupted());
  }
  return {};
}

Result<void> Preprocessor::ForecastFrames() {
  const auto start = std::chrono::steady_clock::now();
  std::map<FrameId, FrameSampling> sampling;
  for (const FrameId frame : frames_) {
    LF_ASSIGN_OR_RETURN(FrameNeeds needs, Needs(frame));
    LF_RETURN_IF_ERROR(CheckKept(*store_, light_field_, frame, needs));
    const auto virtual_count = static_cast<size_t>(std::count_if(
        needs.images.begin(), needs.images.end(),
        [this](const auto& image) { return light_field_.cameras[image.id.value].is_virtual; }));
    report_.frames.push_back({frame,
                              needs.images.size() - virtual_count,
                              virtual_count,
                              needs.RayCount(),
                              needs.rebinned_count,
                              {}});
    if (needs.sampling) sampling[frame] = *needs.sampling;
    KeepDistances(frame, needs.instant_distances_w);
    Keep(frame, std::move(needs));
  }
  LF_RETURN_IF_ERROR(DescribeSurroundings(sampling));
  report_.select_s += SecondsSince(start);
  const auto density_start = std::chrono::steady_clock::now();
  // Each frame is measured by one thread.
  pool_.ForEach(frames_.size(), [this](size_t f) {
    if (options_.interrupted != nullptr && *options_.interrupted) return;
    report_.frames[f].density =
        DensityOf(*index_, path_.Camera(frames_[f]),
                  options_.depths ? options_.depths : light_field_.depth_range);
  });
  LF_RETURN_IF_ERROR(CheckInterrupted());
  report_.density_s = SecondsSince(density_start);
  if (std::all_of(report_.frames.begin(), report_.frames.end(),
                  [](const FrameForecast& frame) { return frame.ReadsNone(); }))
    return NoneContributes(frames_);
  return {};
}

// Keeps the camera distances of the instants of a frame for the packages, if there are any.
void Preprocessor::KeepDistances(FrameId frame, const std::vector<double>& distances_w) {
  if (distances_w.empty()) return;
  instant_distances_w_.resize(path_.instants.size(), -1);
  std::copy(distances_w.begin(), distances_w.end(),
            instant_distances_w_.begin() +
                static_cast<ptrdiff_t>(path_.frames().IndexOf(frame) * distances_w.size()));
}

void Preprocessor::Keep(FrameId frame, FrameNeeds needs) {
  const uint64_t bytes = needs.images.capacity() * sizeof(FrameNeeds::Image) +
                         needs.neighbours.capacity() * sizeof(LfImageId);
  if (kept_bytes_ + bytes > kMostKeptBytes) return;
  kept_bytes_ += bytes;
  kept_needs_.emplace(frame, std::move(needs));
}

// Measures report_.rate with the frame that has the median number of rays.
Result<void> Preprocessor::Measure() {
  std::vector<size_t> by_rays(frames_.size());
  std::iota(by_rays.begin(), by_rays.end(), size_t{0});
  std::erase_if(by_rays, [this](size_t f) { return report_.frames[f].ReadsNone(); });
  std::sort(by_rays.begin(), by_rays.end(), [this](size_t a, size_t b) {
    return report_.frames[a].ray_count < report_.frames[b].ray_count;
  });
  const FrameId frame = frames_[by_rays[by_rays.size() / 2]];
  LF_ASSIGN_OR_RETURN(const RenderMemory memory, MemoryOf(light_field_, frames_.size()));
  const Result<RenderRate> rate =
      MeasureRate(*index_, path_.Camera(frame), path_.Instants(frame).size(), needs_, film_.reading,
                  {memory.plan.reference_bytes, IsInGroups()}, pool_);
  if (rate)
    report_.rate = *rate;
  else
    report_.rate_error = rate.error().message;
  return {};
}

Result<RenderMemory> Preprocessor::MemoryOf(const LightField& light_field,
                                            size_t frame_count) const {
  const Intrinsics& plate = path_.Camera(frames_.front()).pinhole.intrinsics;
  const RenderMemoryNeed need = {.mode = film_.mode,
                                 .interpolation = film_.rebin.interpolation,
                                 .light_field = light_field,
                                 .reading = film_.reading,
                                 .plate_width = plate.width_px,
                                 .plate_height = plate.height_px,
                                 .frame_count = frame_count,
                                 .thread_count = pool_.thread_count(),
                                 .is_guarded = needs_.guard,
                                 .instants = static_cast<size_t>(path_.shutter.samples),
                                 .surface = LargestSurface(path_, frames_),
                                 .references = ReferenceNeedOf(*store_, light_field, IsInGroups())};
  return PlanRenderMemory(options_.memory_bytes, need);
}

Result<std::vector<Section>> Preprocessor::Split() const {
  LF_ASSIGN_OR_RETURN(const RenderMemory memory, MemoryOf(light_field_, frames_.size()));
  std::vector<uint64_t> costs;
  for (const FrameForecast& frame : report_.frames)
    costs.push_back(options_.balance == PackageBalance::kRays ? frame.ray_count : 1);
  if (options_.package_count) return SplitByCost(costs, *options_.package_count);
  if (options_.frames_per_package) {
    std::vector<Section> sections;
    for (size_t begin = 0; begin < frames_.size(); begin += *options_.frames_per_package)
      sections.push_back({begin, std::min(frames_.size(), begin + *options_.frames_per_package)});
    return sections;
  }
  return SplitToFit(costs, memory.plan.frames_per_pass);
}

Result<void> Preprocessor::MakePackage(size_t number, const Section& section, size_t count) {
  const auto start = std::chrono::steady_clock::now();
  Gathering gathering;
  for (size_t f = section.begin; f < section.end; ++f) {
    LF_ASSIGN_OR_RETURN(const FrameNeeds needs, Needs(frames_[f]));
    gathering.Add(needs);
  }
  Package package = PackageOf(section, gathering);
  package.number = number + 1;
  package.count = count;
  report_.select_s += SecondsSince(start);

  PackageForecast forecast;
  const std::string part = NameOfPart(options_.frames, path_.frame_count());
  forecast.name = fmt::format("package-{:04}{}", number, part);
  LF_RETURN_IF_ERROR(CountMissing(package, &forecast));
  LF_RETURN_IF_ERROR(Forecast(package, &forecast));
  report_.packages.push_back(std::move(forecast));
  if (!folder_) return {};

  const auto write_start = std::chrono::steady_clock::now();
  const std::string& name = report_.packages.back().name;
  LF_RETURN_IF_ERROR(folder_->Add(
      name, package, {options_.version, options_.light_field_name, options_.light_field_options}));
  report_.write_s += SecondsSince(write_start);
  LogDebug("{}: {} frames, {} LF images, {} neighbours: written in {:.2f} s",
           folder_->PathOf(name).string(), package.frames.size(),
           report_.packages.back().image_count, report_.packages.back().neighbour_count,
           SecondsSince(write_start));
  return {};
}

// Counts the missing files of the package. Adds to the totals of the film, in report_, the LF
// images and the missing files that no earlier package has counted.
Result<void> Preprocessor::CountMissing(const Package& package, PackageForecast* forecast) {
  is_counted_.resize(light_field_.size(), false);
  for (size_t i = 0; i < package.images.size(); ++i) {
    const PackageImage& image = package.images[i];
    if (image.frame_count == 0) continue;
    const bool is_missing = image.file_bytes == 0, is_known = is_counted_[image.id];
    is_counted_[image.id] = true;
    if (is_missing) ++forecast->missing_count;
    if (is_known) continue;
    ++report_.needed_count;
    if (is_missing && report_.missing_count++ == 0)
      report_.first_missing =
          package.light_field.ImagePath(LfImageId{static_cast<uint32_t>(i)}).string();
    if (is_missing && options_.strict)
      return InputError(
          fmt::format("{{strict}}: {}: the file of this LF image does not exist, or is empty: "
                      "restore it, or leave {{strict}} out",
                      report_.first_missing));
  }
  return {};
}

Package Preprocessor::PackageOf(const Section& section, const Gathering& gathering) const {
  Package package;
  package.whole = whole_;
  package.whole_virtual_count = report_.light_field_virtual_count;
  package.choices = {film_.order,
                     film_.seed,
                     film_.max_image_count,
                     film_.max_angle_rad,
                     needs_.HasNeighbours(),
                     film_.mode,
                     Rebins(film_.mode) ? film_.rebin.interpolation : RayInterpolation::kAuto};
  package.path = path_;
  package.surroundings = surroundings_;
  package.instant_distances_w = instant_distances_w_;
  for (size_t f = section.begin; f < section.end; ++f)
    package.frames.push_back({.id = frames_[f],
                              .image_count = report_.frames[f].image_count,
                              .ray_count = report_.frames[f].ray_count});
  LightField& part = package.light_field;
  part.folder = light_field_.folder;
  part.encoding = light_field_.encoding;
  part.encoding.footprint = footprint_;
  part.unit_m = light_field_.unit_m;
  part.depth_range = light_field_.depth_range;
  package.ranks.end = ranks_.end;
  // Index of intrinsics in the package, by their index in the whole light field.
  std::map<uint32_t, uint32_t> intrinsics;
  for (const auto& [id, gathered] : gathering.images()) {
    LfCamera camera = light_field_.cameras[id.value];
    const auto [known, is_new] = intrinsics.try_emplace(
        camera.intrinsics_index, static_cast<uint32_t>(part.intrinsics.size()));
    if (is_new) part.intrinsics.push_back(light_field_.intrinsics[camera.intrinsics_index]);
    camera.intrinsics_index = known->second;
    part.cameras.push_back(camera);
    part.image_names.push_back(light_field_.image_names[id.value]);
    if (!light_field_.mask_names.empty())
      part.mask_names.push_back(light_field_.mask_names[id.value]);
    package.ranks.of_images.push_back(ranks_.of_images[id.value]);
    PackageImage image;
    image.id = id.value;
    image.rect = gathered.rect;
    image.frame_count = gathered.frame_count;
    image.ray_count = gathered.ray_count;
    package.images.push_back(image);
  }
  const std::vector<uint64_t> sizes = FileSizes(package);
  for (size_t i = 0; i < sizes.size(); ++i) package.images[i].file_bytes = sizes[i];
  return package;
}

// Returns the sizes of the image files; 0 for a missing file, and for a neighbour, because its file
// is not read.
std::vector<uint64_t> Preprocessor::FileSizes(const Package& package) const {
  constexpr size_t kTogether = 256;
  std::vector<uint64_t> sizes(package.images.size(), 0);
  pool_.ForEach((sizes.size() + kTogether - 1) / kTogether, [&](size_t task) {
    for (size_t i = task * kTogether; i < std::min(sizes.size(), (task + 1) * kTogether); ++i)
      if (package.images[i].frame_count > 0)
        sizes[i] = store_->StoredBytes(LfImageId{package.images[i].id});
  });
  return sizes;
}

Result<void> Preprocessor::Forecast(const Package& package, PackageForecast* forecast) const {
  forecast->frames = package.FrameIds();
  uint64_t rebinned_count = 0;
  for (const FrameForecast& frame : report_.frames)
    if (std::binary_search(forecast->frames.begin(), forecast->frames.end(), frame.frame))
      rebinned_count += frame.rebinned_count;
  ReadImages read;
  for (size_t i = 0; i < package.images.size(); ++i) {
    const PackageImage& image = package.images[i];
    const bool is_virtual = package.light_field.cameras[i].is_virtual;
    ++(image.frame_count == 0 ? forecast->neighbour_count
       : is_virtual           ? forecast->virtual_count
                              : forecast->image_count);
    read.pixel_count += static_cast<uint64_t>(image.rect.pixel_count());  // 0 for neighbours
    forecast->read_bytes += image.file_bytes;
    forecast->ray_count += image.ray_count;
  }
  read.count = forecast->image_count + forecast->virtual_count;
  const size_t frame_count = package.frames.size();
  LF_ASSIGN_OR_RETURN(const RenderMemory memory, MemoryOf(package.light_field, frame_count));
  const size_t per_pass = std::min(memory.plan.frames_per_pass, frame_count);
  forecast->pass_count = (frame_count + per_pass - 1) / per_pass;
  RebinCost cost;
  StageTimes cpu;
  if (needs_.KeepsCells()) {
    // The passes have about equal numbers of frames, and the first stands for all.
    const auto pass = std::span<const FrameId>(forecast->frames).first(per_pass);
    LF_ASSIGN_OR_RETURN(cost, ForecastRebinning(*index_, *store_, path_, surroundings_, pass,
                                                needs_, film_.reading, memory.max_cells, pool_));
    LF_RETURN_IF_ERROR(CheckInterrupted());
    const auto passes = static_cast<double>(frame_count) / static_cast<double>(per_pass);
    cpu = {passes * cost.begin_s, 0, 0, passes * cost.rebin_s, passes * cost.complete_s, 0};
  }
  const uint64_t asked_count =
      Collects(film_.mode) ? std::min(rebinned_count, read.pixel_count) : read.pixel_count;
  if (KeepsPixels(film_))
    cost.map_bytes = std::min<uint64_t>(asked_count, memory.max_cells) *
                     FramePixels::BytesPerPixel(package.light_field.encoding,
                                                film_.reading.estimator, needs_.guard);
  // A render with this memory must not be refused.
  forecast->memory_bytes =
      std::max(memory.least_bytes,
               ExpectedBytes(memory, package.light_field, read, !needs_.KeepsOnlyCells(),
                             film_.reading.Prefilters(), Rebins(film_.mode) ? &cost : nullptr));
  if (!report_.rate) return {};
  cpu.begin_s += begin_cpu_s_;
  cpu.load_s = report_.rate->load_s * static_cast<double>(read.count);
  // Frames are collected from kept pixels as from LF images.
  const uint64_t not_collected = needs_.KeepsCells() ? rebinned_count : 0;
  cpu.collect_s =
      report_.rate->collect_s * static_cast<double>(forecast->ray_count - not_collected);
  cpu.finish_s = report_.rate->finish_s * static_cast<double>(frame_count);
  if (KeepsPixels(film_)) {
    // All pixels are kept if they fill at most nine tenths of the room, as in FramePixels.
    const KeptRate& kept =
        10 * asked_count <= 9 * memory.max_cells ? report_.rate->all : report_.rate->edges;
    cpu.begin_s += report_.rate->gaps_s * static_cast<double>(frame_count);
    cpu.rebin_s = kept.keep_s * static_cast<double>(asked_count);
    cpu.complete_s = kept.make_s * static_cast<double>(Collects(film_.mode) ? rebinned_count
                                                                            : forecast->ray_count);
  }
  forecast->cpu = cpu;
  return {};
}

}  // namespace

Result<PreprocessReport> Preprocess(const LightField& light_field, const CameraPath& path,
                                    const PreprocessOptions& options, ThreadPool& pool,
                                    const std::function<void(size_t, size_t)>& progress) {
  LF_RETURN_IF_ERROR(CheckNotReduced(light_field, "a package"));
  return Preprocessor(light_field, path, options, pool, progress).Run();
}

}  // namespace lf
