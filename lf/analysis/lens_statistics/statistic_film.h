// SPDX-License-Identifier: Apache-2.0
// Renders films by a statistic over the lens (lens_statistics.h), as render/pipeline/render.h
// renders those of rays: into a folder, with its files, reports and interruptions.
//
//   StatisticFilm film(options);
//   RenderOptions render = RenderOptionsOf(options, light_field.encoding);
//   render.source = &film;
//   Render(package, render, pool, progress);
//
// Each frame has the bits of MakeStatisticFrame().
#pragma once

#include <memory>
#include <span>

#include "lf/analysis/lens_statistics/lens_statistics.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/radiance.h"
#include "lf/render/pipeline/frame_source.h"
#include "lf/render/pipeline/render.h"

namespace lf {

// Returns the settings of the film and of the work that the options of a statistic mean for light
// fields with this encoding.
RenderOptions RenderOptionsOf(const LensStatisticOptions& options,
                              const RadianceEncoding& encoding);

class StatisticFilm final : public FilmSource {
 public:
  explicit StatisticFilm(const LensStatisticOptions& options);
  ~StatisticFilm() override;

  // kUsage: options out of range, a mosaic filter, a lens with a transmission, a path with a
  // shutter; or options that a statistic does not have: it needs all values of an element, and has
  // neither sums that could be added or continued nor the noise of a mean.
  Result<void> Check(const Package& package, const RenderOptions& options) const override;
  RunInputs Inputs() const override { return InputsOfStatistic(options_); }
  ImageMetadata Metadata() const override { return StatisticMetadata(options_); }
  // kOutput: the memory is too small for the values of one row of elements; the message names the
  // least that suffices.
  Result<PassPlan> Plan(FilmSetup* setup, std::span<const FrameId> frames) override;
  std::unique_ptr<FrameSource> Open(const FilmSetup& setup,
                                    std::span<const FrameId> frames) const override;

 private:
  const LensStatisticOptions options_;
  std::unique_ptr<struct StatisticPlan> plan_;  // set by Plan()
};

}  // namespace lf
