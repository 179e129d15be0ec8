// The inner loop of ray collection: addresses by linear forms, a chunk at a time so that the
// compiler turns the maths into vectors, then one integer addition per ray and channel.
#include <algorithm>
#include <cmath>

#include "lf/collection/scatter.h"

namespace lf {
namespace {

constexpr int kChunk = 64;

// Within this of the band's border a span is tested ray by ray. Covers the float bounds of RaySpan.
constexpr float kBorderMargin = 0.01f;

// Elements of kChunk rays, clamped to the plate: the law has accepted them, rounding must not
// move them out.
struct ChunkElements {
  int x[kChunk];
  int y[kChunk];
};

// On a scanline of a camera without distortion.
class LineAddresses {
 public:
  LineAddresses(const ScatterPlan& plan, int y)
      : x_slope_(plan.forms.sensor_x[0]),
        y_slope_(plan.forms.sensor_y[0]),
        front_slope_(plan.forms.front[0]),
        x_constant_(Value(plan.forms.sensor_x, 0, y + 0.5)),
        y_constant_(Value(plan.forms.sensor_y, 0, y + 0.5)),
        front_constant_(Value(plan.forms.front, 0, y + 0.5)),
        x_last_(plan.plate_width - 1),
        y_last_(plan.plate_height - 1) {}

  // From absolute pixel positions, so that no cut of the work changes an address.
  void Compute(int x_begin, int count, ChunkElements* elements) const {
    for (int i = 0; i < count; ++i) {
      const double position = x_begin + i + 0.5;
      const double scale = 1 / (front_slope_ * position + front_constant_);
      const double x = (x_slope_ * position + x_constant_) * scale;
      const double y = (y_slope_ * position + y_constant_) * scale;
      // Not negative after clamping: truncation is floor.
      elements->x[i] = static_cast<int>(std::min(std::max(x, 0.0), x_last_));
      elements->y[i] = static_cast<int>(std::min(std::max(y, 0.0), y_last_));
    }
  }

  // Cuts from [begin, end) what lands outside of element rows [row_begin, row_end), leaving up to
  // a pixel too much on either side. y is monotonic along a span; a row is solved for only where
  // the span crosses it.
  void Narrow(double row_begin, double row_end, int* begin, int* end) const {
    const double y_first = RowAt(*begin), y_last = RowAt(*end - 1);
    const bool rising = y_first <= y_last;
    const double enter = rising ? row_begin : row_end, leave = rising ? row_end : row_begin;
    const auto beyond = [rising](double y, double row) { return rising ? y > row : y < row; };
    const int first = beyond(enter, y_first) ? CrossingOf(enter, *begin, *end) : *begin;
    const int last = beyond(y_last, leave) ? CrossingOf(leave, *begin, *end) + 2 : *end;
    *begin = first;
    *end = std::min(*end, last);
  }

 private:
  double RowAt(int x) const {
    const double position = x + 0.5;
    return (y_slope_ * position + y_constant_) / (front_slope_ * position + front_constant_);
  }

  // Last pixel of [begin, end) whose centre is not beyond y = row.
  int CrossingOf(double row, int begin, int end) const {
    const double x = (row * front_constant_ - y_constant_) / (y_slope_ - row * front_slope_);
    return static_cast<int>(std::clamp<double>(std::floor(x - 0.5), begin, end));
  }

  double x_slope_, y_slope_, front_slope_;
  double x_constant_, y_constant_, front_constant_;
  double x_last_, y_last_;
};

// A form along an arc: a cubic in the arc's parameter.
struct ArcForm {
  double c0, c1, c2, c3;
  ArcForm(const PixelForm& form, const IdealArc& arc) {
    const double b0 = Value(form, arc.control[0]), b1 = Value(form, arc.control[1]);
    const double b2 = Value(form, arc.control[2]), b3 = Value(form, arc.control[3]);
    c0 = b0;
    c1 = 3 * (b1 - b0);
    c2 = 3 * (b0 - 2 * b1 + b2);
    c3 = b3 - b0 + 3 * (b1 - b2);
  }
  double At(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
};

// On an arc of a camera with distortion.
class ArcAddresses {
 public:
  ArcAddresses(const ScatterPlan& plan, const IdealArc& arc)
      : x_(plan.forms.sensor_x, arc),
        y_(plan.forms.sensor_y, arc),
        front_(plan.forms.front, arc),
        first_(arc.x_begin),
        step_(1.0 / (arc.x_end - arc.x_begin)),
        x_last_(plan.plate_width - 1),
        y_last_(plan.plate_height - 1) {}

  void Compute(int x_begin, int count, ChunkElements* elements) const {
    for (int i = 0; i < count; ++i) {
      const double t = (x_begin - first_ + i + 0.5) * step_;
      const double scale = 1 / front_.At(t);
      elements->x[i] = static_cast<int>(std::min(std::max(x_.At(t) * scale, 0.0), x_last_));
      elements->y[i] = static_cast<int>(std::min(std::max(y_.At(t) * scale, 0.0), y_last_));
    }
  }

  // Arcs are short: all of it is tested.
  void Narrow(double, double, int*, int*) const {}

 private:
  ArcForm x_, y_, front_;
  int first_;
  double step_;
  double x_last_, y_last_;
};

// How a pixel of the scanline adds to an element; the number of its rays, 0 of a masked one.
struct RgbPixels {
  const uint16_t* row;  // [width][4]
  uint32_t Add(int column, uint64_t* element) const {
    const uint16_t* v = row + static_cast<ptrdiff_t>(column) * LfPixels::kRgbLanes;
    const uint64_t rays = uint64_t{v[LfPixels::kRayLane]} << SensorPlate::kSumBits;
    element[0] += rays | v[0];
    element[1] += rays | v[1];
    element[2] += rays | v[2];
    return v[LfPixels::kRayLane];
  }
};

struct MosaicPixels {
  const uint16_t* row;  // [width]
  const uint8_t* mask;  // [width], or none
  int channels[2];      // of even and odd columns
  uint32_t Add(int column, uint64_t* element) const {
    if (mask != nullptr && mask[column] == 0) return 0;
    element[channels[column & 1]] += SensorPlate::kOneRay | row[column];
    return 1;
  }
};

template <class Addresses, class Pixels>
uint64_t ScatterSpan(const Addresses& addresses, const RaySpan& span, const Pixels& pixels,
                     int x_origin, PlateBand* band) {
  const bool all_inside =
      span.element_y_min >= static_cast<float>(band->y_begin()) + kBorderMargin &&
      span.element_y_max <= static_cast<float>(band->y_end()) - kBorderMargin;
  const int chunk = std::min<int>(kChunk, static_cast<int>(band->max_reserve()));
  const int rows = band->y_end() - band->y_begin();
  const size_t row_words = static_cast<size_t>(band->width()) * SensorPlate::kChannels;
  uint64_t* const words = band->row(band->y_begin());
  int x_begin = span.x_begin, x_end = span.x_end;
  if (!all_inside)
    addresses.Narrow(band->y_begin() - kBorderMargin, band->y_end() + kBorderMargin, &x_begin,
                     &x_end);
  uint64_t accepted = 0;
  ChunkElements elements;
  for (int x = x_begin; x < x_end; x += chunk) {
    const int count = std::min(chunk, x_end - x);
    addresses.Compute(x, count, &elements);
    band->Reserve(static_cast<uint32_t>(count));
    const auto add = [&](int i, int row) {
      accepted += pixels.Add(x + i - x_origin,
                             words + static_cast<size_t>(row) * row_words +
                                 static_cast<size_t>(elements.x[i]) * SensorPlate::kChannels);
    };
    if (all_inside) {
      for (int i = 0; i < count; ++i) add(i, elements.y[i] - band->y_begin());
      continue;
    }
    for (int i = 0; i < count; ++i) {
      const int row = elements.y[i] - band->y_begin();
      if (row >= 0 && row < rows) add(i, row);
    }
  }
  return accepted;
}

template <class Pixels>
uint64_t ScatterSpan(const ScatterPlan& plan, const RaySpan& span, const Pixels& pixels,
                     int x_origin, PlateBand* band) {
  if (plan.ideal_pixels == nullptr)
    return ScatterSpan(LineAddresses(plan, span.y), span, pixels, x_origin, band);
  const IdealArc& arc = plan.ideal_pixels->Scanline(span.y)[span.arc];
  return ScatterSpan(ArcAddresses(plan, arc), span, pixels, x_origin, band);
}

}  // namespace

uint64_t ScatterBand(const ScatterPlan& plan, const LfPixels& pixels, PlateBand* band) {
  LF_CHECK(band->width() == plan.plate_width);
  const int x_origin = pixels.rect.x_begin;
  const float begin = static_cast<float>(band->y_begin()) - kBorderMargin;
  const float end = static_cast<float>(band->y_end()) + kBorderMargin;
  uint64_t accepted = 0;
  for (const RaySpan& span : plan.spans) {
    if (span.element_y_max < begin || span.element_y_min > end) continue;
    const int row = span.y - pixels.rect.y_begin;
    if (pixels.bayer == BayerPattern::kNone) {
      accepted += ScatterSpan(plan, span, RgbPixels{pixels.radiance.row(row)}, x_origin, band);
      continue;
    }
    const MosaicPixels mosaic{pixels.radiance.row(row),
                              pixels.mosaic_mask.empty() ? nullptr : pixels.mosaic_mask.row(row),
                              {BayerChannel(pixels.bayer, x_origin, span.y),
                               BayerChannel(pixels.bayer, x_origin + 1, span.y)}};
    accepted += ScatterSpan(plan, span, mosaic, x_origin, band);
  }
  return accepted;
}

}  // namespace lf
