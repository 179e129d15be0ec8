// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/folded_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "lf/core/median.h"
#include "lf/core/shell_word.h"
#include "lf/densify/camera_chart.h"
#include "lf/densify/natural_neighbours.h"
#include "lf/densify/semi_global.h"
#include "lf/densify/working_images.h"

namespace lf {
namespace {

constexpr int kComparedWidth = 100;
constexpr size_t kNearest = 6;

ChosenPlanes Swept(const WorkingImage& reference, const WorkingImage& image,
                   const InverseDepths& range, int planes, InterruptFlag interrupted) {
  const SweepView view[] = {ViewFrom(reference, image)};
  MatchingCosts costs;
  ComputeMatchingCosts(reference, view, range, planes,
                       {0, 0, reference.width(), reference.height()}, &costs, interrupted);
  return ChoosePlanes(costs, reference.tones, false, interrupted);
}

// Returns the share of the textured pixels of one image that the other one confirms; nullopt if few
// pixels have texture.
std::optional<double> ConfirmedShare(const WorkingImage& image, const ChosenPlanes& of_image,
                                     const WorkingImage& other, const ChosenPlanes& of_other,
                                     const InverseDepths& range, int planes) {
  constexpr int kLeastTexture = 24, kCheap = 60, kLeastTextured = 50;
  constexpr float kSame = 1.5f;  // planes
  const PairMap map = MapBetween(image.camera, other.camera);
  const auto step = static_cast<float>((range.greatest - range.least) / (planes - 1));
  const auto least = static_cast<float>(range.least);
  int textured = 0, confirmed = 0;
  for (int y = 1; y + 1 < image.height(); ++y)
    for (int x = 1; x + 1 < image.width(); ++x) {
      if (TextureAt(image.tones, x, y) <= kLeastTexture) continue;
      ++textured;
      const float z = least + of_image.place.at(x, y) * step;
      const PairMap::Place at =
          map.At(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, z);
      if (of_image.cost.at(x, y) >= kCheap || !(at.w > 0 && at.u_px >= 0 && at.v_px >= 0 &&
                                                at.u_px < static_cast<float>(other.width()) &&
                                                at.v_px < static_cast<float>(other.height())))
        continue;
      const float there =
          least + of_other.place.at(static_cast<int>(at.u_px), static_cast<int>(at.v_px)) * step;
      if (std::abs(there - z / at.w) < kSame * step) ++confirmed;
    }
  if (textured < kLeastTextured) return std::nullopt;
  return static_cast<double>(confirmed) / textured;
}

// Returns the larger share of both; nullopt if few pixels have texture.
std::optional<double> AgreeingShare(const WorkingImage& a, const WorkingImage& b,
                                    const InverseDepths& range, InterruptFlag interrupted) {
  constexpr double kStep_px = 0.5, kFewest = 8, kMost = 160;
  const double shift_px = (range.greatest - range.least) * ShiftPerInverseDepth(a.camera, b.camera);
  const int planes = static_cast<int>(std::clamp(shift_px / kStep_px + 2, kFewest, kMost));
  const ChosenPlanes of_a = Swept(a, b, range, planes, interrupted);
  const ChosenPlanes of_b = Swept(b, a, range, planes, interrupted);
  const std::optional<double> in_a = ConfirmedShare(a, of_a, b, of_b, range, planes);
  const std::optional<double> in_b = ConfirmedShare(b, of_b, a, of_a, range, planes);
  return std::max(in_a, in_b);
}

// Groups of numbers that are joined step by step.
class Groups {
 public:
  explicit Groups(size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0u);
  }
  void Join(uint32_t a, uint32_t b) { parents_[RootOf(a)] = RootOf(b); }
  uint32_t RootOf(uint32_t i) const {
    while (parents_[i] != i) i = parents_[i];
    return i;
  }

 private:
  std::vector<uint32_t> parents_;
};

constexpr double kAgrees = 0.4, kDisagrees = 0.2;  // limits, as shares of the usual best share

double UsualBest(size_t count, std::span<const ComparedPair> pairs) {
  std::vector<double> best(count, -1);
  for (const ComparedPair& pair : pairs)
    for (const uint32_t i : {pair.first, pair.second})
      best[i] = std::max(best[i], pair.agreeing_share);
  std::erase(best, -1);
  return Median(std::move(best));
}

std::string NameOf(const LightField& light_field, uint32_t id) {
  return std::filesystem::path(light_field.image_names[id]).filename().string();
}

// Returns a pattern of --exclude that matches the name. Characters that have a meaning in a list of
// patterns become "?", which matches any character.
std::string PatternOf(std::string name) {
  for (size_t i = 0; i < name.size(); ++i)
    if (std::strchr(",*[\\", name[i]) || (i == 0 && name[i] == '@')) name[i] = '?';
  return name;
}

// Returns the groups with all LF images that are joined to them by pairs that agree; nullopt if two
// groups are then joined.
std::optional<std::vector<std::vector<uint32_t>>> Grown(
    size_t count, std::span<const std::vector<uint32_t>> groups,
    std::span<const ComparedPair> pairs) {
  const double usual = UsualBest(count, pairs);
  Groups joined(count);
  for (const ComparedPair& pair : pairs)
    if (pair.agreeing_share >= kAgrees * usual) joined.Join(pair.first, pair.second);
  std::map<uint32_t, size_t> group_of_root;
  for (size_t g = 0; g < groups.size(); ++g)
    for (const uint32_t id : groups[g])
      if (group_of_root.try_emplace(joined.RootOf(id), g).first->second != g) return std::nullopt;
  std::vector<std::vector<uint32_t>> grown(groups.size());
  for (uint32_t id = 0; id < count; ++id)
    if (const auto group = group_of_root.find(joined.RootOf(id)); group != group_of_root.end())
      grown[group->second].push_back(id);
  return grown;
}

// Returns names with runs of LF images abbreviated: "a.jpg to c.jpg, f.jpg".
std::string RunsText(const LightField& light_field, std::span<const uint32_t> ids) {
  std::string text;
  for (size_t i = 0; i < ids.size();) {
    size_t last = i;
    while (last + 1 < ids.size() && ids[last + 1] == ids[last] + 1) ++last;
    text += (text.empty() ? "" : ", ") + NameOf(light_field, ids[i]);
    if (last > i) text += " to " + NameOf(light_field, ids[last]);
    i = last + 1;
  }
  return text;
}

// Returns the command that writes a light field of one group.
//   number  of the group, from 0
std::string GroupCommand(const LightField& light_field, const std::vector<uint32_t>& group,
                         size_t number, std::span<const std::string> source) {
  std::string excluded;
  for (uint32_t id = 0; id < light_field.image_names.size(); ++id)
    if (!std::binary_search(group.begin(), group.end(), id))
      excluded += (excluded.empty() ? "" : ",") + PatternOf(NameOf(light_field, id));
  std::vector<std::string> words = {"lfimport"};
  words.insert(words.end(), source.begin(), source.end());
  words.insert(words.end(), {"-o", fmt::format("group_{}", number + 1), "--exclude", excluded});
  return ShellCommand(words);
}

}  // namespace

Result<std::vector<ComparedPair>> ComparePairs(const LightField& light_field,
                                               const LfImageStore& store,
                                               std::span<const uint32_t> ids,
                                               const InverseDepths& range, ThreadPool& pool,
                                               const Watch& watch) {
  std::set<std::pair<uint32_t, uint32_t>> wanted;
  const auto distance = [&](uint32_t a, uint32_t b) {
    return (light_field.Camera(LfImageId{a}).CentreWorld() -
            light_field.Camera(LfImageId{b}).CentreWorld())
        .norm();
  };
  for (const uint32_t id : ids) {
    std::vector<std::pair<double, uint32_t>> order;
    for (const uint32_t other : ids)
      if (other != id) order.emplace_back(distance(id, other), other);
    std::sort(order.begin(), order.end());
    for (size_t k = 0; k < std::min(kNearest, order.size()); ++k)
      wanted.insert(std::minmax(id, order[k].second));
  }
  const int divisor = std::max(1, light_field.intrinsics.front().width_px / kComparedWidth);
  WorkingImages images(light_field, store, divisor, std::numeric_limits<size_t>::max());
  const std::vector<std::pair<uint32_t, uint32_t>> list(wanted.begin(), wanted.end());
  std::vector<std::optional<double>> shares(list.size());
  const auto compare = [&](size_t i) -> Result<void> {
    LF_ASSIGN_OR_RETURN(const auto first, images.Get(LfImageId{list[i].first}));
    LF_ASSIGN_OR_RETURN(const auto second, images.Get(LfImageId{list[i].second}));
    shares[i] = AgreeingShare(*first, *second, range, watch.interrupted);
    return {};
  };
  LF_RETURN_IF_ERROR(ForEachWatched(pool, list.size(), watch, compare));
  std::vector<ComparedPair> pairs;
  for (size_t i = 0; i < list.size(); ++i)
    if (shares[i])
      pairs.push_back(
          {list[i].first, list[i].second, distance(list[i].first, list[i].second), *shares[i]});
  return pairs;
}

std::vector<std::vector<uint32_t>> ContradictingGroups(size_t count,
                                                       std::span<const ComparedPair> pairs) {
  constexpr double kLeastSize = 0.1, kInterleaved = 0.25;
  constexpr size_t kLeastImages = 3, kLeastInterleaved = 2;
  constexpr double kLeastUsual = 0.15;
  if (pairs.empty()) return {};
  const double usual = UsualBest(count, pairs);
  if (usual < kLeastUsual) return {};
  Groups joined(count);
  std::vector<double> distances;
  std::set<uint32_t> compared;
  for (const ComparedPair& pair : pairs) {
    compared.insert({pair.first, pair.second});
    if (pair.agreeing_share >= kAgrees * usual) {
      joined.Join(pair.first, pair.second);
      distances.push_back(pair.distance);
    }
  }
  if (distances.empty()) return {};
  const double near = Median(std::move(distances));

  std::vector<std::vector<uint32_t>> groups(count);
  for (uint32_t i = 0; i < count; ++i) groups[joined.RootOf(i)].push_back(i);
  const auto share = kLeastSize * static_cast<double>(compared.size());
  const size_t least_size = std::max(kLeastImages, static_cast<size_t>(std::ceil(share)));
  std::erase_if(groups, [&](const auto& group) { return group.size() < least_size; });
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });

  const auto contradicts = [&](const std::vector<uint32_t>& larger,
                               const std::vector<uint32_t>& smaller) {
    std::set<uint32_t> disagreeing;
    for (const ComparedPair& pair : pairs) {
      if (pair.distance > near || pair.agreeing_share >= kDisagrees * usual) continue;
      for (const auto& [here, there] :
           {std::pair(pair.first, pair.second), std::pair(pair.second, pair.first)})
        if (joined.RootOf(here) == joined.RootOf(smaller[0]) &&
            joined.RootOf(there) == joined.RootOf(larger[0]))
          disagreeing.insert(here);
    }
    return disagreeing.size() >= kLeastInterleaved &&
           static_cast<double>(disagreeing.size()) >=
               kInterleaved * static_cast<double>(smaller.size());
  };
  for (size_t i = 0; i < groups.size(); ++i)
    for (size_t j = i + 1; j < groups.size(); ++j)
      if (contradicts(groups[i], groups[j])) return groups;
  return {};
}

std::optional<FilmGroup> GroupOfFilm(const LightField& light_field,
                                     std::span<const std::vector<uint32_t>> groups,
                                     std::span<const RenderCamera> frames) {
  constexpr size_t kAsked = 8;
  constexpr double kMiddle = 1.0 / 8;  // share of the distance of the farthest LF camera asked
  constexpr double kLeastMean = 2.0 / 3, kLeastOfFrame = 0.5;
  const std::vector<uint32_t> all_ids = FarEnoughApart(light_field, {});
  std::vector<double> sums(groups.size(), 0), least(groups.size(), 1);
  for (const RenderCamera& frame : frames) {
    const CameraChart chart =
        ChartAround(light_field, all_ids, frame.pinhole, 1 / frame.focus_distance_w);
    std::vector<uint32_t> near = ByDistance(chart.points, Vec2::Zero());
    near.resize(std::min(kAsked, near.size()));
    const double middle = near.empty() ? 0 : kMiddle * chart.points[near.back()].norm();
    if (middle == 0) return std::nullopt;
    std::vector<double> nearness(groups.size(), 0);
    double all = 0;
    for (const uint32_t at : near) {
      const double one = 1 / (chart.points[at].squaredNorm() + middle * middle);
      all += one;
      for (size_t g = 0; g < groups.size(); ++g)
        if (std::binary_search(groups[g].begin(), groups[g].end(), chart.ids[at]))
          nearness[g] += one;
    }
    for (size_t g = 0; g < groups.size(); ++g) {
      sums[g] += nearness[g] / all / static_cast<double>(frames.size());
      least[g] = std::min(least[g], nearness[g] / all);
    }
  }
  for (size_t g = 0; g < groups.size(); ++g)
    if (sums[g] >= kLeastMean && least[g] >= kLeastOfFrame) return FilmGroup{g, sums[g]};
  return std::nullopt;
}

std::string FilmGroupText(const LightField& light_field,
                          std::span<const std::vector<uint32_t>> groups, const FilmGroup& chosen,
                          std::span<const std::string> source) {
  const std::vector<uint32_t>& kept = groups[chosen.number];
  std::vector<uint32_t> left_out;
  for (uint32_t id = 0; id < light_field.size(); ++id)
    if (!std::binary_search(kept.begin(), kept.end(), id)) left_out.push_back(id);
  std::string others;
  for (size_t i = 0; i < groups.size(); ++i)
    if (i != chosen.number)
      others += (others.empty() ? "" : "; ") + GroupCommand(light_field, groups[i], i, source);
  return fmt::format(
      "{} LF images are left out ({}), because their poses are wrong: they do not agree with the "
      "LF "
      "images in the lenses of the film, although some of them stand as near, for example because "
      "equal patterns on two sides were confused. The film is made of the other {} ({}), which "
      "have {:.0f} % of the nearness to its lenses. To film what was left out instead: {}",
      left_out.size(), RunsText(light_field, left_out), kept.size(), RunsText(light_field, kept),
      100 * chosen.share, others);
}

std::string ContradictionText(const LightField& light_field,
                              std::span<const std::vector<uint32_t>> groups,
                              std::span<const std::string> source) {
  std::string text =
      "these LF cameras' pictures contradict each other: LF images stand as near to one another as "
      "those that agree, and show different things";
  std::string commands;
  for (size_t i = 0; i < groups.size(); ++i) {
    text += fmt::format("{} group {} has {} ({})", i == 0 ? ";" : ",", i + 1, groups[i].size(),
                        RunsText(light_field, groups[i]));
    commands += (i == 0 ? ": " : "; ") + GroupCommand(light_field, groups[i], i, source);
  }
  return text +
         ". Poses are wrong, for example because equal patterns on two sides were confused, or "
         "exposures differ ({lfimport match_exposure}). Densify each group by itself" +
         commands;
}

Result<Contradiction> FindContradiction(const LightField& light_field,
                                        std::span<const uint32_t> ids,
                                        std::span<const RenderCamera> frames,
                                        std::span<const std::string> source,
                                        const PairSearch& search) {
  const size_t count = light_field.size();
  LF_ASSIGN_OR_RETURN(std::vector<ComparedPair> pairs, search(ids));
  std::vector<std::vector<uint32_t>> groups = ContradictingGroups(count, pairs);
  if (groups.empty()) return Contradiction{};
  Contradiction found;
  if (!frames.empty()) {
    if (ids.size() < count) {
      std::vector<uint32_t> all(count);
      std::iota(all.begin(), all.end(), 0U);
      LF_ASSIGN_OR_RETURN(const std::vector<ComparedPair> further, search(all));
      pairs.insert(pairs.end(), further.begin(), further.end());
      if (auto grown = Grown(count, groups, pairs)) groups = *std::move(grown);
    }
    if (const std::optional<FilmGroup> chosen = GroupOfFilm(light_field, groups, frames)) {
      found.text = FilmGroupText(light_field, groups, *chosen, source);
      found.kept.assign(groups[chosen->number].begin(), groups[chosen->number].end());
      found.share = chosen->share;
      return found;
    }
  }
  found.text = ContradictionText(light_field, groups, source);
  return found;
}

}  // namespace lf
