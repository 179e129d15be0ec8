// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string_view>

namespace lf {
namespace {

// Returns the layer of a channel: "" for "R", "beauty." for "beauty.R".
std::string LayerOf(const std::string& channel_name) {
  const size_t dot = channel_name.rfind('.');
  return dot == std::string::npos ? "" : channel_name.substr(0, dot + 1);
}

// Returns the layers that have R, G and B.
std::vector<std::string> ColourLayers(const std::vector<std::string>& channel_names) {
  const std::set<std::string> names(channel_names.begin(), channel_names.end());
  std::set<std::string> layers;
  for (const std::string& channel_name : channel_names) {
    const std::string layer = LayerOf(channel_name);
    if (names.contains(layer + "R") && names.contains(layer + "G") && names.contains(layer + "B"))
      layers.insert(layer);
  }
  return {layers.begin(), layers.end()};
}

}  // namespace

Result<std::vector<int>> ColoursFirst(const std::vector<std::string>& channel_names,
                                      const std::string& name) {
  const auto is_plain = [](const std::string& channel_name) {
    return channel_name == "R" || channel_name == "G" || channel_name == "B";
  };
  const std::vector<std::string> layers = ColourLayers(channel_names);
  std::string chosen;  // "" stands for the channels without a layer; R, G or B may be missing
  if (std::none_of(channel_names.begin(), channel_names.end(), is_plain)) {
    if (layers.size() > 1)
      return InputError(
          fmt::format("{}: has colours in the layers {} and {}, but no channels R, G and B outside "
                      "of layers: choose a layer, and rename its channels to R, G and B",
                      name, layers[0].substr(0, layers[0].size() - 1),
                      layers[1].substr(0, layers[1].size() - 1)));
    if (!layers.empty()) chosen = layers[0];
  }
  std::vector<int> order(channel_names.size());
  std::iota(order.begin(), order.end(), 0);
  const auto rank = [&](int channel) -> size_t {
    constexpr size_t kOther = 4;
    const std::string& channel_name = channel_names[static_cast<size_t>(channel)];
    if (channel_name.size() != chosen.size() + 1 || !channel_name.starts_with(chosen))
      return kOther;
    return std::min(std::string_view("RGBA").find(channel_name.back()), kOther);
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank(a) < rank(b); });
  return order;
}

}  // namespace lf
