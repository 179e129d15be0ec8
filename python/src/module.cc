// SPDX-License-Identifier: Apache-2.0
// The private extension of the package lfrendertools: lfrendertools._core. Its users call the typed
// functions of the package, which check and explain their arguments.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "python/src/analysis.h"
#include "python/src/cameras.h"
#include "python/src/captures.h"
#include "python/src/comparisons.h"
#include "python/src/depth_maps.h"
#include "python/src/errors.h"
#include "python/src/film.h"
#include "python/src/frames.h"
#include "python/src/gil.h"
#include "python/src/lens_statistics.h"
#include "python/src/light_field.h"
#include "python/src/messages.h"
#include "python/src/setting_words.h"

#include "lf/core/version.h"

PYBIND11_MODULE(_core, module) {
  lf::python::WatchForEndOfPython();
  lf::python::TranslateFailures();
  lf::python::SendMessagesToPython();
  lf::python::AddLightField(module);
  lf::python::AddCameras(module);
  lf::python::AddFrames(module);
  lf::python::AddSettings(module);
  lf::python::AddFilm(module);
  lf::python::AddAnalysis(module);
  lf::python::AddDepthMaps(module);
  lf::python::AddLensStatistics(module);
  lf::python::AddCaptures(module);
  lf::python::AddComparisons(module);
  module.attr("version") = lf::Version();
}
