// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/lf_image_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include "lf/core/check.h"
#include "lf/pixels/codec/code_head.h"
#include "lf/pixels/codec/decode_by.h"
#include "lf/pixels/codec/entropy.h"
#include "lf/pixels/codec/residual_code.h"
#include "lf/pixels/codec/thesis_tile.h"
#include "lf/pixels/codec/wavelet_tile.h"

namespace lf {
namespace {

constexpr int kColoursOfMosaic = 4;            // channels of a reduced mosaic
constexpr uint64_t kMostCodeBytes = 1U << 30;  // most bytes of an encoded image

template <class Pixel>
ImageView<Pixel> Part(ImageView<Pixel> image, const PixelRect& rect) {
  image.data = image.row(rect.y_begin) + static_cast<size_t>(rect.x_begin) * image.channels;
  image.width = rect.width();
  image.height = rect.height();
  return image;
}

using IsInterrupted = std::function<bool()>;  // may be empty

Result<void> CheckInterrupted(const IsInterrupted& is_interrupted) {
  if (is_interrupted && is_interrupted()) return Error{ErrorKind::kInterrupted, "interrupted"};
  return {};
}

// Returns the encoded image: head, table of contents and sections. Sections are ordered by
// resolution, then by tile.
template <class Tile>
Result<std::string> Assembled(const CodeHead& head, const std::vector<Tile>& tiles,
                              const IsInterrupted& is_interrupted) {
  std::string code, sections;
  AppendHead(head, &code);
  for (int resolution = 0; resolution <= head.info.levels; ++resolution)
    for (const Tile& tile : tiles) {
      LF_RETURN_IF_ERROR(CheckInterrupted(is_interrupted));
      const std::string section = CodeOfSection(head, tile, resolution);
      AppendNumber(section.size(), &code);
      sections += section;
    }
  return code + sections;
}

//   prediction  empty if the head says that the image is not predicted
template <class Pixel>
Result<std::string> Encode(ImageView<const Pixel> pixels, ImageView<const Pixel> prediction,
                           const CodecSettings& settings, CodeHead head,
                           const IsInterrupted& is_interrupted) {
  if (settings.profile == CodecProfile::kThesis) {
    std::vector<HaarTile> tiles;
    for (size_t i = 0; i < head.tile_count(); ++i) {
      LF_RETURN_IF_ERROR(CheckInterrupted(is_interrupted));
      tiles.push_back(TransformTile(head, settings.threshold, Part(pixels, head.TileRect(i))));
    }
    head.quantizer = settings.quantizer;
    head.low = tiles.front().low;
    head.high = tiles.front().high;
    for (const HaarTile& tile : tiles) {
      head.low = std::min<int64_t>(head.low, tile.low);
      head.high = std::max<int64_t>(head.high, tile.high);
    }
    return Assembled(head, tiles, is_interrupted);
  }
  SetSteps(settings, &head);
  std::vector<QuantizedTile> tiles;
  int32_t largest = 0;
  for (size_t i = 0; i < head.tile_count(); ++i) {
    LF_RETURN_IF_ERROR(CheckInterrupted(is_interrupted));
    const PixelRect rect = head.TileRect(i);
    tiles.push_back(
        QuantizeTile(Transform::kSimd, head, Part(pixels, rect),
                     prediction.empty() ? ImageView<const Pixel>() : Part(prediction, rect)));
    largest = std::max(largest, tiles.back().largest);
  }
  head.coefficient_bytes = head.info.bits == 8 && FitsInTwoBytes(largest) ? 2 : 4;
  return Assembled(head, tiles, is_interrupted);
}

// Head and sections of an encoded image.
struct Contents {
  CodeHead head;
  std::vector<std::string_view> sections;  // index: resolution * tile_count() + tile
};

Error DamagedCode(std::string_view fault) {
  return InputError(
      fmt::format("is a damaged encoded LF image: {}; copy or make the packed store again", fault));
}

// Reads the table of contents from the front of `code`: the sizes of all sections.
//   most_bytes  no section is larger
Result<std::vector<uint64_t>> TakeSizes(const CodeHead& head, uint64_t most_bytes,
                                        std::string_view* code) {
  const size_t count = head.tile_count() * (head.info.levels + 1);
  // The table has at least one byte for each section.
  if (count > code->size())
    return DamagedCode(fmt::format("{} bytes are too few for {} packets", code->size(), count));
  std::vector<uint64_t> sizes(count);
  for (uint64_t& size : sizes)
    if (!TakeNumber(code, most_bytes, &size))
      return DamagedCode(fmt::format(
          "its table of contents states a packet of more than the {} bytes of all", most_bytes));
  return sizes;
}

// Reads head and table of contents from the front of `code`, and divides the rest into the sections
// of the resolutions up to `last_resolution`. `code` may end behind them.
//   most_bytes  size of the whole encoded image, or more
Result<Contents> TakeFront(std::string_view* code, CodeHead head, int last_resolution,
                           uint64_t most_bytes) {
  Contents contents{std::move(head), {}};
  LF_ASSIGN_OR_RETURN(const std::vector<uint64_t> sizes,
                      TakeSizes(contents.head, most_bytes, code));
  contents.sections.resize(contents.head.tile_count() * (last_resolution + 1));
  for (size_t i = 0; i < contents.sections.size(); ++i)
    if (!TakeBytes(code, sizes[i], &contents.sections[i]))
      return DamagedCode("it is shorter than the packets in its table of contents");
  return contents;
}

// Reads the whole encoded image.
Result<Contents> TakeContents(std::string_view code) {
  const size_t bytes = code.size();
  LF_ASSIGN_OR_RETURN(CodeHead head, TakeHead(&code));
  const int levels = head.info.levels;
  LF_ASSIGN_OR_RETURN(Contents contents, TakeFront(&code, std::move(head), levels, bytes));
  if (!code.empty())
    return DamagedCode(fmt::format("{} bytes follow its last packet", code.size()));
  return contents;
}

// Decodes the tiles of `rect`. Before, `pixels` must hold their prediction if the head says that
// the image is predicted.
template <class Pixel>
Result<void> Decode(Transform transform, const Contents& contents, const PixelRect& rect,
                    CodecPixels* pixels) {
  const CodeHead& head = contents.head;
  if (!std::holds_alternative<Image<Pixel>>(*pixels)) *pixels = Image<Pixel>();
  auto& image = std::get<Image<Pixel>>(*pixels);
  image.Resize(rect.width(), rect.height(), ChannelsOf(head.info.layout));
  std::vector<std::string_view> sections(head.info.levels + 1);
  for (size_t tile = 0; tile < head.tile_count(); ++tile) {
    PixelRect here = head.TileRect(tile);
    if (Intersection(here, rect).empty()) continue;
    for (size_t r = 0; r < sections.size(); ++r)
      sections[r] = contents.sections[r * head.tile_count() + tile];
    here = {here.x_begin - rect.x_begin, here.y_begin - rect.y_begin, here.x_end - rect.x_begin,
            here.y_end - rect.y_begin};
    const ImageView<Pixel> part = Part(image.view(), here);
    const bool is_whole = head.info.profile == CodecProfile::kThesis
                              ? DecodeHaarTile(transform, head, sections, part)
                              : DecodeWaveletTile(transform, head, sections, part);
    if (!is_whole)
      return DamagedCode(fmt::format("the tile at pixel ({}, {}) cannot be decoded",
                                     head.TileRect(tile).x_begin, head.TileRect(tile).y_begin));
  }
  return {};
}

// Number of resolutions that are left out for a reduction by 2^n. A mosaic is halved by its first
// level, which belongs to no resolution.
int LeftOut(const CodeInfo& info, int n) { return info.layout == PixelLayout::kMosaic ? n - 1 : n; }

// Number of channels of a reduced picture.
int ReducedChannels(PixelLayout layout) {
  return layout == PixelLayout::kMosaic ? kColoursOfMosaic : ChannelsOf(layout);
}

// Makes means of squares of 2^n x 2^n pixels of samples that belong to the upper left pixels of
// these squares. The centre of a square lies (2^n - 1) / 2 pixels farther, so that its mean is
// about a value between this sample and the next ones, in integers. [height][width][channels]; the
// samples may have one more column and row.
template <class Pixel>
void ToMeans(const Image<Pixel>& samples, int n, Image<Pixel>* means) {
  const uint32_t next = (1U << n) - 1, here = (1U << n) + 1;  // in 1 / 2^(n + 1)
  const int shift = 2 * (n + 1), channels = samples.channels();
  const uint32_t half = 1U << (shift - 1);
  // Values of the last column have no next sample if it is the last one of the samples.
  const int values = means->width() * channels;
  const int with_next = std::min(means->width(), samples.width() - 1) * channels;
  for (int y = 0; y < means->height(); ++y) {
    const Pixel* const upper = samples.row(y);
    const Pixel* const lower = samples.row(std::min(y + 1, samples.height() - 1));
    Pixel* const out = means->row(y);
    for (int i = 0; i < with_next; ++i)
      out[i] = static_cast<Pixel>((here * (here * upper[i] + next * upper[i + channels]) +
                                   next * (here * lower[i] + next * lower[i + channels]) + half) >>
                                  shift);
    for (int i = with_next; i < values; ++i)
      out[i] =
          static_cast<Pixel>(((here + next) * (here * upper[i] + next * lower[i]) + half) >> shift);
  }
}

template <class Pixel>
Result<void> DecodeMeans(Transform transform, const Contents& contents, int n,
                         CodecPixels* pixels) {
  const CodeHead& head = contents.head;
  const int side = 1 << n, channels = ReducedChannels(head.info.layout);
  const auto samples_along = [side](int count) { return (count + side - 1) / side; };
  Image<Pixel> samples(samples_along(head.info.width), samples_along(head.info.height), channels);
  std::vector<std::string_view> sections(contents.sections.size() / head.tile_count());
  for (size_t tile = 0; tile < head.tile_count(); ++tile) {
    const PixelRect rect = head.TileRect(tile);
    for (size_t r = 0; r < sections.size(); ++r)
      sections[r] = contents.sections[r * head.tile_count() + tile];
    const int x = rect.x_begin / side, y = rect.y_begin / side;
    const ImageView<Pixel> part = Part(
        samples.view(), {x, y, x + samples_along(rect.width()), y + samples_along(rect.height())});
    if (!DecodeReducedTile(transform, head, sections, rect.width(), rect.height(), part))
      return DamagedCode(
          fmt::format("the tile at pixel ({}, {}) cannot be decoded", rect.x_begin, rect.y_begin));
  }
  if (!std::holds_alternative<Image<Pixel>>(*pixels)) *pixels = Image<Pixel>();
  auto& means = std::get<Image<Pixel>>(*pixels);
  means.Resize(head.info.width / side, head.info.height / side, channels);
  ToMeans(samples, n, &means);
  return {};
}

}  // namespace

Result<void> CheckSettings(const CodecSettings& settings) {
  if (settings.levels < 1 || settings.levels > kMostLevels)
    return UsageError(fmt::format("{{levels {}}}: expected 1 to {}", settings.levels, kMostLevels));
  if (!(settings.threshold >= 0 && settings.threshold <= 65535))
    return UsageError(fmt::format("{{threshold {}}}: expected 0 to 65535", settings.threshold));
  if (settings.quantizer < 2 || settings.quantizer > 65536)
    return UsageError(
        fmt::format("{{quantizer {}}}: expected 8bit, or 2 to 65536 values per coefficient",
                    settings.quantizer));
  return {};
}

namespace {

// Encodes an image, or its difference to a prediction: bytes that describe the prediction follow
// the head.
//   prediction  null if reference_count is 0
Result<std::string> EncodeAny(const CodecPixels& pixels, const CodecPixels* prediction,
                              PixelLayout layout, const CodecSettings& settings,
                              int reference_count, std::string_view prediction_code,
                              const IsInterrupted& is_interrupted) {
  LF_CHECK(CheckSettings(settings).has_value());
  return std::visit(
      [&]<class Pixel>(const Image<Pixel>& image) {
        LF_CHECK(image.channels() == ChannelsOf(layout) && image.width() > 0 &&
                 image.height() > 0 &&
                 static_cast<long long>(image.width()) * image.height() <= kMostPixels);
        CodeHead head;
        head.info = {image.width(),    image.height(),  layout,           8 * sizeof(Pixel),
                     settings.profile, settings.levels, settings.entropy, reference_count};
        if (settings.profile == CodecProfile::kThesis) head.info.entropy = Entropy::kPacked;
        head.prediction = prediction_code;
        ImageView<const Pixel> predicted;
        if (prediction != nullptr) predicted = std::get<Image<Pixel>>(*prediction).view();
        return Encode(image.view(), predicted, settings, std::move(head), is_interrupted);
      },
      pixels);
}

}  // namespace

std::string EncodeImage(const CodecPixels& pixels, PixelLayout layout,
                        const CodecSettings& settings) {
  return *EncodeAny(pixels, nullptr, layout, settings, 0, {}, {});
}

Result<std::string> EncodeImage(const CodecPixels& pixels, PixelLayout layout,
                                const CodecSettings& settings,
                                const std::function<bool()>& is_interrupted) {
  return EncodeAny(pixels, nullptr, layout, settings, 0, {}, is_interrupted);
}

std::string EncodeResidual(const CodecPixels& pixels, const CodecPixels& prediction,
                           PixelLayout layout, const CodecSettings& settings, int reference_count,
                           std::string_view prediction_code) {
  LF_CHECK(reference_count > 0 && settings.profile != CodecProfile::kThesis);
  return *EncodeAny(pixels, &prediction, layout, settings, reference_count, prediction_code, {});
}

PixelRect TilesAround(const CodeHead& head, const PixelRect& wanted) {
  const int size = head.tile_size();
  return {wanted.x_begin / size * size, wanted.y_begin / size * size,
          std::min((wanted.x_end - 1) / size * size + size, head.info.width),
          std::min((wanted.y_end - 1) / size * size + size, head.info.height)};
}

Result<CodeInfo> ReadCodeInfo(std::string_view code) {
  LF_ASSIGN_OR_RETURN(const CodeHead head, TakeHead(&code));
  if (head.tile_count() * (head.info.levels + 1) > code.size())
    return DamagedCode("it is shorter than its table of contents");
  return head.info;
}

Result<void> DecodeImageBy(Transform transform, std::string_view code, const PixelRect& wanted,
                           DecodedPart* part) {
  LF_ASSIGN_OR_RETURN(const Contents contents, TakeContents(code));
  const CodeInfo& info = contents.head.info;
  if (info.reference_count > 0)
    return InputError(fmt::format(
        "is an encoded LF image that is predicted from {} others and needs their pixels",
        info.reference_count));
  const PixelRect inside = Intersection(wanted, {0, 0, info.width, info.height});
  LF_CHECK(!inside.empty());
  part->rect = TilesAround(contents.head, inside);
  return info.bits == 8 ? Decode<uint8_t>(transform, contents, part->rect, &part->pixels)
                        : Decode<uint16_t>(transform, contents, part->rect, &part->pixels);
}

Result<void> DecodeResidual(Transform transform, std::string_view code, const PixelRect& rect,
                            CodecPixels* pixels) {
  LF_ASSIGN_OR_RETURN(const Contents contents, TakeContents(code));
  LF_CHECK(TilesAround(contents.head, rect) == rect);
  return contents.head.info.bits == 8 ? Decode<uint8_t>(transform, contents, rect, pixels)
                                      : Decode<uint16_t>(transform, contents, rect, pixels);
}

int LargestReduction(const CodeInfo& info) {
  if (info.profile == CodecProfile::kThesis || info.reference_count > 0) return 1;
  int n = info.layout == PixelLayout::kMosaic ? info.levels + 1 : info.levels;
  while (n > 0 && std::min(info.width, info.height) < 1 << n) --n;
  return 1 << n;
}

Result<std::vector<uint64_t>> ResolutionEnds(std::string_view code) {
  const size_t bytes = code.size();
  LF_ASSIGN_OR_RETURN(const CodeHead head, TakeHead(&code));
  LF_ASSIGN_OR_RETURN(const std::vector<uint64_t> sizes, TakeSizes(head, bytes, &code));
  std::vector<uint64_t> ends(head.info.levels + 1, bytes - code.size());
  for (size_t r = 0; r < ends.size(); ++r) {
    const auto begin = sizes.begin() + static_cast<ptrdiff_t>(r * head.tile_count());
    ends[r] = std::accumulate(begin, begin + static_cast<ptrdiff_t>(head.tile_count()),
                              r == 0 ? ends[0] : ends[r - 1]);
  }
  return ends;
}

int ResolutionFor(const CodeInfo& info, int reduction) {
  return info.levels - LeftOut(info, std::countr_zero(static_cast<unsigned>(reduction)));
}

Result<void> DecodeReducedBy(Transform transform, std::string_view code, int reduction,
                             CodecPixels* pixels) {
  LF_ASSIGN_OR_RETURN(CodeHead head, TakeHead(&code));
  LF_CHECK(reduction >= 2 && std::has_single_bit(static_cast<unsigned>(reduction)) &&
           reduction <= LargestReduction(head.info));
  const int last_resolution = ResolutionFor(head.info, reduction);
  LF_ASSIGN_OR_RETURN(const Contents contents,
                      TakeFront(&code, std::move(head), last_resolution, kMostCodeBytes));
  const int n = std::countr_zero(static_cast<unsigned>(reduction));
  return contents.head.info.bits == 8 ? DecodeMeans<uint8_t>(transform, contents, n, pixels)
                                      : DecodeMeans<uint16_t>(transform, contents, n, pixels);
}

Result<void> DecodeReduced(std::string_view code, int reduction, CodecPixels* pixels) {
  return DecodeReducedBy(Transform::kSimd, code, reduction, pixels);
}

Result<void> DecodeImage(std::string_view code, const PixelRect& wanted, DecodedPart* part) {
  return DecodeImageBy(Transform::kSimd, code, wanted, part);
}

Result<void> DecodeImage(std::string_view code, DecodedPart* part) {
  LF_ASSIGN_OR_RETURN(const CodeInfo info, ReadCodeInfo(code));
  return DecodeImage(code, {0, 0, info.width, info.height}, part);
}

}  // namespace lf
