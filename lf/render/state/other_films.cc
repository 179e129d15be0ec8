// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/other_films.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <system_error>
#include <utility>

#include "lf/render/state/report.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

bool HasFilm(const RunInputs& inputs) {
  return std::any_of(inputs.begin(), inputs.end(),
                     [](const auto& input) { return input.first == kFilmOfPackage; });
}

std::optional<InputDifference> FilmDifference(RunInputs recorded, RunInputs wanted) {
  if (HasFilm(recorded) != HasFilm(wanted))
    for (RunInputs* inputs : {&recorded, &wanted})
      std::erase_if(*inputs, [](const auto& input) { return input.first == kFilmOfPackage; });
  return FirstDifference(recorded, wanted);
}

}  // namespace

std::vector<fs::path> ReportsIn(const fs::path& folder) {
  std::vector<fs::path> reports;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (entry->path().extension() == ".json" &&
        (name == "report.json" || name.starts_with("report-")))
      reports.push_back(entry->path());
  }
  std::sort(reports.begin(), reports.end());
  return reports;
}

Result<FramesThatStay> FindFramesThatStay(const fs::path& report, const FilmInFolder& film) {
  LF_ASSIGN_OR_RETURN(RenderReport earlier, ReadReport(report));
  const auto all = FilmDifference(earlier.inputs, film.inputs);
  std::vector<FrameReport> same;
  std::string first;
  size_t count = 0;
  for (FrameReport& frame : earlier.frames) {
    std::error_code ignored;
    if (std::binary_search(film.frames.begin(), film.frames.end(), frame.frame) ||
        !fs::exists(film.file_of(frame.frame), ignored))
      continue;
    std::string difference;
    if (all) {
      difference = all->Text("was rendered with", "this call has");
    } else if (!film.path.frames().Has(frame.frame)) {
      difference =
          fmt::format("belongs to frame {}, but the camera path has the frames {} to {}",
                      frame.frame.value, film.path.frames().first, film.path.frames().last());
    } else if (const auto camera =
                   FirstDifference(frame.camera, InputsOfFrame(film.path, frame.frame))) {
      difference = camera->Text("was rendered with", "this call has");
    } else {
      same.push_back(std::move(frame));
      continue;
    }
    if (++count == 1)
      first = film.file_of(frame.frame).filename().string() + ", " + std::move(difference);
  }
  FramesThatStay staying;
  if (count > 0)
    staying.others = fmt::format(
        "{} of another film; the first, {}",
        count == 1 ? "a file is a frame" : fmt::format("{} files are frames", count), first);
  if (same.empty()) return staying;
  earlier.frames = std::move(same);
  staying.same = std::move(earlier);
  return staying;
}

void AddFrames(const RenderReport& from, RenderReport* to) {
  to->frames.insert(to->frames.end(), from.frames.begin(), from.frames.end());
  std::sort(to->frames.begin(), to->frames.end(),
            [](const FrameReport& a, const FrameReport& b) { return a.frame < b.frame; });
  to->AddSkipped(from.skipped);
}

}  // namespace lf
