// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/state_entries.h"

namespace lf {
namespace {
constexpr const char* kPassFrames = "rays.frames";
}  // namespace

PlateEntries EntriesOfPass(const RunInputs& rays, const std::string& frames, uint32_t ranks_done) {
  PlateEntries entries = rays;
  entries.emplace_back(kPassFrames, frames);
  entries.emplace_back(kRanksDone, fmt::format("{}", ranks_done));
  return entries;
}

Result<void> CheckEntriesOfPass(const std::filesystem::path& path, const PlateEntries& entries,
                                const RunInputs& rays, const std::string& frames) {
  RunInputs recorded, wanted = rays;
  wanted.emplace_back(kPassFrames, frames);
  for (const auto& entry : entries)
    if (!entry.first.starts_with(kProgressKeys)) recorded.push_back(entry);
  if (const auto difference = FirstDifference(recorded, wanted))
    return UsageError(fmt::format(
        "{}: {}, so that {{resume}} cannot continue; {}, or another {{output}}, or "
        "start again with {{overwrite}} instead of {{resume}}",
        path.string(), difference->Text("was made with", "this call has"), difference->Remedy()));
  return {};
}

Result<void> CheckNoneIsOther(const std::filesystem::path& folder, std::string_view other,
                              std::string_view made_with, std::string_view has) {
  std::error_code ignored;
  for (const auto& file : std::filesystem::directory_iterator(folder, ignored))
    if (file.path().extension() == other)
      return UsageError(fmt::format(
          "{}: was made with {}, this call has {}, so that {{resume}} cannot continue; give the "
          "same inputs and options, or another {{output}}, or start again with {{overwrite}} "
          "instead of {{resume}}",
          file.path().string(), made_with, has));
  return {};
}

}  // namespace lf
