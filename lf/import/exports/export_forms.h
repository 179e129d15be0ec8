// SPDX-License-Identifier: Apache-2.0
// The table of other programs' exports: how each form is recognised, and either its reader or the
// advice how to make a form that is read. Every reader of this folder has a row in it.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"
#include "lf/import/exports/export_cameras.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// A row of the table.
struct ExportForm {
  std::string_view name = {};  // completes "is ...": "a reconstruction of OpenSfM or OpenDroneMap"
  // The form in the list of forms that are read: "reconstruction.json (OpenSfM, OpenDroneMap)".
  // Empty for forms that are not read.
  std::string_view listed = {};
  // Patterns of paths in a folder. In names with * or ?, which stand for any characters, letters
  // fit in upper and lower case. The files of the first pattern that fits are taken. A file that is
  // given itself fits if its name fits the last part of a pattern.
  std::vector<std::string_view> places = {};
  // Further patterns of the names of files that are given themselves.
  std::vector<std::string_view> names = {};
  // Texts that all occur in the first MiB of the file.
  std::vector<std::string_view> words = {};
  // A file that must exist, named from the folder of the file that fits; empty: none.
  std::string_view beside = {};
  // True: the files that fit are parts of one light field, of which any leads to the others.
  // False: each is a light field of its own.
  bool has_parts = false;
  // True: the form does not state the focal length, so that ExportOptions::focal_px is needed.
  bool takes_focal = false;
  // Reads the light field to which a file belongs. nullptr: the form is not read.
  Result<LightField> (*read)(const std::filesystem::path& file,
                             const ExportOptions& options) = nullptr;
  // For forms that are not read: true if their program has the poses, so that they need not be
  // reconstructed.
  bool has_poses = false;
  // The way to a form that is read, as the end of a message: "export ... by the menu ...". Empty
  // for forms that are read.
  std::string_view advice = {};
  // Returns the command that follows the advice, which then ends with "for instance by". nullptr:
  // there is none.
  std::string (*command)(const std::filesystem::path& file) = nullptr;
};

// Files of one form.
struct FoundExport {
  const ExportForm* form = nullptr;
  std::vector<std::filesystem::path> files;  // sorted; only the first if form->has_parts
};

// Returns all rows. Forms that are read come first, and are tried in this order.
std::span<const ExportForm> ExportForms();

// Returns the form of a file that is given itself; nullptr if no row fits.
const ExportForm* ExportFormOf(const std::filesystem::path& file);

// Returns what a folder holds, in the order of the table. Its files may be damaged. At most 2^17
// names of a folder are compared with patterns.
//   reads  true: only forms that are read; false: only forms that are not
std::vector<FoundExport> ExportsIn(const std::filesystem::path& folder, bool reads);

// Returns the forms that are read, as messages list them: "A, B, C".
std::string ListOfExportForms();

// Reads the export that a file is, or belongs to. nullopt if no row fits. kInput: an error of
// the reader; for a form that is not read, the advice.
std::optional<Result<LightField>> OpenExportFile(const std::filesystem::path& file,
                                                 const ExportOptions& options);

// Reads the first form in a folder that is read; nullopt if there is none. Logs which file is taken
// if the folder holds several forms. kInput: several files of this form; an error of the reader.
std::optional<Result<LightField>> OpenExportIn(const std::filesystem::path& folder,
                                               const ExportOptions& options);

// Advice on what a folder holds that is not read.
struct ExportAdvice {
  // The end of a message, "; FILE is a project of Metashape, which ...: open it ...". At most three
  // forms are named. "" if there is none.
  std::string text;
  bool has_poses = false;  // true if one of these forms has poses (ExportForm::has_poses)
  // ", for instance by: COMMAND" if only one form is there, and if it has a command; "" otherwise.
  // Must end the message.
  std::string command;
};
ExportAdvice AdviceOnExportsIn(const std::filesystem::path& folder);

}  // namespace lf
