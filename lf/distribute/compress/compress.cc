// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/compress.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include "lf/core/check.h"
#include "lf/core/log.h"
#include "lf/distribute/compress/choose_prediction.h"
#include "lf/distribute/compress/demosaicked_images.h"
#include "lf/distribute/compress/find_threshold.h"
#include "lf/distribute/compress/group_coder.h"
#include "lf/distribute/compress/image_coder.h"
#include "lf/distribute/compress/image_groups.h"
#include "lf/distribute/compress/verify_store.h"
#include "lf/selection/spread_order.h"
#include "lf/storage/load/copied_codes.h"
#include "lf/storage/load/recorded_image.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Returns the number of files of a store by resolution: one for each resolution that LF images can
// be loaded with, up to an eighth of their size.
size_t PartCount(const CompressOptions& options, const Encoding& encoding, bool is_copied) {
  constexpr int kMostHalvings = 3;
  if (!options.by_resolution) return 0;
  // The levels of encoded images that are copied are not known yet.
  if (is_copied) return 1 + kMostHalvings;
  if (encoding.settings.profile == CodecProfile::kThesis || encoding.files == KeepFiles::kAll)
    return 1;
  return 1 + static_cast<size_t>(std::min(encoding.settings.levels, kMostHalvings));
}

//   copied  null unless encoded images are copied
PackedStorePlan PlanOf(const CompressSource& source, const CompressOptions& options,
                       const Encoding& encoding, const ThresholdFactors& factors,
                       const CopiedCodes* copied) {
  PackedStorePlan plan;
  plan.whole = source.whole;
  plan.whole_ids = source.whole_ids;
  plan.rects = source.rects;
  plan.codec = NameOf(encoding, factors);
  if (source.demosaicked) plan.codec = DemosaickedImages::Words() + ", " + plan.codec;
  plan.is_predicted = encoding.in_groups;
  plan.films = options.use != nullptr ? std::optional(options.use->films) : source.films;
  plan.display_levels =
      ImageCoder(source.light_field.encoding, encoding.settings, KeepFiles::kNone, {})
          .display_levels();
  if (copied != nullptr) copied->Describe(&plan);
  plan.shard_bytes = options.shard_bytes;
  plan.part_count = PartCount(options, encoding, copied != nullptr);
  plan.source = options.source_name;
  plan.version = options.version;
  return plan;
}

Result<PackedStoreWriter> OpenWriter(const CompressSource& source, const CompressOptions& options,
                                     const PackedStorePlan& plan, FileLock lock) {
  const fs::path& store = options.store;
  if (options.resume)
    return PackedStoreWriter::Resume(store, source.light_field, plan, std::move(lock));
  if (options.overwrite) PackedStoreWriter::RemoveUnfinished(store, lock);
  return PackedStoreWriter::Create(store, source.light_field, plan, std::move(lock));
}

// A lock whose file the destructor removes, unless a PackedStoreWriter has taken over the lock.
struct HeldLock {
  std::optional<FileLock> lock;
  HeldLock() = default;
  HeldLock(const HeldLock&) = delete;
  HeldLock& operator=(const HeldLock&) = delete;
  ~HeldLock() {
    if (lock) lock->Remove();
  }
};

// State of one call of Compress(), shared by its threads.
class Compressor {
 public:
  Compressor(const CompressSource& source, const CompressOptions& options, ThreadPool& pool,
             const std::function<void(const CompressProgress&)>& progress,
             CompressSource* prepared = nullptr)
      : source_(source),
        prepared_(prepared),
        options_(options),
        pool_(pool),
        progress_(progress),
        ids_(source.CompressedIds()) {
    if (options.use != nullptr) {
      factors_ = ThresholdFactors(*options.use, source.rects);
      errors_.resize(source.rects.size());
    }
  }

  Result<CompressReport> Run();

 private:
  Result<void> CheckTarget();
  Result<void> FindSkipped();
  Result<void> FindThresholdOf(Encoding* encoding);
  Result<void> Prepare();
  Result<void> Choose();
  Result<void> Write(FileLock lock);
  std::vector<LfImageId> Ordered() const;
  Result<void> CheckFiles(const PackedStoreWriter& writer);
  Result<CodedMember> Encode(LfImageId id) const;
  Result<CodedMember> Copy(const PackedStoreWriter& writer, LfImageId id) const;
  void Count(const CodedMember& coded);
  bool Goes();
  void Note(const Error& error, LfImageId id, bool is_of_image);
  void AddOne(PackedStoreWriter* writer, LfImageId id);
  void AddAlone(PackedStoreWriter* writer, std::span<const LfImageId> ids);
  void AddGroups(PackedStoreWriter* writer);
  void AddGroup(PackedStoreWriter* writer, std::span<const GroupMember> group);
  VerifyOptions Verification() const;
  Result<void> Verify();
  void Show() const {
    if (progress_) progress_(now_);
  }
  bool IsInterrupted() const { return options_.interrupted && *options_.interrupted; }
  Error Interrupted() const;

  const CompressSource& source_;
  CompressSource* const prepared_;  // `source_`, which Prepare() completes; null: it is complete
  const CompressOptions& options_;
  ThreadPool& pool_;
  const std::function<void(const CompressProgress&)>& progress_;
  const std::vector<LfImageId> ids_;  // LF images that are compressed
  Encoding encoding_;
  ThresholdFactors factors_;
  std::optional<ImageCoder> coder_;
  std::optional<GroupCoder> group_coder_;  // set if LF images are predicted
  std::unique_ptr<CopiedCodes> copied_;    // set if encoded images are copied
  PackedStorePlan plan_;

  std::mutex mutex_;  // guards all members below
  CompressReport report_;
  CompressProgress now_;
  std::vector<double> errors_;  // [id]: mean squared error, 0 until encoded; empty without `use`
  std::optional<Error> error_;
  bool ended_ = false;  // true after an error or an interruption
};

Error Compressor::Interrupted() const {
  return {ErrorKind::kInterrupted,
          fmt::format("interrupted after {} of {} LF images: {{resume}} continues", now_.done,
                      now_.total)};
}

// Returns false if no further LF image must be begun.
bool Compressor::Goes() {
  const std::lock_guard lock(mutex_);
  if (IsInterrupted()) ended_ = true;
  return !ended_;
}

// Notes an error; the caller holds the mutex. Only an LF image that is broken itself (kInput) is
// skipped. If the machine lacks memory or disk space, Compress() fails.
//   is_of_image  true: the error is about the LF image, and not about the store
void Compressor::Note(const Error& error, LfImageId id, bool is_of_image) {
  if (error.kind == ErrorKind::kInterrupted) {
    ended_ = true;
    return;
  }
  const bool is_image = is_of_image && error.kind == ErrorKind::kInput;
  if (is_image)
    report_.skipped.push_back({source_.light_field.image_names[id.value], error.message});
  if ((!is_image || options_.strict) && !ended_) {
    ended_ = true;
    error_ = error;
  }
}

void Compressor::AddOne(PackedStoreWriter* writer, LfImageId id) {
  if (!Goes()) return;
  const ThreadCpuTimer timer;
  const Result<CodedMember> coded = copied_ ? Copy(*writer, id) : Encode(id);
  std::optional<Error> error;
  if (!coded)
    error = coded.error();
  else if (const Result<void> added = writer->Add(id, coded->image); !added)
    error = added.error();

  const std::lock_guard lock(mutex_);
  report_.encode_cpu_s += static_cast<double>(timer.Nanoseconds()) * 1e-9;
  if (error) Note(*error, id, !coded);
  if (error && error->kind == ErrorKind::kInterrupted) return;
  ++now_.done;
  if (!error) Count(*coded);
  Show();
}

void Compressor::AddAlone(PackedStoreWriter* writer, std::span<const LfImageId> ids) {
  if (copied_ && copied_->ArePredicted()) {
    // Copying is as fast in one thread, and adds reference images before those that need them.
    for (const LfImageId id : ids) AddOne(writer, id);
    return;
  }
  pool_.ForEach(ids.size(), [&](size_t i) { AddOne(writer, ids[i]); });
}

// Encodes a group and adds it to the store as a whole, because its images are of no use without
// their reference images.
void Compressor::AddGroup(PackedStoreWriter* writer, std::span<const GroupMember> group) {
  if (!Goes()) return;
  const ThreadCpuTimer timer;
  size_t shown = 0;  // number of LF images that Show() counted
  const auto encoded = [&] {
    const std::lock_guard lock(mutex_);
    ++shown;
    ++now_.done;
    Show();
  };
  const Result<CodedGroup> coded = group_coder_->Encode(group, encoded);
  std::optional<Error> error;
  if (!coded) {
    error = coded.error();
  } else {
    std::vector<GroupedImage> images;
    for (const CodedMember& member : coded->members) images.push_back({member.id, member.image});
    if (const Result<void> added = writer->AddGroup(images); !added) error = added.error();
  }
  const std::lock_guard lock(mutex_);
  report_.encode_cpu_s += static_cast<double>(timer.Nanoseconds()) * 1e-9;
  if (error) {
    now_.done -= shown;  // the store has none of them
    Note(*error, group[0].id, false);
    return;
  }
  for (const CodedGroup::Unreadable& image : coded->unreadable) Note(image.error, image.id, true);
  for (const CodedMember& member : coded->members) Count(member);
}

// An LF image whose group is in the store already, because it was broken when the group was
// encoded, is encoded by itself.
void Compressor::AddGroups(PackedStoreWriter* writer) {
  const ReferenceGroups groups = GroupsOf(source_);
  std::vector<size_t> whole;
  std::vector<LfImageId> single;
  for (size_t g = 0; g < groups.size(); ++g) {
    const std::span<const GroupMember> group = groups.Group(g);
    const auto has = [&](const GroupMember& member) { return writer->Has(member.id); };
    if (std::none_of(group.begin(), group.end(), has)) {
      whole.push_back(g);
      continue;
    }
    for (const GroupMember& member : group)
      if (!has(member)) single.push_back(member.id);
  }
  pool_.ForEach(whole.size(), [&](size_t i) { AddGroup(writer, groups.Group(whole[i])); });
  AddAlone(writer, single);
}

Result<CodedMember> Compressor::Encode(LfImageId id) const {
  const LightField& light_field = source_.light_field;
  LF_ASSIGN_OR_RETURN(const RecordedImage image, ReadToCompress(source_, id));
  CodedMember coded;
  coded.id = id;
  LF_ASSIGN_OR_RETURN(coded.image,
                      coder_->CodeOrFile(light_field, id, image, factors_.Of(id.value)));
  LF_ASSIGN_OR_RETURN(coded.lost, coder_->ErrorOf(image, coded.image));
  coded.pixel_bytes =
      std::visit([](const auto& pixels) { return pixels.size_bytes(); }, image.pixels);
  coded.is_rounded = image.is_rounded && coded.image.values != StoredValues::kFile;
  return coded;
}

Result<CodedMember> Compressor::Copy(const PackedStoreWriter& writer, LfImageId id) const {
  CodedMember coded;
  coded.id = id;
  LF_ASSIGN_OR_RETURN(coded.image, copied_->Of(id));
  for (const LfImageId reference : coded.image.references)
    if (!writer.Has(reference))
      return InputError(fmt::format(
          "{}: is predicted from {}, which cannot be copied: make the packed store again",
          source_.light_field.ImagePath(id).string(),
          source_.light_field.image_names[reference.value]));
  return coded;
}

void Compressor::Count(const CodedMember& coded) {
  const std::string& name = source_.light_field.image_names[coded.id.value];
  const CodeError& lost = coded.lost;
  ++report_.coded_count;
  report_.file_count += coded.image.values == StoredValues::kFile ? 1 : 0;
  report_.predicted_count += coded.image.references.empty() ? 0 : 1;
  report_.rounded_count += coded.is_rounded ? 1 : 0;
  report_.source_bytes += coded.image.source_bytes;
  report_.pixel_bytes += coded.pixel_bytes;
  report_.code_bytes += coded.image.code.size() + coded.image.mask.size();
  report_.error += lost;
  if (!errors_.empty()) errors_[coded.id.value] = lost.Mean();
  if (report_.worst_name.empty() || lost.PsnrDb() < report_.worst_psnr_db ||
      (lost.PsnrDb() == report_.worst_psnr_db && name < report_.worst_name)) {
    report_.worst_psnr_db = lost.PsnrDb();
    report_.worst_name = name;
  }
  now_.pixel_bytes = report_.pixel_bytes;
  now_.code_bytes = report_.code_bytes;
}

// Returns the LF images to compress in the order in which they are added to the store.
std::vector<LfImageId> Compressor::Ordered() const {
  if (copied_ && copied_->ArePredicted()) {
    std::vector<LfImageId> ordered;
    std::vector<bool> is_listed(source_.rects.size());
    for (const LfImageId id : ids_)
      for (const LfImageId needed : copied_->NeededBy(id)) {
        if (is_listed[needed.value]) continue;
        is_listed[needed.value] = true;
        ordered.push_back(needed);
      }
    return ordered;
  }
  if (!options_.by_resolution) return ids_;
  std::vector<LfImageId> ordered;
  for (const uint32_t id : SpreadOrder(source_.light_field, /*seed=*/0))
    if (!source_.rects[id].empty()) ordered.push_back({id});
  return ordered;
}

// Checks that the file of each LF image in the unfinished store still has the size that it had when
// it was encoded, because it may have been replaced. Files that no longer exist are not checked.
Result<void> Compressor::CheckFiles(const PackedStoreWriter& writer) {
  const LightField& light_field = source_.light_field;
  pool_.ForEach(ids_.size(), [&](size_t i) {
    const LfImageId id = ids_[i];
    if (!writer.Has(id)) return;
    const uint64_t now = SourceBytesOf(light_field, id), then = writer.SourceBytes(id);
    if (now == 0 || now == then) return;
    const std::lock_guard lock(mutex_);
    if (!error_)
      error_ = InputError(fmt::format(
          "{}: has {} bytes, but had {} when it was encoded into the unfinished {}: restore the "
          "file, or start the store again with {{overwrite}}",
          light_field.ImagePath(id).string(), now, then, options_.store.string()));
  });
  if (error_) return *error_;
  return {};
}

Result<void> Compressor::Write(FileLock lock) {
  const auto is_interrupted = [this] { return IsInterrupted(); };
  coder_.emplace(source_.light_field.encoding, encoding_.settings, encoding_.files, is_interrupted);
  if (encoding_.in_groups) group_coder_.emplace(source_, *coder_, factors_, is_interrupted);
  LF_ASSIGN_OR_RETURN(PackedStoreWriter writer,
                      OpenWriter(source_, options_, plan_, std::move(lock)));
  LF_RETURN_IF_ERROR(CheckFiles(writer));
  std::vector<LfImageId> ids;
  for (const LfImageId id : Ordered())
    if (!writer.Has(id)) ids.push_back(id);
  report_.resumed_count = ids_.size() - ids.size();
  now_.total = ids_.size();
  now_.done = report_.resumed_count;
  Show();
  LogDebug("{}: {} LF images to be encoded, {} are encoded; codec {}; {} threads",
           options_.store.string(), ids.size(), report_.resumed_count, plan_.codec,
           pool_.thread_count());
  if (group_coder_)
    AddGroups(&writer);
  else
    AddAlone(&writer, ids);
  std::sort(report_.skipped.begin(), report_.skipped.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  if (error_) {
    // Earlier work is committed, unless the disk or the memory failed.
    if (error_->kind == ErrorKind::kInput) LF_RETURN_IF_ERROR(writer.Commit());
    return *error_;
  }
  if (ended_) {
    LF_RETURN_IF_ERROR(writer.Commit());
    return Interrupted();
  }
  if (report_.skipped.size() == ids_.size()) {
    writer.Abandon();
    return InputError(fmt::format(
        "none of the {} LF images can be read, so that no store was written; the first: {}",
        report_.skipped.size(), report_.skipped.front().reason));
  }
  return writer.Finish();
}

VerifyOptions Compressor::Verification() const {
  return {options_.store, copied_.get(), encoding_, factors_, plan_, !options_.resume, [this] {
            return IsInterrupted();
          }};
}

Result<void> Compressor::Verify() {
  now_ = {0, ids_.size(), 0, 0, CompressPhase::kVerifying};
  Show();
  LF_ASSIGN_OR_RETURN(const size_t verified,
                      VerifyStore(source_, Verification(), pool_, [&](size_t done) {
                        now_.done = done;
                        Show();
                      }));
  report_.verified_count = verified;
  return {};
}

// Adds the LF images that an existing store lacks to report_.skipped.
Result<void> Compressor::FindSkipped() {
  const std::vector<std::string>& names = source_.light_field.image_names;
  LF_ASSIGN_OR_RETURN(const std::vector<PackedCode> codes,
                      FindCodes(options_.store, source_.light_field));
  for (const LfImageId id : ids_)
    if (codes[id.value].bytes == 0)
      report_.skipped.push_back({names[id.value], "it could not be read when the store was made"});
  return {};
}

// Sets report_.was_there. kUsage: a store exists, complete or unfinished, and no option says what
// to do with it.
Result<void> Compressor::CheckTarget() {
  const fs::path& store = options_.store;
  LF_ASSIGN_OR_RETURN(const bool is_there, IsStoreThere(store));
  std::error_code ignored;
  if (copied_ && fs::equivalent(store, source_.light_field.folder, ignored))
    return UsageError(fmt::format(
        "{}: is the packed store that would be copied, and cannot be compressed again into itself: "
        "give the new store another name ({{output}})",
        store.string()));
  const bool is_unfinished = PackedStoreWriter::IsUnfinished(store);
  if (options_.overwrite) return {};
  if (options_.resume) {
    report_.was_there = is_there && !is_unfinished;
    return {};
  }
  report_.was_there = is_there && options_.verify;
  if (report_.was_there) return {};
  if (is_there)
    return UsageError(fmt::format(
        "{}: exists already: replace it with {{overwrite}}, or check it with {{verify}}",
        store.string()));
  if (is_unfinished)
    return UsageError(fmt::format(
        "{}: exists already as an unfinished store: continue it with {{resume}}, or start "
        "it again with {{overwrite}}",
        store.string()));
  return {};
}

// Sets the threshold that gives the quality that is asked for.
Result<void> Compressor::FindThresholdOf(Encoding* encoding) {
  if (!options_.target_psnr_db) return {};
  LF_ASSIGN_OR_RETURN(encoding->settings.threshold,
                      FindThreshold(source_, *encoding, *options_.target_psnr_db, options_.use,
                                    pool_, [this] { return IsInterrupted(); }));
  LogDebug("{{target_psnr {}}}: threshold {}", *options_.target_psnr_db,
           encoding->settings.threshold);
  return {};
}

// Prepares demosaicking, if the source needs it.
Result<void> Compressor::Prepare() {
  if (prepared_ == nullptr) return {};
  now_.phase = CompressPhase::kPreparing;
  const Result<void> prepared =
      source_.demosaicked->Prepare(pool_, options_.interrupted, [this](size_t done, size_t total) {
        now_.done = done;
        now_.total = total;
        Show();
      });
  now_ = {};
  if (prepared) prepared_->light_field.encoding.footprint = source_.demosaicked->footprint();
  return prepared;
}

// Chooses how LF images are encoded, as far as the options leave it open.
Result<void> Compressor::Choose() {
  encoding_ = {options_.codec, options_.files, options_.prediction == Prediction::kGroups};
  if (encoding_.in_groups) encoding_.settings.entropy = options_.group_entropy;
  if (!copied_) LF_RETURN_IF_ERROR(FindThresholdOf(&encoding_));
  if (!copied_ && options_.prediction == Prediction::kChosen) {
    CodecSettings of_groups = encoding_.settings;
    of_groups.entropy = options_.group_entropy;
    now_.phase = CompressPhase::kChoosing;
    LF_ASSIGN_OR_RETURN(report_.sample,
                        SampleBytes(
                            source_, of_groups, factors_, pool_, [this] { return IsInterrupted(); },
                            [this](size_t done, size_t total) {
                              now_.done = done;
                              now_.total = total;
                              Show();
                            }));
    now_ = {};
    if (report_.sample->GroupsAreBetter()) {
      encoding_.files = KeepFiles::kNone;
      encoding_.in_groups = true;
      encoding_.settings = of_groups;
      LF_RETURN_IF_ERROR(FindThresholdOf(&encoding_));
    } else if (report_.sample->FilesAreBetter()) {
      encoding_.settings.profile = CodecProfile::kLossless;
      encoding_.files = KeepFiles::kAll;
    }
  }
  report_.threshold = encoding_.settings.threshold;
  plan_ = PlanOf(source_, options_, encoding_, factors_, copied_.get());
  report_.codec = plan_.codec;
  report_.is_copy = copied_ != nullptr;
  return {};
}

Result<CompressReport> Compressor::Run() {
  const double begin_s = Now();
  LF_RETURN_IF_ERROR(CheckSettings(options_.codec));
  LF_CHECK(!options_.by_resolution || options_.shard_bytes == 0);
  LF_CHECK(!source_.demosaicked ||
           (options_.files == KeepFiles::kNone && options_.prediction != Prediction::kChosen));
  if (source_.IsCopied()) {
    LF_ASSIGN_OR_RETURN(copied_, CopiedCodes::Open(source_.light_field));
    if (options_.by_resolution && copied_->ArePredicted())
      return UsageError(fmt::format(
          "{}: has LF images that are predicted from others, which have no smaller pictures and "
          "cannot be divided by resolution: leave out {{by_resolution}}, or compress the light "
          "field that the store was made from",
          source_.light_field.folder.string()));
  }
  report_.image_count = ids_.size();
  report_.left_out_count = source_.light_field.size() - ids_.size();
  LF_RETURN_IF_ERROR(CheckTarget());
  HeldLock held;
  if (!report_.was_there) {
    LF_ASSIGN_OR_RETURN(held.lock, PackedStoreWriter::Lock(options_.store));
    LF_RETURN_IF_ERROR(CheckTarget());  // another program may have finished the store meanwhile
  }
  LF_RETURN_IF_ERROR(Prepare());
  LF_RETURN_IF_ERROR(Choose());
  if (report_.was_there) {
    if (const Result<void> same = CheckStoreFacts(source_, Verification()); !same)
      return Error{same.error().kind, same.error().message + ", or replace it with {overwrite}"};
    LF_RETURN_IF_ERROR(FindSkipped());
  } else {
    LF_RETURN_IF_ERROR(Write(std::move(*held.lock)));
  }
  if (options_.verify) LF_RETURN_IF_ERROR(Verify());
  if (options_.use != nullptr && report_.coded_count + report_.skipped.size() == ids_.size())
    report_.frames = PredictFrames(*options_.use, errors_);
  if (source_.demosaicked && !(report_.was_there && !options_.verify))
    report_.demosaicked = source_.demosaicked->Errors();
  report_.store_bytes = StoreBytes(options_.store);
  report_.total_s = Now() - begin_s;
  return std::move(report_);
}

}  // namespace

Result<CompressReport> Compress(const CompressSource& source, const CompressOptions& options,
                                ThreadPool& pool,
                                const std::function<void(const CompressProgress&)>& progress) {
  if (!source.demosaicked) return Compressor(source, options, pool, progress).Run();
  CompressSource prepared = source;
  return Compressor(prepared, options, pool, progress, &prepared).Run();
}

}  // namespace lf
