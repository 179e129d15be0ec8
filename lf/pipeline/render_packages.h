// Package files in, one image sequence out.
#pragma once

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

// A package file and those of its frames that are wanted.
struct PackagePart {
  std::filesystem::path path;
  std::vector<FrameId> frames;
  bool is_whole = true;    // all of its frames
  uint64_t ray_count = 0;  // of these frames, about
  size_t film_count = 1;   // packages of the film
};

// Opens every package and checks that they are of one film. Those without a frame that is wanted
// are left out; nothing wanted: all frames. A film of which packages are missing is warned about.
// kUsage: packages that have frames in common, frames that none of them has; kInput: packages of
// different films or light fields. Else as OpenPackage().
Result<std::vector<PackagePart>> LookAtPackages(const std::vector<std::filesystem::path>& paths,
                                                const std::optional<LightFieldPlace>& place,
                                                const std::vector<FrameId>& wanted);

// contact_sheet.png; of one package alone contact_sheet-NAME.png.
std::string ContactSheetName(const std::vector<std::filesystem::path>& paths);

// One after the other as by Render(), each with its own report and state; then the contact sheet
// (ContactSheetName()) and the video of their frames.
// Reads every package before the first is rendered. Of options.frames each takes its own. The
// report is that of all. Errors as Render() and LookAtPackages().
Result<RenderReport> RenderPackages(const std::vector<std::filesystem::path>& paths,
                                    const std::optional<LightFieldPlace>& place,
                                    const RenderOptions& options, ThreadPool& pool,
                                    const std::function<void(const RenderProgress&)>& progress);

}  // namespace lf
