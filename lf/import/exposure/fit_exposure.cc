// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exposure/fit_exposure.h"

#include <Eigen/Cholesky>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace lf {
namespace {

constexpr int kRounds = 16;
// The first kHuberRounds rounds use Huber's weights, the others Tukey's, which are 0 for outliers.
constexpr int kHuberRounds = 5;
// Tuning constants of these weights, in standard deviations. Both make the fit 95 % efficient on
// normal noise.
constexpr double kHuber = 1.345;
constexpr double kTukey = 4.685;
constexpr double kLeastFactor = 0.2;     // lower bound of Fit::factor_
constexpr double kUnit = 0.01;           // deviation of a sample whose weight is 1
constexpr double kLeastFalloff = 0.05;   // lower bound of the share F of a falloff, while fitting
constexpr double kPriorDeviation = 1;    // prior standard deviation of falloff coefficients
constexpr double kAgrees = 0.1;          // a log ratio agrees if its robust weight is larger
constexpr double kMostDeviation = 0.02;  // largest standard deviation of a log gain that is used
constexpr double kCommonShare = 0.25;    // share of a pair's spread that more samples do not reduce
// An LF image with fewer agreeing log ratios is kAlone. A sample has up to three: of R, G and B.
constexpr size_t kLeastLogRatios = 12;
// The spread of all pairs counts as much as the spread of this number of places of one pair.
constexpr double kBelievedSamples = 8;

double BoundedFalloff(const Vignetting& falloff, double r_squared) {
  return std::max(kLeastFalloff, falloff.Falloff(r_squared));
}

// Returns the mean of ln F over values of r^2 with this mean and variance, to the second order.
// F(r) is the share of light that the falloff leaves (camera/vignetting.h).
double MeanLogShare(const Vignetting& falloff, double r_squared, double variance) {
  const double share = BoundedFalloff(falloff, r_squared);
  const auto& [v1, v2, v3] = falloff.v;
  const double slope = (v1 + r_squared * (2 * v2 + r_squared * 3 * v3)) / share;
  const double bend = (2 * v2 + 6 * r_squared * v3) / share - slope * slope;
  return std::log(share) + bend * variance / 2;
}

// Returns the derivatives of ln F(r) by the coefficients v1, v2 and v3 of the falloff F.
Eigen::Vector3d Slope(const Vignetting& falloff, double r_squared) {
  return Eigen::Vector3d(r_squared, r_squared * r_squared, r_squared * r_squared * r_squared) /
         BoundedFalloff(falloff, r_squared);
}

double MedianOf(std::vector<double>* values) {
  if (values->empty()) return 0;
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

// Returns the standard deviation of normal noise whose absolute values are `sizes`. Outliers have
// little influence.
double SpreadOf(std::vector<double>* sizes) { return 1.4826 * MedianOf(sizes); }

class Fit {
 public:
  Fit(const std::vector<ExposureSample>& samples, const std::vector<uint32_t>& groups,
      const std::vector<Vignetting>& known, const FitOptions& options)
      : samples_(samples), groups_(groups), options_(options) {
    fit_.log_gains.resize(groups.size());
    fit_.falloffs = known;
    if (options.vignetting) std::fill(fit_.falloffs.begin(), fit_.falloffs.end(), Vignetting());
    FindPairs();
  }

  ExposureFit Run() {
    residuals_.resize(3 * samples_.size());
    weights_.resize(residuals_.size());
    agreements_.resize(residuals_.size());
    for (round_ = 0; round_ < kRounds; ++round_) {
      Weigh();
      Step();
    }
    Weigh();
    FindComponents();
    Centre();
    Summarise();
    return std::move(fit_);
  }

 private:
  // Numbers the pairs of LF images, because samples of the same pair contribute to the same entries
  // of the equations.
  void FindPairs() {
    std::unordered_map<uint64_t, uint32_t> numbers;
    for (const ExposureSample& sample : samples_) {
      const uint64_t key = uint64_t{sample.a} << 32 | sample.b;
      const auto [found, is_new] = numbers.emplace(key, static_cast<uint32_t>(pairs_.size()));
      if (is_new) pairs_.push_back({sample.a, sample.b});
      pair_of_.push_back(found->second);
    }
  }

  // Computes residuals_, factor_, agreements_ and weights_ from the present gains and falloffs.
  void Weigh() {
    std::vector<double> sizes;
    for (size_t i = 0; i < samples_.size(); ++i)
      for (size_t c = 0; c < 3; ++c) {
        const double measured = samples_[i].log_ratio[c];
        const double residual = measured - ModelLogRatio(samples_[i], static_cast<int>(c),
                                                         fit_.log_gains, groups_, fit_.falloffs);
        residuals_[3 * i + c] = residual;
        if (!std::isnan(residual)) sizes.push_back(std::abs(residual) / samples_[i].deviation[c]);
      }
    if (sizes.empty()) return;
    factor_ = std::max(kLeastFactor, SpreadOf(&sizes));
    for (size_t i = 0; i < residuals_.size(); ++i) {
      const double deviation = samples_[i / 3].deviation[i % 3];
      agreements_[i] =
          std::isnan(residuals_[i])
              ? 0
              : static_cast<float>(RobustWeight(std::abs(residuals_[i]) / (deviation * factor_)));
      weights_[i] = agreements_[i] * static_cast<float>(kUnit * kUnit / (deviation * deviation));
    }
  }

  double RobustWeight(double deviations) const {
    if (round_ < kHuberRounds) return deviations <= kHuber ? 1 : kHuber / deviations;
    if (deviations >= kTukey) return 0;
    const double x = deviations / kTukey;
    return (1 - x * x) * (1 - x * x);
  }

  // Makes one Gauss-Newton step for all gains and falloffs at once. The gains are eliminated first:
  // the matrix of their equations is the Laplacian of the graph whose nodes are LF images and whose
  // edges are pairs_; conjugate gradients solve it.
  void Step() {
    const auto images = static_cast<Eigen::Index>(groups_.size());
    const auto unknowns =
        static_cast<Eigen::Index>(options_.vignetting ? 3 * fit_.falloffs.size() : 0);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(unknowns, unknowns) *
                             std::pow(factor_ * kUnit / kPriorDeviation, 2);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
    for (Eigen::Index i = 0; i < unknowns; ++i)
      right[i] = -matrix(i, i) * fit_.falloffs[static_cast<size_t>(i / 3)].v[i % 3];
    std::array<Eigen::MatrixXd, 3> ties, solved;
    for (size_t c = 0; c < 3; ++c) {
      ties[c] = Eigen::MatrixXd::Zero(images, unknowns + 1);
      solved[c] = SolveGains(c, &ties[c], &matrix, &right);
    }
    for (size_t c = 0; c < 3; ++c) {
      const auto of_falloffs = ties[c].leftCols(unknowns);
      matrix -= of_falloffs.transpose() * solved[c].leftCols(unknowns);
      right -= of_falloffs.transpose() * solved[c].col(unknowns);
    }
    Eigen::VectorXd change = Eigen::VectorXd::Zero(unknowns);
    if (unknowns > 0) change = matrix.ldlt().solve(right);
    for (Eigen::Index i = 0; i < unknowns; ++i)
      fit_.falloffs[static_cast<size_t>(i / 3)].v[static_cast<size_t>(i % 3)] += change[i];
    for (size_t c = 0; c < 3; ++c) {
      const Eigen::VectorXd gains = solved[c].col(unknowns) - solved[c].leftCols(unknowns) * change;
      for (Eigen::Index i = 0; i < images; ++i)
        fit_.log_gains[static_cast<size_t>(i)][c] += gains[i];
    }
  }

  // Adds the samples of channel c to the equations of the falloffs (`matrix`, `right`) and to
  // `ties` = [C y]: C couples gains and falloffs, and y is the right-hand side of the equations of
  // the gains. Returns L^-1 [C y], where L is the Laplacian of the channel.
  Eigen::MatrixXd SolveGains(size_t c, Eigen::MatrixXd* ties, Eigen::MatrixXd* matrix,
                             Eigen::VectorXd* right) const {
    std::vector<double> of_pairs(pairs_.size());
    const Eigen::Index last = ties->cols() - 1;
    for (size_t i = 0; i < samples_.size(); ++i) {
      const double weight = weights_[3 * i + c];
      if (weight == 0) continue;
      const ExposureSample& sample = samples_[i];
      const double residual = residuals_[3 * i + c];
      of_pairs[pair_of_[i]] += weight;
      (*ties)(sample.a, last) -= weight * residual;
      (*ties)(sample.b, last) += weight * residual;
      if (last == 0) continue;
      const uint32_t group_a = groups_[sample.a], group_b = groups_[sample.b];
      const Eigen::Vector3d slope_a = Slope(fit_.falloffs[group_a], sample.a_r_squared);
      const Eigen::Vector3d slope_b = -Slope(fit_.falloffs[group_b], sample.b_r_squared);
      const auto at = [](uint32_t group) { return 3 * static_cast<Eigen::Index>(group); };
      for (const auto& [group, slope] :
           {std::pair(group_a, slope_a), std::pair(group_b, slope_b)}) {
        ties->block<1, 3>(sample.a, at(group)) -= weight * slope.transpose();
        ties->block<1, 3>(sample.b, at(group)) += weight * slope.transpose();
        right->segment<3>(at(group)) += weight * residual * slope;
        for (const auto& [other, other_slope] :
             {std::pair(group_a, slope_a), std::pair(group_b, slope_b)})
          matrix->block<3, 3>(at(group), at(other)) += weight * slope * other_slope.transpose();
      }
    }
    return SolveLaplacian(of_pairs, *ties);
  }

  Eigen::MatrixXd SolveLaplacian(const std::vector<double>& of_pairs,
                                 const Eigen::MatrixXd& right) const {
    const auto images = static_cast<Eigen::Index>(groups_.size());
    std::vector<Eigen::Triplet<double>> entries;
    for (size_t p = 0; p < pairs_.size(); ++p) {
      const int a = static_cast<int>(pairs_[p][0]), b = static_cast<int>(pairs_[p][1]);
      entries.emplace_back(a, a, of_pairs[p]);
      entries.emplace_back(b, b, of_pairs[p]);
      entries.emplace_back(a, b, -of_pairs[p]);
      entries.emplace_back(b, a, -of_pairs[p]);
    }
    // A tiny multiple of the identity makes gains that no sample determines keep their value.
    constexpr double kTrace = 1e-9;
    for (int i = 0; i < static_cast<int>(images); ++i) entries.emplace_back(i, i, kTrace);
    Eigen::SparseMatrix<double> laplacian(images, images);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(1e-10);
    solver.compute(laplacian);
    Eigen::MatrixXd solved = Eigen::MatrixXd::Zero(images, right.cols());
    for (Eigen::Index column = 0; column < right.cols(); ++column)
      if (right.col(column).squaredNorm() > 0) solved.col(column) = solver.solve(right.col(column));
    return solved;
  }

  bool Agrees(size_t sample, size_t c) const { return agreements_[3 * sample + c] > kAgrees; }

  // Returns the variance of the log ratio of each pair of LF images, estimated from how much the
  // places that both images show differ in their residuals. If a lamp stands still while the object
  // turns, each place becomes brighter or darker by a factor that it shares only with the places
  // around it. In this case no gain is right, and more samples do not help.
  std::vector<double> PairVariances() {
    std::vector<std::vector<double>> sizes(pairs_.size());
    std::vector<double> all;
    for (size_t i = 0; i < residuals_.size(); ++i)
      if (!std::isnan(residuals_[i])) {
        sizes[pair_of_[i / 3]].push_back(std::abs(residuals_[i]));
        all.push_back(std::abs(residuals_[i]));
      }
    const double common = std::pow(SpreadOf(&all), 2);
    std::vector<double> variances(pairs_.size());
    std::vector<double> spreads;
    for (size_t p = 0; p < pairs_.size(); ++p) {
      const double places = static_cast<double>(sizes[p].size()) / 3;
      const double own = std::pow(SpreadOf(&sizes[p]), 2);
      const double spread_squared =
          (kBelievedSamples * common + places * own) / (kBelievedSamples + places);
      variances[p] = spread_squared * (kCommonShare * kCommonShare + 1 / std::max(places, 0.1));
      spreads.push_back(std::sqrt(own));
    }
    fit_.spread = MedianOf(&spreads);
    return variances;
  }

  // Finds the LF images whose gains are determined by enough samples, and the components that these
  // LF images form.
  void FindComponents() {
    std::vector<size_t> counts(groups_.size());
    for (size_t i = 0; i < samples_.size(); ++i)
      for (size_t c = 0; c < 3; ++c)
        if (Agrees(i, c)) ++counts[samples_[i].a], ++counts[samples_[i].b];
    const std::vector<double> variances = PairVariances();
    std::vector<double> certainties(groups_.size());
    for (size_t p = 0; p < pairs_.size(); ++p)
      for (const uint32_t image : pairs_[p]) certainties[image] += 1 / variances[p];
    std::vector<uint32_t> parents(groups_.size());
    std::iota(parents.begin(), parents.end(), 0U);
    const auto root = [&](uint32_t i) {
      while (parents[i] != i) i = parents[i] = parents[parents[i]];
      return i;
    };
    const auto is_tied = [&](uint32_t image) {
      return counts[image] >= kLeastLogRatios &&
             certainties[image] >= 1 / (kMostDeviation * kMostDeviation);
    };
    for (size_t i = 0; i < samples_.size(); ++i) {
      const auto [a, b] = pairs_[pair_of_[i]];
      if (is_tied(a) && is_tied(b) && (Agrees(i, 0) || Agrees(i, 1) || Agrees(i, 2)))
        parents[root(a)] = root(b);
    }
    std::vector<size_t> sizes(groups_.size());
    for (uint32_t i = 0; i < groups_.size(); ++i) ++sizes[root(i)];
    std::vector<uint32_t> numbers(groups_.size(), kAlone);
    fit_.components.assign(groups_.size(), kAlone);
    for (uint32_t i = 0; i < groups_.size(); ++i) {
      if (sizes[root(i)] < 2) continue;
      if (numbers[root(i)] == kAlone) numbers[root(i)] = fit_.component_count++;
      fit_.components[i] = numbers[root(i)];
    }
  }

  void Centre() {
    std::vector<std::array<double, 3>> sums(fit_.component_count);
    std::vector<size_t> counts(fit_.component_count);
    for (size_t i = 0; i < groups_.size(); ++i) {
      if (fit_.components[i] == kAlone) continue;
      ++counts[fit_.components[i]];
      for (size_t c = 0; c < 3; ++c) sums[fit_.components[i]][c] += fit_.log_gains[i][c];
    }
    for (size_t i = 0; i < groups_.size(); ++i)
      for (size_t c = 0; c < 3; ++c)
        fit_.log_gains[i][c] =
            fit_.components[i] == kAlone
                ? 0
                : fit_.log_gains[i][c] -
                      sums[fit_.components[i]][c] / static_cast<double>(counts[fit_.components[i]]);
  }

  void Summarise() {
    fit_.weights.resize(samples_.size());
    double sum = 0;
    for (size_t i = 0; i < samples_.size(); ++i)
      for (size_t c = 0; c < 3; ++c) {
        if (!Agrees(i, c) || fit_.components[samples_[i].a] == kAlone) continue;
        ++fit_.sample_count;
        sum += std::abs(residuals_[3 * i + c]);
        fit_.weights[i] = std::max(fit_.weights[i], agreements_[3 * i + c]);
      }
    if (fit_.sample_count > 0) fit_.step = sum / static_cast<double>(fit_.sample_count);
  }

  const std::vector<ExposureSample>& samples_;
  const std::vector<uint32_t>& groups_;
  const FitOptions options_;
  std::vector<std::array<uint32_t, 2>> pairs_;
  std::vector<uint32_t> pair_of_;  // index into pairs_, for each sample
  std::vector<double> residuals_;  // [samples][3]: log ratio minus model; NaN: no log ratio
  std::vector<float> agreements_;  // [samples][3]: robust weights, in [0, 1]
  std::vector<float> weights_;     // [samples][3]: robust weights times inverse variance
  double factor_ = 1;  // actual size of residuals, as a multiple of ExposureSample::deviation
  int round_ = 0;
  ExposureFit fit_;
};

}  // namespace

double ModelLogRatio(const ExposureSample& sample, int channel,
                     const std::vector<std::array<double, 3>>& log_gains,
                     const std::vector<uint32_t>& groups, const std::vector<Vignetting>& falloffs) {
  const auto c = static_cast<size_t>(channel);
  return log_gains[sample.b][c] - log_gains[sample.a][c] +
         MeanLogShare(falloffs[groups[sample.a]], sample.a_r_squared, sample.a_r_variance) -
         MeanLogShare(falloffs[groups[sample.b]], sample.b_r_squared, sample.b_r_variance);
}

ExposureFit FitExposure(const std::vector<ExposureSample>& samples,
                        const std::vector<uint32_t>& groups, const std::vector<Vignetting>& known,
                        const FitOptions& options) {
  return Fit(samples, groups, known, options).Run();
}

}  // namespace lf
