// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/setup_inputs.h"

#include <gtest/gtest.h>

#include "lf/render/settings/test_settings.h"

namespace lf {
namespace {

RunInputs InputsOf(const FilmSettings& film) {
  RunChoices choices;
  choices.film = film;
  RunInputs inputs = InputsOfRays(LightFieldIdentity(), RadianceEncoding(), choices);
  const RunInputs picture = InputsOfPicture(choices);
  inputs.insert(inputs.end(), picture.begin(), picture.end());
  return inputs;
}

// A render that is resumed, and plates that are added, must have been made with the same settings.
TEST(SetupInputs, TellEachSettingThatChangesFrames) {
  FilmSettings usual;
  usual.mode = RenderMode::kHybrid;  // rebinned rays have inputs
  for (const Setting& setting : SettingTable()) {
    FilmSettings changed = usual;
    const std::string text = setting.key == "mode" ? "rebin" : testing::AnotherOf(setting);
    ASSERT_TRUE(setting.set(text, &changed)) << setting.key;
    // The rule that a frame must meet only measures it.
    EXPECT_EQ(FirstDifference(InputsOf(usual), InputsOf(changed)).has_value(),
              setting.key != "require")
        << setting.key;
  }
}

}  // namespace
}  // namespace lf
