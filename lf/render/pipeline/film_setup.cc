// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/film_setup.h"

#include <fmt/format.h>

#include <utility>

#include "lf/core/byte_text.h"
#include "lf/light_field/model/radiance.h"
#include "lf/render/collect/noise_moments.h"
#include "lf/render/hybrid/frame_sampling.h"
#include "lf/render/hybrid/render_memory.h"
#include "lf/render/pipeline/check_film_settings.h"
#include "lf/render/pipeline/resolved_settings.h"
#include "lf/render/pipeline/warn_of_other_film.h"
#include "lf/render/settings/interpolation.h"
#include "lf/storage/load/measure_footprint.h"
#include "lf/storage/load/open_store.h"

namespace lf {
namespace {

Package WithRoomBesideEdges(Package package, const RayReading& reading) {
  LightField& light_field = package.light_field;
  if (reading.Prefilters())
    MakeRoomBesideEdges(light_field.image_names, &light_field.encoding);
  else if (reading.estimator == Estimator::kBilinear)
    MakeRoomForUndershoot(&light_field.encoding);
  return package;
}

}  // namespace

FilmSetup::FilmSetup(Package package, const FilmSettings& film, const WorkSettings& work,
                     std::vector<FrameId> frames, ThreadPool& pool)
    : package_(WithRoomBesideEdges(std::move(package), film.reading)),
      film_(film),
      work_(work),
      frames_(frames.empty() ? package_.FrameIds() : std::move(frames)),
      pool_(pool),
      index_(package_.light_field, package_.ranks) {}

Result<std::unique_ptr<FilmSetup>> FilmSetup::Make(Package package, const FilmSettings& film,
                                                   const WorkSettings& work,
                                                   std::vector<FrameId> frames, ThreadPool& pool,
                                                   std::unique_ptr<LfImageStore> store) {
  const FilmSettings resolved = Resolved(film, package);
  LF_RETURN_IF_ERROR(CheckFilmSettings(package, film, frames));
  std::unique_ptr<FilmSetup> setup(
      new FilmSetup(std::move(package), resolved, work, std::move(frames), pool));
  setup->store_ = std::move(store);
  if (!setup->store_) {
    LF_ASSIGN_OR_RETURN(
        setup->store_,
        OpenStore(
            setup->light_field(),
            film.reading.estimator == Estimator::kBilinear ? Mosaics::kToRgb : Mosaics::kAsRecorded,
            resolved.guard ? StoreContent::kPixelsAndDepths : StoreContent::kPixels));
  }
  setup->film_.guard = setup->store_->LoadsDepths();
  LF_RETURN_IF_ERROR(WarnOfOtherFilm(setup->package(), setup->film()));
  LF_RETURN_IF_ERROR(setup->CheckStore());
  LF_RETURN_IF_ERROR(setup->FindFootprint());
  LF_RETURN_IF_ERROR(setup->PlanMemory());
  return setup;
}

// Checks, frame by frame, that a packed store that keeps only some pixels has all pixels that the
// frames need. Without this check, the render would fail only after hours of work.
Result<void> FilmSetup::CheckStore() const {
  if (!store_->IsPartial()) return {};
  const NeedsOptions needs = Needs();
  for (const FrameId frame : frames_) {
    const FrameNeeds wanted = NeedsOf(index_, path(), frame, needs, pool_, &package_);
    if (work_.IsStopped()) return {};
    LF_RETURN_IF_ERROR(CheckKept(*store_, light_field(), frame, wanted));
  }
  return {};
}

// Decides on the footprint of LF pixels (each pixel averages over its area, or shows a point), if
// the filter has to know it.
Result<void> FilmSetup::FindFootprint() {
  if (!film_.reading.Prefilters() || film_.reading.footprint) return {};
  LF_ASSIGN_OR_RETURN(film_.reading.footprint, FootprintOf(light_field(), *store_));
  return {};
}

Result<void> FilmSetup::PlanMemory() {
  const Intrinsics& plate = path().Camera(frames_.front()).pinhole.intrinsics;
  const RenderMemoryNeed need = {
      .mode = film_.mode,
      .interpolation = film_.rebin.interpolation,
      .max_cells = film_.rebin.max_cells,
      .light_field = light_field(),
      .reading = film_.reading,
      .plate_width = plate.width_px,
      .plate_height = plate.height_px,
      .frame_count = frames_.size(),
      .thread_count = pool_.thread_count(),
      .measured_bytes = film_.MeasuresNoise() ? NoiseMoments::kMostBytes : 0,
      .is_guarded = is_guarded(),
      .instants = static_cast<size_t>(path().shutter.samples),
      .surface = LargestSurface(path(), frames_),
      .references = References()};
  LF_ASSIGN_OR_RETURN(const RenderMemory memory, PlanRenderMemory(work_.memory_bytes, need));
  plan_ = memory.plan;
  max_cells_ = memory.max_cells;
  enough_bytes_ = memory.enough_bytes;
  if (store_->ReferenceBytes() > 0) store_->LimitReferences(plan_.reference_bytes);
  return {};
}

ReferenceNeed FilmSetup::References() const {
  return ReferenceNeedOf(*store_, light_field(), film_.order == ImageOrder::kGroups);
}

std::string FilmSetup::ReferenceNote() const {
  const ReferenceNeed references = References();
  if (references.in_groups || plan_.reference_bytes >= references.all_bytes) return "";
  constexpr size_t kMiB = size_t{1} << 20;
  // With another order, a frame that does not take all its LF images is another frame, and so is a
  // shard.
  const bool is_whole = !film_.max_image_count && !film_.HasStopRule() && !film_.shard;
  return fmt::format(
      "LF images are predicted from reference images, which take {} decoded; {{memory {}}} keeps "
      "{} of them, so that LF images are decoded several times: give {{memory {}M}}{}",
      ByteText(references.all_bytes), ByteText(work_.memory_bytes), ByteText(plan_.reference_bytes),
      (enough_bytes_ + kMiB - 1) / kMiB,
      !is_whole               ? ""
      : package_.name.empty() ? ", or {order groups}"
                              : ", or make the packages with {lfpreprocessor order groups}");
}

NeedsOptions FilmSetup::Needs() const {
  NeedsOptions needs = NeedsOfFilm(package_, film_, work_);
  needs.guard = is_guarded();
  return needs;
}

SelectOptions FilmSetup::Select() const { return Needs().select; }

Result<void> FilmSetup::PlanSlabs() {
  if (!KeepsCells(film_) || slabs_) return {};
  const SelectOptions select = Select();
  std::vector<SampledFrame> frames;
  for (const FrameId frame : path().frames().All()) {
    const RenderCamera& camera = path().Camera(frame);
    const std::optional<FrameSampling> known = SamplingOf(package_, frame);
    frames.push_back({camera, known ? *known : SamplingOf(index_, camera, select, pool_)});
    if (work_.IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
  }
  slabs_.emplace(frames, path().first_frame, film_.rebin.query, film_.rebin.slab);
  return {};
}

}  // namespace lf
