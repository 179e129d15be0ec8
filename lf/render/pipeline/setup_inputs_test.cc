// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/setup_inputs.h"

#include <gtest/gtest.h>

#include <set>

#include "lf/render/settings/test_settings.h"

namespace lf {
namespace {

RunInputs InputsOf(const FilmSettings& film) {
  RunChoices choices;
  choices.film = film;
  RunInputs inputs = InputsOfRays(LightFieldIdentity(), RadianceEncoding(), choices);
  for (const RunInputs& more :
       {InputsOfRebinning(film, film.rebin.max_cells, "film"), InputsOfPicture(choices)})
    inputs.insert(inputs.end(), more.begin(), more.end());
  return inputs;
}

// A render that is resumed, and plates that are added, must have been made with the same settings.
TEST(SetupInputs, TellEachSettingThatChangesFrames) {
  const std::set<std::string_view> others = {
      "require",  // only measures frames
      "guard"};   // an input if the light field is densified (InputsOfRays() of a setup)
  FilmSettings usual;
  usual.mode = RenderMode::kHybrid;  // rebinned rays have inputs
  for (const Setting& setting : SettingTable()) {
    FilmSettings changed = usual;
    const std::string text = setting.key == "mode" ? "rebin" : testing::AnotherOf(setting);
    ASSERT_TRUE(setting.set(text, &changed)) << setting.key;
    // The seed of rebinned rays is that of the film (Resolved()).
    changed.rebin.rebin.seed = changed.rebin.query.seed = changed.seed;
    EXPECT_EQ(FirstDifference(InputsOf(usual), InputsOf(changed)).has_value(),
              !others.contains(setting.key))
        << setting.key;
  }
}

}  // namespace
}  // namespace lf
