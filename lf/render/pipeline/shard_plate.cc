// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/shard_plate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

namespace lf {
namespace fs = std::filesystem;
namespace {

const char* GapWords(const ShardPlate& plate) {
  return plate.has_gaps ? "the gaps of its lens" : "no gaps of a lens";
}

}  // namespace

RunInputs LightFieldOf(const ShardPlate& plate) {
  RunInputs inputs;
  for (const auto& entry : plate.inputs)
    if (entry.first.starts_with("light_field.")) inputs.push_back(entry);
  return inputs;
}

Result<std::vector<fs::path>> PlateFilesOf(const std::vector<fs::path>& given) {
  std::vector<fs::path> files;
  for (const fs::path& path : given) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
      files.push_back(path);
      continue;
    }
    const size_t before = files.size();
    for (auto entry = fs::recursive_directory_iterator(path, error);
         !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
      if (entry->path().extension() == ".plate" &&
          !entry->path().filename().string().starts_with('.'))
        files.push_back(entry->path());
    if (error)
      return InputError(fmt::format(
          "{}: cannot be searched for plates ({}): make the folder and the folders in it readable",
          path.string(), error.message()));
    if (files.size() == before)
      return InputError(
          fmt::format("{}: contains no plates: expected files that end in .plate, written by "
                      "{{lfrenderer shard}} or {{keep_plates}}",
                      path.string()));
  }
  std::sort(files.begin(), files.end());
  for (size_t i = 1; i < files.size(); ++i)
    if (files[i] == files[i - 1])
      return UsageError(fmt::format("{}: is given twice: give each plate once", files[i].string()));
  return files;
}

Error WithPlateRemedy(const Error& error) {
  return {error.kind, error.message + "; copy the plate again, or render it again"};
}

Result<PlateReader> OpenPlate(const fs::path& path) {
  Result<PlateReader> reader = PlateReader::Open(path);
  if (!reader) return WithPlateRemedy(reader.error());
  return reader;
}

Result<ShardPlate> LookAtPlate(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const PlateReader reader, OpenPlate(path));
  ShardPlate plate;
  plate.path = path;
  plate.width_px = reader.width();
  plate.height_px = reader.height();
  plate.kind = reader.kind();
  plate.has_gaps = reader.has_gaps();
  LF_ASSIGN_OR_RETURN(
      plate.notes, PlateNotesOf(reader.entries(), reader.width(), reader.height(), path.string()));
  LF_ASSIGN_OR_RETURN(plate.shard, ShardIn(reader.entries(), path.string()));
  plate.inputs = SharedEntries(reader.entries());
  return plate;
}

Result<void> CheckShards(FrameId frame, std::vector<ShardPlate>* plates) {
  std::sort(plates->begin(), plates->end(), [](const ShardPlate& a, const ShardPlate& b) {
    return a.shard.number < b.shard.number;
  });
  const ShardPlate& one = plates->front();
  std::set<uint32_t> there;
  for (const ShardPlate& plate : *plates) {
    if (plate.shard.count != one.shard.count)
      return InputError(fmt::format(
          "frame {}: {} is shard {}, but {} is shard {}: give shards with the same K", frame.value,
          one.path.string(), one.shard.Text(), plate.path.string(), plate.shard.Text()));
    if (!there.insert(plate.shard.number).second)
      return InputError(
          fmt::format("frame {}: {} is shard {}, and so is another file: give each shard once",
                      frame.value, plate.path.string(), plate.shard.Text()));
    if (plate.width_px != one.width_px || plate.height_px != one.height_px)
      return InputError(
          fmt::format("frame {}: {} has {} x {} elements, but {} has {} x {}: give plates of "
                      "one render only",
                      frame.value, one.path.string(), one.width_px, one.height_px,
                      plate.path.string(), plate.width_px, plate.height_px));
    if (const auto difference = FirstDifference(plate.inputs, one.inputs))
      return InputError(fmt::format(
          "frame {}: {}: give only shards that were rendered with the same inputs and options",
          frame.value,
          difference->Text(plate.path.string() + " was made with", one.path.string() + " with")));
    if (plate.kind != one.kind || plate.has_gaps != one.has_gaps)
      return InputError(fmt::format(
          "frame {}: {} has {} channels and {}, but {} has {} and {}: render all shards of a "
          "frame with the same program",
          frame.value, one.path.string(), static_cast<int>(one.kind), GapWords(one),
          plate.path.string(), static_cast<int>(plate.kind), GapWords(plate)));
  }
  std::vector<uint32_t> missing;
  for (uint32_t k = 1; k <= one.shard.count && missing.size() < 10; ++k)
    if (!there.contains(k)) missing.push_back(k);
  if (!missing.empty())
    return InputError(
        fmt::format("frame {}: {} shards are expected, but {} are given; missing are {}{}: "
                    "give their plates, or render them first",
                    frame.value, one.shard.count, there.size(), fmt::join(missing, ", "),
                    one.shard.count - there.size() > missing.size() ? ", ..." : ""));
  return {};
}

}  // namespace lf
