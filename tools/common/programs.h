// SPDX-License-Identifier: Apache-2.0
// The programs, in the order of the data flow, and the commands of lfr that run them.
#pragma once

#include <array>
#include <string_view>

namespace lf {

struct ListedProgram {
  const char* name;
  const char* command;  // `lfr render` runs lfrenderer
  const char* summary;  // one sentence: what the program does
};

// Every program but lfr itself.
inline constexpr std::array kPrograms = {
    ListedProgram{"lfsynth", "synth", "Photographs a synthetic scene as a light field."},
    ListedProgram{"lfimport", "import",
                  "Reports what a light field contains and what looks wrong in it, and converts "
                  "its calibration to a transforms.json."},
    ListedProgram{"lfexample", "example",
                  "Writes a commented, working camera path for a light field."},
    ListedProgram{"lfcammvminfo", "cameras",
                  "Shows the camera of every frame of a path: position, orientation, aperture, "
                  "focus, field of view, depth of field."},
    ListedProgram{
        "lfpath", "path",
        "Converts camera paths between programs, moves and resamples them, or describes one."},
    ListedProgram{"lfpreprocessor", "preprocess",
                  "Selects the part of a light field that a film needs, and divides it into "
                  "packages for many machines."},
    ListedProgram{"lfcompressor", "compress",
                  "Compresses the LF images of a light field, or the part that packages need, into "
                  "a packed store."},
    ListedProgram{"lfdensify", "densify",
                  "Puts virtual LF images between the recorded ones of a sparse light field, so "
                  "that blur is smooth."},
    ListedProgram{"lfrenderer", "render",
                  "Films a densely recorded light field with a thin-lens camera on a path."},
    ListedProgram{
        "lffocus", "focus",
        "Makes focus stacks, depths, sharp and epipolar pictures, views; sees through foliage."},
    ListedProgram{"lfsubmit", "submit",
                  "Renders the packages of a film in many processes or on many machines."},
    ListedProgram{"lfmerge", "merge", "Adds the plates of a divided render and writes its frames."},
    ListedProgram{
        "lfquilt", "quilt",
        "Joins the rendered views of a film: quilts for light field displays, stereo pairs."},
    ListedProgram{"lfcompare", "compare",
                  "Measures how far pictures are from references: PSNR, SSIM and FLIP."},
    ListedProgram{"lfvisualizer", "visualize",
                  "Shows a light field and the part of it that a camera path needs, in the browser "
                  "or as text."},
};

// Returns the summary of a program. The name must be one of kPrograms, which the compiler checks.
consteval const char* SummaryOf(std::string_view name) {
  for (const ListedProgram& program : kPrograms)
    if (program.name == name) return program.summary;
  throw "kPrograms has no such program";
}

}  // namespace lf
