// Package files in, one image sequence out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/capture/light_field_identity.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/package/package.h"
#include "lf/pipeline/render.h"
#include "lf/record/report.h"

namespace lf {

// A light field that packages are said to be of, which may have moved since they were made.
struct LightFieldPlace {
  std::string name;  // for messages
  LightFieldIdentity identity;
  std::optional<LightFieldIdentity> whole;  // of a packed store: that its LF images are from
  std::filesystem::path folder;             // of its image files, or the packed store
};

//   name  for messages
// kInput: a damaged packed store.
Result<LightFieldPlace> PlaceOf(const std::string& name, const LightField& light_field);

// Reads and checks a package and its light field's image files, a few of which are looked at.
// Packages of a light field may take its LF images from a packed store of it, too.
// kInput: as ReadPackage(); it is of another light field than `place`; none of the files is there,
// or none is the one that it was; a packed store without some of the package's LF images, or of
// other pixels of them than it needs.
Result<Package> OpenPackage(const std::filesystem::path& path,
                            const std::optional<LightFieldPlace>& place = {});

// A package file and frames of it.
struct PackagePart {
  std::filesystem::path path;
  std::vector<FrameId> frames;
  bool is_whole = true;    // all of its frames
  uint64_t ray_count = 0;  // of these frames, about
  // Size and time of the file when it was checked: as long as they are the same, it is.
  uint64_t file_bytes = 0;
  std::filesystem::file_time_type file_time = {};
};

// Packages that are rendered into one folder.
struct PackagedFilm {
  std::vector<std::filesystem::path> paths;
  std::optional<LightFieldPlace> place;
  std::vector<PackagePart> parts;  // as paths
  size_t film_count = 1;           // packages of the film, more of which there may be elsewhere
  Package first;                   // of paths.front()
};

// Opens every package once, as OpenPackage(), and checks that they are of one film.
// kUsage: packages that have frames or a name in common; kInput: packages of different films or
// light fields. Else as OpenPackage().
Result<PackagedFilm> OpenPackages(std::vector<std::filesystem::path> paths,
                                  std::optional<LightFieldPlace> place);

// Returns the parts with frames that are wanted; nothing wanted: all frames. Warns about a film of
// which packages are missing.
// kUsage: frames that none of the packages has.
Result<std::vector<PackagePart>> PartsWith(const PackagedFilm& film,
                                           const std::vector<FrameId>& wanted);

// contact_sheet.png; of one package alone contact_sheet-NAME.png.
std::string ContactSheetName(const std::vector<std::filesystem::path>& paths);

// Renders one package after the other as by Render(), each with its own report and state; then the
// contact sheet (ContactSheetName()) and the video of their frames.
// Each package takes its own of options.frames. The report is that of all. A package that was
// changed since the film was opened is opened again, with all checks. kInput: every frame of a
// whole film is black. Else errors as Render() and PartsWith().
Result<RenderReport> RenderPackages(PackagedFilm film, const RenderOptions& options,
                                    ThreadPool& pool,
                                    const std::function<void(const RenderProgress&)>& progress);

}  // namespace lf
