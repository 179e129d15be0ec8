// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/display_view.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/film/develop/colour_space.h"

#ifdef LF_HAS_OCIO
#include <OpenColorIO/OpenColorIO.h>
#endif

namespace lf {

#ifdef LF_HAS_OCIO

namespace {

namespace ocio = OCIO_NAMESPACE;

constexpr const char* kInterchange = "aces_interchange";  // role of ACES2065-1
// Names and aliases of linear Rec. 709 in the configurations of ACES, Blender and Nuke.
constexpr const char* kLinearNames[] = {"lin_rec709",
                                        "lin_rec709_scene",
                                        "lin_srgb",
                                        "Linear Rec.709 (sRGB)",
                                        "Utility - Linear - sRGB",
                                        "Utility - Linear - Rec.709",
                                        "Linear Rec.709",
                                        "Linear BT.709"};

// SMPTE ST 2065-1 (ACES2065-1): primaries AP0 and the white of ACES.
Primaries Ap0() { return {{0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, {0.32168, 0.33767}}; }

bool HasSrgb(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return name.find("srgb") != std::string::npos;
}

class OcioView : public DisplayView {
 public:
  OcioView(ocio::ConstCPUProcessorRcPtr processor, const Mat3& source_from_rec709,
           std::string identity, bool is_srgb)
      : processor_(std::move(processor)),
        source_from_rec709_(source_from_rec709),
        identity_(std::move(identity)),
        is_srgb_(is_srgb) {}

  void Apply(Image<float>* rgb) const override {
    Multiply(source_from_rec709_, rgb);
    ocio::PackedImageDesc picture(rgb->pixels().data(), rgb->width(), rgb->height(), 3);
    processor_->apply(picture);
  }
  const std::string& identity() const override { return identity_; }
  bool is_srgb() const override { return is_srgb_; }

 private:
  const ocio::ConstCPUProcessorRcPtr processor_;
  const Mat3 source_from_rec709_;
  const std::string identity_;
  const bool is_srgb_;
};

std::vector<std::string> DisplaysOf(const ocio::Config& config) {
  std::vector<std::string> names;
  for (int i = 0; i < config.getNumDisplays(); ++i) names.emplace_back(config.getDisplay(i));
  return names;
}

std::vector<std::string> ViewsOf(const ocio::Config& config, const std::string& display) {
  std::vector<std::string> names;
  for (int i = 0; i < config.getNumViews(display.c_str()); ++i)
    names.emplace_back(config.getView(display.c_str(), i));
  return names;
}

Result<void> CheckName(const std::string& option, const std::string& name,
                       const std::vector<std::string>& known, const std::string& file) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return {};
  return UsageError(fmt::format("{} {}: {} has none of this name: expected {}", option, name, file,
                                known.empty() ? "a configuration with displays and views"
                                              : fmt::format("{}", fmt::join(known, ", "))));
}

// Returns the name of the colour space that a view is applied to, and the matrix to it.
Result<std::pair<std::string, Mat3>> SourceOf(const ocio::Config& config, const std::string& file) {
  if (config.hasRole(kInterchange))
    return std::pair(std::string(kInterchange),
                     LinearFromLinear(Ap0(), PrimariesOf(ColourSpace::kRec709)));
  for (const char* name : kLinearNames)
    if (config.getColorSpace(name)) return std::pair(std::string(name), Mat3(Mat3::Identity()));
  return UsageError(
      fmt::format("{{view}}: {} does not say what linear light is: add the role {}, or a colour "
                  "space lin_rec709",
                  file, kInterchange));
}

Result<std::shared_ptr<const DisplayView>> OpenView(const std::string& file,
                                                    const std::string& asked_display,
                                                    const std::string& view) {
  const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(file.c_str());
  config->validate();
  const std::string display =
      asked_display.empty() ? config->getDefaultDisplay() : asked_display.c_str();
  LF_RETURN_IF_ERROR(CheckName("{display}", display, DisplaysOf(*config), file));
  LF_RETURN_IF_ERROR(CheckName("{view}", view, ViewsOf(*config, display), file));
  LF_ASSIGN_OR_RETURN(const auto source, SourceOf(*config, file));
  const auto transform = ocio::DisplayViewTransform::Create();
  transform->setSrc(source.first.c_str());
  transform->setDisplay(display.c_str());
  transform->setView(view.c_str());
  const std::string values = config->getDisplayViewColorSpaceName(display.c_str(), view.c_str());
  return std::shared_ptr<const DisplayView>(std::make_shared<OcioView>(
      config->getProcessor(transform)->getDefaultCPUProcessor(), source.second,
      fmt::format("{}, {} ({})", display, view, config->getCacheID()),
      HasSrgb(values) || HasSrgb(display)));
}

}  // namespace

Result<std::shared_ptr<const DisplayView>> DisplayView::Open(const std::string& display,
                                                             const std::string& view) {
  const char* const file = std::getenv("OCIO");
  if (file == nullptr || *file == '\0')
    return UsageError(
        "{view}: the environment variable OCIO is not set: set it to the file config.ocio of the "
        "OpenColorIO configuration that has the view, or leave {view} out");
  try {
    return OpenView(file, display, view);
  } catch (const ocio::Exception& error) {
    return InputError(fmt::format("{}: cannot be used as a configuration of OpenColorIO: {}", file,
                                  error.what()));
  }
}

#else

Result<std::shared_ptr<const DisplayView>> DisplayView::Open(const std::string&,
                                                             const std::string&) {
  return UsageError(
      "{view}: this program was built without OpenColorIO: leave it out, or install "
      "libopencolorio-dev and build again");
}

#endif

}  // namespace lf
