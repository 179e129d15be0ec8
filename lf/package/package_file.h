// The file of a package: SQLite (doc/formats/package.md).
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/package/package.h"

namespace lf {

// The pixels of one LF image that one frame may take rays from.
struct FrameRect {
  FrameId frame;
  PixelRect rect;

  friend bool operator==(const FrameRect&, const FrameRect&) = default;
};

// By its extension, .lfp: that programs tell it from a LIGHTFIELD.
bool IsPackageName(const std::filesystem::path& path);

// Those of an LF image, by ascending frames; may be asked once for each.
using FrameRects = std::function<std::vector<FrameRect>(LfImageId)>;

struct PackageNotes {
  std::string version;      // of the program
  std::string light_field;  // LIGHTFIELD, as it was given
};

// kOutput; nothing is left behind then.
Result<void> WritePackage(const std::filesystem::path& path, const Package& package,
                          const FrameRects& rects, const PackageNotes& notes);

struct ReadPackageOptions {
  // Off where damage is made on purpose: every byte is checked otherwise.
  bool check_seal = true;
};

// The package's name is that of the file. Its light_field.folder is where the LF images were; if
// that is gone, the same place seen from the file, so that a light field and its packages may move
// together.
// kInput: it cannot be read, is damaged, or of another version.
Result<Package> ReadPackage(const std::filesystem::path& path,
                            const ReadPackageOptions& options = {});

// The rectangles of the LF image at a place, which ReadPackage() leaves in the file. kInput.
Result<std::vector<FrameRect>> ReadFrameRects(const std::filesystem::path& path, uint32_t place);

}  // namespace lf
