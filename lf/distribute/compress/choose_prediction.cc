// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/choose_prediction.h"

#include <fmt/format.h>

#include <mutex>
#include <optional>
#include <vector>

#include "lf/distribute/compress/group_coder.h"
#include "lf/distribute/compress/image_groups.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {
namespace {

constexpr size_t kSampled = 32;  // LF images in the sample, about

}  // namespace

bool SampledBytes::GroupsAreBetter() const {
  return static_cast<double>(in_groups) <= kMostPredicted * static_cast<double>(alone);
}

Result<SampledBytes> SampleBytes(const CompressSource& source, const CodecSettings& settings,
                                 const ThresholdFactors& factors, ThreadPool& pool,
                                 const std::function<bool()>& is_interrupted,
                                 const std::function<void(size_t done, size_t total)>& progress) {
  const ImageCoder coder(source.light_field.encoding, settings, KeepFiles::kNone, is_interrupted);
  const GroupCoder group_coder(source, coder, factors, is_interrupted);
  const ReferenceGroups groups = GroupsOf(source);
  const std::vector<size_t> sample = SampleOf(groups, kSampled);
  size_t done = 0, total = 0;  // LF images
  for (const size_t group : sample) total += groups.Group(group).size();
  progress(done, total);
  std::mutex mutex;  // guards `done`, and orders the calls of progress()
  const auto encoded = [&] {
    const std::lock_guard lock(mutex);
    progress(++done, total);
  };
  std::vector<std::optional<Result<CodedGroup>>> coded(sample.size());
  pool.ForEach(sample.size(), [&](size_t i) {
    if (!is_interrupted()) coded[i] = group_coder.Encode(groups.Group(sample[i]), encoded);
  });
  SampledBytes bytes;
  std::optional<Error> unreadable;
  for (const auto& group : coded) {
    if (!group || (!*group && group->error().kind == ErrorKind::kInterrupted))
      return Error{ErrorKind::kInterrupted, "interrupted during the choice of a profile"};
    LF_RETURN_IF_ERROR(*group);
    bytes.in_groups += (*group)->bytes;
    for (size_t i = 0; i < (*group)->members.size(); ++i) {
      const CodedMember& member = (*group)->members[i];
      const uint64_t alone = (*group)->bytes_alone[i];
      const uint64_t file = member.image.source_bytes;
      const bool is_file =
          CanKeepFile(source.light_field, member.id, member.image.rect) && file <= alone;
      ++bytes.image_count;
      bytes.file_count += is_file ? 1 : 0;
      bytes.alone += is_file ? file : alone;
    }
    if (!unreadable && !(*group)->unreadable.empty())
      unreadable = (*group)->unreadable.front().error;
  }
  if (bytes.image_count == 0)
    return InputError(fmt::format(
        "none of the LF images that were tried can be read, so that no profile can be chosen; the "
        "first: {}",
        unreadable ? unreadable->message : std::string("there is none")));
  return bytes;
}

}  // namespace lf
