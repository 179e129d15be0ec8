// Renders package files into one image sequence.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/state/report.h"

namespace lf {

// The light field of packages, which may have moved since they were made.
struct LightFieldPlace {
  std::string name;  // for messages
  LightFieldIdentity identity;
  std::optional<LightFieldIdentity> whole;  // of a packed store: light field that it was made from
  std::filesystem::path folder;             // of its image files, or the packed store
};

// Returns the place of an opened light field.
//   name  for messages
// kInput: a damaged packed store.
Result<LightFieldPlace> PlaceOf(const std::string& name, const LightField& light_field);

// Reads a package and checks it and a few of its light field's image files. The LF images of a
// package may also come from a packed store of its light field.
// kInput: as ReadPackage(); the package is of another light field than `place`; none of the checked
// files is there with the size that it had; the packed store lacks LF images, or pixels of them,
// that the package needs.
Result<Package> OpenPackage(const std::filesystem::path& path,
                            const std::optional<LightFieldPlace>& place = {});

// A package file, and the frames of it that are rendered.
struct PackagePart {
  std::filesystem::path path;
  std::vector<FrameId> frames;
  bool is_whole = true;    // true if these are all frames of the package
  uint64_t ray_count = 0;  // of these frames, approximately
  // Size and time of the file when it was checked. If they are the same later, so is the file.
  uint64_t file_bytes = 0;
  std::filesystem::file_time_type file_time = {};
};

// Packages that are rendered into one folder.
struct PackagedFilm {
  std::vector<std::filesystem::path> paths;
  std::optional<LightFieldPlace> place;
  std::vector<PackagePart> parts;  // one for each path
  size_t film_count = 1;           // packages of the film, some of which may not be given
  Package first;                   // of paths.front()
};

// Opens every package with OpenPackage(), and checks that all are of one film.
// kUsage: packages have frames or a name in common. kInput: packages are of different films or
// light fields. Other errors are those of OpenPackage().
Result<PackagedFilm> OpenPackages(std::vector<std::filesystem::path> paths,
                                  std::optional<LightFieldPlace> place);

// Returns the parts that have frames of `wanted`; all parts if `wanted` is empty. Warns if packages
// of the film are missing.
// kUsage: none of the packages has a wanted frame.
Result<std::vector<PackagePart>> PartsWith(const PackagedFilm& film,
                                           const std::vector<FrameId>& wanted);

// Returns "contact_sheet.png", or "contact_sheet-NAME.png" for a single package.
std::string ContactSheetName(const std::vector<std::filesystem::path>& paths);

// Renders one package after the other with Render(), each with its own report and state. Then
// writes the contact sheet (ContactSheetName()) and the video of their frames. Each package renders
// those of options.frames that it has. Returns the report of all packages together. A package file
// that was changed since the film was opened is opened again, with all checks.
// kInput: every frame of a whole film is black. Other errors are those of Render() and PartsWith().
Result<RenderReport> RenderPackages(PackagedFilm film, const RenderOptions& options,
                                    ThreadPool& pool,
                                    const std::function<void(const RenderProgress&)>& progress);

}  // namespace lf
