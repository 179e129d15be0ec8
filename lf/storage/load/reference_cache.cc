// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/reference_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "lf/core/check.h"
#include "lf/pixels/codec/predicted_image.h"
#include "lf/storage/load/check_code.h"

namespace lf {
namespace {

uint64_t PixelBytes(const DecodedPart& part) {
  return std::visit([](const auto& image) { return uint64_t{image.size_bytes()}; }, part.pixels);
}

bool Covers(const PixelRect& rect, const PixelRect& wanted) {
  return Intersection(rect, wanted) == wanted;
}

// Copies the pixels `wanted` of the image, and those beside them that complete squares of a mosaic.
void CopyPixels(const DecodedPart& from, const PixelRect& wanted, DecodedPart* to) {
  const PixelRect squares = {wanted.x_begin / 2 * 2, wanted.y_begin / 2 * 2,
                             (wanted.x_end + 1) / 2 * 2, (wanted.y_end + 1) / 2 * 2};
  to->rect = Intersection(from.rect, squares);
  std::visit(
      [&]<class Pixel>(const Image<Pixel>& source) {
        if (!std::holds_alternative<Image<Pixel>>(to->pixels)) to->pixels = Image<Pixel>();
        auto& copy = std::get<Image<Pixel>>(to->pixels);
        copy.Resize(to->rect.width(), to->rect.height(), source.channels());
        const size_t channels = static_cast<size_t>(source.channels());
        for (int y = 0; y < copy.height(); ++y)
          std::copy_n(source.row(y + to->rect.y_begin - from.rect.y_begin) +
                          channels * static_cast<size_t>(to->rect.x_begin - from.rect.x_begin),
                      channels * static_cast<size_t>(copy.width()), copy.row(y));
      },
      from.pixels);
}

}  // namespace

// Memory of decoded pixels that nobody uses now. LF images have similar sizes: memory that is
// allocated and freed for each of them, between small pieces, took twice as much as is in use.
class ReferenceCache::SpareParts : public std::enable_shared_from_this<SpareParts> {
 public:
  // Returns pixels to decode into, whose memory comes back here when the last pointer goes away.
  std::shared_ptr<DecodedPart> Take() {
    const auto give_back = [spares = shared_from_this()](DecodedPart* part) {
      std::unique_ptr<DecodedPart> owned(part);
      const std::lock_guard lock(spares->mutex_);
      if (spares->parts_.size() < kMost) spares->parts_.push_back(std::move(owned));
    };
    std::unique_ptr<DecodedPart> part;
    {
      const std::lock_guard lock(mutex_);
      if (!parts_.empty()) {
        part = std::move(parts_.back());
        parts_.pop_back();
      }
    }
    if (!part) part = std::make_unique<DecodedPart>();
    return {part.release(), give_back};
  }

 private:
  static constexpr size_t kMost = 8;
  std::mutex mutex_;
  std::vector<std::unique_ptr<DecodedPart>> parts_;
};

ReferenceCache::ReferenceCache(std::filesystem::path store, BayerPattern bayer,
                               ReferenceTable references, std::vector<PackedCode> codes)
    : store_(std::move(store)),
      bayer_(bayer),
      references_(std::move(references)),
      codes_(std::move(codes)),
      spares_(std::make_shared<SpareParts>()) {}

Result<std::unique_ptr<ReferenceCache>> ReferenceCache::Open(const std::filesystem::path& store,
                                                             BayerPattern bayer) {
  LF_ASSIGN_OR_RETURN(ReferenceTable references, ReadReferences(store));
  if (references.empty()) return std::unique_ptr<ReferenceCache>();
  LF_ASSIGN_OR_RETURN(std::vector<PackedCode> codes, CodesInStore(store));
  return std::unique_ptr<ReferenceCache>(
      new ReferenceCache(store, bayer, std::move(references), std::move(codes)));
}

uint64_t ReferenceCache::AllBytes() const {
  uint64_t values = 0;
  std::optional<uint32_t> first;
  for (uint32_t id = 0; id < codes_.size(); ++id) {
    if (!IsReference(id)) continue;
    if (!first) first = id;
    values +=
        static_cast<uint64_t>(codes_[id].rect.pixel_count()) * (BitsOf(codes_[id].values) / 8);
  }
  if (!first || bayer_ != BayerPattern::kNone) return values;
  // The table of the store does not tell grey LF images from others.
  const Result<std::string> code = Read(*first);
  const Result<CodeInfo> info = code ? ReadCodeInfo(*code) : Result<CodeInfo>(code.error());
  return info && info->layout == PixelLayout::kGrey ? values : 3 * values;
}

uint64_t ReferenceCache::decoded_count() const {
  const std::lock_guard lock(mutex_);
  return decoded_count_;
}

void ReferenceCache::Limit(uint64_t most_bytes) {
  const std::lock_guard lock(mutex_);
  most_bytes_ = most_bytes;
  DropBeyond(most_bytes_);
}

Result<void> ReferenceCache::Decode(uint32_t id, std::string_view code, const PixelRect& wanted,
                                    DecodedPart* part) {
  LF_ASSIGN_OR_RETURN(Steps steps, Plan(id, code, wanted));
  return Run(&steps, part);
}

Result<std::shared_ptr<const DecodedPart>> ReferenceCache::Whole(uint32_t id) {
  LF_CHECK(id < codes_.size() && codes_[id].bytes > 0);
  const PixelRect& rect = codes_[id].rect;
  const PixelRect whole = {0, 0, rect.width(), rect.height()};
  if (IsReference(id)) {
    const std::lock_guard lock(mutex_);
    if (Part part = Find(id, whole)) return part;
  }
  LF_ASSIGN_OR_RETURN(const std::string code, Read(id));
  LF_ASSIGN_OR_RETURN(Steps steps, Plan(id, code, whole));
  if (!IsReference(id)) {
    std::shared_ptr<DecodedPart> decoded = spares_->Take();
    LF_RETURN_IF_ERROR(Run(&steps, decoded.get()));
    return Part(std::move(decoded));
  }
  LF_RETURN_IF_ERROR(Run(&steps, nullptr));
  return steps.back().part;
}

Result<std::string> ReferenceCache::Read(uint32_t id) const {
  std::optional<PackedCodeReader> reader;
  {
    const std::lock_guard lock(mutex_);
    if (!readers_.empty()) {
      reader = std::move(readers_.back());
      readers_.pop_back();
    }
  }
  if (!reader) {
    LF_ASSIGN_OR_RETURN(reader, PackedCodeReader::Open(store_));
  }
  const Result<PackedCodeReader::Bytes> bytes = reader->Read(codes_[id]);
  Result<std::string> code =
      bytes ? Result<std::string>(std::string(bytes->code)) : Result<std::string>(bytes.error());
  const std::lock_guard lock(mutex_);
  readers_.push_back(*std::move(reader));
  return code;
}

// Finds the pixels that a step needs among those that are kept. If they are not, reads its encoded
// image, and adds the pixels that it needs of its reference images to their steps.
Result<void> ReferenceCache::PlanStep(size_t index, Steps* steps) {
  Step& step = (*steps)[index];
  if (IsReference(step.id)) {
    const std::lock_guard lock(mutex_);
    step.part = Find(step.id, step.wanted);
    // A part of the LF image is enlarged by decoding all of it again.
    if (const auto kept = kept_of_.find(step.id); !step.part && kept != kept_of_.end())
      step.wanted = Bounds(step.wanted, kept->second->part->rect);
  }
  if (step.part) return {};
  if (step.code.empty()) {
    LF_ASSIGN_OR_RETURN(step.bytes, Read(step.id));
    step.code = step.bytes;
  }
  LF_RETURN_IF_ERROR(CheckColours(step.code, codes_[step.id], bayer_));
  const std::span<const uint32_t> references = references_.Of(step.id);
  LF_ASSIGN_OR_RETURN(const CodeInfo info, ReadCodeInfo(step.code));
  if (static_cast<size_t>(info.reference_count) != references.size())
    return InputError(
        fmt::format("is damaged in the packed store: its encoded image has {} reference images, "
                    "but the table of the store says {}; copy or make the store again",
                    info.reference_count, references.size()));
  if (references.empty()) return {};
  // All of an image needs nearly all of its reference images.
  std::vector<PixelRect> needed;
  if (step.wanted == PixelRect{0, 0, info.width, info.height}) {
    for (const uint32_t reference : references) {
      const PixelRect& rect = codes_[reference].rect;
      needed.push_back({0, 0, rect.width(), rect.height()});
    }
  } else {
    LF_ASSIGN_OR_RETURN(needed, NeededOfReferences(step.code, step.wanted));
  }
  for (size_t r = 0; r < references.size(); ++r) {
    const auto of_reference = std::find_if(
        steps->begin(), steps->end(), [&](const Step& other) { return other.id == references[r]; });
    const PixelRect& rect = codes_[references[r]].rect;
    of_reference->wanted =
        Bounds(of_reference->wanted, Intersection(needed[r], {0, 0, rect.width(), rect.height()}));
    of_reference->last_use = std::max(of_reference->last_use, index);
  }
  return {};
}

// Returns the LF images to decode, each after its reference images, and which of their pixels. The
// last one is `id`.
Result<ReferenceCache::Steps> ReferenceCache::Plan(uint32_t id, std::string_view code,
                                                   const PixelRect& wanted) {
  const std::vector<uint32_t> needed = references_.NeededBy(id);
  Steps steps(needed.size());
  for (size_t i = 0; i < needed.size(); ++i) steps[i].id = needed[i];
  steps.back().code = code;
  const PixelRect& rect = codes_[id].rect;
  steps.back().wanted = Intersection(wanted, {0, 0, rect.width(), rect.height()});
  LF_CHECK(!steps.back().wanted.empty());
  steps.back().last_use = steps.size();
  for (size_t i = steps.size(); i-- > 0;) {
    if (steps[i].wanted.empty()) continue;
    if (const Result<void> planned = PlanStep(i, &steps); !planned)
      return steps[i].id == id ? planned.error() : OfReference(steps[i].id, planned.error());
  }
  return steps;
}

// Decodes the pixels of a step, whose reference images are decoded.
Result<void> ReferenceCache::DecodeStep(const Step& step, const Steps& steps,
                                        DecodedPart* part) const {
  std::vector<const DecodedPart*> parts;
  for (const uint32_t reference : references_.Of(step.id)) {
    const auto found = std::find_if(steps.begin(), steps.end(),
                                    [&](const Step& other) { return other.id == reference; });
    parts.push_back(found->part.get());
  }
  return DecodePredicted(step.code, parts, step.wanted, part);
}

// Returns the decoded pixels of a reference image: those that are kept, or those that another
// thread decodes now, or, if there are none, those that it decodes.
Result<ReferenceCache::Part> ReferenceCache::Obtain(const Step& step, const Steps& steps) {
  std::unique_lock lock(mutex_);
  while (true) {
    if (Part part = Find(step.id, step.wanted)) return part;
    const auto other = pending_.find(step.id);
    if (other == pending_.end()) break;
    const std::shared_ptr<Pending> pending = other->second;
    is_decoded_.wait(lock, [&] { return pending->is_done; });
    if (pending->part && Covers(pending->part->rect, step.wanted)) return pending->part;
    // The other thread has failed, or has decoded other pixels.
  }
  // Ends the wait of others however this call ends, also if memory runs out.
  struct Announced {
    ReferenceCache& cache;
    std::unique_lock<std::mutex>& lock;
    const uint32_t id;
    const std::shared_ptr<Pending> pending;

    ~Announced() {
      if (!lock.owns_lock()) lock.lock();
      pending->is_done = true;
      cache.pending_.erase(id);
      cache.is_decoded_.notify_all();
    }
  } announced{*this, lock, step.id, std::make_shared<Pending>()};
  pending_.emplace(step.id, announced.pending);
  lock.unlock();
  std::shared_ptr<DecodedPart> decoded = spares_->Take();
  LF_RETURN_IF_ERROR(DecodeStep(step, steps, decoded.get()));
  lock.lock();
  ++decoded_count_;
  used_[step.id] = decoded;
  announced.pending->part = decoded;
  Keep(step.id, decoded);
  return Part(std::move(decoded));
}

// Decodes all LF images of a plan in their order.
//   part  gets the pixels of the last one; null: they stay in the step of a reference image
Result<void> ReferenceCache::Run(Steps* steps, DecodedPart* part) {
  for (size_t i = 0; i < steps->size(); ++i) {
    Step& step = (*steps)[i];
    if (step.wanted.empty()) continue;
    const bool is_last = i + 1 == steps->size();
    if (is_last && !IsReference(step.id)) return DecodeStep(step, *steps, part);
    if (!step.part) {
      Result<Part> obtained = Obtain(step, *steps);
      if (!obtained) return is_last ? obtained.error() : OfReference(step.id, obtained.error());
      step.part = *std::move(obtained);
    }
    step.bytes = {};
    for (Step& done : *steps)
      if (done.last_use == i && &done != &step) done.part = nullptr;
  }
  if (part != nullptr) CopyPixels(*steps->back().part, steps->back().wanted, part);
  return {};
}

Error ReferenceCache::OfReference(uint32_t id, const Error& error) const {
  const Result<std::string> name = NameInStore(store_, {id});
  return {error.kind,
          fmt::format("cannot be decoded without the reference image {}: {}",
                      name ? *name : fmt::format("{} of the store", id), error.message)};
}

// Returns the pixels of an LF image that are kept, or that a call uses now, if they contain
// `wanted`, otherwise null.
ReferenceCache::Part ReferenceCache::Find(uint32_t id, const PixelRect& wanted) {
  if (const auto kept = kept_of_.find(id);
      kept != kept_of_.end() && Covers(kept->second->part->rect, wanted)) {
    kept_.splice(kept_.begin(), kept_, kept->second);
    return kept->second->part;
  }
  const auto used = used_.find(id);
  if (used == used_.end()) return nullptr;
  Part part = used->second.lock();
  if (!part) used_.erase(used);
  return part && Covers(part->rect, wanted) ? part : nullptr;
}

// Keeps decoded pixels in place of those of the same LF image, unless these contain them.
void ReferenceCache::Keep(uint32_t id, const Part& part) {
  if (const auto old = kept_of_.find(id); old != kept_of_.end()) {
    if (Covers(old->second->part->rect, part->rect)) return;
    kept_bytes_ -= PixelBytes(*old->second->part);
    kept_.erase(old->second);
    kept_of_.erase(old);
  }
  const uint64_t bytes = PixelBytes(*part);
  if (bytes > most_bytes_) return;
  DropBeyond(most_bytes_ - bytes);
  std::list<Kept> added = {{id, part}};
  kept_of_[id] = added.begin();
  kept_.splice(kept_.begin(), added);
  kept_bytes_ += bytes;
}

// Drops the least recently used LF images until those that are kept have at most this size.
void ReferenceCache::DropBeyond(uint64_t most_bytes) {
  while (kept_bytes_ > most_bytes) {
    kept_bytes_ -= PixelBytes(*kept_.back().part);
    kept_of_.erase(kept_.back().id);
    kept_.pop_back();
  }
}

}  // namespace lf
