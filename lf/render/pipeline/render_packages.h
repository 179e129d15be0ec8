// SPDX-License-Identifier: Apache-2.0
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

// Location and identity of the packages' light field, whose files may have moved since the packages
// were made.
struct LightFieldPlace {
  std::string name;  // name of the light field in messages
  LightFieldIdentity identity;
  // Identity of the light field that a packed store was made from; unset if `folder` is no packed
  // store.
  std::optional<LightFieldIdentity> whole;
  std::filesystem::path folder;  // folder of the image files, or the packed store
};

// Returns the LightFieldPlace of an opened light field.
//   name  name of the light field in messages
// kInput: a damaged packed store. kUsage: the light field is reduced, and packages state whole LF
// images.
Result<LightFieldPlace> PlaceOf(const std::string& name, const LightField& light_field);

// Reads a package, and checks it and a few image files of its light field. If the light field is a
// packed store, checks instead that the store has all LF images and pixels that the package needs.
//   place  where the light field is now; unset: where ReadPackage() finds it
// kInput: the errors of ReadPackage(); the package was made from another light field than `place`;
// none of the checked files exists with its recorded size; the packed store lacks LF images or
// pixels that the package needs.
Result<Package> OpenPackage(const std::filesystem::path& path,
                            const std::optional<LightFieldPlace>& place = {});

// A package file, and those of its frames that are rendered.
struct PackagePart {
  std::filesystem::path path;
  std::vector<FrameId> frames;
  bool is_whole = true;    // true if these are all frames of the package
  uint64_t ray_count = 0;  // approximate number of rays of these frames
  size_t image_count = 0;  // number of LF images that the frames of the package need
  // Size and modification time of the file when it was checked. A file whose size and time are the
  // same later is taken to be unchanged.
  uint64_t file_bytes = 0;
  std::filesystem::file_time_type file_time = {};
};

// The packages that are rendered into one folder.
struct PackagedFilm {
  std::vector<std::filesystem::path> paths;
  std::optional<LightFieldPlace> place;
  std::vector<PackagePart> parts;  // one part for each path
  size_t film_count = 1;           // number of packages of the film; `paths` may lack some
  Package first;                   // package of paths.front()
};

// Opens every package with OpenPackage(), and checks that all packages are of the same film.
// kUsage: two packages have a frame in common, or have the same name. kInput: packages are of
// different films or light fields. Other errors are those of OpenPackage().
Result<PackagedFilm> OpenPackages(std::vector<std::filesystem::path> paths,
                                  std::optional<LightFieldPlace> place);

// Returns the parts that have frames of `wanted`, without their other frames; all parts if `wanted`
// is empty. Warns if two or more packages are given, but not all packages of the film.
// kUsage: a wanted frame is in none of the packages.
Result<std::vector<PackagePart>> PartsWith(const PackagedFilm& film,
                                           const std::vector<FrameId>& wanted);

// Returns "contact_sheet.png"; if there is a single package NAME.lfp, "contact_sheet-NAME.png".
std::string ContactSheetName(const std::vector<std::filesystem::path>& paths);

// Renders one package after the other with Render(), each with its own report and state. Each
// package renders those of options.frames that it contains (all its frames if options.frames is
// empty). Then writes the contact sheet (ContactSheetName()) and the video of the frames of all
// packages. Returns one report about all packages. If a package file was changed since the film was
// opened, it is checked again.
// kInput: all packages of the film are given, and every rendered frame is black. Other errors are
// those of Render() and PartsWith().
Result<RenderReport> RenderPackages(PackagedFilm film, const RenderOptions& options,
                                    ThreadPool& pool,
                                    const std::function<void(const RenderProgress&)>& progress);

}  // namespace lf
