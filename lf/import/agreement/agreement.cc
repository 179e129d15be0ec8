// SPDX-License-Identifier: Apache-2.0
#include "lf/import/agreement/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lf/core/log.h"
#include "lf/core/median.h"
#include "lf/import/agreement/find_places.h"
#include "lf/import/agreement/place_errors.h"

namespace lf {
namespace {

constexpr size_t kLeastPlaces = 24;
constexpr double kLeastMove = 3;  // median way of a place between LF images, in reduced pixels

// Thresholds of the verdict, as shares of the places. doc/judgements.md says how they were chosen.
constexpr double kAgreeShare = 0.6;     // images and poses agree if no fewer places do
constexpr double kRepairedShare = 0.6;  // a repair is named if it makes as many places agree
constexpr double kCertainShare = 0.75;  // as kRepairedShare, if few places are explained better
constexpr double kContrast = 0.25;      // between right and wrong poses
constexpr double kSureShare = 0.85;     // no repair is tried, except of the order of names
constexpr double kMostGain = 0.08;      // largest gain by a repair if images and poses agree
constexpr double kWins = 0.1;           // places that a repair explains better, see IsBetter()
constexpr double kOrderWins = 0.04;     // as kWins, for another order of the names

constexpr size_t kPlacesForOrder = 200;  // fewer may not tell one order of names from another
constexpr size_t kFocalSteps = 76;       // focal lengths that are tried, each 4 % longer
// Focal lengths of lenses without much distortion, as multiples of the image width.
constexpr double kLeastFocal = 0.2, kMostFocal = 12;
constexpr double kEqual = 0.03;  // shares that differ by less are equal

struct Judged {
  Repair repair;
  Fit fit;
};

Fit FitOf(const std::vector<PlaceError>& errors, int divisor) {
  if (errors.empty()) return {};
  std::vector<double> all_px;
  for (const PlaceError& error : errors) all_px.push_back(error.reduced_px * divisor);
  const auto same = std::count_if(errors.begin(), errors.end(),
                                  [](const PlaceError& error) { return error.agrees(); });
  return {Median(std::move(all_px)),
          static_cast<double>(same) / static_cast<double>(errors.size())};
}

// Returns true if all LF cameras look in the same direction, within a hundredth of a radian.
bool AreParallel(const LightField& light_field) {
  const Mat3& first = light_field.cameras[0].cam_from_world.rotation;
  return std::all_of(light_field.cameras.begin(), light_field.cameras.end(),
                     [&](const LfCamera& camera) {
                       return (camera.cam_from_world.rotation - first).norm() < 0.01;
                     });
}

// Returns repairs of focal lengths: those of usual units and sizes first, then all factors for
// which the focal length is from 0.3 to 6 widths, in steps of 4 %. None leads to a focal length
// that no lens has.
std::vector<Repair> FocalRepairs(const LightField& light_field) {
  std::vector<Repair> all;
  const Intrinsics& k = light_field.Camera({0}).intrinsics;
  const double w = k.width_px, h = k.height_px;
  const auto add = [&](double fx, double fy) {
    const double widths = k.fx_px * fx / w;
    if (widths >= kLeastFocal && widths <= kMostFocal) all.push_back({.focal_factors = {fx, fy}});
  };
  for (const double factor : {w, h, w / 36, h / 36, std::hypot(w, h) / 43.27, 2., 0.5, 4., 0.25})
    add(factor, factor);
  add(w, h);
  for (size_t i = 0; i < kFocalSteps; ++i) {
    const double focal_px = 0.3 * w * std::pow(1.04, i);
    add(focal_px / k.fx_px, focal_px / k.fx_px);
  }
  return all;
}

// Returns true if the repair is one of the many focal lengths that are tried in steps, or lies
// between them.
bool IsOfScan(const Repair& repair, const std::vector<Repair>& repairs) {
  const auto at = std::find(repairs.begin(), repairs.end(), repair);
  return repair.focal_factors != Repair().focal_factors &&
         repairs.end() - at <= static_cast<ptrdiff_t>(kFocalSteps);
}

// Returns the fault that a repair undoes, as a clause. Names the unit of focal lengths.
std::string ClauseFor(const Repair& repair, const LightField& light_field) {
  const Intrinsics k = light_field.Camera({0}).intrinsics;
  const bool is_rectified = IsRectified(light_field);
  const double factor = repair.focal_factors[0];
  const auto is = [&](double other) { return std::abs(factor / other - 1) < 1e-6; };
  if (factor != 1 && k.fx_px < 0.1 * k.width_px) {
    for (const auto& [size, text] : {std::pair{k.width_px, "width"}, {k.height_px, "height"}})
      if (is(size))
        return fmt::format("the focal lengths were shares of the {} instead of pixels", text);
    for (const auto& [size, text] : {std::pair{k.width_px, "wide"}, {k.height_px, "high"}})
      if (is(size / 36.0))
        return fmt::format("the focal lengths were in millimetres, of a sensor 36 mm {}", text);
    return fmt::format("the focal lengths were {:.5g} instead of {:.5g} pixels", k.fx_px * factor,
                       k.fx_px);
  }
  for (const auto& [size, text] :
       {std::pair{2., "half"}, {4., "a quarter of"}, {0.5, "twice"}, {0.25, "four times"}})
    if (is(size)) return fmt::format("the focal lengths belonged to images of {} the size", text);
  std::string clause = ClauseOf(repair);
  if (is_rectified && repair == Repair{.mirror_y = true})
    clause += " (or mirror-x, if near things are then blurred like far ones)";
  return clause;
}

// Counts the places at which a repair explains the images well and clearly better than the poses as
// recorded, and those at which the recorded poses do.
struct Duel {
  size_t wins = 0, losses = 0;
};
Duel Compare(const std::vector<PlaceError>& repaired, const std::vector<PlaceError>& recorded) {
  const auto beats = [](const PlaceError& a, const PlaceError& b) {
    return a.agrees() && a.reduced_px + a.tolerance / 2 < b.reduced_px;
  };
  Duel duel;
  for (size_t i = 0; i < recorded.size(); ++i) {
    if (beats(repaired[i], recorded[i])) ++duel.wins;
    if (beats(recorded[i], repaired[i])) ++duel.losses;
  }
  return duel;
}

std::string WhyTooFew(const FoundPlaces& found) {
  constexpr double kLeastCorners = 40;
  if (found.tried_count == 0) return "no LF cameras are neighbours";
  if (found.corner_count < kLeastCorners) return "the LF images have too little texture";
  if (found.pair_count == 0)
    return fmt::format("none of {} compared pairs of LF images show places in common",
                       found.tried_count);
  return fmt::format("only {} places of the scene were found in several LF images",
                     found.places.size());
}

// Refines the factor of a repair of focal lengths in small steps.
Judged WithRefinedFocal(const Judged& judged, const PlaceErrors& errors, int divisor) {
  Judged best = judged;
  for (int step = -10; step <= 10; ++step) {
    Judged tried = judged;
    for (double& factor : tried.repair.focal_factors) factor *= 1 + 0.004 * step;
    tried.fit = FitOf(errors.Of(tried.repair), divisor);
    if (tried.fit.error_px < best.fit.error_px) best = tried;
  }
  for (double& factor : best.repair.focal_factors)
    factor = std::stod(fmt::format("{:.5g}", factor));
  return best;
}

// Returns the repair that explains the images best. Among those that explain them about equally
// well, the first of the list is taken, because the list begins with the most usual mistakes.
Judged BestRepair(const std::vector<Repair>& repairs, const PlaceErrors& errors, size_t count,
                  int divisor, ThreadPool& pool) {
  constexpr size_t kSampled = 400;  // places at which all repairs are tried
  std::vector<Fit> fits(repairs.size());
  const size_t step = std::max<size_t>(1, count / kSampled);
  pool.ForEach(repairs.size(),
               [&](size_t i) { fits[i] = FitOf(errors.Of(repairs[i], step), divisor); });
  const double best = std::max_element(fits.begin(), fits.end(), [](const Fit& a, const Fit& b) {
                        return a.share < b.share;
                      })->share;
  double least_px = std::numeric_limits<double>::infinity();
  for (const Fit& fit : fits)
    if (fit.share >= best - kEqual) least_px = std::min(least_px, fit.error_px);
  const auto is_equal = [&](const Fit& fit) {
    return fit.share >= best - kEqual && fit.error_px <= 1.1 * least_px + 0.01 * divisor;
  };
  const auto chosen =
      static_cast<size_t>(std::find_if(fits.begin(), fits.end(), is_equal) - fits.begin());
  if (chosen == fits.size()) return {};  // nothing is explained at all
  for (size_t i = 0; i < repairs.size(); ++i)
    if (is_equal(fits[i]))
      LogDebug("agreement: {:.2f} px at {:.1f} % with {{repair {}}}", fits[i].error_px,
               100 * fits[i].share, NameOf(repairs[i]));
  const Judged judged = {repairs[chosen], FitOf(errors.Of(repairs[chosen]), divisor)};
  return IsOfScan(repairs[chosen], repairs) ? WithRefinedFocal(judged, errors, divisor) : judged;
}

// Returns true if a repair explains clearly more places better than the poses as recorded than it
// explains worse.
//   least_wins  share of the places
bool IsBetter(const std::vector<PlaceError>& repaired, const std::vector<PlaceError>& recorded,
              double least_wins) {
  constexpr size_t kWinsPerLoss = 4;
  const Duel duel = Compare(repaired, recorded);
  LogDebug("agreement: {} of {} places are explained better, {} worse", duel.wins, recorded.size(),
           duel.losses);
  return duel.wins >= kLeastPlaces && duel.wins >= kWinsPerLoss * duel.losses &&
         static_cast<double>(duel.wins) >= least_wins * static_cast<double>(recorded.size());
}

// How other orders of the names explain the images.
struct Orders {
  std::optional<Judged> better;  // better than the recorded order
  bool are_equal = false;        // true if another order explains the images no worse
};

// Tries other orders of the names. Names shifted by one leave most neighbours in a grid beside one
// another, and turn a ring as a whole, so that most places agree nevertheless: few wins suffice.
Orders TryOrders(const std::vector<Repair>& repairs, const PlaceErrors& errors,
                 const std::vector<PlaceError>& recorded, double share, int divisor) {
  Orders orders;
  for (const Repair& order : repairs) {
    if (order.names == NameOrder::kAsRecorded) continue;
    const std::vector<PlaceError> repaired = errors.Of(order);
    const Fit fit = FitOf(repaired, divisor);
    if (fit.share >= kRepairedShare && (!orders.better || fit.share > orders.better->fit.share) &&
        IsBetter(repaired, recorded, kOrderWins))
      orders.better = Judged{order, fit};
    const bool is_same = std::equal(repaired.begin(), repaired.end(), recorded.begin(),
                                    [](const PlaceError& a, const PlaceError& b) {
                                      return std::abs(a.reduced_px - b.reduced_px) < 1e-6;
                                    });
    if (!is_same && fit.share > share - kMostGain) orders.are_equal = true;
  }
  return orders;
}

// Returns the repair of a focal length that no lens without distortion has, because it is not in
// pixels, if images and poses agree with it no less; none if there is no such fault. Parallel
// cameras agree with any focal length: the scene is then longer or shorter. Among repairs that
// explain the images about equally well, the most usual one is taken.
std::optional<Judged> PlausibleFocal(const LightField& light_field, const PlaceErrors& errors,
                                     const Fit& recorded, int divisor) {
  const Intrinsics& k = light_field.Camera({0}).intrinsics;
  if (k.has_distortion() || k.fx_px >= kLeastFocal / 2 * k.width_px) return std::nullopt;
  std::optional<Judged> best;
  for (const Repair& repair : FocalRepairs(light_field)) {
    const Fit fit = FitOf(errors.Of(repair), divisor);
    if (fit.share >= kRepairedShare && fit.share >= recorded.share - kMostGain &&
        (!best || fit.share > best->fit.share + kEqual))
      best = Judged{repair, fit};
  }
  return best;
}

// Returns true if other intrinsics, which must be wrong, explain the images clearly less well.
bool TellsIntrinsics(const PlaceErrors& errors, const Fit& recorded, const Intrinsics& k,
                     int divisor) {
  std::vector<Repair> others = {{.focal_factors = {0.5, 0.5}}, {.focal_factors = {2, 2}}};
  if (std::abs(k.cx_px - k.cy_px) > 0.05 * k.width_px)
    others.push_back({.swap_principal_point = true});
  return std::all_of(others.begin(), others.end(), [&](const Repair& other) {
    return FitOf(errors.Of(other), divisor).share < recorded.share - kMostGain;
  });
}

void SetRepair(const Judged& judged, std::string clause, Agreement* agreement) {
  agreement->verdict = Verdict::kDisagree;
  agreement->repair = judged.repair;
  agreement->repaired = judged.fit;
  agreement->clause = std::move(clause);
}

// Judges places that suffice for a verdict.
void Judge(const LightField& light_field, const FoundPlaces& found, ThreadPool& pool,
           Agreement* agreement) {
  const Intrinsics k = light_field.Camera({0}).intrinsics;
  const PlaceErrors errors(light_field, found.places, found.divisor);
  const std::vector<PlaceError> recorded = errors.Of({});
  agreement->fit = FitOf(recorded, found.divisor);
  const std::vector<Repair> usual = UsualRepairs(AreParallel(light_field));
  // Mistakes that are certainly none: if they explained the images as well, nothing could be told.
  double least_share = 1;
  for (const Repair& control : usual) {
    if (control.names != NameOrder::kAsRecorded) continue;
    if (&control - usual.data() > 8) break;
    least_share = std::min(least_share, FitOf(errors.Of(control), found.divisor).share);
  }
  const bool can_tell = agreement->fit.share - least_share >= kContrast;
  double gain = 0;
  bool is_doubted = false;  // true if a repair explains a few places better, and hardly any worse
  if (const std::optional<Judged> unit =
          PlausibleFocal(light_field, errors, agreement->fit, found.divisor)) {
    SetRepair(*unit, ClauseFor(unit->repair, light_field), agreement);
    return;
  }
  const Orders orders = TryOrders(usual, errors, recorded, agreement->fit.share, found.divisor);
  const std::optional<Judged>& order = orders.better;
  if (order || agreement->fit.share < kSureShare) {
    std::vector<Repair> repairs = usual;
    const std::vector<Repair> focal = FocalRepairs(light_field);
    repairs.insert(repairs.end(), focal.begin(), focal.end());
    const Judged best = BestRepair(repairs, errors, recorded.size(), found.divisor, pool);
    gain = best.fit.share - agreement->fit.share;
    is_doubted =
        order || (!IsOfScan(best.repair, repairs) && IsBetter(errors.Of(best.repair), recorded, 0));
    if (best.fit.share >= kRepairedShare &&
        (gain >= kContrast || (best.fit.share >= kCertainShare && !IsOfScan(best.repair, repairs) &&
                               IsBetter(errors.Of(best.repair), recorded, kWins)))) {
      SetRepair(best, ClauseFor(best.repair, light_field), agreement);
      return;
    }
    if (order && order->fit.share >= kCertainShare) {
      SetRepair(*order, ClauseOf(order->repair), agreement);
      return;
    }
  }
  if (agreement->fit.share >= kAgreeShare && gain < kMostGain) {
    if (is_doubted) {
      agreement->reason = "a usual mistake would explain the LF images slightly better";
    } else if (recorded.size() < kPlacesForOrder && orders.are_equal) {
      agreement->reason = "so few places do not tell whether names are shifted";
    } else if (can_tell) {
      agreement->verdict = Verdict::kAgree;
      agreement->tells_intrinsics = TellsIntrinsics(errors, agreement->fit, k, found.divisor);
      agreement->tells_order = !orders.are_equal;
    } else {
      agreement->reason = "wrong poses would explain the LF images as well";
    }
  } else {
    agreement->reason =
        fmt::format("only {:.0f} % of the places agree, and no usual mistake explains it",
                    std::floor(100 * agreement->fit.share));
  }
}

}  // namespace

Result<Agreement> JudgeAgreement(const LightField& light_field, const LfImageStore& store,
                                 ThreadPool& pool, const std::atomic<bool>* interrupted) {
  LF_ASSIGN_OR_RETURN(FoundPlaces found, FindPlaces(light_field, store, pool, interrupted));
  // A place in two LF images tells only the distance from the epipolar line.
  const auto is_pair = [](const SeenPlace& place) { return place.others.size() == 1; };
  const auto pairs = std::count_if(found.places.begin(), found.places.end(), is_pair);
  if (found.places.size() - static_cast<size_t>(pairs) >= kLeastPlaces)
    std::erase_if(found.places, is_pair);
  Agreement agreement;
  agreement.place_count = found.places.size();
  agreement.pair_count = found.pair_count;
  agreement.image_count = found.image_count;
  LogDebug(
      "agreement: {} places in {} of {} pairs of {} LF images, {:.0f} corners in each, moved by "
      "{:.2f} reduced pixels of {}",
      found.places.size(), found.pair_count, found.tried_count, found.image_count,
      found.corner_count, found.move, found.divisor);
  if (found.places.size() < kLeastPlaces) {
    agreement.reason = WhyTooFew(found);
  } else if (found.move < kLeastMove) {
    agreement.reason = fmt::format("places move by only {:.1f} px between the LF images",
                                   found.move * found.divisor);
  } else {
    Judge(light_field, found, pool, &agreement);
  }
  return agreement;
}

const char* NameOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAgree:
      return "agree";
    case Verdict::kNotSure:
      return "not-sure";
    case Verdict::kDisagree:
      return "disagree";
  }
  LF_CHECK(false);
}

std::string TextOf(const Agreement& agreement) {
  const auto measured = [](const Fit& fit) {
    return fmt::format("{:.2g} px", std::max(fit.error_px, 0.01));
  };
  const std::string where =
      fmt::format("{} at {} places of {} pairs ({:.0f} %)", measured(agreement.fit),
                  agreement.place_count, agreement.pair_count, 100 * agreement.fit.share);
  switch (agreement.verdict) {
    case Verdict::kAgree:
      return "images agree with the poses: " + where +
             (agreement.tells_intrinsics
                  ? ""
                  : ", and would with other focal lengths or principal points") +
             (agreement.tells_order ? "" : ", and would with shifted names");
    case Verdict::kNotSure:
      return fmt::format("not sure that images and poses belong together: {}{}", agreement.reason,
                         agreement.fit.share > 0 ? ", " + where : "");
    case Verdict::kDisagree:
      break;
  }
  return fmt::format("images and poses do not agree: {}; they would ({}, {:.0f} %) if {}", where,
                     measured(agreement.repaired), 100 * agreement.repaired.share,
                     agreement.clause);
}

}  // namespace lf
