// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/join_views.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "lf/film/develop/colour_space.h"
#include "lf/film/develop/display_picture.h"
#include "lf/film/develop/squeeze_view.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Channels of the joined picture that a view gives, [begin, end).
struct ChannelRange {
  int begin = 0;
  int end = 0;
};

ChannelRange ChannelsOfView(ViewLayout layout, int view, int channels) {
  if (layout != ViewLayout::kAnaglyph) return {0, channels};
  return view == 0 ? ChannelRange{0, 1} : ChannelRange{1, 3};
}

// Copies channels of a view to a tile of the joined picture, which may have fewer channels.
template <class T>
void Place(const Image<T>& view, const ViewTile& tile, const ChannelRange& channels,
           Image<T>* joined) {
  const int left = tile.column * view.width(), top = tile.row * view.height();
  for (int y = 0; y < view.height(); ++y)
    for (int x = 0; x < view.width(); ++x) {
      const T* const from = &view.at(x, y);
      T* const to = &joined->at(left + x, top + y);
      std::copy(from + channels.begin, from + channels.end, to + channels.begin);
    }
}

StoredImage EmptyPicture(PixelType type, int width, int height, int channels) {
  switch (type) {
    case PixelType::kUint8:
      return Image<uint8_t>(width, height, channels);
    case PixelType::kUint16:
      return Image<uint16_t>(width, height, channels);
    case PixelType::kHalf:
    case PixelType::kFloat:
      break;
  }
  return Image<float>(width, height, channels);
}

std::array<float, 8> ChromaticitiesOf(const Primaries& p) {
  const auto number = [](double x) { return static_cast<float>(x); };
  return {number(p.red.x()),  number(p.red.y()),  number(p.green.x()), number(p.green.y()),
          number(p.blue.x()), number(p.blue.y()), number(p.white.x()), number(p.white.y())};
}

// Converts linear light with these chromaticities to Rec. 709. Light of a space that we know is
// converted as lfrenderer does for its videos, to the same bits.
void ToRec709(const std::array<float, 8>& c, Image<float>* rgb) {
  for (const ColourSpace space :
       {ColourSpace::kRec709, ColourSpace::kRec2020, ColourSpace::kAcesCg})
    if (ChromaticitiesOf(PrimariesOf(space)) == c) return ConvertToRec709(space, rgb);
  const Primaries from = {{c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}};
  Multiply(LinearFromLinear(PrimariesOf(ColourSpace::kRec709), from), rgb);
}

// Reads the picture of a view, which must be as the header says.
Result<StoredImage> ReadView(const fs::path& file, const PictureHeader& header,
                             bool is_for_display) {
  LF_ASSIGN_OR_RETURN(ImageWithInfo view, ReadImageWithInfo(file));
  if (view.info.width != header.info.width || view.info.height != header.info.height ||
      view.info.channel_names != header.info.channel_names || view.info.bits != header.info.bits)
    return InputError(
        fmt::format("{}: was changed while the views were joined: start again", file.string()));
  if (!is_for_display) return std::move(view.image);
  if (auto* const floats = std::get_if<Image<float>>(&view.image);
      floats != nullptr && header.colours.chromaticities)
    ToRec709(*header.colours.chromaticities, floats);
  LF_ASSIGN_OR_RETURN(Image<uint8_t> picture, DisplayPicture(view.image, file.string()));
  return StoredImage(std::move(picture));
}

}  // namespace

Result<std::vector<std::string>> JoinedChannels(const PictureHeader& header,
                                                const JoinOptions& options,
                                                const std::string& name) {
  const std::vector<std::string>& names = header.info.channel_names;
  const bool needs_colours =
      options.is_for_display || options.layout == ViewLayout::kAnaglyph || header.info.is_float;
  const auto is = [&](size_t i, char last) { return i < names.size() && names[i].ends_with(last); };
  if (needs_colours && !(is(0, 'R') && is(1, 'G') && is(2, 'B')))
    return InputError(
        fmt::format("{}: has the channels {}: expected R, G and B", name, fmt::join(names, " ")));
  if (options.layout == ViewLayout::kAnaglyph && is(3, 'A'))
    return InputError(
        fmt::format("{}: has alpha, but an anaglyph takes its colours from two views, which may be "
                    "transparent at different places: composite the views first, or choose "
                    "another layout",
                    name));
  if (options.is_for_display) return std::vector<std::string>{"R", "G", "B"};
  if (!header.info.is_float) return names;
  std::vector<std::string> kept = {"R", "G", "B"};
  if (is(3, 'A')) kept.emplace_back("A");
  return kept;
}

Result<StoredImage> JoinViews(std::span<const fs::path> files, const PictureHeader& header,
                              const JoinOptions& options, ThreadPool& pool,
                              const std::function<bool()>& on_view) {
  LF_CHECK(!files.empty());
  LF_ASSIGN_OR_RETURN(const std::vector<std::string> names,
                      JoinedChannels(header, options, files[0].string()));
  const int channels = static_cast<int>(names.size());
  const TileCounts grid = GridOf(options.layout, options.grid);
  const ViewSize of_view = {header.info.width, header.info.height};
  const ViewSize tile = options.tile.value_or(of_view);
  StoredImage joined =
      EmptyPicture(options.is_for_display ? PixelType::kUint8 : header.colours.type,
                   tile.width * grid.columns, tile.height * grid.rows, channels);
  std::vector<std::optional<Error>> errors(files.size());
  std::atomic<bool> is_interrupted = false;
  pool.ForEach(files.size(), [&](size_t i) {
    if (is_interrupted) return;
    Result<StoredImage> view = ReadView(files[i], header, options.is_for_display);
    if (!view) {
      errors[i] = view.error();
      return;
    }
    if (tile != of_view) *view = Squeezed(*view, tile.width, tile.height);
    const int index = static_cast<int>(i);
    std::visit(
        [&](const auto& image) {
          using Picture = std::remove_cvref_t<decltype(image)>;
          Place(image, TileOf(options.layout, options.grid, index),
                ChannelsOfView(options.layout, index, channels), &std::get<Picture>(joined));
        },
        *view);
    if (on_view && !on_view()) is_interrupted = true;
  });
  for (const std::optional<Error>& error : errors)
    if (error) return *error;
  if (is_interrupted) return Error{ErrorKind::kInterrupted, "interrupted"};
  return joined;
}

std::string KindOf(const PictureHeader& header) {
  constexpr const char* kTypes[] = {"8 bits", "16 bits", "half", "float"};
  std::string kind = fmt::format("{} x {} pixels of {} in the channels {}", header.info.width,
                                 header.info.height, kTypes[static_cast<int>(header.colours.type)],
                                 fmt::join(header.info.channel_names, " "));
  if (header.colours.chromaticities)
    kind +=
        fmt::format(" with the chromaticities {}", fmt::join(*header.colours.chromaticities, " "));
  if (header.colours.is_srgb) kind += " of sRGB";
  if (header.colours.frames_per_second)
    kind += fmt::format(" at {} frames per second", *header.colours.frames_per_second);
  return kind;
}

}  // namespace lf
