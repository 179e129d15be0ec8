// SPDX-License-Identifier: Apache-2.0
// The parts of FilmRenderer that collect frames, or the gaps of their lenses, from kept pixels.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lf/core/byte_text.h"
#include "lf/core/log.h"
#include "lf/render/pipeline/film_renderer.h"

namespace lf {

uint32_t FilmRenderer::RebinnedRanksDone() const {
  return pixels_ ? pixels_->ranks_done() : rebinned_->ranks_done();
}

// Finds the parts of the lenses that collection leaves open, and gives the weights of all instants
// of a frame the same unit.
Result<void> FilmRenderer::FindGaps() {
  for (Frame& frame : frames_) {
    const std::span<const RenderCamera> instants = setup_.path().Instants(frame.id);
    const std::span<const double> distances_w = setup_.package().InstantDistances(frame.id);
    std::optional<double> distance_w = setup_.package().CameraDistance(frame.id);
    // The sum of the shares of a gap is at most 1, so that this limits the weights of all instants
    // together.
    double least = FrameWeights::kMostTogether / static_cast<double>(instants.size());
    for (size_t i = 0; i < instants.size(); ++i) {
      if (setup_.work().IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
      if (i < distances_w.size()) distance_w = distances_w[i];
      const GapLens& gap = frame.gaps.emplace_back(
          setup_.index(), instants[i], frame.all_lens ? *frame.all_lens : frame.lenses[i],
          frame.ranks, select_, setup_.pool(), distance_w);
      if (gap.exists()) least = std::min(least, gap.WeightsPerShare());
    }
    for (GapLens& gap : frame.gaps)
      if (gap.exists()) gap.ReduceWeights(least / gap.WeightsPerShare());
  }
  return {};
}

std::vector<TakingFrame> FilmRenderer::TakingGaps(const Frame& frame) const {
  std::vector<TakingFrame> taking;
  for (const GapLens& gap : frame.gaps)
    if (gap.exists())
      taking.push_back({gap.camera(), frame.ranks, [&gap](LfImageId id) { return gap.Takes(id); }});
  return taking;
}

Result<void> FilmRenderer::PreparePixels(const RunState* state) {
  if (film_.Collects()) LF_RETURN_IF_ERROR(FindGaps());
  std::vector<KeptFrame> kept;
  std::vector<TakingFrame> taking;
  for (const Frame& frame : frames_) {
    KeptFrame& one = kept.emplace_back();
    one.ranks = frame.ranks;
    for (const GapLens& gap : frame.gaps)
      if (gap.exists()) one.gaps.push_back(&gap);
    for (TakingFrame& gap : TakingGaps(frame)) taking.push_back(std::move(gap));
    if (film_.Collects()) continue;
    for (const FrameLens& lens : frame.lenses) one.lenses.push_back(&lens);
    if (frame.all_lens) one.lenses.push_back(&*frame.all_lens);
    for (TakingFrame& instant : TakingInstants(frame)) taking.push_back(std::move(instant));
    if (frame.all_lens) taking.push_back(Taking(frame, *frame.all_lens));
  }
  std::vector<SelectedImage> images;
  if (!taking.empty()) images = SelectImages(setup_.index(), taking, select_, setup_.pool());
  if (film_.shard)
    std::erase_if(images,
                  [this](const SelectedImage& image) { return !film_.shard->Holds(image.rank); });
  RebinSettings options = film_.rebin;
  options.max_cells = setup_.max_cells();
  pixels_ = std::make_unique<FramePixels>(setup_.index(), std::move(kept), std::move(images),
                                          select_, options, setup_.pool());
  LogInfo("{}", pixels_->Describe());
  const FramePixels::Facts facts = pixels_->facts();
  if (film_.shard && !facts.keeps_all)
    return UsageError(fmt::format(
        "{{shard}}, {{mode {}}}: {} for about {:.3g} million pixels of this shard, but {{max_rays "
        "{}}} has no room for all of them, and shards add up only if every shard keeps all pixels: "
        "use more shards, increase {{max_rays}} or {{memory}}, or leave {{shard}} out",
        NameOf(film_.mode), film_.Collects() ? "gaps of lenses ask" : "frames ask",
        facts.asked * 1e-6, options.max_cells));
  if (film_.rebin.kept == KeptRays::kAll && facts.asked > static_cast<double>(options.max_cells))
    return UsageError(fmt::format(
        "{{kept all}}: frames ask for about {:.3g} million pixels, but {{max_rays {}}}{} has no "
        "room for all of them: increase {}, or use {{kept auto}}",
        facts.asked * 1e-6, options.max_cells,
        film_.rebin.max_cells == 0 ? ", which {memory} allows," : "",
        film_.rebin.max_cells == 0 ? "{memory}" : "{max_rays}"));
  if (state == nullptr) return {};
  LF_ASSIGN_OR_RETURN(std::optional<RunState::Kept> saved,
                      state->LoadKept(id(0), RaysFrames(), pixels_->max_pixels(), setup_.pool()));
  if (!saved) return {};
  for (const auto& [image, kept_image] : saved->pixels.images()) {
    const bool is_there = image.value < setup_.light_field().size();
    const Intrinsics k = is_there ? setup_.light_field().Camera(image).intrinsics : Intrinsics();
    if (is_there && k.width_px == kept_image.width_px && k.height_px == kept_image.height_px)
      continue;
    return InputError(fmt::format(
        "the kept pixels in {{output}} are those of another light field: LF image {} has {} x {} "
        "pixels there, and {} x {} in the calibration; start again with {{overwrite}} instead of "
        "{{resume}}",
        image.value, kept_image.width_px, kept_image.height_px, k.width_px, k.height_px));
  }
  pixels_->Restore(std::move(saved->pixels), saved->ranks_done);
  return {};
}

// Returns kOutput if masks and depths of the LF images so far leave no room for pixels.
Result<void> FilmRenderer::CheckRoom() const {
  const KeptPixels& kept = pixels_->kept();
  if (!kept.is_too_small()) return {};
  // The memory that all LF images will take, with a quarter more.
  const double all = 1.25 * static_cast<double>(kept.other_bytes()) *
                     static_cast<double>(pixels_->images().size()) /
                     static_cast<double>(kept.images().size());
  return OutputError(fmt::format(
      "{{max_rays {}}} leaves no room for pixels beside the masks and depths of LF images, which "
      "take {} so far: give {{max_rays {}}}, or more {{memory}}",
      kept.max_pixels(), ByteText(kept.other_bytes()),
      static_cast<uint64_t>(all) / KeptPixels::kLeastPixelBytes + kept.max_pixels()));
}

// Adds the LF images that frames ask for to images_, unless they are there or done.
void FilmRenderer::AddKeptImages() {
  const auto is_before = [](const SelectedImage& a, const SelectedImage& b) {
    return a.rank < b.rank;
  };
  std::vector<SelectedImage> all;
  for (SelectedImage image : pixels_->images()) {
    if (image.rank < pixels_->ranks_done()) continue;
    if (std::binary_search(images_.begin(), images_.end(), image, is_before)) continue;
    if (film_.Collects()) image.rect = {};  // none of its pixels is collected
    all.push_back(image);
  }
  const auto middle = all.insert(all.end(), images_.begin(), images_.end());
  std::inplace_merge(all.begin(), middle, all.end(), is_before);
  images_ = std::move(all);
}

// Collects the rays of kept pixels into the plate of a frame.
//   frame   exactly one frame; its ranks end before the first LF image that must not be used
//   taking  the frame as selection sees it: each of its instants
Result<void> FilmRenderer::CollectFromKept(std::vector<CollectedFrame>* frame,
                                           std::span<const TakingFrame> taking) const {
  SelectOptions select = select_;
  // A request to stop does not end selection, because a part of the LF images would give another
  // picture.
  select.interrupted = nullptr;
  std::vector<SelectedImage> order = SelectImages(setup_.index(), taking, select, setup_.pool());
  // LF images that are broken were never kept.
  const auto& kept = pixels_->kept().images();
  std::erase_if(order, [&kept](const SelectedImage& image) { return !kept.contains(image.id); });
  CollectOptions collect = OptionsOfCollector();
  collect.consumer = nullptr;
  collect.strict = true;
  collect.batch_image_count = static_cast<int>(setup_.plan().kept_batch_image_count);
  // Only a request to stop interrupts this: one to save is for the steps of the render. After a
  // request to stop, the last pictures are still made if they do not take long.
  collect.interrupted = setup_.work().stop;
  constexpr size_t kFewImages = 256;
  if (setup_.work().IsStopped() && order.size() <= kFewImages) collect.interrupted = nullptr;
  LF_ASSIGN_OR_RETURN(
      const CollectStatistics statistics,
      Collect(setup_.light_field(), pixels_->store(), *frame, order, collect, setup_.pool(), {}));
  frame->front().progress.rays = statistics.frames.front();
  return {};
}

// kOutput: this is a shard, and pixels were dropped.
Result<void> FilmRenderer::CheckKeptAdd() const {
  if (!film_.shard || !pixels_->facts().is_full) return {};
  return OutputError(fmt::format(
      "{{shard}}, {{mode {}}}: there was no room for all pixels that {} ask for, so that the "
      "shards would not add up: increase {{max_rays}} or {{memory}}, or leave {{shard}} out",
      NameOf(film_.mode), film_.Collects() ? "gaps of lenses" : "frames"));
}

// Collects the plate of a frame from the kept pixels of LF images at ranks before rank_end.
Result<void> FilmRenderer::CollectKept(Frame* frame, uint32_t rank_end) {
  LF_RETURN_IF_ERROR(CheckKeptAdd());
  frame->kept_plate = EmptyPlateOf(*frame);
  std::vector<TakingFrame> taking = TakingInstants(*frame);
  if (frame->all_lens) taking.push_back(Taking(*frame, *frame->all_lens));
  const RankRange ranks = {0, std::min(frame->ranks.end, rank_end)};
  for (TakingFrame& instant : taking) instant.ranks = ranks;
  std::vector<CollectedFrame> collected = {CollectedInto(&frame->kept_plate, *frame)};
  collected.front().ranks = ranks;
  LF_RETURN_IF_ERROR(CollectFromKept(&collected, taking));
  frame->kept_rays = collected.front().progress.rays;
  return {};
}

// Collects the gaps of a frame's lenses from the kept pixels of LF images at ranks before rank_end.
// If no gap exists, the shares are 0: the channel `interpolated` is written nevertheless.
Result<PlateGaps> FilmRenderer::CollectGaps(const Frame& frame, uint32_t rank_end) {
  LF_RETURN_IF_ERROR(CheckKeptAdd());
  std::vector<TakingFrame> taking = TakingGaps(frame);
  const Intrinsics& plate = frame.lenses.front().camera().pinhole.intrinsics;
  PlateGaps gaps = {SensorPlate(plate.width_px, plate.height_px,
                                PlateKindOf(setup_.light_field().encoding, false)),
                    Image<float>(plate.width_px, plate.height_px)};
  if (taking.empty()) return gaps;
  const RankRange ranks = {0, std::min(frame.ranks.end, rank_end)};
  for (TakingFrame& gap : taking) gap.ranks = ranks;
  CollectedFrame collected;
  collected.plate = &gaps.rays;
  collected.ranks = ranks;
  collected.correction = frame.correction;
  const auto weights_of = [](const GapLens& gap) -> ImageWeights {
    return [&gap](LfImageId id) { return gap.WeightsOf(id); };
  };
  collected.camera = frame.gaps.front().camera();
  collected.weights = weights_of(frame.gaps.front());
  for (const GapLens& gap : std::span(frame.gaps).subspan(1))
    collected.further.push_back({gap.camera(), weights_of(gap)});
  std::vector<CollectedFrame> frames = {std::move(collected)};
  LF_RETURN_IF_ERROR(CollectFromKept(&frames, taking));
  const double per_gap = 1 / static_cast<double>(frame.gaps.size());
  setup_.pool().ForEach(static_cast<size_t>(plate.height_px), [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < plate.width_px; ++x) {
      float& share = gaps.share.at(x, y);
      for (const GapLens& gap : frame.gaps)
        if (gap.exists()) share += static_cast<float>(per_gap * gap.ShareAt(x, y));
      share = std::clamp(share, 0.0f, 1.0f);  // rounded sums may be slightly larger
    }
  });
  return gaps;
}

}  // namespace lf
