// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/densify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include "lf/core/log.h"
#include "lf/core/shell_word.h"
#include "lf/densify/densify_trial.h"
#include "lf/densify/densify_work.h"
#include "lf/densify/depth_cache.h"
#include "lf/densify/depth_planes.h"
#include "lf/densify/folded_poses.h"
#include "lf/densify/kept_findings.h"
#include "lf/densify/recorded_codes.h"
#include "lf/densify/recorded_values.h"
#include "lf/densify/synthesis.h"
#include "lf/densify/watched_loop.h"
#include "lf/densify/working_images.h"
#include "lf/light_field/model/keep_images.h"
#include "lf/light_field/model/reduction.h"
#include "lf/storage/load/measure_footprint.h"
#include "lf/storage/load/open_store.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {
namespace {

// Is changed whenever the same light field and options give other virtual LF images or trust, so
// that an unfinished store of an older program is not resumed.
constexpr int kDensifyVersion = 7;

std::string SettingsInWords(const DensifyPlan& plan, const DensifyChoices& choices) {
  return fmt::format(
      "densify {}, {} virtual LF images at distances of {}, {} depths, divisor {}, tolerance {}",
      kDensifyVersion, plan.virtual_cameras.size(), plan.distance_w, plan.planes, choices.divisor,
      plan.tolerance);
}

Result<void> CheckCount(const LightField& light_field) {
  constexpr size_t kLeast = 3;
  if (light_field.size() >= kLeast) return {};
  return InputError(fmt::format("{} LF images can be read: densifying needs at least {}",
                                light_field.size(), kLeast));
}

// Returns the recorded LF cameras, and behind them the virtual ones.
LightField WithVirtual(const LightField& light_field, std::span<const VirtualCamera> cameras) {
  LightField all = light_field;
  all.mask_names.clear();  // masks are stored with the LF images
  for (size_t i = 0; i < cameras.size(); ++i) {
    const Intrinsics& k = cameras[i].camera.intrinsics;
    const auto known = std::find(all.intrinsics.begin(), all.intrinsics.end(), k);
    LfCamera camera;
    camera.cam_from_world = cameras[i].camera.cam_from_world;
    camera.intrinsics_index = static_cast<uint32_t>(known - all.intrinsics.begin());
    camera.gain = GainsToHold(light_field, cameras[i].sources);
    camera.is_virtual = true;
    if (known == all.intrinsics.end()) all.intrinsics.push_back(k);
    all.cameras.push_back(camera);
    all.image_names.push_back(fmt::format("virtual/{:06}", i + 1));
  }
  return all;
}

class Densifier {
 public:
  Densifier(LightField light_field, const DensifyOptions& options, ThreadPool& pool,
            const std::function<void(const DensifyProgress&)>& progress)
      : whole_(IdentityOf(light_field)),
        encoding_(light_field.encoding),
        light_field_(WithOpacities(std::move(light_field))),
        options_(options),
        pool_(pool),
        progress_(progress),
        cache_(options.cache),
        work_(light_field_, options.choices) {}

  Result<DensifyReport> Run();

 private:
  using Loaded = std::vector<std::shared_ptr<const WorkingImage>>;

  Result<void> CheckTarget() const;
  Result<void> FindWhole();
  Result<void> LeaveOutBroken();
  // Leaves out all other LF images.
  Result<void> Keep(std::span<const size_t> kept);
  Result<void> MakePlan();
  Result<void> CheckPoses();
  Result<void> Test();
  Result<void> TestBeyond();
  Result<void> OpenWriter();
  void LeaveOutDoneWork();
  Result<void> FindDepths();
  Result<void> AddRecorded(LfImageId id);
  std::unique_ptr<SynthesisMemory> TakeMemory();
  Result<void> AddVirtual(const RecordedValues& values, size_t i);
  // Makes kind_ hold the values of a recorded LF image.
  void Hold(const StoredKind& kind);
  Result<Loaded> Load(std::span<const uint32_t> ids);
  // Returns a watch of a step, which shows progress.
  Watch WatchOf(DensifyStep step) const;
  // Calls body(i) for each i on all threads, until a call fails or the user interrupts. Commits
  // what was written.
  Result<void> ForEach(DensifyStep step, size_t count,
                       const std::function<Result<void>(size_t)>& body);

  LightFieldIdentity whole_;         // for a packed store, the light field that it was made from
  const RadianceEncoding encoding_;  // for the store
  LightField light_field_;           // without broken LF images, and WithOpacities()
  const DensifyOptions& options_;
  ThreadPool& pool_;
  const std::function<void(const DensifyProgress&)>& progress_;
  DepthCache cache_;
  DensifyWork work_;

  std::unique_ptr<LfImageStore> store_;
  std::unique_ptr<RecordedCodes> recorded_;
  std::unique_ptr<WorkingImages> images_;
  std::vector<uint32_t> whole_ids_;  // number of each LF image in the whole light field
  DensifyPlan plan_;
  LightField all_;  // recorded and virtual LF cameras
  std::optional<PackedStoreWriter> writer_;
  std::optional<LfImageKeys> keys_;
  std::optional<KeptFindings> findings_;
  std::unique_ptr<DepthPlanes> depths_;

  std::mutex adding_;  // held while a predicted LF image is added with its reference images
  std::mutex mutex_;   // guards all members below
  DensifyReport report_;
  std::vector<std::unique_ptr<SynthesisMemory>> spare_;  // memory that no thread uses
  StoredKind kind_;  // kind that holds the values of all recorded LF images
};

Watch Densifier::WatchOf(DensifyStep step) const {
  Watch watch{NameOf(step), options_.interrupted};
  if (!progress_) return watch;
  watch.tell = [=, this](size_t done, size_t count) {
    const double share = static_cast<double>(done) / static_cast<double>(count);
    progress_({NameOf(step), done, count, static_cast<uint64_t>(work_.Done(step, share)),
               static_cast<uint64_t>(work_.Total())});
  };
  return watch;
}

Result<void> Densifier::ForEach(DensifyStep step, size_t count,
                                const std::function<Result<void>(size_t)>& body) {
  const Result<void> result = ForEachWatched(pool_, count, WatchOf(step), body);
  // Earlier work is committed, unless the disk or the memory failed.
  if (!result && writer_ && result.error().kind != ErrorKind::kOutput)
    LF_RETURN_IF_ERROR(writer_->Commit());
  return result;
}

Result<Densifier::Loaded> Densifier::Load(std::span<const uint32_t> ids) {
  Loaded loaded;
  for (const uint32_t id : ids) {
    LF_ASSIGN_OR_RETURN(auto image, images_->Get(LfImageId{id}));
    loaded.push_back(std::move(image));
  }
  return loaded;
}

Result<void> Densifier::CheckTarget() const {
  const std::filesystem::path& store = options_.store;
  LF_ASSIGN_OR_RETURN(const bool is_there, IsStoreThere(store));
  std::error_code error;
  if (is_there && std::filesystem::equivalent(store, light_field_.folder, error))
    return UsageError(fmt::format(
        "{{output {}}}: is the packed store that is densified: give another name", store.string()));
  if (options_.overwrite) return {};
  if (is_there && !options_.resume)
    return UsageError(
        fmt::format("{}: exists already: replace it with {{overwrite}}", store.string()));
  if (PackedStoreWriter::IsUnfinished(store) && !options_.resume)
    return UsageError(fmt::format(
        "{}: exists already as an unfinished store: continue it with {{resume}}, or start it again "
        "with {{overwrite}}",
        store.string()));
  return {};
}

// Finds the numbers that LF images have in the whole light field.
Result<void> Densifier::FindWhole() {
  LF_RETURN_IF_ERROR(CheckNotReduced(light_field_, "a densified store"));
  whole_ids_.resize(light_field_.size());
  std::iota(whole_ids_.begin(), whole_ids_.end(), 0U);
  if (!HoldsPackedStore(light_field_)) return {};
  LF_ASSIGN_OR_RETURN(PackedStoreFacts facts, ReadPackedStore(light_field_.folder));
  whole_ = facts.whole;
  whole_ids_ = std::move(facts.whole_ids);
  return {};
}

// Loads every LF image once, and removes those that cannot be read. kInput: the light field is a
// packed store that left out pixels on purpose.
Result<void> Densifier::LeaveOutBroken() {
  LF_ASSIGN_OR_RETURN(store_, OpenStore(light_field_, Mosaics::kToRgb));
  if (store_->IsPartial())
    return InputError(
        fmt::format("{}: this packed store has only the pixels that packages need: densify the "
                    "light field that it was made from",
                    light_field_.folder.string()));
  std::vector<std::string> reasons(light_field_.size());
  LF_RETURN_IF_ERROR(ForEach(DensifyStep::kChecking, light_field_.size(), [&](size_t i) {
    const LfImageId id{static_cast<uint32_t>(i)};
    const Intrinsics& k = light_field_.Camera(id).intrinsics;
    const auto loaded = LoadWithoutThrowing(*store_, id, {0, 0, k.width_px, k.height_px},
                                            light_field_.image_names[i], LfPixels{});
    if (loaded) return Result<void>();
    if (options_.strict || loaded.error().kind != ErrorKind::kInput)
      return Result<void>(loaded.error());
    reasons[i] = loaded.error().message;
    return Result<void>();
  }));
  std::vector<size_t> kept;
  for (size_t i = 0; i < reasons.size(); ++i) {
    if (reasons[i].empty())
      kept.push_back(i);
    else
      report_.skipped.push_back({light_field_.image_names[i], reasons[i]});
  }
  if (kept.size() == light_field_.size()) return {};
  if (kept.empty())
    return InputError(fmt::format("none of the {} LF images can be read; the first: {}",
                                  light_field_.size(), report_.skipped.front().reason));
  return Keep(kept);
}

Result<void> Densifier::Keep(std::span<const size_t> kept) {
  std::vector<uint32_t> whole_ids;
  for (const size_t i : kept) whole_ids.push_back(whole_ids_[i]);
  KeepImages(kept, &light_field_);
  whole_ids_ = std::move(whole_ids);
  LF_ASSIGN_OR_RETURN(store_, OpenStore(light_field_, Mosaics::kToRgb));
  return {};
}

// Makes the plan for the LF images that are used.
Result<void> Densifier::MakePlan() {
  LF_RETURN_IF_ERROR(CheckCount(light_field_));
  keys_.emplace(light_field_, kDensifyVersion);
  findings_.emplace(light_field_, *store_, *keys_, cache_, pool_);
  images_ = std::make_unique<WorkingImages>(light_field_, *store_, options_.choices.divisor,
                                            options_.memory_bytes);
  LF_ASSIGN_OR_RETURN(
      plan_, PlanDensify(light_field_, *store_, options_.choices, pool_,
                         [this](std::span<const std::vector<uint32_t>> compare_with) {
                           return findings_->Range(compare_with, WatchOf(DensifyStep::kRange));
                         },
                         {NameOf(DensifyStep::kRange), options_.interrupted}));
  work_.Plan(light_field_, options_.choices, plan_);
  report_.dense = plan_.dense;
  report_.recorded_count = light_field_.size();
  report_.virtual_count = plan_.virtual_cameras.size();
  report_.range = plan_.range;
  report_.planes = plan_.planes;
  report_.shift_px = plan_.ShiftPx();
  report_.distance_w = plan_.distance_w;
  report_.spacing_px = plan_.spacing_px;
  return {};
}

// Looks for groups of LF images that contradict each other. A film is made of the group that
// clearly stands in its lenses; the others are then left out.
Result<void> Densifier::CheckPoses() {
  if (light_field_.size() > kMostChecked) return {};
  std::vector<std::string> source = {FileArgument(options_.source_name)};
  source.insert(source.end(), options_.source_options.begin(), options_.source_options.end());
  std::span<const RenderCamera> frames = options_.choices.frames;
  if (options_.choices.force) frames = {};  // nothing is left out
  LF_ASSIGN_OR_RETURN(const Contradiction found,
                      FindContradiction(light_field_, plan_.serving, frames, source,
                                        [&](std::span<const uint32_t> ids) {
                                          return findings_->Pairs(plan_, ids,
                                                                  WatchOf(DensifyStep::kPairs));
                                        }));
  if (found.text.empty()) return {};
  if (found.kept.empty() && !options_.choices.force) return InputError(found.text);
  LogWarning("{}", found.text);
  if (found.kept.empty()) return {};
  for (uint32_t i = 0; i < light_field_.size(); ++i)
    if (!std::binary_search(found.kept.begin(), found.kept.end(), i))
      report_.left_out.push_back(light_field_.image_names[i]);
  report_.kept_share = found.share;
  LF_RETURN_IF_ERROR(Keep(found.kept));
  LF_ASSIGN_OR_RETURN(recorded_, RecordedCodes::Open(light_field_));
  return MakePlan();
}

Result<void> Densifier::Test() {
  LF_ASSIGN_OR_RETURN(report_.tests, findings_->Tests(plan_, WatchOf(DensifyStep::kTests)));
  const std::vector<LeftOut> inside = TestsOf(report_.tests, false);
  if (inside.empty())
    LogWarning(
        "no LF camera is surrounded by others, so that virtual LF images cannot be tested against "
        "recorded ones");
  std::string objection = ObjectionOf(inside, plan_.range, plan_.is_film);
  if (!objection.empty() && !options_.choices.force) return InputError(std::move(objection));
  return TestBeyond();
}

// Leaves out virtual LF images beyond the LF cameras unless they are right.
Result<void> Densifier::TestBeyond() {
  const std::vector<LeftOut> beyond = TestsOf(report_.tests, true);
  std::string objection = ObjectionOf(beyond, plan_.range, plan_.is_film);
  if (objection.empty() || options_.choices.force) return {};
  DropBeyond(options_.choices.frames, &plan_);
  if (plan_.virtual_cameras.empty()) return InputError(std::move(objection));
  LogWarning(
      "virtual LF images are made between the LF cameras only, and fill less of the lens, because "
      "beyond them they would not be right: made of neighbours on one side, LF images are {:.1f} "
      "dB "
      "better than a mean of these, at {:.0f} dB",
      MedianGainDb(beyond), MedianPsnrDb(beyond));
  return {};
}

Result<void> Densifier::OpenWriter() {
  all_ = WithVirtual(light_field_, plan_.virtual_cameras);
  all_.encoding = encoding_;  // the background is that of the light field
  // Virtual LF images are interpolated, so that their own pixels would not tell.
  LF_ASSIGN_OR_RETURN(all_.encoding.footprint, FootprintOf(light_field_, *store_));
  PackedStorePlan plan;
  plan.whole = whole_;
  plan.whole_ids = whole_ids_;
  plan.whole_ids.resize(all_.size(), kNoWholeId);
  recorded_->Describe(&plan);
  plan.densified = DensifiedPlan{SettingsInWords(plan_, options_.choices), plan_.range.least,
                                 plan_.range.greatest, options_.choices.divisor};
  plan.source = options_.source_name;
  plan.version = options_.version;
  if (options_.resume && IsPackedStore(options_.store) &&
      !PackedStoreWriter::IsUnfinished(options_.store)) {
    report_.was_there = true;
    // Virtual LF images do not depend on the background that the store was made with.
    LF_ASSIGN_OR_RETURN(const PackedStoreFacts facts, ReadPackedStore(options_.store));
    all_.encoding.background = facts.light_field.encoding.background;
    all_.encoding.keeps_opacity = facts.light_field.encoding.keeps_opacity;
    const Result<void> same = CheckIsOfPlan(options_.store, all_, plan, true);
    if (same) return {};
    return Error{same.error().kind, same.error().message + ", or replace it with {overwrite}"};
  }
  LF_ASSIGN_OR_RETURN(FileLock lock, PackedStoreWriter::Lock(options_.store));
  if (options_.overwrite && !options_.resume)
    PackedStoreWriter::RemoveUnfinished(options_.store, lock);
  auto writer = options_.resume
                    ? PackedStoreWriter::Resume(options_.store, all_, plan, std::move(lock))
                    : PackedStoreWriter::Create(options_.store, all_, plan, std::move(lock));
  if (!writer) return writer.error();
  writer_.emplace(*std::move(writer));
  depths_ = std::make_unique<DepthPlanes>(light_field_, plan_, *images_, *writer_, *keys_, cache_,
                                          options_.interrupted);
  LeaveOutDoneWork();
  return {};
}

// Work of an earlier run is not work of this one.
void Densifier::LeaveOutDoneWork() {
  const auto share = [](size_t missing, size_t count) {
    return count == 0 ? 0 : static_cast<double>(missing) / static_cast<double>(count);
  };
  size_t recorded = 0, made = 0;
  for (uint32_t i = 0; i < all_.size(); ++i)
    if (!writer_->Has(LfImageId{i})) ++(i < light_field_.size() ? recorded : made);
  work_.Scale(DensifyStep::kRecorded, share(recorded, light_field_.size()));
  work_.Scale(DensifyStep::kDepths, share(depths_->MissingCount(), plan_.swept.size()));
  work_.Scale(DensifyStep::kVirtual, share(made, plan_.virtual_cameras.size()));
}

Result<void> Densifier::FindDepths() {
  const DepthPlanes::Loop loop = [this](DensifyStep step, size_t count, const auto& body) {
    return ForEach(step, count, body);
  };

  LF_RETURN_IF_ERROR(depths_->Search(loop));
  LF_RETURN_IF_ERROR(depths_->MakeAgree(loop));
  LF_RETURN_IF_ERROR(depths_->Store(loop));
  report_.cached_planes = depths_->facts().cached;
  report_.sweep_cpu_s = depths_->facts().cpu_s;
  report_.swept_pixels = depths_->facts().searched_pixels;
  report_.agreeing_share = depths_->facts().agreeing_share;
  return {};
}

void Densifier::Hold(const StoredKind& kind) {
  const std::lock_guard lock(mutex_);
  kind_ = KindToHold(kind_, kind);
}

Result<void> Densifier::AddRecorded(LfImageId id) {
  if (writer_->Has(id)) {
    LF_ASSIGN_OR_RETURN(const StoredKind kind, recorded_->KindOf(id));
    Hold(kind);
    return {};
  }
  // Another thread must not add an LF image while its reference images are added.
  std::unique_lock<std::mutex> lock;
  if (recorded_->ArePredicted()) lock = std::unique_lock(adding_);
  for (const LfImageId needed : recorded_->NeededBy(id)) {
    if (writer_->Has(needed)) continue;
    LF_ASSIGN_OR_RETURN(const CodedImage image,
                        recorded_->Of(needed, [this] { return IsSet(options_.interrupted); }));
    LF_ASSIGN_OR_RETURN(const StoredKind kind, KindOfCode(image, light_field_.encoding));
    Hold(kind);
    LF_RETURN_IF_ERROR(writer_->Add(needed, image));
  }
  return {};
}

std::unique_ptr<SynthesisMemory> Densifier::TakeMemory() {
  const std::lock_guard lock(mutex_);
  if (spare_.empty()) return std::make_unique<SynthesisMemory>();
  std::unique_ptr<SynthesisMemory> memory = std::move(spare_.back());
  spare_.pop_back();
  return memory;
}

Result<void> Densifier::AddVirtual(const RecordedValues& values, size_t i) {
  const LfImageId id{static_cast<uint32_t>(light_field_.size() + i)};
  if (writer_->Has(id)) return {};
  const VirtualCamera& wanted = plan_.virtual_cameras[i];
  std::vector<uint32_t> ids;
  for (const WeightedPoint& source : wanted.sources) ids.push_back(source.index);
  LF_ASSIGN_OR_RETURN(const Loaded loaded, Load(ids));
  const ThreadCpuTimer timer;
  std::vector<Source> sources;
  for (size_t k = 0; k < ids.size(); ++k)
    sources.push_back(
        {loaded[k].get(), &depths_->Of(ids[k]), static_cast<float>(wanted.sources[k].weight)});
  std::unique_ptr<SynthesisMemory> memory = TakeMemory();
  const VirtualImage& image = Synthesize(wanted.camera, sources, plan_.range, plan_.tolerance,
                                         options_.interrupted, memory.get());
  // The loop returns an error of its own.
  if (IsSet(options_.interrupted)) return Error{ErrorKind::kInterrupted, "interrupted"};
  {
    const std::lock_guard lock(mutex_);
    const auto pixels = static_cast<double>(image.light.width()) * image.light.height();
    report_.synthesis_cpu_s += static_cast<double>(timer.Nanoseconds()) * 1e-9;
    report_.made_pixels += pixels;
    report_.weak_share += image.weak_share * pixels;
  }
  // The trust is first, so that no virtual LF image lacks it, wherever the program is interrupted.
  if (!writer_->HasPlane(id, PlaneKind::kTrust))
    LF_RETURN_IF_ERROR(writer_->AddTrust(id, image.trust));
  CodecSettings settings;
  settings.profile = CodecProfile::kLossless;
  LF_ASSIGN_OR_RETURN(const CodedImage coded,
                      CodeOf(values.Of(image.light, all_.cameras[id.value].gain), settings,
                             [this] { return IsSet(options_.interrupted); }));
  LF_RETURN_IF_ERROR(writer_->Add(id, coded));
  const std::lock_guard lock(mutex_);
  spare_.push_back(std::move(memory));
  return {};
}

Result<DensifyReport> Densifier::Run() {
  LF_RETURN_IF_ERROR(CheckKind(light_field_));
  LF_RETURN_IF_ERROR(CheckTarget());
  LF_RETURN_IF_ERROR(FindWhole());
  LF_RETURN_IF_ERROR(LeaveOutBroken());
  LF_ASSIGN_OR_RETURN(recorded_, RecordedCodes::Open(light_field_));
  LF_RETURN_IF_ERROR(MakePlan());
  if (report_.dense.empty()) LF_RETURN_IF_ERROR(CheckPoses());
  if (!report_.dense.empty()) return std::move(report_);
  LogDebug("{}: {}", options_.store.string(), SettingsInWords(plan_, options_.choices));
  LF_RETURN_IF_ERROR(Test());
  report_.virtual_count = plan_.virtual_cameras.size();
  if (std::isfinite(plan_.filled_radius_w)) report_.filled_diameter_w = 2 * plan_.filled_radius_w;

  LF_RETURN_IF_ERROR(OpenWriter());
  if (report_.was_there) return std::move(report_);
  LF_RETURN_IF_ERROR(ForEach(DensifyStep::kRecorded, light_field_.size(), [&](size_t i) {
    return AddRecorded(LfImageId{static_cast<uint32_t>(i)});
  }));
  LF_RETURN_IF_ERROR(FindDepths());
  const RecordedValues values(light_field_.encoding, kind_);
  LF_RETURN_IF_ERROR(ForEach(DensifyStep::kVirtual, plan_.virtual_cameras.size(),
                             [&](size_t i) { return AddVirtual(values, i); }));
  if (report_.made_pixels > 0) report_.weak_share /= report_.made_pixels;
  LF_RETURN_IF_ERROR(writer_->DropPlanes(PlaneKind::kSwept));
  LF_RETURN_IF_ERROR(writer_->Finish());
  return std::move(report_);
}

}  // namespace

Result<DensifyReport> Densify(const LightField& light_field, const DensifyOptions& options,
                              ThreadPool& pool,
                              const std::function<void(const DensifyProgress&)>& progress) {
  return Densifier(light_field, options, pool, progress).Run();
}

}  // namespace lf
