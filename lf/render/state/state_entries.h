// SPDX-License-Identifier: Apache-2.0
// Entries of the files of a state: the inputs that a file was made from, and the progress of the
// render. Internal to render/state.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "lf/core/parse_number.h"
#include "lf/core/result.h"
#include "lf/film/plate/plate_file.h"
#include "lf/render/state/run_inputs.h"

namespace lf {

inline constexpr std::string_view kProgressKeys = "progress.";  // all other entries are inputs
inline constexpr const char* kRanksDone = "progress.ranks_done";

inline RunInputs Joined(RunInputs a, const RunInputs& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Returns the error with the advice for a damaged file behind its message.
inline Error WithAdvice(const Error& error, const char* advice) {
  return {error.kind, fmt::format("{}; {}", error.message, advice)};
}

// Reads the number of an entry. kInput if the entry is missing or is no whole number.
template <class Number>
Result<void> NumberOf(const std::filesystem::path& path, const PlateEntries& entries,
                      const char* key, const char* advice, Number* value) {
  const std::string* text = FindEntry(entries, key);
  const std::string number = text == nullptr ? "(none)" : *text;
  if (const auto whole = ParseWhole<Number>(number)) {
    *value = *whole;
    return {};
  }
  return WithAdvice(InputError(fmt::format("{}: its entry {} is \"{}\", expected a whole number",
                                           path.string(), key, number)),
                    advice);
}

// Returns the entries of a file that all frames of a pass share, such as their rebinned rays.
//   rays    RunStateOptions::rays
//   frames  describes the frames of the pass
PlateEntries EntriesOfPass(const RunInputs& rays, const std::string& frames, uint32_t ranks_done);

// kUsage if the folder has a file with the extension `other` (with its dot): the run was begun with
// the other way to keep rays.
//   made_with, has  the settings of that run and of this one, for the message
Result<void> CheckNoneIsOther(const std::filesystem::path& folder, std::string_view other,
                              std::string_view made_with, std::string_view has);

// kUsage if a file with these entries was made for other frames or from other inputs than those
// that EntriesOfPass() would be called with.
Result<void> CheckEntriesOfPass(const std::filesystem::path& path, const PlateEntries& entries,
                                const RunInputs& rays, const std::string& frames);

}  // namespace lf
