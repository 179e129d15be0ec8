// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/check_outputs.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "lf/render/pipeline/frame_output.h"
#include "lf/render/state/run_state.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

using FileNumber = std::pair<dev_t, ino_t>;

std::optional<FileNumber> NumberOf(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return FileNumber{status.st_dev, status.st_ino};
}

std::string_view NameIn(const std::string& path) {
  return std::string_view(path).substr(path.rfind('/') + 1);
}

// The outputs that exist already, and that the render would overwrite.
class Replaced {
 public:
  explicit Replaced(const std::vector<fs::path>& outputs) {
    for (const fs::path& output : outputs) {
      const std::optional<FileNumber> number = NumberOf(output);
      if (!number) continue;
      std::error_code error;
      const fs::path canonical = fs::canonical(output, error);
      numbers_.emplace(*number, output);
      if (error) continue;
      names_.insert(canonical.filename().string());
      paths_.emplace(canonical.string(), output);
    }
  }
  bool empty() const { return numbers_.empty(); }

  // Returns the output that is the same file as `input`; null if there is none.
  const fs::path* Find(const fs::path& input) const {
    const std::optional<FileNumber> number = NumberOf(input);
    if (!number) return nullptr;
    const auto found = numbers_.find(*number);
    return found == numbers_.end() ? nullptr : &found->second;
  }
  // Returns the output whose canonical path equals folder/name after links to folders are followed;
  // null if there is none. Accesses the disk once for each folder, and not for each file.
  const fs::path* FindByName(const fs::path& folder, const std::string& name) {
    if (!names_.contains(NameIn(name))) return nullptr;
    const fs::path input = folder / name;
    const auto [known, is_new] = folders_.try_emplace(input.parent_path());
    std::error_code error;
    if (is_new) known->second = fs::canonical(input.parent_path(), error);
    const auto found = paths_.find((known->second / NameIn(name)).string());
    return found == paths_.end() ? nullptr : &found->second;
  }

 private:
  std::map<FileNumber, fs::path> numbers_;
  std::set<std::string, std::less<>> names_;
  // From the canonical path of an output to its path as given.
  std::map<std::string, fs::path> paths_;
  // From a folder of inputs, as given, to its canonical path.
  std::map<fs::path, fs::path> folders_;
};

Error Refusal(const fs::path& output, std::string_view what, const fs::path& input) {
  return UsageError(
      fmt::format("{}: would be replaced by the render, but is {} ({}): give another -o",
                  output.string(), what, input.string()));
}

// Returns the files that the render may write or remove, except for plates and rebinned rays in its
// state.
std::vector<fs::path> OutputsOf(const Package& package, const RenderOptions& options) {
  const fs::path& folder = options.folder.output_folder;
  const std::string state = NameOfState(package.name, options.film.shard);
  const fs::path partial = folder / "partial" / state;
  std::vector<fs::path> outputs = {folder / kContactSheet, folder / "report.json",
                                   partial / "run.json"};
  if (!package.name.empty()) outputs.push_back(folder / ("contact_sheet-" + package.name + ".png"));
  if (!state.empty()) outputs.push_back(folder / ("report-" + state + ".json"));
  for (const FrameId frame : options.frames.empty() ? package.FrameIds() : options.frames) {
    outputs.push_back(FramePath(folder, frame, options.folder.format));
    if (options.folder.keep_plates)
      outputs.push_back(fs::path(outputs.back()).replace_extension(".plate"));
    outputs.push_back(FramePath(partial, frame, options.folder.format));
    outputs.push_back(fs::path(outputs.back()).replace_extension(".json"));
  }
  return outputs;
}

Result<void> CheckImages(const fs::path& folder, const std::vector<std::string>& names,
                         std::string_view what, Replaced* replaced) {
  constexpr size_t kMostLooks = 20'000;
  for (const std::string& name : names) {
    if (name.empty()) continue;
    const fs::path* output = replaced->FindByName(folder, name);
    if (output == nullptr && names.size() <= kMostLooks) output = replaced->Find(folder / name);
    if (output != nullptr) return Refusal(*output, what, folder / name);
  }
  return {};
}

Result<void> CheckFiles(const std::vector<fs::path>& inputs, const Replaced& replaced) {
  for (const fs::path& input : inputs)
    if (const fs::path* const output = replaced.Find(input))
      return Refusal(*output, "an input file", input);
  return {};
}

}  // namespace

Result<void> CheckReplacesNone(const std::vector<fs::path>& outputs,
                               const std::vector<fs::path>& inputs) {
  const Replaced replaced(outputs);
  return replaced.empty() ? Result<void>() : CheckFiles(inputs, replaced);
}

std::vector<fs::path> FilesOfLightField(const LightField& light_field) {
  if (HoldsPackedStore(light_field)) return {light_field.folder};
  std::vector<fs::path> files;
  for (const std::vector<std::string>* names : {&light_field.image_names, &light_field.mask_names})
    for (const std::string& name : *names)
      if (!name.empty()) files.push_back(light_field.folder / name);
  return files;
}

Result<void> CheckOutputs(const Package& package, const RenderOptions& options) {
  Replaced replaced(OutputsOf(package, options));
  if (replaced.empty()) return {};
  LF_RETURN_IF_ERROR(CheckFiles(options.folder.inputs, replaced));
  const LightField& light_field = package.light_field;
  LF_RETURN_IF_ERROR(
      CheckImages(light_field.folder, light_field.image_names, "an LF image", &replaced));
  return CheckImages(light_field.folder, light_field.mask_names, "a mask of an LF image",
                     &replaced);
}

}  // namespace lf
