// SPDX-License-Identifier: Apache-2.0
// Opens light fields whose cameras stand in a grid that the names of the images, or one picture or
// array, state without their geometry: ReadStanfordFolder() with the options of OpenLightField().
// Internal to this folder.
#pragma once

#include <filesystem>
#include <optional>

#include "lf/core/result.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Opens a folder of images with Stanford names, or of OpenOptions::grid.
//   asked_for  LIGHTFIELD as the user typed it
Result<LightField> OpenStanford(const std::filesystem::path& folder, const OpenOptions& options,
                                const std::filesystem::path& asked_for);

// Opens a picture that holds the views of a grid of cameras. kInput also if neither its name nor
// the options state their columns and rows.
//   asked_for  the picture, or its folder, as the user typed it
Result<LightField> OpenPicture(const std::filesystem::path& path, const OpenOptions& options,
                               const std::filesystem::path& asked_for);

// Opens an array of views, which states its rows and columns. An HDF5 file may also state the
// geometry (hci_archive.h), which the options override.
//   asked_for  the array, or its folder, as the user typed it
Result<LightField> OpenArray(const std::filesystem::path& path, const OpenOptions& options,
                             const std::filesystem::path& asked_for);

// Returns the lf.h5 in a folder or, if it holds views, the only HDF5 file there; nullopt otherwise.
std::optional<std::filesystem::path> ArrayIn(const std::filesystem::path& folder);

}  // namespace lf
