// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/export_forms.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <system_error>

#include "lf/core/log.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kLookedAtBytes = size_t{1} << 20;
constexpr size_t kMostEntries = size_t{1} << 17;
constexpr size_t kMostPartsLookedAt = 16;

bool Fits(std::string_view pattern, const std::string& name) {
  return fnmatch(std::string(pattern).c_str(), name.c_str(), FNM_PERIOD | FNM_CASEFOLD) == 0;
}

bool IsPattern(std::string_view part) { return part.find_first_of("*?") != part.npos; }

std::string_view LastPart(std::string_view pattern) {
  return pattern.substr(pattern.rfind('/') + 1);  // npos + 1 is 0
}

std::string HeadOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(kLookedAtBytes, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(stream.gcount()));
  return head;
}

// Returns true if the file holds the words of the form, and if what must lie beside it is there.
bool FitsInside(const ExportForm& form, const fs::path& file) {
  std::error_code error;
  if (!form.beside.empty() && !fs::exists(FolderAbove(file) / form.beside, error)) return false;
  if (form.words.empty()) return true;
  if (!fs::is_regular_file(file, error)) return false;  // reading a pipe might never end
  const std::string head = HeadOf(file);
  return std::all_of(form.words.begin(), form.words.end(),
                     [&](std::string_view word) { return head.find(word) != std::string::npos; });
}

// Finds files by patterns. Each folder is listed once.
class FilesByPattern {
 public:
  explicit FilesByPattern(const fs::path& folder) : folder_(folder) {}

  // Returns the files that fit, sorted.
  std::vector<fs::path> Find(std::string_view pattern) {
    std::vector<fs::path> found = {folder_};
    while (!pattern.empty()) {
      const std::string_view part = pattern.substr(0, pattern.find('/'));
      pattern.remove_prefix(std::min(pattern.size(), part.size() + 1));
      std::vector<fs::path> next;
      for (const fs::path& folder : found) Add(folder, part, !pattern.empty(), &next);
      found = std::move(next);
    }
    return found;
  }

 private:
  struct Names {
    std::vector<std::string> files, folders;
  };

  // Adds the files of a folder that fit a part of a pattern, or the folders in it.
  void Add(const fs::path& folder, std::string_view part, bool is_folder,
           std::vector<fs::path>* found) {
    if (!IsPattern(part)) {
      const fs::path path = folder / part;
      std::error_code error;
      if (is_folder ? fs::is_directory(path, error) : fs::is_regular_file(path, error))
        found->push_back(path);
      return;
    }
    const Names& names = NamesIn(folder);
    for (const std::string& name : is_folder ? names.folders : names.files)
      if (Fits(part, name)) found->push_back(folder / name);
  }

  const Names& NamesIn(const fs::path& folder) {
    const auto [entry, is_new] = names_.try_emplace(folder.string());
    Names& names = entry->second;
    if (!is_new) return names;
    std::error_code error, ignored;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      if (names.files.size() + names.folders.size() == kMostEntries) break;
      std::vector<std::string>& kind = it->is_directory(ignored) ? names.folders : names.files;
      kind.push_back(it->path().filename().string());
    }
    std::sort(names.files.begin(), names.files.end());
    std::sort(names.folders.begin(), names.folders.end());
    return names;
  }

  fs::path folder_;
  std::map<std::string, Names> names_;
};

// Returns the files of a form: those of the first pattern that fits.
std::vector<fs::path> FilesOf(const ExportForm& form, FilesByPattern* files) {
  for (const std::string_view pattern : form.places) {
    std::vector<fs::path> found = files->Find(pattern);
    // Only the first of many parts are read, because a data set may have one for each of its
    // images.
    if (form.has_parts && found.size() > kMostPartsLookedAt) found.resize(kMostPartsLookedAt);
    std::erase_if(found, [&](const fs::path& file) { return !FitsInside(form, file); });
    if (form.has_parts && found.size() > 1) found.resize(1);
    if (!found.empty()) return found;
  }
  return {};
}

// Returns the command of a form as the end of its advice; "" if it has none.
std::string CommandOf(const ExportForm& form, const fs::path& file) {
  return form.command == nullptr ? "" : ", for instance by: " + form.command(file);
}

}  // namespace

const ExportForm* ExportFormOf(const fs::path& file) {
  const std::string name = file.filename().string();
  for (const ExportForm& form : ExportForms()) {
    const auto fits = [&](std::string_view pattern) { return Fits(LastPart(pattern), name); };
    if ((std::any_of(form.places.begin(), form.places.end(), fits) ||
         std::any_of(form.names.begin(), form.names.end(), fits)) &&
        FitsInside(form, file))
      return &form;
  }
  return nullptr;
}

std::vector<FoundExport> ExportsIn(const fs::path& folder, bool reads) {
  FilesByPattern files(folder);
  std::vector<FoundExport> found;
  for (const ExportForm& form : ExportForms()) {
    if ((form.read != nullptr) != reads) continue;
    FoundExport one{&form, FilesOf(form, &files)};
    if (!one.files.empty()) found.push_back(std::move(one));
  }
  return found;
}

std::string ListOfExportForms() {
  std::vector<std::string_view> listed;
  for (const ExportForm& form : ExportForms())
    if (form.read != nullptr) listed.push_back(form.listed);
  return fmt::format("{}", fmt::join(listed, ", "));
}

std::optional<Result<LightField>> OpenExportFile(const fs::path& file,
                                                 const ExportOptions& options) {
  const ExportForm* const form = ExportFormOf(file);
  if (form == nullptr) return std::nullopt;
  if (form->read == nullptr)
    return InputError(fmt::format("{}: is not a light field, but {}: {}{}", file.string(),
                                  form->name, form->advice, CommandOf(*form, file)));
  LogDebug("{}: opened as {}", file.string(), form->name);
  return form->read(file, options);
}

std::optional<Result<LightField>> OpenExportIn(const fs::path& folder,
                                               const ExportOptions& options) {
  const std::vector<FoundExport> found = ExportsIn(folder, /*reads=*/true);
  if (found.empty()) return std::nullopt;
  const std::vector<fs::path>& files = found[0].files;
  if (files.size() > 1)
    return InputError(
        fmt::format("{}: holds several calibrations, such as {} and {}: give the "
                    "path of one of these files",
                    folder.string(), files[0].lexically_relative(folder).string(),
                    files[1].lexically_relative(folder).string()));
  if (found.size() > 1)
    LogInfo("{} is read, {}; {} is {}, too: give its path to read it instead", files[0].string(),
            found[0].form->name, found[1].files[0].string(), found[1].form->name);
  LogDebug("{}: opened as {}", files[0].string(), found[0].form->name);
  return found[0].form->read(files[0], options);
}

ExportAdvice AdviceOnExportsIn(const fs::path& folder) {
  constexpr size_t kMostNamed = 3;
  ExportAdvice advice;
  const std::vector<FoundExport> found = ExportsIn(folder, /*reads=*/false);
  for (size_t i = 0; i < std::min(found.size(), kMostNamed); ++i) {
    advice.text += fmt::format("; {} is {}: {}", found[i].files[0].string(), found[i].form->name,
                               found[i].form->advice);
    advice.has_poses = advice.has_poses || found[i].form->has_poses;
  }
  if (found.size() == 1) advice.command = CommandOf(*found[0].form, found[0].files[0]);
  return advice;
}

}  // namespace lf
